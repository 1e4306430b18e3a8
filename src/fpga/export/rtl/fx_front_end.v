// Front end of a fixed-point core: from words of d to the pairs that the core takes.
//
//   sample ---->|              |---> x   the word LAG samples ago, rounded into a word of x
//   valid ----->| fx_front_end |---> d   the newest word, or with MEAN that of the two newest
//   ready <-----|              |---> pair_valid, held until pair_ready
//
// A sample is taken in one clock and offered as a pair in the next; the next one is taken in the
// clock in which the core takes the pair. Reset is synchronous. Synthesizable.
`default_nettype none

module fx_front_end #(
    parameter WX = 32, parameter NX = 31, parameter RX = 1, parameter SX = 1,
    parameter WD = 32, parameter ND = 31, parameter RD = 1, parameter SD = 1,
    parameter LAG  = 1,             // samples by which x is older than the newest, 0 to 64
    parameter MEAN = 0              // 1: d is the mean of the two newest
) (
    input  wire          clk,
    input  wire          rst,
    input  wire          valid,     // hold sample and valid until ready
    output wire          ready,
    input  wire [WD-1:0] sample,
    output wire          pair_valid,
    input  wire          pair_ready,
    output wire [WX-1:0] x,
    output wire [WD-1:0] d,
    output wire          overflow   // x or d was beyond the ends of its words; one clock
);
    localparam DEPTH = LAG > 1 ? LAG : 1;
    localparam AW    = 128;

    reg                 offering;
    reg  [WD-1:0]       taken;
    /* verilator lint_off UNUSED */
    reg  [WD*DEPTH-1:0] held;       // older words, newest in the lowest bits
    /* verilator lint_on UNUSED */

    wire x_over, d_over;
    wire handed = pair_valid & pair_ready;
    wire take   = valid & ready;
    assign ready      = ~offering | handed;
    assign pair_valid = offering;

    always @(posedge clk)
        if (rst) begin
            offering <= 1'b0;
            taken    <= {WD{1'b0}};
        end else begin
            offering <= take | (offering & ~handed);
            if (take) taken <= sample;
        end

    wire signed [WD-1:0] newest = taken;
    wire signed [WD-1:0] earlier = held[WD-1:0];
    wire signed [WD-1:0] old;
    /* verilator lint_off WIDTH */
    wire signed [AW-1:0] old_wide = old;
    wire signed [AW-1:0] newest_wide = newest;
    wire signed [AW-1:0] earlier_wide = earlier;
    /* verilator lint_on WIDTH */
    generate
        if (LAG == 0) begin : direct
            assign old = newest;
        end else begin : delayed
            assign old = held[WD*DEPTH-1 -: WD];
        end
        if (DEPTH > 1) begin : chain
            always @(posedge clk)
                if (rst) held <= {(WD*DEPTH){1'b0}};
                else if (handed) held <= {held[WD*(DEPTH-1)-1:0], taken};
        end else begin : single
            always @(posedge clk)
                if (rst) held <= {WD{1'b0}};
                else if (handed) held <= taken;
        end
        if (MEAN != 0) begin : averaged
            fx_store #(.FROM(ND + 1), .WIDTH(WD), .N(ND), .RND(RD), .SAT(SD)) store_d (
                .a(newest_wide + earlier_wide), .q(d), .over(d_over));
        end else begin : current
            /* verilator lint_off UNUSED */
            wire signed [AW-1:0] unused = newest_wide + earlier_wide;
            /* verilator lint_on UNUSED */
            assign d = newest;
            assign d_over = 1'b0;
        end
    endgenerate
    fx_store #(.FROM(ND), .WIDTH(WX), .N(NX), .RND(RX), .SAT(SX)) store_x (
        .a(old_wide), .q(x), .over(x_over));
    assign overflow = handed & (x_over | d_over);
endmodule

`default_nettype wire
