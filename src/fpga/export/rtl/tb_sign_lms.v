// Self-checking testbench of the line enhancer; the checks are in tb_common.vh. Run by run.sh.
// Plusargs as in tb_rls.v.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"
`define DUT sign_lms
`define VEC_NAME "sign_lms"

module tb_sign_lms;
    localparam W          = `VEC_WIDTH;
    localparam M          = `VEC_TAPS;
    localparam RAMA_WORDS = M;
    localparam RAMB_WORDS = M;
    localparam DIVISIONS  = 1;
    localparam PERIOD     = `VEC_PERIOD + (`VEC_DIV_LATENCY - 1) * DIVISIONS;
    localparam TRACED     = 1;
    localparam LATENCY    = `VEC_LATENCY + (`VEC_DIV_LATENCY - 1) * DIVISIONS;
    localparam CLEARING   = 11;

    reg          clk, rst;
    wire         strobe, in_ready, out_valid;
    wire [W-1:0] x, d, y;

    sign_lms_core #(
        .M(M), .W(W), .MU(`VEC_MU), .ALPHA(`VEC_ALPHA), .W0(`VEC_W0), .GUARD(`VEC_GUARD),
        .GUARDED(`VEC_GUARDED), .HOLD(`VEC_HOLD), .NLMS(`VEC_NLMS), .RECOMPUTE(`VEC_RECOMPUTE),
        .FTZ(`VEC_FTZ), .DIV_LATENCY(`VEC_DIV_LATENCY)
    ) sign_lms (
        .clk(clk), .rst(rst), .in_valid(strobe), .in_ready(in_ready),
        .x(x), .d(d), .out_valid(out_valid), .y(y));

    `include "tb_common.vh"
endmodule
