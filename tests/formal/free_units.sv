// Units of which nothing is known: they take as long as they like, and give any word.

module fp_add #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take, sub,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign done  = req & go;
    assign q     = $anyseq;
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
    assign q     = $anyseq;
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
    assign q     = $anyseq;
endmodule

module fx_div #(
    parameter AW = 128, parameter BW = AW, parameter WIDTH = 32, parameter RND = 1,
    parameter SAT = 1, parameter LATENCY = 1
) (
    input  wire                    clk, rst, req,
    input  wire signed [AW-1:0]    a,
    input  wire signed [BW-1:0]    b,
    output wire                    done,
    output wire signed [WIDTH-1:0] q,
    output wire                    over
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign done  = req & go;
    assign q     = $anyseq;
    assign over  = $anyseq;
endmodule

// The handshake of a unit of fixed point, whose word is not left out.
module fp_wait #(parameter LATENCY = 1) (
    input  wire clk, rst, req, take,
    output wire first, done
);
    wire   go    = $anyseq;
    wire   waits = req & ~go;
    assign first = $anyseq;
    assign done  = req & go;
endmodule
