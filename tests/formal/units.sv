// What stands for memories and arithmetic units in proofs about the control: nothing is known of a word but
// what it depends on.

// A single-port memory. With ANY defined, what is read in a clock of writing may be any word.
module sp_ram #(
    parameter         W           = 64,
    parameter         DEPTH       = 8,
    parameter         AW          = $clog2(DEPTH),
    parameter         DIAG_FIRST  = 0,
    parameter         DIAG_STRIDE = 1,
    parameter         DIAG_COUNT  = 0,
    parameter [W-1:0] DIAG_WORD   = {W{1'b0}}
) (
    input  wire          clk,
    input  wire          we,
    input  wire [AW-1:0] addr,
    input  wire [W-1:0]  wdata,
    output wire [W-1:0]  rdata
);
    reg [W-1:0] mem [0:DEPTH-1];
`ifdef ANY
    wire [W-1:0] any = $anyseq;
`else
    wire [W-1:0] any = {W{1'b0}};
`endif
    assign rdata = we ? any : mem[addr];
    always @(posedge clk) if (we) mem[addr] <= wdata;
endmodule

// Every bit of the result hangs on a bit of each operand.
module fp_add #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take, sub,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    assign q    = {a[W-2:0], a[W-1]} ^ {b[W-4:0], b[W-1:W-3]} ^ {W{sub}};
    assign done = req;
endmodule

module fp_mul #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    assign q    = {a[W-2:0], a[W-1]} ^ {b[W-4:0], b[W-1:W-3]};
    assign done = req;
endmodule

module fp_div #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1) (
    input  wire         clk, rst, req, take,
    input  wire [W-1:0] a, b,
    output wire         done,
    output wire [W-1:0] q
);
    assign q    = {a[W-2:0], a[W-1]} ^ {b[W-4:0], b[W-1:W-3]};
    assign done = req;
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
    assign q    = a[WIDTH-1:0] ^ {b[WIDTH-2:0], b[WIDTH-1]};
    assign over = ^a ^ ^b;
    assign done = req;
endmodule

// Units of fixed point have a handshake of their own.
module fp_wait #(parameter LATENCY = 1) (
    input  wire clk, rst, req, take,
    output wire first, done
);
    assign first = 1'b1;
    assign done  = req;
endmodule
