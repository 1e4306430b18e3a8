// Single-port memory: one address per clock, asynchronous read, write at the clock's end.
// Maps to distributed memory (LUT RAM). Initial contents: +0, except for DIAG_COUNT words of
// DIAG_WORD at DIAG_FIRST, DIAG_FIRST + DIAG_STRIDE, ... (the diagonal of a matrix).
`default_nettype none

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

    integer k;
    initial begin
        for (k = 0; k < DEPTH; k = k + 1) mem[k] = {W{1'b0}};
        for (k = 0; k < DIAG_COUNT; k = k + 1) mem[DIAG_FIRST + k * DIAG_STRIDE] = DIAG_WORD;
    end

    assign rdata = mem[addr];

    always @(posedge clk) if (we) mem[addr] <= wdata;

`ifdef WAVE
    /* verilator lint_off UNUSED */
    real wdata_real, rdata_real;
    /* verilator lint_on UNUSED */
    always @* wdata_real = W == 64 ? $bitstoreal(wdata) : 0.0;
    always @* rdata_real = W == 64 ? $bitstoreal(rdata) : 0.0;
`endif
endmodule

`default_nettype wire
