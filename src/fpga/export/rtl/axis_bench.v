// Self-checking testbench of an export's AXI4-Stream ports. Run by run.sh.
//
// The first samples go in three times, after a reset within a sample: from a source and into a sink
// that pause at random; from and into such as never pause; from a source that ignores tready, which
// withdraws and changes words that wait and gives them again. Checked, the first mismatch ends the run
// non-zero: every word against y.hex, none lost, none doubled; tvalid and tdata while the sink waits;
// the clocks from sample to sample without pauses; every flag in every clock.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"

module axis_bench;
    localparam W      = `VEC_WIDTH;
    localparam SB     = `VEC_TOP_SAMPLE_BITS;
    localparam FB     = `VEC_TOP_CODE != 0 ? 32 : W;
    localparam RB     = `VEC_TOP_RESULT_BITS;
    localparam SD     = 8 * ((SB + 7) / 8);
    localparam RD     = 8 * ((RB + 7) / 8);
    localparam COUNT  = `VEC_SAMPLES < 60 ? `VEC_SAMPLES : 60;
    localparam PERIOD = `VEC_TOP_PERIOD;
    // Ways of source and sink.
    localparam [1:0] PAUSING = 2'd0, STEADY = 2'd1, IGNORING = 2'd2;

    reg [FB-1:0] samples [0:`VEC_SAMPLES-1];
    reg [W-1:0]  y_words [0:`VEC_SAMPLES-1];
    // Longest path, in characters. Verilator 5.006 holds no longer string.
    reg [8*256-1:0] vec_dir, path;

    reg           clk, rstn, s_valid, m_ready, clear, running, failed, is_wrong, accepted, lost;
    reg  [1:0]    way;
    wire          s_ready, m_valid, overrun, nan, overflow, indefinite;
    wire [RD-1:0] m_data;
    integer       cycle, progress, taken, given, handed, seen, start, pause, stall, losses, tail;

    // Bits beyond the sample are not to be looked at.
    wire [FB-1:0] sample = samples[taken < COUNT ? taken : 0];
    wire [SB-1:0] word   = is_wrong ? ~sample[SB-1:0] : sample[SB-1:0];
    wire [63:0]   padded = {{(64-SB){~sample[0]}}, word};

    `VEC_AXIS #(
        .ADD_LATENCY(`VEC_ADD_LATENCY), .MUL_LATENCY(`VEC_MUL_LATENCY),
        .DIV_LATENCY(`VEC_DIV_LATENCY)
    ) dut (
        .aclk(clk), .aresetn(rstn),
        .s_axis_tvalid(s_valid), .s_axis_tready(s_ready), .s_axis_tdata(padded[SD-1:0]),
        .m_axis_tvalid(m_valid), .m_axis_tready(m_ready), .m_axis_tdata(m_data),
        .flags_clear(clear), .flag_overrun(overrun), .flag_nan(nan), .flag_overflow(overflow),
        .flag_indefinite(indefinite));

    always #(`VEC_CLOCK_PS / 2) clk = ~clk;

    task fail(input [8*32-1:0] what, input [63:0] expected, input [63:0] got);
        if (!failed) begin
            failed = 1'b1;
            $display("MISMATCH %0s: expected %h got %h", what, expected, got);
            $display("  stream ports, way %0d, cycle %0d, samples taken %0d, results given %0d", way,
                     cycle, taken, given);
            $fatal(1, "first mismatch, stopped");
        end
    endtask

    // A repeatable generator: upper bits of a 32-bit LCG.
    reg [31:0] seed;
    integer    drawn;
    task draw(input integer bound);
        begin
            seed  = seed * 32'd1664525 + 32'd1013904223;
            drawn = {16'd0, seed[31:16]} % bound;
        end
    endtask

    // Inputs change at the falling edge.
    task drive_source;
        begin
            lost = 1'b0;
            if (s_valid && accepted) begin
                taken   = taken + 1;
                s_valid = 1'b0;
                draw(2);
                if (way != STEADY && drawn != 0) begin
                    draw(2 * PERIOD);
                    pause = drawn;
                end
            end else if (s_valid && way == IGNORING) begin
                draw(4);
                if (drawn == 0) begin
                    s_valid  = 1'b0;
                    is_wrong = 1'b0;
                    lost     = 1'b1;
                    draw(9);
                    pause    = drawn + 1;
                end else if (is_wrong ? s_ready || drawn == 1 : !s_ready && drawn == 1) begin
                    // A wrong word is there only while it cannot be taken.
                    is_wrong = !is_wrong;
                    lost     = 1'b1;
                end
            end
            if (pause > 0) pause = pause - 1;
            else if (taken < COUNT) s_valid = 1'b1;
            if (lost) losses = losses + 1;
            draw(40);
            clear = way == IGNORING && drawn == 0;
        end
    endtask

    task drive_sink;
        if (way == STEADY || (taken == COUNT && given == COUNT)) m_ready = 1'b1;
        else if (stall > 0) begin
            stall   = stall - 1;
            m_ready = 1'b0;
        end else begin
            draw(2);
            m_ready = drawn != 0;
            draw(16);
            if (m_ready && m_valid && drawn < 8) begin
                // This word is given; the next one waits.
                draw(3 * PERIOD);
                stall = drawn;
            end
        end
    endtask

    integer phase, waited;
    initial begin
        clk = 1'b0; rstn = 1'b0; s_valid = 1'b0; m_ready = 1'b0; clear = 1'b0; failed = 1'b0;
        running = 1'b0; is_wrong = 1'b0; lost = 1'b0; seed = 32'd1; cycle = 0; losses = 0; way = PAUSING;
        taken = 0; given = 0; pause = 0; stall = 0; progress = 0; tail = 0;
        if (!$value$plusargs("VEC_DIR=%s", vec_dir)) vec_dir = ".";
        if (`VEC_TOP_CODE != 0) $sformat(path, "%0s/in_codes.hex", vec_dir);
        else $sformat(path, "%0s/samples.hex", vec_dir);
        $readmemh(path, samples);
        $sformat(path, "%0s/y.hex", vec_dir);
        $readmemh(path, y_words);
        if (^samples[COUNT-1] === 1'bx || ^y_words[COUNT-1] === 1'bx)
            fail("vectors, missing or short", 64'd0, 64'd0);
        // Phase 0 is the one that a reset ends.
        for (phase = 0; phase < 4; phase = phase + 1) begin
            way = phase == 0 ? PAUSING : phase[1:0] - 2'd1;
            rstn = 1'b0;
            is_wrong = 1'b0; clear = 1'b0;
            // A source that offers a word during the reset keeps it.
            s_valid = 1'b1;
            @(negedge clk);
            if (s_ready !== 1'b0) fail("tready during a reset", 64'd0, s_ready);
            if (m_valid !== 1'b0) fail("tvalid during a reset", 64'd0, m_valid);
            s_valid = 1'b0;
            @(negedge clk);
            taken = 0; pause = 0; stall = 0; waited = 0; tail = 0; progress = cycle;
            rstn = 1'b1;
            running = 1'b1;
            // After the last word none may follow.
            while (tail < 2 * PERIOD + 40 && (phase != 0 || waited < 7 * PERIOD / 2)) begin
                drive_source;
                drive_sink;
                @(negedge clk);
                waited = waited + 1;
                if (taken == COUNT && given == COUNT) tail = tail + 1;
                check_flags;
            end
            running = 1'b0;
            if (phase == 1)
                $display("flags: nan %b overflow %b indefinite %b", nan, overflow, indefinite);
        end
        if (COUNT > 5 && losses == 0) fail("words lost", 64'd1, 64'd0);
        $display("PASS %0s: %0d results, three ways; %0d words lost, each flagged", "stream ports",
                 COUNT, losses);
        $finish;
    end

    // What the flags have to be, from clock to clock.
    reg want_overrun, want_nan, want_overflow, want_indefinite;
    wire [W-1:0] y_word = y_words[seen < COUNT ? seen : 0];
    task check_flags;
        if (running) begin
            if (overrun !== want_overrun) fail("overrun", want_overrun, overrun);
            // The other flags have no such count once they were cleared.
            if (way != IGNORING) begin
                if (nan !== want_nan) fail("nan", want_nan, nan);
`ifdef VEC_AXIS_OVERFLOW_AT
                check_within("overflow", `VEC_AXIS_OVERFLOW_AT, overflow);
                check_within("indefinite", `VEC_AXIS_INDEFINITE_AT, indefinite);
`else
                if (overflow !== want_overflow) fail("overflow", want_overflow, overflow);
                if (indefinite !== want_indefinite)
                    fail("indefinite", want_indefinite, indefinite);
`endif
            end
        end
    endtask

`ifdef VEC_AXIS_OVERFLOW_AT
    // The flag rises while the core works on a sample, -1: never.
    task check_within(input [8*32-1:0] what, input integer at, input flag);
        begin
            if (flag !== 1'b0 && (at < 0 || handed <= at)) fail(what, 64'd0, flag);
            if (flag !== 1'b1 && at >= 0 && handed >= at + 2) fail(what, 64'd1, flag);
        end
    endtask
    wire y_nan = 1'b0, y_infinite = 1'b0, den_bad = 1'b0;
`else
    localparam EB = W == 64 ? 52 : 23;
    wire y_full     = &y_word[W-2:EB];
    wire y_nan      = y_full & (|y_word[EB-1:0]);
    wire y_infinite = y_full & ~(|y_word[EB-1:0]);
    wire [W-1:0] den = dut.top.core.den;
    wire den_bad = den[W-1] | (den == {W{1'b0}}) | ((&den[W-2:EB]) & (|den[EB-1:0]));
`endif

    reg          prev_waits;
    reg [RD-1:0] prev_data;
    wire [W-1:0] want_word = given < `VEC_TOP_NEXT ? {W{1'b0}}
                           : y_words[given < COUNT + `VEC_TOP_NEXT ? given - `VEC_TOP_NEXT : 0];
    wire [RD-1:0] want = {{(RD-RB+1){want_word[RB-1]}}, want_word[RB-2:0]};
    always @(posedge clk) begin
        cycle    <= cycle + 1;
        accepted <= s_valid && s_ready;
        if (!rstn) begin
            given           <= 0;
            handed          <= 0;
            seen            <= 0;
            prev_waits      <= 1'b0;
            want_overrun    <= 1'b0;
            want_nan        <= 1'b0;
            want_overflow   <= 1'b0;
            want_indefinite <= 1'b0;
        end else if (!failed) begin
            want_overrun    <= lost | (want_overrun & ~clear);
            want_indefinite <= want_indefinite | den_bad;
            if (dut.top.core_valid) begin
                want_nan      <= want_nan | y_nan;
                want_overflow <= want_overflow | y_infinite;
                seen          <= seen + 1;
            end
            if (dut.top.pair_valid && dut.top.pair_ready) handed <= handed + 1;
            if (m_valid !== 1'b0 && m_valid !== 1'b1) fail("tvalid", 64'd0, m_valid);
            if (prev_waits && !m_valid) fail("tvalid while it waits", 64'd1, 64'd0);
            if (prev_waits && m_data !== prev_data) fail("tdata while it waits", prev_data, m_data);
            prev_waits <= m_valid && !m_ready;
            prev_data  <= m_data;
            if (m_valid && m_ready) begin
                if (given >= COUNT) fail("results", COUNT, given + 1);
                else if (m_data !== want) fail("result", want, m_data);
                given    <= given + 1;
                progress <= cycle;
            end
            if (s_valid && s_ready) begin
`ifndef VEC_OTHER_UNITS
`ifndef VEC_ANY_CLOCKS
                if (way == STEADY && taken > 2 && cycle - start != PERIOD)
                    fail("clocks between samples", PERIOD, cycle - start);
`endif
`endif
                start    <= cycle;
                progress <= cycle;
            end
            if (running && tail == 0 && cycle - progress > 64 * PERIOD + 5000)
                fail("clocks without a word", 64'd0, cycle - progress);
        end
    end
endmodule
