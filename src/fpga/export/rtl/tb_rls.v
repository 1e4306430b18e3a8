// Self-checking testbench of the RLS pipeline; the checks are in tb_common.vh. Run by run.sh.
//
// Plusargs: +VEC_DIR=folder of the vectors; +GAP=n clocks without strobe after each sample, or,
// with +GAP_SEED=s, a random number of them from 0 to n; +WITHDRAW raises the strobe for one clock
// before the first sample; +RESETS=0 leaves out the resets in every state before the run; +VCD=file,
// +VCD_FIRST=sample, +VCD_SAMPLES=count dump a window.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"
`define DUT rls
`define VEC_NAME "rls"

module tb_rls;
    localparam W          = `VEC_WIDTH;
    localparam P          = `VEC_TAPS;
    localparam RAMA_WORDS = 2 * P;
    localparam RAMB_WORDS = 2 * P + P * P;
    // Clocks of a sample: a step lasts as long as the slowest unit that it asks for.
    localparam LA   = `VEC_ADD_LATENCY;
    localparam LM   = `VEC_MUL_LATENCY;
    localparam LD   = `VEC_DIV_LATENCY;
    localparam DOT  = LM + (P - 1) * (LA > LM ? LA : LM) + LA;
    localparam LS   = `VEC_ALPHA == (W == 64 ? 64'h3ff0000000000000 : 64'h3f800000)
                    || LA + LM == 2 ? 0 : LM;
    localparam RFR  = `VEC_DIV_ELEM != 0 ? P * P * (LM + LD + LA + LS)
                    : P * P * (2 * LM + LA + LS) + (LD > LM ? LD - LM : 0);
    localparam LATENCY = 1 + 2 * (P + 1) * DOT + RFR;
    localparam PERIOD  = LATENCY + LA + P * (LM + LA);
    // With latencies from run.sh the control may take a step that the trace does not have, or the other
    // way round.
`ifdef VEC_OTHER_UNITS
`ifdef VEC_UNITS_PERIOD
    localparam TRACED = 0;
`else
    localparam TRACED = LS == 0;
`endif
`else
    localparam TRACED = 1;
`endif
    localparam CLEARING   = 14;

    reg          clk, rst;
    wire         strobe, in_ready, out_valid;
    wire [W-1:0] x, d, y;

    rls_core #(
        .P(P), .W(W), .ALPHA(`VEC_ALPHA), .IALPHA(`VEC_IALPHA), .DELTA(`VEC_DELTA),
        .DIV_ELEM(`VEC_DIV_ELEM), .UPDATE_SUB(`VEC_UPDATE_SUB), .FTZ(`VEC_FTZ),
        .ADD_LATENCY(`VEC_ADD_LATENCY), .MUL_LATENCY(`VEC_MUL_LATENCY), .DIV_LATENCY(`VEC_DIV_LATENCY)
    ) rls (
        .clk(clk), .rst(rst), .in_valid(strobe), .in_ready(in_ready),
        .x(x), .d(d), .out_valid(out_valid), .y(y));

    `include "tb_common.vh"
endmodule
