// Single-port memory: asynchronous read, synchronous write (distributed RAM).
// Initial contents: zero, but words FIRST, FIRST + STEP, ... (COUNT of them) hold VALUE.
`timescale 1ns/1ps

module ram_sp #(
    parameter W = 64,
    parameter DEPTH = 8,
    parameter AW = 3,
    parameter FIRST = 0,
    parameter STEP = 1,
    parameter COUNT = 0,
    parameter [W-1:0] VALUE = 0
) (
    input  wire          clk,
    input  wire          we,
    input  wire [AW-1:0] addr,
    input  wire [W-1:0]  wdata,
    output wire [W-1:0]  rdata
);
    reg [W-1:0] mem [0:DEPTH-1];
    integer k;
    initial begin
        for (k = 0; k < DEPTH; k = k + 1) mem[k] = 0;
        for (k = 0; k < COUNT; k = k + 1) mem[FIRST + k * STEP] = VALUE;
    end
    assign rdata = mem[addr];
    always @(posedge clk) if (we) mem[addr] <= wdata;
endmodule
