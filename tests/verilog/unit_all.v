// The four operations side by side, combinational: for unit_all.cpp.
module unit_all #(
    parameter W   = 64,
    parameter FTZ = 0
) (
    input  wire         clk,
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    output wire [W-1:0] sum,
    output wire [W-1:0] difference,
    output wire [W-1:0] product,
    output wire [W-1:0] quotient
);
    fp_add #(.W(W), .FTZ(FTZ)) add (.clk(clk), .rst(1'b0), .req(1'b1), .take(1'b1), .a(a), .b(b),
        .sub(1'b0), .done(), .q(sum));
    fp_add #(.W(W), .FTZ(FTZ)) sub (.clk(clk), .rst(1'b0), .req(1'b1), .take(1'b1), .a(a), .b(b),
        .sub(1'b1), .done(), .q(difference));
    fp_mul #(.W(W), .FTZ(FTZ)) mul (.clk(clk), .rst(1'b0), .req(1'b1), .take(1'b1), .a(a), .b(b),
        .done(), .q(product));
    fp_div #(.W(W), .FTZ(FTZ)) div (.clk(clk), .rst(1'b0), .req(1'b1), .take(1'b1), .a(a), .b(b),
        .done(), .q(quotient));
endmodule
