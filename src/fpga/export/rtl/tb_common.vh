// Body of the self-checking testbenches tb_rls.v and tb_lms.v, included inside the module. The
// including file declares RAMA_WORDS, RAMB_WORDS, PERIOD and LATENCY in clocks, TRACED, CLEARING (code of that state), clk, rst,
// strobe, in_ready, x, d, out_valid, y and the device under test, instance `DUT. File formats:
// README.txt.
//
// Checked, first mismatch ends the run non-zero:
//   before the run, resets in every state of the control, with NaN in the memories and with words:
//   clocks of the clearing, no sample taken meanwhile, all memories and registers after it;
//   every word of y.hex against y, in the clock of out_valid;
//   clocks from taking a sample to out_valid, and to taking the next sample;
//   the flag of a denominator that is a NaN or not above zero;
//   memories before the first sample against ram_init.hex, after the last against ram_final.hex;
//   every clock of trace.csv: state, both memory ports, registers, before the clock edge; and its
//   place in the sample if the vectors state the latencies of the units and run.sh no others.
// With BLACK_BOX defined only the words of y and the clocks are checked: for your own core.

    localparam SAMPLES = `VEC_SAMPLES;
`ifdef VEC_ANY_CLOCKS
    // Units that take as long as they like: only words, memories and registers are compared.
    localparam ANY_CLOCKS = 1;
`else
    localparam ANY_CLOCKS = 0;
`endif
    localparam LONGEST = ANY_CLOCKS != 0 ? 64 * PERIOD : 2 * PERIOD;
    localparam CLEAR_CLOCKS = RAMB_WORDS;       // RAMB takes a word a clock and is the longer one

    reg [W-1:0] in_words [0:2*SAMPLES-1];
    reg [W-1:0] y_words  [0:SAMPLES-1];
    reg [W-1:0] init_words  [0:RAMA_WORDS+RAMB_WORDS-1];
    reg [W-1:0] final_words [0:RAMA_WORDS+RAMB_WORDS-1];

    // Longest path and line, in characters. Verilator 5.006 holds no longer string.
`ifdef VERILATOR
    localparam CHARS = 256;
`else
    localparam CHARS = 1024;
`endif
    reg [8*CHARS-1:0] vec_dir, vcd_file, path;
    integer trace_file, gap_max, gap_seed, first_wave, count_wave;
    reg     random_gap, withdraw;

    integer cycle;          // clocks since reset
    integer taken;          // samples taken
    integer given;          // results seen
    integer start;          // cycle in which the newest sample was taken
    integer gap, pause;     // clocks without strobe after the newest sample; still to come
    integer previous_gap;
    integer rows;           // rows of the trace compared
    integer idle_clocks;
    integer row_start;      // cycle number, in the trace, of the row in which its sample was taken
    integer warm;           // clocks after reset before the first strobe
    reg     failed;
    reg     resetting;      // the resets before the run
    reg     pushing;        // a strobe during them, never withdrawn
    reg     poison;         // its words are NaN
    integer want_resets, resets;

    always #(`VEC_CLOCK_PS / 2) clk = ~clk;

    // The strobe stays up until its sample is taken, and longer if the next one waits already.
    wire in_valid = !rst && !resetting && warm == 0 && pause == 0 && taken < SAMPLES;
    // One strobe of a single clock before the first sample, which must not be taken.
    wire withdrawn = withdraw && warm == 4;
    assign strobe = in_valid || withdrawn || pushing;
    wire [W-1:0] next_x = in_words[taken < SAMPLES ? 2 * taken : 0];
    wire [W-1:0] next_d = in_words[taken < SAMPLES ? 2 * taken + 1 : 1];
    assign x = !strobe ? {W{1'b0}} : poison ? {W{1'b1}} : next_x;
    assign d = !strobe ? {W{1'b0}} : poison ? {W{1'b1}} : next_d;

    task fail(input [8*24-1:0] signal, input [63:0] expected, input [63:0] got);
        if (!failed) begin
            failed = 1'b1;
            $display("MISMATCH %0s: expected %h got %h", signal, expected, got);
            if (W == 64)
                $display("  as numbers: expected %.17g got %.17g", $bitstoreal(expected),
                         $bitstoreal(got));
            show_place;
            $fatal(1, "first mismatch, stopped");
        end
    endtask

    // For counts, which are not floating-point words.
    task fail_count(input [8*24-1:0] signal, input integer expected, input integer got);
        if (!failed) begin
            failed = 1'b1;
            $display("MISMATCH %0s: expected %0d got %0d", signal, expected, got);
            show_place;
            $fatal(1, "first mismatch, stopped");
        end
    endtask

    task show_place;
