// Self-checking testbench of an export's top level. Run by run.sh.
//
// Samples go in at the board's port, in_codes.hex or samples.hex; checked, the first mismatch ends
// the run non-zero: every result against y.hex, one sample later with the next-sample register; the
// clocks from a sample to its pair and from pair to pair, back to back. Before that a reset in the clock
// in which the core takes a pair, which must leave nothing behind.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"

module top_bench;
    localparam W       = `VEC_WIDTH;
    localparam SB      = `VEC_TOP_SAMPLE_BITS;
    localparam FB      = `VEC_TOP_CODE != 0 ? 32 : W;
    localparam RB      = `VEC_TOP_RESULT_BITS;
    localparam SAMPLES = `VEC_SAMPLES;

    // Words of a width of their own stand sign-extended in their files.
    reg [FB-1:0] samples [0:SAMPLES-1];
    reg [W-1:0]  y_words [0:SAMPLES-1];

    // Longest path, in characters. Verilator 5.006 holds no longer string.
    reg [8*256-1:0] vec_dir, path;
    reg             clk, rst, valid, failed;
    wire            ready, result_valid;
    wire [RB-1:0]   result;
    integer         cycle, taken, given, handed, start, first;
    // With the next-sample register result k stands for y of sample k-1, the first for +0.
    wire [W-1:0]    want = given < `VEC_TOP_NEXT ? {W{1'b0}} : y_words[given - `VEC_TOP_NEXT];
    wire [FB-1:0]   next_sample = samples[taken < SAMPLES ? taken : 0];

    `VEC_TOP #(
        .ADD_LATENCY(`VEC_ADD_LATENCY), .MUL_LATENCY(`VEC_MUL_LATENCY),
        .DIV_LATENCY(`VEC_DIV_LATENCY)
    ) top (
        .clk(clk), .rst(rst), .sample_valid(valid), .sample_ready(ready),
        .sample(valid ? next_sample[SB-1:0] : {SB{1'b0}}),
        .result_valid(result_valid), .result(result));

    always #(`VEC_CLOCK_PS / 2) clk = ~clk;

    task fail(input [8*24-1:0] what, input [63:0] expected, input [63:0] got);
        if (!failed) begin
            failed = 1'b1;
            $display("MISMATCH %0s: expected %h got %h", what, expected, got);
            $display("  top level, cycle %0d, result %0d", cycle, given);
            $fatal(1, "first mismatch, stopped");
        end
    endtask

    reg last_run;
    initial begin
        clk = 1'b0; rst = 1'b1; valid = 1'b0; failed = 1'b0; last_run = 1'b0;
        cycle = 0; taken = 0; given = 0; handed = 0; start = 0; first = 0;
        if (!$value$plusargs("VEC_DIR=%s", vec_dir)) vec_dir = ".";
        if (`VEC_TOP_CODE != 0) $sformat(path, "%0s/in_codes.hex", vec_dir);
        else $sformat(path, "%0s/samples.hex", vec_dir);
        $readmemh(path, samples);
        $sformat(path, "%0s/y.hex", vec_dir);
        $readmemh(path, y_words);
        if (^samples[SAMPLES-1] === 1'bx || ^y_words[SAMPLES-1] === 1'bx)
            fail("vectors, missing or short", 64'd0, 64'd0);
        repeat (2) @(negedge clk);
        rst = 1'b0;
        // Two samples and a half, then a reset in the clock in which a pair is taken.
        valid = 1'b1;
        repeat (5 * `VEC_PERIOD / 2 + 40) @(negedge clk);
        while (!(top.pair_valid && top.pair_ready)) @(negedge clk);
        rst = 1'b1;
        valid = 1'b0;
        @(negedge clk);
        if (result_valid !== 1'b0) fail("result_valid after reset", 64'd0, result_valid);
        if (result !== {RB{1'b0}}) fail("result after reset", 64'd0, result);
        cycle = 0; taken = 0; given = 0; handed = 0;
        last_run = 1'b1;
        rst = 1'b0;
        // The core clears its memories and idles: the first sample has its full latency.
        repeat (`VEC_PERIOD + 40) @(negedge clk);
        valid = 1'b1;
    end

    always @(posedge clk) if (!rst && !failed) begin
        cycle <= cycle + 1;
        if (valid && ready) begin
            if (taken == 0) first <= cycle;
            taken <= taken + 1;
            if (taken == SAMPLES - 1) valid <= 1'b0;
        end
        if (top.pair_valid && top.pair_ready) begin
`ifndef VEC_OTHER_UNITS
            // One clock wakes the core up.
            if (last_run && handed == 0 && cycle - first != `VEC_TOP_FRONT + 1)
                fail("clocks to the first pair", `VEC_TOP_FRONT + 1, cycle - first);
            if (handed != 0 && cycle - start != `VEC_TOP_PERIOD)
                fail("clocks between samples", `VEC_TOP_PERIOD, cycle - start);
`endif
            start <= cycle;
            handed <= handed + 1;
        end
        if (result_valid) begin
            if (result !== want[RB-1:0]) fail("result", want, result);
            given <= given + 1;
            if (last_run && given == SAMPLES - 1) begin
                $display("PASS %0s: %0d results, front end %0d clocks, period %0d", "top level",
                         SAMPLES, `VEC_TOP_FRONT, `VEC_TOP_PERIOD);
                $finish;
            end
        end
        if (last_run && handed != 0 && given < SAMPLES && cycle - start > 20 * `VEC_TOP_PERIOD + 5000)
            fail("clocks without a result", 64'd0, cycle - start);
    end
endmodule
