// Self-checking testbench of the RLS pipeline. Stops non-zero at the first difference.
`timescale 1ns/1ps
`include "params.vh"

module tb_rls;
    localparam W = `FB_W;
    localparam DEPTH_A = 2 * `FB_P;
    localparam DEPTH_B = 2 * `FB_P + `FB_P * `FB_P;
    `include "tb_body.vh"

    rls_core #(
        .P(`FB_P), .W(W), .FTZ(`FB_FTZ), .ELEM(`FB_ELEM), .AS_PRINTED(`FB_AS_PRINTED),
        .ONE(`FB_ONE), .ALPHA(`FB_ALPHA), .IALPHA(`FB_IALPHA), .DELTA(`FB_DELTA)
    ) dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .x(x), .d(d),
        .out_valid(out_valid), .y(y)
    );
endmodule
