// Body of the testbenches: drives in.hex back to back and compares, clock by clock, with
// trace.csv, y.hex and ram_final.hex. The folder of the vectors: +VEC_DIR=, default ".".
    localparam SAMPLES = `FB_SAMPLES;
    localparam DEPTH = DEPTH_A + DEPTH_B;

    reg clk = 0, rst = 1, in_valid = 0;
    reg [W-1:0] x = 0, d = 0;
    wire in_ready, out_valid;
    wire [W-1:0] y;

    reg [W-1:0] in_words [0:2*SAMPLES-1];
    reg [W-1:0] y_words [0:SAMPLES-1];
    reg [W-1:0] ram_words [0:DEPTH-1];
    string dir;
    reg [8*200-1:0] header;
    integer file, fields, k;
    integer cyc = 0, taken = 0, finished = 0, traced = 0, rows = `FB_TRACE_CLOCKS;

    // One line of the trace.
    integer t_cyc, t_state, t_ra_addr, t_ra_we, t_rb_addr, t_rb_we, t_head, t_i, t_j;
    reg [W-1:0] t_ra_wdata, t_rb_wdata, t_p, t_acc, t_rr, t_den, t_y, t_e, t_rcp, t_d;

    task check(input string name, input [W-1:0] expected, input [W-1:0] got);
        if (expected !== got) begin
            $display("MISMATCH clock %0d state %0d sample %0d: %0s expected %h got %h",
                     cyc, dut.state, taken - 1, name, expected, got);
            $fatal(1);
        end
    endtask

    task check_memories(input string name);
        begin
            for (k = 0; k < DEPTH_A; k = k + 1)
                check({name, " RAMA"}, ram_words[k], dut.rama.mem[k]);
            for (k = 0; k < DEPTH_B; k = k + 1)
                check({name, " RAMB"}, ram_words[DEPTH_A + k], dut.ramb.mem[k]);
        end
    endtask

    task check_trace;
        begin
            fields = $fscanf(file, "%d,%d,%d,%d,%h,%d,%d,%h,%h,%h,%h,%h,%h,%h,%h,%h,%d,%d,%d\n",
                t_cyc, t_state, t_ra_addr, t_ra_we, t_ra_wdata, t_rb_addr, t_rb_we, t_rb_wdata,
                t_p, t_acc, t_rr, t_den, t_y, t_e, t_rcp, t_d, t_head, t_i, t_j);
            check("trace fields", 19, fields);
            check("clock", t_cyc, cyc);
            check("state", t_state, dut.state);
            check("ra_addr", t_ra_addr, dut.ra_addr);
            check("ra_we", t_ra_we, dut.ra_we);
            check("ra_wdata", t_ra_wdata, dut.ra_wdata);
            check("rb_addr", t_rb_addr, dut.rb_addr);
            check("rb_we", t_rb_we, dut.rb_we);
            check("rb_wdata", t_rb_wdata, dut.rb_wdata);
            check("P", t_p, dut.p);
            check("ACC", t_acc, dut.acc);
            check("RR", t_rr, dut.rr);
            check("DEN", t_den, dut.den);
            check("Y", t_y, dut.yy);
            check("E", t_e, dut.ee);
            check("RCP", t_rcp, dut.rcp);
            check("D", t_d, dut.dd);
            check("HEAD", t_head, dut.head);
            check("i", t_i, dut.i);
            check("j", t_j, dut.j);
            traced = traced + 1;
        end
    endtask

    initial begin
        if (!$value$plusargs("VEC_DIR=%s", dir)) dir = ".";
        if ($test$plusargs("WAVES")) begin
            $dumpfile({dir, "/simulated.vcd"});
            $dumpvars(0, dut);
        end
        $readmemh({dir, "/in.hex"}, in_words);
        $readmemh({dir, "/y.hex"}, y_words);
        $readmemh({dir, "/ram_init.hex"}, ram_words);
        file = $fopen({dir, "/trace.csv"}, "r");
        if (file == 0) begin
            $display("cannot open %0s/trace.csv", dir);
            $fatal(1);
        end
        // The header is one word: it has no blanks.
        k = $fscanf(file, "%s\n", header);
        #1 check_memories("initial");
        #4 clk = 1;
        #5 clk = 0;
        rst = 0;
        while (taken < SAMPLES || dut.state != 0) begin
            in_valid = (taken < SAMPLES);
            x = in_valid ? in_words[2 * taken] : 0;
            d = in_valid ? in_words[2 * taken + 1] : 0;
            #1;
            if (traced < rows) check_trace;
            if (out_valid) begin
                check("y", y_words[finished], y);
                finished = finished + 1;
            end
            if (in_ready) taken = taken + 1;
            #4 clk = 1;
            #5 clk = 0;
            cyc = cyc + 1;
        end
        check("count of outputs", SAMPLES, finished);
        $readmemh({dir, "/ram_final.hex"}, ram_words);
        check_memories("final");
        $display("PASS %0d samples, %0d clocks, %0d of them compared with the trace",
                 finished, cyc, traced);
        $finish;
    end
