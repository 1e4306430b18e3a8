// Tells a denominator that a filter must not divide by, in the clock after it was loaded: looked at in
// the register, not behind the adder.
`default_nettype none

module den_check #(
    parameter W = 64                // bits of a word: 64 or 32
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         load,       // den is loaded at the end of this clock
    input  wire [W-1:0] den,
    output wire         indefinite  // one clock: the new den is a NaN or not above zero
);
    localparam FB = W == 64 ? 52 : 23;              // fraction bits
    reg fresh;
    always @(posedge clk) fresh <= ~rst & load;
    wire is_nan  = (&den[W-2:FB]) & (|den[FB-1:0]);
    wire is_zero = den[W-2:0] == {(W-1){1'b0}};
    assign indefinite = fresh & (den[W-1] | is_nan | is_zero);
endmodule

`default_nettype wire
