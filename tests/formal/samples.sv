// Two samples, word for word: results and memories are those that the algorithm gives with the same units.
//
// A unit may be any function of its operands. core.vh says which core it is, and
// algorithm.vh, written by samples.py, what it has to compute, operation by operation.
`include "core.vh"

module samples_properties (
    input wire       clk,
    input wire       rst,
    input wire       in_valid,
    input wire [3:0] x,
    input wire [3:0] d
);
    wire       in_ready, out_valid;
    wire [3:0] y;
    `CORE #(`PARAMETERS) dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .x(x), .d(d), .out_valid(out_valid), .y(y));

    // Connected by name: a word of each memory, and what waits.
    wire        waits_a, waits_b, waits_c;
    wire        waits = waits_a | waits_b | waits_c;
    wire [`A_ADDRESS_BITS-1:0] a_at;
    wire [`B_ADDRESS_BITS-1:0] b_at;
    wire [3:0] a_word, b_word;

    // Samples taken, results given, clocks that units have withheld.
    reg [1:0]  taken, given;
    reg [3:0] x_0, d_0, x_1, d_1;
    reg [2:0]  waited;
    always @(posedge clk)
        if (rst) begin
            taken  <= 2'd0;
            given  <= 2'd0;
            waited <= 3'd0;
        end else begin
            if (in_valid & in_ready) begin
                taken <= taken + 2'd1;
                if (taken == 2'd0) begin x_0 <= x; d_0 <= d; end
                if (taken == 2'd1) begin x_1 <= x; d_1 <= d; end
            end
            if (out_valid) given <= given + 2'd1;
            if (waits) waited <= waited + 3'd1;
        end

`include "algorithm.vh"

    always @* begin
        assume (rst == $initstate);
        if (!$initstate) begin
            assume (in_valid);
            assume (!waits || waited < `WITHHELD);
            if (out_valid && given == 2'd0) first_result:  assert (y == y_0);
            if (out_valid && given == 2'd1) second_result: assert (y == y_1);
            if (in_ready && taken == 2'd2) begin
                first_memory:  assert (a_word == first_after);
                second_memory: assert (b_word == second_after);
                two_samples:   cover (waited == `WITHHELD);
            end
        end
    end
endmodule
