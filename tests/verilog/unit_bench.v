// Testbench of the floating-point units: every line of units.hex against their results and clocks.
// A line is the operation (0 add, 1 subtract, 2 multiply, 3 divide; with W = 64 also 4: a as binary32,
// at once), a, b and the result.
`timescale 1ns/1ns

module unit_bench;
    parameter W       = 64;
    parameter FTZ     = 0;
    parameter LATENCY = 1;
    parameter COUNT   = 1;

    reg [3*W+3:0] lines [0:COUNT-1];
    reg           clk, rst, req, take;
    reg  [3:0]    op;
    reg  [W-1:0]  a, b, want;
    wire          add_done, mul_done, div_done;
    wire [W-1:0]  add_q, mul_q, div_q;
    integer       k, clocks, seed, hold;

    fp_add #(.W(W), .FTZ(FTZ), .LATENCY(LATENCY)) add (
        .clk(clk), .rst(rst), .req(req && op < 2), .take(take), .a(a), .b(b), .sub(op[0]),
        .done(add_done), .q(add_q));
    fp_mul #(.W(W), .FTZ(FTZ), .LATENCY(LATENCY)) mul (
        .clk(clk), .rst(rst), .req(req && op == 2), .take(take), .a(a), .b(b),
        .done(mul_done), .q(mul_q));
    fp_div #(.W(W), .FTZ(FTZ), .LATENCY(LATENCY)) div (
        .clk(clk), .rst(rst), .req(req && op == 3), .take(take), .a(a), .b(b),
        .done(div_done), .q(div_q));
    wire [31:0]  narrow_q;
    fp_narrow #(.FTZ(FTZ)) narrow (.a({{(64-W){1'b0}}, a}), .q(narrow_q));
    wire         done = op == 4 ? clocks == LATENCY : op < 2 ? add_done : op == 2 ? mul_done : div_done;
    wire [W-1:0] q    = op == 4 ? {{(W-32){1'b0}}, narrow_q} : op < 2 ? add_q : op == 2 ? mul_q : div_q;

    always #5 clk = ~clk;

    initial begin
        clk = 0; rst = 1; req = 0; take = 0; op = 0; a = 0; b = 0; seed = 1;
        $readmemh("units.hex", lines);
        @(negedge clk);
        @(negedge clk);
        rst = 0;
        for (k = 0; k < COUNT; k = k + 1) begin
            {op, a, b, want} = lines[k];
            if (^lines[k] === 1'bx) $fatal(1, "units.hex is missing or too short");
            req = 1;
            clocks = 1;
            #1;
            while (!done && clocks < 2 * LATENCY + 2) begin
                @(negedge clk);
                clocks = clocks + 1;
                #1;
            end
            if (clocks != LATENCY) begin
                $display("MISMATCH clocks: expected %0d got %0d", LATENCY, clocks);
                $fatal(1, "stopped");
            end
            // The result waits to be taken.
            hold = $unsigned($random(seed)) % 4 == 0 ? $unsigned($random(seed)) % 5 : 0;
            repeat (hold) @(negedge clk);
            if (!done || q !== want) begin
                $display("MISMATCH operation %0d: %h, %h: expected %h got %h", op, a, b, want, q);
                $fatal(1, "stopped");
            end
            take = 1;
            @(negedge clk);
            take = 0;
            // Now and then nothing is asked for, and now and then it is withdrawn.
            if ($unsigned($random(seed)) % 8 == 0) begin
                req = 0;
                @(negedge clk);
            end
            if ($unsigned($random(seed)) % 16 == 0) begin
                req = 1;
                a = ~a;
                repeat ($unsigned($random(seed)) % LATENCY) @(negedge clk);
                req = 0;
                @(negedge clk);
            end
        end
        $display("PASS %0d operations", COUNT);
        $finish;
    end
endmodule
