// After a reset in any state, the memories hold their initial words once the core is ready again.
//
// Registers and memories start as anything. The first clock is one of a reset; others may come in any clock,
// in the clearing too. core.vh says which core it is, and what its second memory begins with.
`include "core.vh"

module reset_properties (
    input wire               clk,
    input wire               rst,
    input wire               in_valid,
    input wire [`X_BITS-1:0] x,
    input wire [`D_BITS-1:0] d
);
    wire               in_ready;
    wire [`Y_BITS-1:0] y;
    `CORE #(`PARAMETERS) dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .x(x), .d(d), .y(y));

    // A word of each memory, connected by name: which one is left to the solver.
    wire [`A_ADDRESS_BITS-1:0] a_at;
    wire [`B_ADDRESS_BITS-1:0] b_at;
    wire [`A_BITS-1:0]         a_word;
    wire [`B_BITS-1:0]         b_word;

    // Not ready since the last reset; a reset has come before the core was ready again.
    reg fresh, again;
    always @(posedge clk)
        if (rst) begin
            fresh <= 1'b1;
            again <= fresh & ~$initstate;
        end else fresh <= fresh & ~in_ready;

    always @* begin
        if ($initstate) assume (rst);
        else if (fresh && in_ready) begin
            first_memory_as_at_the_start:  assert (a_word == 0);
            second_memory_as_at_the_start: assert (b_word == (`IMAGE));
            result_as_at_the_start:        assert (y == 0);
            ready_after_resets_on_end:     cover (again);
        end
    end
endmodule
