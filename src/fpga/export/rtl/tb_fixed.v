// Self-checking testbench of a fixed-point core of any kind, constants of params.vh: resets in
// every state, a strobe that is withdrawn, every word of y, the clocks of every sample, in which samples
// a word was beyond the ends of its signal, the memories before and after, and every clock of trace.csv.
// The first mismatch ends the run non-zero.
`timescale 1ps/1ps
`include "params.vh"
`include "tb_defaults.vh"

module `VEC_BENCH;
    localparam SAMPLES = `VEC_SAMPLES;
    localparam A_WORDS = `VEC_A_WORDS;
    localparam WORDS   = `VEC_WORDS;
    localparam CLEAR_CLOCKS = `VEC_CLEAR_CLOCKS;
    localparam LD = `VEC_DIV_LATENCY;
`ifdef VEC_RLS_FIXED
    // Steps, each as long as its slowest unit; the product with 1/alpha and its rounding have steps of
    // their own where adder or multiplier take more than a clock.
    localparam P  = `VEC_TAPS;
    localparam LA = `VEC_ADD_LATENCY;
    localparam LM = `VEC_MUL_LATENCY;
    localparam SPLIT = `VEC_SCALES != 0 && (LA > 1 || LM > 1);
    localparam DOT = LM + (P - 1) * (LA > LM ? LA : LM) + LA;
    localparam RFR = P * (P + 1) / 2 * (LM + 1 + LA + (SPLIT ? LM + LA : 0)) + P * (P - 1) / 2;
    localparam LATENCY = 1 + (P + 2) * DOT + P * LD + RFR;
    localparam PERIOD  = LATENCY + LA + P * (LM + LA);
    // With latencies from run.sh the control may take steps that the trace does not have, or the other way.
    localparam TRACED  = SPLIT == `VEC_SPLIT ? `VEC_TRACE_CLOCKS : 0;
`else
    localparam EXTRA   = (LD - 1) * `VEC_DIVISIONS;     // clocks a slower divider adds
    localparam PERIOD  = `VEC_PERIOD + EXTRA;
    localparam LATENCY = `VEC_LATENCY + EXTRA;
    localparam TRACED  = `VEC_TRACE_CLOCKS;
`endif
    localparam [3:0] CLEAR = `VEC_CLEAR;

    reg [63:0]    in_words [0:2*SAMPLES-1];
    reg [63:0]    y_words [0:SAMPLES-1];
    reg [63:0]    beyond_words [0:SAMPLES-1];
    reg [63:0]    init_words [0:WORDS-1];
    reg [63:0]    final_words [0:WORDS-1];
    reg           clk, rst, valid, running, failed;
    wire          in_ready, out_valid, overflow, indefinite;
    reg           beyond;           // since the newest sample was taken
    // Longest path, in characters. Verilator 5.006 holds no longer string.
    reg [8*256-1:0] vec_dir, path;
    wire [63:0]   x_full = in_words[taken < SAMPLES ? 2 * taken : 0];
    wire [63:0]   d_full = in_words[taken < SAMPLES ? 2 * taken + 1 : 1];
    wire [`VEC_WX-1:0] x = x_full[`VEC_WX-1:0];
    wire [`VEC_WD-1:0] d = d_full[`VEC_WD-1:0];
    wire signed [`VEC_WY-1:0] y;
    integer       cycle, taken, given, start, rows, k, target, waited, trace_file, scanned;

    `VEC_CORE_MODULE #(
        `VEC_CORE,
