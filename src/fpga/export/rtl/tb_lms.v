// Self-checking testbench of the LMS and NLMS pipelines; the checks are in tb_common.vh. Run by
// run.sh. Plusargs as in tb_rls.v.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"
`define DUT lms
`define VEC_NAME "lms"

module tb_lms;
    localparam W          = `VEC_WIDTH;
    localparam N          = `VEC_TAPS;
    localparam RAMA_WORDS = N;
    localparam RAMB_WORDS = N;
    localparam DIVISIONS  = `VEC_NLMS != 0 ? 1 : 0;
    localparam PERIOD     = `VEC_PERIOD + (`VEC_DIV_LATENCY - 1) * DIVISIONS;
    localparam TRACED     = 1;
    localparam LATENCY    = `VEC_LATENCY + (`VEC_DIV_LATENCY - 1) * DIVISIONS;
    localparam CLEARING   = 10;

    reg          clk, rst;
    wire         strobe, in_ready, out_valid;
    wire [W-1:0] x, d, y;

    lms_core #(
        .N(N), .W(W), .MU(`VEC_MU), .EPS(`VEC_EPS), .NLMS(`VEC_NLMS), .D_PORT(`VEC_D_PORT),
        .UPDATE_SUB(`VEC_UPDATE_SUB), .FTZ(`VEC_FTZ), .DIV_LATENCY(`VEC_DIV_LATENCY)
    ) lms (
        .clk(clk), .rst(rst), .in_valid(strobe), .in_ready(in_ready),
        .x(x), .d(d), .out_valid(out_valid), .y(y));

    `include "tb_common.vh"

`ifndef BLACK_BOX
    // The divider stands a level lower than the other units: plain LMS has none.
    generate
        if (`VEC_NLMS != 0) begin : divider
            always @(dumping) $dumpvars(1, lms.with_divider.div);
        end
    endgenerate
`endif
endmodule
