// LMS or NLMS in fixed point: the data path under the control of the floating-point core, lms_ctrl.v.
//
//              +--------------------------------------------------------+
//  x, d ------>| RAMA  N words of x   L (ring)                          |
//  in_valid -->| RAMB  N words of W   W                                 |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider (NLMS)          |---> y
//              | registers P ACC RR DEN K D E T Y; control lms_ctrl     |
//              +--------------------------------------------------------+
//
//   den  = Qden(EPS + L_0*L_0 + L_1*L_1 + ...)       NLMS; sums exact, rounded once
//   k    = MU, a word of k                           NLMS: Qk(MU / den)
//   y    = Qy(L_0*W_0 + ...)                         weights before the update
//   t    = Qt(Qy(d - y) * k)
//   W_j  = QW(W_j + L_j*t)
//
// Each signal S has WS bits, NS of them behind the point, a rounding RS (0 cut off, 1 half up, 2
// nearest even) and SS (1 saturates, 0 wraps). The letter of den is N.
//
// Reset, in any clock: registers 0; then N clocks write 0 into the memories, and in_ready stays low.
// y is right from the clock with out_valid until the next one.
`default_nettype none

module lms_fixed_core #(
    parameter N  = 10,              // taps, 1 to 64
    parameter WX = 32, parameter NX = 31,
    parameter WD = 32, parameter ND = 31,
    parameter WT = 32, parameter NT = 24, parameter RT = 1, parameter ST = 1,
    parameter WN = 32, parameter NN = 24, parameter RN = 1, parameter SN = 1,   // denominator
    parameter WK = 32, parameter NK = 15, parameter RK = 1, parameter SK = 1,
    parameter WW = 32, parameter NW = 29, parameter RW = 1, parameter SW = 1,
    parameter WY = 32, parameter NY = 31, parameter RY = 1, parameter SY = 1,
    parameter signed [63:0] MU = 64'sd1,
    parameter NM = 0,               // fraction bits of MU
    parameter signed [127:0] EPS = 128'sd0,     // at 2*NX fraction bits
    parameter NLMS = 0,             // 1: normalised
    parameter DIV_LATENCY = 1
) (
    input  wire          clk,
    input  wire          rst,
    input  wire          in_valid,  // hold x, d and in_valid until in_ready
    output wire          in_ready,
    input  wire [WX-1:0] x,
    input  wire [WD-1:0] d,
    output wire          out_valid, // one clock
    output wire [WY-1:0] y,
    // One clock each: a word is stored that was beyond the ends of its signal; a denominator is
    // stored that is not above zero.
    output wire          overflow,
    output wire          indefinite
);
    localparam AW = 128;            // exact values
    localparam AB = N > 1 ? $clog2(N) : 1;

    wire          ra_we, rb_we, p_en, acc_en, acc_first, acc_eps, rr_en, den_en, rcp_en;
    wire          d_en, e_en, e_gain, y_en, div_req, div_done, clear;
    wire [AB-1:0] ra_addr, rb_addr;
    wire [2:0]    mul_sel;
    /* verilator lint_off UNUSED */
    wire [1:0]    add_sel;          // the sums have adders of their widths
    wire          d_half;           // the front end forms the mean
    wire [3:0]    state;            // for the eye and the testbench
    /* verilator lint_on UNUSED */
    reg  signed [AW-1:0] p, acc;
    reg  signed [WW-1:0] rr;
    reg  signed [WD-1:0] dd;
    reg  signed [WY-1:0] ee, yy;
    reg  signed [WT-1:0] tt;
    // NLMS only.
    /* verilator lint_off UNUSED */
    reg  signed [WN-1:0] den;
    /* verilator lint_on UNUSED */
    reg  signed [WK-1:0] kk;

    lms_ctrl #(.N(N), .NLMS(NLMS)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .div_req(div_req), .div_done(div_done), .state(state),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we),
        .mul_sel(mul_sel), .add_sel(add_sel), .p_en(p_en), .acc_en(acc_en),
        .acc_first(acc_first), .acc_eps(acc_eps), .rr_en(rr_en), .den_en(den_en),
        .rcp_en(rcp_en), .d_en(d_en), .d_half(d_half), .e_en(e_en), .e_gain(e_gain),
        .y_en(y_en), .clear(clear));

    wire signed [WX-1:0] ra_rdata;
    wire signed [WW-1:0] rb_rdata, w_word;
    wire signed [WT-1:0] t_word;
    wire signed [WN-1:0] den_word;
    wire signed [WK-1:0] k_word;
    wire signed [WY-1:0] y_word, e_word;
    wire signed [WX-1:0] ra_wdata = clear ? {WX{1'b0}} : x;
    wire signed [WW-1:0] rb_wdata = clear ? {WW{1'b0}} : w_word;
    sp_ram #(.W(WX), .DEPTH(N), .AW(AB)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));
    sp_ram #(.W(WW), .DEPTH(N), .AW(AB)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    wire t_over, den_over, y_over, e_over, w_over, k_over;

    // Exact values.
    localparam ST_T = NX + NT;                      // scale of L*t
    localparam FW = NW > ST_T ? NW : ST_T;          // scale of W + L*t
    localparam FE = ND > NY ? ND : NY;              // scale of d - y
    /* verilator lint_off WIDTH */
    wire signed [AW-1:0] l_wide = ra_rdata, w_wide = rb_rdata, e_wide = ee, t_wide = tt;
    wire signed [AW-1:0] k_wide = NLMS != 0 ? {{(AW-WK){kk[WK-1]}}, kk} : MU;
    wire signed [AW-1:0] rr_wide = rr, d_wide = dd, y_wide = yy;
    /* verilator lint_on WIDTH */
    wire signed [AW-1:0] mul_a   = mul_sel == 3'd4 ? e_wide : l_wide;
    wire signed [AW-1:0] mul_b   = mul_sel == 3'd0 ? w_wide : mul_sel == 3'd1 ? l_wide
                                 : mul_sel == 3'd2 ? t_wide : k_wide;
    wire signed [AW-1:0] product = mul_a * mul_b;
    wire signed [AW-1:0] sum     = acc + p;
    wire signed [AW-1:0] w_exact = (rr_wide <<< (FW - NW)) + (p <<< (FW - ST_T));
    wire signed [AW-1:0] e_exact = (d_wide <<< (FE - ND)) - (y_wide <<< (FE - NY));

    fx_store #(.FROM(2 * NX), .WIDTH(WN), .N(NN), .RND(RN), .SAT(SN)) store_den (
        .a(sum), .q(den_word), .over(den_over));
    fx_store #(.FROM(NX + NW), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY)) store_y (
        .a(sum), .q(y_word), .over(y_over));
    fx_store #(.FROM(FE), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY)) store_e (
        .a(e_exact), .q(e_word), .over(e_over));
    fx_store #(.FROM(NY + NK), .WIDTH(WT), .N(NT), .RND(RT), .SAT(ST)) store_t (
        .a(product), .q(t_word), .over(t_over));
    fx_store #(.FROM(FW), .WIDTH(WW), .N(NW), .RND(RW), .SAT(SW)) store_w (
        .a(w_exact), .q(w_word), .over(w_over));

    // Plain LMS never divides.
    generate
        if (NLMS != 0) begin : with_divider
            localparam UP = NK + NN > NM ? NK + NN - NM : 0;
            localparam DN = NM > NK + NN ? NM - NK - NN : 0;
            /* verilator lint_off WIDTH */
            wire signed [AW-1:0] mu_wide = MU, den_wide = den;
            /* verilator lint_on WIDTH */
            fx_div #(.WIDTH(WK), .RND(RK), .SAT(SK), .LATENCY(DIV_LATENCY)) div (
                .clk(clk), .rst(rst), .req(div_req), .a(mu_wide <<< UP), .b(den_wide <<< DN),
                .done(div_done), .q(k_word), .over(k_over));
        end else begin : without_divider
            assign div_done = div_req;
            assign k_word   = {WK{1'b0}};
            assign k_over   = 1'b0;
        end
    endgenerate

    always @(posedge clk)
        if (rst) begin
            p   <= {AW{1'b0}};
            acc <= {AW{1'b0}};
            rr  <= {WW{1'b0}};
            den <= {WN{1'b0}};
            kk  <= {WK{1'b0}};
            dd  <= {WD{1'b0}};
            ee  <= {WY{1'b0}};
            tt  <= {WT{1'b0}};
            yy  <= {WY{1'b0}};
        end else begin
            if (p_en)   p   <= product;
            if (acc_en) acc <= !acc_first ? sum : acc_eps ? EPS : {AW{1'b0}};
            if (rr_en)  rr  <= rb_rdata;
            if (den_en) den <= den_word;
            if (rcp_en) kk  <= k_word;
            if (d_en)   dd  <= d;
            if (e_en)   ee  <= e_word;
            if (e_gain) tt  <= t_word;
            if (y_en)   yy  <= y_word;
        end

    assign y = yy;
    assign overflow = (den_en & den_over) | (rcp_en & k_over) | (y_en & y_over) | (e_en & e_over)
                    | (e_gain & t_over) | (rb_we & ~clear & w_over);
    assign indefinite = den_en & (den_word <= 0);
endmodule

`default_nettype wire
