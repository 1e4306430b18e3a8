// Self-checking testbench of the LMS pipeline. Stops non-zero at the first difference.
`timescale 1ns/1ps
`include "params.vh"

module tb_lms;
    localparam W = `FB_W;
    localparam DEPTH_A = `FB_N;
    localparam DEPTH_B = `FB_N;
    `include "tb_body.vh"

    lms_core #(
        .N(`FB_N), .W(W), .FTZ(`FB_FTZ), .NORMALISED(`FB_NORMALISED), .MEAN(`FB_MEAN),
        .AS_PRINTED(`FB_AS_PRINTED), .ONE(`FB_ONE), .HALF(`FB_HALF), .MU(`FB_MU), .EPS(`FB_EPS)
    ) dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .x(x), .d(d),
        .out_valid(out_valid), .y(y)
    );
endmodule