`ifdef BLACK_BOX
        $display("  at cycle %0d, sample %0d, clock %0d of the sample", cycle, taken - 1,
                 cycle - start);
`else
        $display("  at cycle %0d, sample %0d, clock %0d of the sample, %0s %0d %0s, trace row %0d",
                 cycle, in_ready ? taken : taken - 1, in_ready ? 0 : cycle - start,
                 "state", `DUT.ctrl.state, `DUT.ctrl.state_name, rows);
`endif
    endtask

    task broken(input [8*80-1:0] what);
        if (!failed) begin
            failed = 1'b1;
            $display("BROKEN VECTORS in %0s: %0s", vec_dir, what);
            $fatal(1, "vectors cannot be used");
        end
    endtask

    event dumping;
    integer k;
    initial begin
        clk = 1'b0;
        rst = 1'b1;
        failed = 1'b0;
        cycle = 0; taken = 0; given = 0; start = 0; rows = 0; idle_clocks = 0;
        gap = 0; pause = 0; previous_gap = 0;
        resetting = 1'b1; pushing = 1'b0; poison = 1'b0; resets = 0;
        if (!$value$plusargs("VEC_DIR=%s", vec_dir)) vec_dir = ".";
`ifdef VEC_OWN_UNITS
        if (PERIOD != `VEC_UNITS_PERIOD) fail_count("period", `VEC_UNITS_PERIOD, PERIOD);
        if (LATENCY != `VEC_UNITS_LATENCY) fail_count("latency", `VEC_UNITS_LATENCY, LATENCY);