`ifdef VEC_RLS_FIXED
        .ADD_LATENCY(LA), .MUL_LATENCY(LM),
`endif
        .DIV_LATENCY(LD)
    ) dut (
        .clk(clk), .rst(rst), .in_valid(valid), .in_ready(in_ready), .x(x), .d(d),
        .out_valid(out_valid), .y(y), .overflow(overflow), .indefinite(indefinite));

    always #5 clk = ~clk;

    task fail(input [8*16-1:0] what, input [127:0] expected, input [127:0] got);
        if (!failed) begin
            failed = 1'b1;
            $display("MISMATCH %0s: expected %h got %h", what, expected, got);
            $display("  cycle %0d, sample %0d, state %0d, trace row %0d", cycle, taken, dut.state,
                     rows);
            $fatal(1, "first mismatch, stopped");
        end
    endtask

    reg signed [63:0] want, have;
    task check_memories(input last);
        for (k = 0; k < WORDS; k = k + 1) begin
            want = last ? final_words[k] : init_words[k];
            if (k < A_WORDS) have = {{(64-`VEC_MA){dut.rama.mem[k][`VEC_MA-1]}}, dut.rama.mem[k]};
            else have = {{(64-`VEC_MB){dut.ramb.mem[k-A_WORDS][`VEC_MB-1]}},
                         dut.ramb.mem[k-A_WORDS]};
            if (have !== want) fail(last ? "memory, end" : "memory, reset", want, have);
        end
    endtask

    task check_clearing;
        begin
            for (waited = 0; waited < CLEAR_CLOCKS; waited = waited + 1) begin
                if (dut.state != CLEAR || in_ready || out_valid) fail("clearing", CLEAR, dut.state);
                @(negedge clk);
            end
            if (dut.state != 4'd0) fail("after clearing", 0, dut.state);
            if (dut.p !== 0 || dut.acc !== 0 || dut.rr !== 0 || dut.den !== 0 || dut.dd !== 0
                || dut.ee !== 0 || dut.yy !== 0 || `VEC_CONTROL.head != `VEC_TAPS - 1)
                fail("registers", 0, 1);
`ifdef VEC_SIGN_LMS_FIXED
            if (dut.norm !== 0 || dut.ctrl.held != 0) fail("norm and guard", 0, 1);
`endif
            check_memories(1'b0);
        end
    endtask

    initial begin
        clk = 1'b0; rst = 1'b1; valid = 1'b0; running = 1'b0; failed = 1'b0;
        cycle = 0; taken = 0; given = 0; start = 0; rows = 0; beyond = 1'b0;
        if (!$value$plusargs("VEC_DIR=%s", vec_dir)) vec_dir = ".";
        $sformat(path, "%0s/in.hex", vec_dir);
        $readmemh(path, in_words);
        $sformat(path, "%0s/y.hex", vec_dir);
        $readmemh(path, y_words);
        $sformat(path, "%0s/overflow.hex", vec_dir);
        $readmemh(path, beyond_words);
        $sformat(path, "%0s/ram_init.hex", vec_dir);
        $readmemh(path, init_words);
        $sformat(path, "%0s/ram_final.hex", vec_dir);
        $readmemh(path, final_words);
        $sformat(path, "%0s/trace.csv", vec_dir);
        trace_file = $fopen(path, "r");
`ifdef WAVE
        if ($value$plusargs("VCD=%s", path)) begin
            $dumpfile(path);
            $dumpvars(0, dut);
        end
`endif
        if (trace_file == 0 || ^y_words[SAMPLES-1] === 1'bx
            || ^beyond_words[SAMPLES-1] === 1'bx) fail("vectors", 0, 0);
        repeat (2) @(negedge clk);
        rst = 1'b0;
        check_clearing;
        for (target = 0; target <= CLEAR; target = target + 1) begin
            // Into the state a second time, so that the memories hold something.
            valid = target != 0;
            if (target == CLEAR) begin
                rst = 1'b1;
                @(negedge clk);
                rst = 1'b0;
            end
            waited = 0;
            repeat (2) begin
                @(negedge clk);
                while (dut.state != target && waited < 4 * PERIOD) begin
                    waited = waited + 1;
                    @(negedge clk);
                end
            end
            rst = 1'b1;
            @(negedge clk);
            rst = 1'b0;
            // The strobe stays up: clearing must not take it.
            check_clearing;
            valid = 1'b0;
            @(negedge clk);
        end
        // A strobe of a single clock: nothing is taken.
        valid = 1'b1;
        @(negedge clk);
        valid = 1'b0;
        @(negedge clk);
        if (dut.state != 4'd0) fail("withdrawn", 0, dut.state);
        check_memories(1'b0);
        running = 1'b1;
        valid = 1'b1;
    end

    // A row of the trace: values visible in a clock before its edge.
    integer       r_state, r_ra, r_ra_we, r_rb, r_rb_we, r_head;
    reg [63:0]    r_ra_data, r_rb_data, r_rr, r_den, r_d, r_e, r_y, r_k, r_t;
    reg [127:0]   r_p, r_acc;
    wire signed [63:0] ra_data = dut.ra_wdata, rb_data = dut.rb_wdata, rr = dut.rr, den = dut.den;
    wire signed [127:0] pp = dut.p, acc = dut.acc;
    wire signed [63:0] dd = dut.dd, ee = dut.ee, yy = dut.yy;
`ifdef VEC_GAIN_REGISTERS
    wire signed [63:0] kk = dut.kk, tt = dut.tt;
`endif
    task check_row;
        begin
            scanned = $fscanf(trace_file, "%d,%d,%d,%h,%d,%d,%h,%h,%h,%h,%h,%h,%h,%h,%d,%h,%h",
                r_state,
                r_ra, r_ra_we, r_ra_data, r_rb, r_rb_we, r_rb_data, r_p, r_acc, r_rr, r_den, r_d,
                r_e, r_y, r_head, r_k, r_t);
            if (scanned != 17) fail("trace ends", 17, scanned);
            if (dut.state != r_state) fail("state", r_state, dut.state);
            if (dut.ra_addr != r_ra) fail("ra_addr", r_ra, dut.ra_addr);
            if (dut.ra_we != r_ra_we) fail("ra_we", r_ra_we, dut.ra_we);
            if (dut.ra_we && ra_data !== r_ra_data) fail("ra_wdata", r_ra_data, ra_data);
            if (dut.rb_addr != r_rb) fail("rb_addr", r_rb, dut.rb_addr);
            if (dut.rb_we != r_rb_we) fail("rb_we", r_rb_we, dut.rb_we);
            if (dut.rb_we && rb_data !== r_rb_data) fail("rb_wdata", r_rb_data, rb_data);
            if (pp !== r_p) fail("P", r_p, pp);
            if (acc !== r_acc) fail("ACC", r_acc, acc);
            if (rr !== r_rr) fail("RR", r_rr, rr);
            if (den !== r_den) fail("DEN", r_den, den);
            if (dd !== r_d) fail("D", r_d, dd);
            if (ee !== r_e) fail("E", r_e, ee);
            if (yy !== r_y) fail("Y", r_y, yy);
            if (`VEC_CONTROL.head != r_head) fail("HEAD", r_head, `VEC_CONTROL.head);
`ifdef VEC_GAIN_REGISTERS
            if (kk !== r_k) fail("K", r_k, kk);
            if (tt !== r_t) fail("T", r_t, tt);
`endif
            rows = rows + 1;
        end
    endtask

    // A denominator is judged in the clock in which it is stored, a diagonal element of R in that in
    // which it is written.
`ifdef VEC_RLS_FIXED
    wire stores_den = dut.state == 4'd5 && !dut.stall;
    wire writes_bad = dut.state == 4'd8 && dut.rb_we && dut.i == dut.j && dut.rb_wdata <= 0;
`else
    wire stores_den = dut.den_en;
    wire writes_bad = 1'b0;
`endif
    reg  judged, stored_den, wrote_bad, was_indefinite;
    initial judged = 1'b0;
    always @(posedge clk) begin
        if (judged && was_indefinite !== (stored_den ? dut.den <= 0 : wrote_bad))
            fail("indefinite", !was_indefinite, was_indefinite);
        judged         <= !rst;
        stored_den     <= stores_den;
        wrote_bad      <= writes_bad;
        was_indefinite <= indefinite;
    end

    task check_overflow;
        if (taken != 0 && beyond !== beyond_words[taken-1][0])
            fail("overflow", beyond_words[taken-1], beyond);
    endtask

    wire signed [63:0] y_full = y;
    always @(posedge clk) if (running && !failed) begin
        cycle <= cycle + 1;
        if (dut.state != 4'd0 && !`VEC_CONTROL.stall && rows < TRACED) check_row;
        beyond <= beyond | overflow;
        if (valid && in_ready) begin
            check_overflow;
            beyond <= overflow;
            if (taken != 0 && cycle - start != PERIOD)
                fail("period", PERIOD, cycle - start);
            start <= cycle;
            taken <= taken + 1;
            if (taken == SAMPLES - 1) valid <= 1'b0;
        end
        if (out_valid) begin
            if (y_full !== y_words[given]) fail("y", y_words[given], y_full);
            if (cycle - start != LATENCY) fail("latency", LATENCY, cycle - start);
            given <= given + 1;
        end
        if (taken == SAMPLES && cycle - start == PERIOD) begin
            if (given != SAMPLES) fail("results", SAMPLES, given);
            if (dut.state != 4'd0) fail("state, end", 0, dut.state);
            check_memories(1'b1);
            check_overflow;
            $display("PASS %0s: %0d samples, %0d trace rows", `VEC_KIND_NAME, SAMPLES, rows);
            $finish;
        end
        if (cycle > (SAMPLES + 3) * PERIOD) fail("results", SAMPLES, given);
    end
endmodule
