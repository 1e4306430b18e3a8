// Units whose results are a function of their operands of which nothing is known, after as long as they like.
// sum, product and quotient are declared in front of the design's text for the solver, by samples.py.

(* smtlib2_module *)
module told_sum (
    input  wire       sub,
    input  wire [3:0] a, b,
    (* smtlib2_comb_expr = "(sum sub a b)" *)
    output wire [3:0] q
);
endmodule

(* smtlib2_module *)
module told_product (
    input  wire [3:0] a, b,
    (* smtlib2_comb_expr = "(product a b)" *)
    output wire [3:0] q
);
endmodule

(* smtlib2_module *)
module told_quotient (
    input  wire [3:0] a, b,
    (* smtlib2_comb_expr = "(quotient a b)" *)
    output wire [3:0] q
);
endmodule

module fp_add #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take, sub,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign done  = req & go;
    told_sum told (.sub(sub), .a(a), .b(b), .q(q));
endmodule

module fp_mul #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign done  = req & go;
    told_product told (.a(a), .b(b), .q(q));
endmodule

module fp_div #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign done  = req & go;
    told_quotient told (.a(a), .b(b), .q(q));
endmodule