`endif
        if (!$value$plusargs("GAP=%d", gap_max)) gap_max = 0;
        random_gap = $value$plusargs("GAP_SEED=%d", gap_seed) != 0;
        withdraw = $test$plusargs("WITHDRAW") != 0;
        if (!$value$plusargs("RESETS=%d", want_resets)) want_resets = 1;
        warm = withdraw ? 8 : 1;
        $sformat(path, "%0s/in.hex", vec_dir);
        $readmemh(path, in_words);
        $sformat(path, "%0s/y.hex", vec_dir);
        $readmemh(path, y_words);
        if (^in_words[2*SAMPLES-1] === 1'bx) broken("in.hex is missing or too short");
        if (^y_words[SAMPLES-1] === 1'bx) broken("y.hex is missing or too short");
`ifndef BLACK_BOX
        $sformat(path, "%0s/ram_init.hex", vec_dir);
        $readmemh(path, init_words);
        $sformat(path, "%0s/ram_final.hex", vec_dir);
        $readmemh(path, final_words);
        if (^init_words[RAMA_WORDS+RAMB_WORDS-1] === 1'bx)
            broken("ram_init.hex is missing or too short");
        if (^final_words[RAMA_WORDS+RAMB_WORDS-1] === 1'bx)
            broken("ram_final.hex is missing or too short");
        if (`VEC_TRACE_CLOCKS > 0) begin
            $sformat(path, "%0s/trace.csv", vec_dir);
            trace_file = $fopen(path, "r");
            if (trace_file == 0) broken("trace.csv is missing");
            else scanned = $fgets(line, trace_file);        // column names
        end
`endif
        first_wave = 0;
        count_wave = 0;
        if ($value$plusargs("VCD=%s", vcd_file)) begin
            if (!$value$plusargs("VCD_FIRST=%d", first_wave)) first_wave = 0;
            if (!$value$plusargs("VCD_SAMPLES=%d", count_wave)) count_wave = 3;
            $dumpfile(vcd_file);
`ifdef BLACK_BOX
            $dumpvars(0, `DUT);
`else
            // The core and one level below it: control, memories, units.
            $dumpvars(2, `DUT);
            -> dumping;
`endif
            if (first_wave > 0) $dumpoff;
        end
        repeat (2) @(negedge clk);
        rst = 1'b0;
`ifndef BLACK_BOX
        check_clearing;
        if (want_resets != 0) reset_everywhere;
`endif
        resetting = 1'b0;
    end

`ifndef BLACK_BOX
    // Clearing, from the clock after a reset on; nothing may be taken until it is done.
    integer clear_clock;
    task check_clearing;
        begin
            for (clear_clock = 0; clear_clock < CLEAR_CLOCKS; clear_clock = clear_clock + 1) begin
                if (`DUT.ctrl.state != CLEARING)
                    fail_count("state while clearing", CLEARING, `DUT.ctrl.state);
                if (in_ready) fail_count("in_ready while clearing", 0, 1);
                if (out_valid !== 1'b0) fail_count("out_valid while clearing", 0, 1);
                @(negedge clk);
            end
            if (`DUT.ctrl.state != 4'd0)
                fail_count("state after clearing", 0, `DUT.ctrl.state);
            if (`DUT.p !== zero) fail("P after reset", zero, `DUT.p);
            if (`DUT.acc !== zero) fail("ACC after reset", zero, `DUT.acc);
            if (`DUT.rr !== zero) fail("RR after reset", zero, `DUT.rr);
            if (`DUT.rcp !== zero) fail("RCP after reset", zero, `DUT.rcp);
            if (`DUT.dd !== zero) fail("D after reset", zero, `DUT.dd);
            if (`DUT.ee !== zero) fail("E after reset", zero, `DUT.ee);
            if (`DUT.yy !== zero) fail("Y after reset", zero, `DUT.yy);
            if (`DUT.ctrl.head != `VEC_TAPS - 1)
                fail_count("HEAD after reset", `VEC_TAPS - 1, `DUT.ctrl.head);
            // What no column of the trace shows, but the next samples depend on.
            if (`DUT.ctrl.slot != `VEC_TAPS - 1)
                fail_count("slot after reset", `VEC_TAPS - 1, `DUT.ctrl.slot);
`ifdef VEC_SIGN_LMS
            if (`DUT.norm !== zero) fail("norm after reset", zero, `DUT.norm);
            if (`DUT.ctrl.age != 0) fail_count("age after reset", 0, `DUT.ctrl.age);
            if (`DUT.ctrl.held != 0) fail_count("held after reset", 0, `DUT.ctrl.held);
`endif
            check_memories(1'b0);
        end
    endtask
    wire [W-1:0] zero = {W{1'b0}};

    // A reset in the clock in which the control is in a state for the nth time. States that this
    // filter does not use are passed over.
    integer visits, waited;
    task reset_in(input integer code, input integer nth);
        begin
            if (code == CLEARING) begin
                rst = 1'b1;
                @(negedge clk);
                rst = 1'b0;
            end
            pushing = code != 0;
            visits = `DUT.ctrl.state == code ? 1 : 0;
            waited = 0;
            while (visits < nth && waited < 2 * LONGEST + CLEAR_CLOCKS) begin
                @(negedge clk);
                waited = waited + 1;
                if (`DUT.ctrl.state == code) visits = visits + 1;
            end
            rst = 1'b1;
            @(negedge clk);
            rst = 1'b0;
            if (visits == nth) resets = resets + 1;
            // The strobe stays up for half of them: clearing must not take it.
            pushing = pushing && nth > 1;
            check_clearing;
            pushing = 1'b0;
            @(negedge clk);
        end
    endtask

    integer target;
    task reset_everywhere;
        begin
            poison = 1'b1;
            for (target = 0; target <= CLEARING; target = target + 1) reset_in(target, 1);
            poison = 1'b0;
            // Long filters: once through every state is seconds already.
            if (PERIOD < 2000)
                for (target = 0; target <= CLEARING; target = target + 1) reset_in(target, 3);
        end
    endtask

    task check_memories(input last);
        begin
            for (k = 0; k < RAMA_WORDS + RAMB_WORDS; k = k + 1) begin
                ram_want = last ? final_words[k] : init_words[k];
                ram_got = k < RAMA_WORDS ? `DUT.rama.mem[k] : `DUT.ramb.mem[k - RAMA_WORDS];
                if (ram_got !== ram_want && !failed) begin
                    if (k < RAMA_WORDS) $sformat(name, "RAMA[%0d]", k);
                    else $sformat(name, "RAMB[%0d]", k - RAMA_WORDS);
                    $display("%0s", last ? "memories after the last sample:"
                                         : "memories before the first sample:");
                    fail(name, ram_want, ram_got);
                end
            end
        end
    endtask
    reg [W-1:0]    ram_want, ram_got;
    reg [8*24-1:0] name;

    // One row of trace.csv, values visible in a clock before its edge.
    integer            scanned, row_cycle, row_state, row_ra, row_ra_we, row_rb, row_rb_we;
    integer            row_head, row_i, row_j, row_extra;
    reg [W-1:0]        row_ra_data, row_rb_data, row_p, row_acc, row_rr, row_den, row_y, row_e;
    reg [W-1:0]        row_rcp, row_d;
    reg [8*CHARS-1:0]  line;
    // What follows the column E; a short one, because each row passes through it.
    reg [8*128-1:0]    rest;

    // Idle rows do not count: a pause between samples is not part of the schedule.
    task read_row;
        begin
            row_state = 0;
            scanned = 14;
            while (scanned == 14 && row_state == 0) begin
                scanned = $fscanf(trace_file, "%d,%d,%d,%d,%h,%d,%d,%h,%h,%h,%h,%h,%h,%h",
                    row_cycle, row_state, row_ra, row_ra_we, row_ra_data,
                    row_rb, row_rb_we, row_rb_data,
                    row_p, row_acc, row_rr, row_den, row_y, row_e);
                row_extra = 0;
                if (scanned == 14 && $fgets(rest, trace_file) != 0)
                    row_extra = $sscanf(rest, ",%h,%h,%d,%d,%d", row_rcp, row_d, row_head,
                                        row_i, row_j);
            end
            if (scanned != 14) begin
                $sformat(line, "trace.csv ends or cannot be read after row %0d", rows);
                broken(line[8*80-1:0]);
            end
        end
    endtask

    task check_row;
        begin
            read_row;
            if (!failed) begin
                if (in_ready) row_start = row_cycle;
`ifdef VEC_OWN_UNITS
                if (row_cycle - row_start != (in_ready ? 0 : cycle - start))
                    fail_count("clock of the sample", row_cycle - row_start, cycle - start);
`endif
                if (`DUT.ctrl.state != row_state)
                    fail_count("state", row_state, `DUT.ctrl.state);
                if (`DUT.rama.addr != row_ra) fail_count("ra_addr", row_ra, `DUT.rama.addr);
                if (`DUT.rama.we != row_ra_we) fail_count("ra_we", row_ra_we, `DUT.rama.we);
                if (`DUT.rama.we && `DUT.rama.wdata !== row_ra_data)
                    fail("ra_wdata", row_ra_data, `DUT.rama.wdata);
                if (`DUT.ramb.addr != row_rb) fail_count("rb_addr", row_rb, `DUT.ramb.addr);
                if (`DUT.ramb.we != row_rb_we) fail_count("rb_we", row_rb_we, `DUT.ramb.we);
                if (`DUT.ramb.we && `DUT.ramb.wdata !== row_rb_data)
                    fail("rb_wdata", row_rb_data, `DUT.ramb.wdata);
                if (`DUT.p !== row_p) fail("P", row_p, `DUT.p);
                if (`DUT.acc !== row_acc) fail("ACC", row_acc, `DUT.acc);
                if (`DUT.rr !== row_rr) fail("RR", row_rr, `DUT.rr);
                if (`DUT.den !== row_den) fail("DEN", row_den, `DUT.den);
                if (`DUT.yy !== row_y) fail("Y", row_y, `DUT.yy);
                if (`DUT.ee !== row_e) fail("E", row_e, `DUT.ee);
                if (row_extra >= 3) begin
                    if (`DUT.rcp !== row_rcp) fail("RCP", row_rcp, `DUT.rcp);
                    if (`DUT.dd !== row_d) fail("D", row_d, `DUT.dd);
                    if (`DUT.ctrl.head != row_head) fail_count("HEAD", row_head, `DUT.ctrl.head);
                end
                if (row_extra >= 5) begin
`ifdef VEC_RLS
                    if (`DUT.ctrl.i != row_i) fail_count("i", row_i, `DUT.ctrl.i);
`endif
                    if (`DUT.ctrl.j != row_j) fail_count("j", row_j, `DUT.ctrl.j);
                end
                rows = rows + 1;
            end
        end
    endtask
`endif

`ifndef BLACK_BOX
    // A new denominator is judged in the clock after it was loaded, in the resets before the run too,
    // where the words are NaN.
    localparam FRACTION = W == 64 ? 52 : 23;
    wire [W-1:0] new_den = `DUT.den;
    wire den_is_nan = (&new_den[W-2:FRACTION]) && (|new_den[FRACTION-1:0]);
    wire den_is_bad = den_is_nan || new_den[W-1] || new_den == zero;
    reg  den_loaded;
    initial den_loaded = 1'b0;
    always @(posedge clk) begin
        if (!rst && !failed && `DUT.indefinite !== (den_loaded && den_is_bad))
            fail_count("indefinite", den_loaded && den_is_bad, `DUT.indefinite);
        den_loaded <= !rst && `DUT.den_en;
    end
`endif

`ifdef BLACK_BOX
    wire is_idle = given == SAMPLES;
`else
    wire is_idle = `DUT.ctrl.state == 4'd0;
`endif

    // Where the next sample must be taken: the pipeline's period, or the pause and a wake-up.
    integer expected_period;
    always @(posedge clk) if (!rst && !failed && !resetting) begin
        cycle <= cycle + 1;
        if (warm != 0) begin
            warm <= warm - 1;
`ifndef BLACK_BOX
            if (warm == 1) check_memories(1'b0);
            if (`DUT.rama.we || `DUT.ramb.we) fail_count("write without a sample", 0, 1);
`endif
        end
        if (pause != 0) pause <= pause - 1;

        if (in_valid && in_ready) begin
            if (taken != 0) begin
                expected_period = previous_gap <= PERIOD - 2 ? PERIOD : previous_gap + 2;
                if (ANY_CLOCKS == 0 && cycle - start != expected_period)
                    fail_count("clocks between samples", expected_period, cycle - start);
            end
            start <= cycle;
            taken <= taken + 1;
            gap = gap_max;
            if (random_gap) gap = $unsigned($random(gap_seed)) % (gap_max + 1);
            pause <= gap;
            previous_gap <= gap;
            if (count_wave > 0 && first_wave > 0 && taken == first_wave) $dumpon;
            if (count_wave > 0 && taken == first_wave + count_wave) $dumpoff;
        end

`ifndef BLACK_BOX
        if (`DUT.ctrl.state == 4'd0) idle_clocks <= idle_clocks + 1;
        else if (TRACED != 0 && rows < `VEC_TRACE_CLOCKS && !`DUT.ctrl.stall && (taken != 0 || in_valid))
            check_row;
`endif

        if (out_valid) begin
            if (given >= taken) fail_count("results", taken, given + 1);
            else begin
                if (y !== y_words[given]) fail("y", y_words[given], y);
                if (ANY_CLOCKS == 0 && cycle - start != LATENCY)
                    fail_count("clocks to the result", LATENCY, cycle - start);
            end
            given <= given + 1;
        end

        if (taken != 0 && cycle - start > LONGEST + gap_max)
            fail_count("clocks without a sample", PERIOD, cycle - start);

        // The last sample has left the pipeline; one clock more would change nothing.
        if (taken == SAMPLES && (ANY_CLOCKS != 0 ? is_idle : cycle - start == PERIOD)) begin
            if (given != SAMPLES) fail_count("results", SAMPLES, given);
`ifndef BLACK_BOX
            if (`DUT.ctrl.state != 4'd0) fail_count("state after the last", 0, `DUT.ctrl.state);
            check_memories(1'b1);
            if (TRACED != 0 && rows != `VEC_TRACE_CLOCKS)
                fail_count("rows of the trace", `VEC_TRACE_CLOCKS, rows);
`endif
            if (!failed) begin
                $write("PASS %0s: %0d samples, %0d clocks, %0d idle; ", `VEC_NAME, given, cycle,
                       idle_clocks);
                $write("period %0d, latency %0d clocks; %0d resets; ", PERIOD, LATENCY, resets);
                $display("%0d trace rows; %0d memory words", rows,
`ifdef BLACK_BOX
                    0
`else
                    RAMA_WORDS + RAMB_WORDS
`endif
                );
                $finish;
            end
        end
    end
