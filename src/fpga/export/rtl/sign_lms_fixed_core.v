// Line enhancer in fixed point: the data path under the control of the floating-point core,
// sign_lms_ctrl.v, whose norm is never replaced.
//
//              +------------------------------------------------------------+
//  x, d ------>| RAMA  M words of x   L (ring)                              |
//  in_valid -->| RAMB  M words of W   W                                     |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider                     |---> y
//              | registers P ACC RR DEN K D E T Y X S; control              |
//              +------------------------------------------------------------+
//
// x is the sample that the front end has delayed, d the newest one; o is the word that leaves the ring:
//   S    = S + x*x - o*o                             exact, so that no rounding is kept
//   den  = Qden(ALPHA + S)
//   k    = Qk(MU / den)
//   y    = Qy(L_0*W_0 + ...)                         weights before the update
//   t    = Qt(sgn(Qy(d - y)) * k)                    NLMS: Qt(Qy(d - y) * k); held: 0
//   W_j  = QW(W_j + L_j*t)
// The guard holds while |Qy(d - y)| > GUARD, for at most HOLD samples on end.
//
// Each signal S has WS bits, NS of them behind the point, a rounding RS (0 cut off, 1 half up, 2
// nearest even) and SS (1 saturates, 0 wraps). The letter of den is N.
//
// Reset, in any clock: registers 0; then M clocks write 0 into RAMA and W0 into RAMB, and in_ready
// stays low. y is right from the clock with out_valid until the next one.
`default_nettype none

module sign_lms_fixed_core #(
    parameter M  = 20,              // taps, 1 to 64
    parameter WX = 32, parameter NX = 31,
    parameter WD = 32, parameter ND = 31,
    parameter WT = 32, parameter NT = 28, parameter RT = 1, parameter ST = 1,
    parameter WN = 32, parameter NN = 24, parameter RN = 1, parameter SN = 1,   // denominator
    parameter WK = 32, parameter NK = 28, parameter RK = 1, parameter SK = 1,
    parameter WW = 32, parameter NW = 29, parameter RW = 1, parameter SW = 1,
    parameter WY = 32, parameter NY = 31, parameter RY = 1, parameter SY = 1,
    parameter signed [63:0] MU = 64'sd1,
    parameter NM = 0,               // fraction bits of MU
    parameter signed [127:0] ALPHA = 128'sd0,   // at 2*NX fraction bits
    parameter NLMS = 0,             // 1: the error itself, not its sign
    parameter signed [63:0] W0 = 64'sd0,        // weights at the start, a word of W
    parameter GUARDED = 0,          // 1: the guard is there
    parameter signed [63:0] GUARD = 64'sd0,     // largest error that corrects, a word of y
    parameter HOLD = 35,            // samples on end that it may hold
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
    localparam AB = M > 1 ? $clog2(M) : 1;

    wire          ra_we, rb_we, p_en, acc_en, acc_first, rr_a_en, rr_b_en, den_en, rcp_en, in_en;
    wire          norm_en, norm_last, e_en, e_gain, e_held, y_en, div_req, div_done, clear;
    wire [AB-1:0] ra_addr, rb_addr;
    wire [2:0]    mul_sel;
    /* verilator lint_off UNUSED */
    wire [2:0]    add_sel;          // the sums have adders of their widths
    wire          fresh_en, fresh_first, norm_fresh;
    wire [3:0]    state;            // for the eye and the testbench
    /* verilator lint_on UNUSED */
    reg  signed [AW-1:0] p, acc, norm;
    // A word of x that leaves the ring, or one of W.
    localparam RRW = WX > WW ? WX : WW;
    reg  signed [RRW-1:0] rr;
    reg  signed [WX-1:0] xx;
    reg  signed [WD-1:0] dd;
    reg  signed [WY-1:0] ee, yy;
    reg  signed [WT-1:0] tt;
    reg  signed [WN-1:0] den;
    reg  signed [WK-1:0] kk;

    /* verilator lint_off WIDTH */
    wire signed [AW-1:0] e_wide = ee, guard_wide = GUARD;
    wire signed [WW-1:0] w0_word = W0;
    /* verilator lint_on WIDTH */
    wire beyond = (GUARDED != 0) & ((e_wide > guard_wide) | (-e_wide > guard_wide));

    sign_lms_ctrl #(.M(M), .HOLD(HOLD), .RECOMPUTE(0)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .div_req(div_req), .div_done(div_done), .beyond(beyond), .state(state),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we),
        .mul_sel(mul_sel), .add_sel(add_sel), .p_en(p_en), .acc_en(acc_en),
        .acc_first(acc_first), .rr_a_en(rr_a_en), .rr_b_en(rr_b_en), .den_en(den_en),
        .rcp_en(rcp_en), .in_en(in_en), .fresh_en(fresh_en), .fresh_first(fresh_first),
        .norm_en(norm_en), .norm_last(norm_last), .norm_fresh(norm_fresh),
        .e_en(e_en), .e_gain(e_gain), .e_held(e_held), .y_en(y_en), .clear(clear));

    wire signed [WX-1:0] ra_rdata;
    wire signed [WW-1:0] rb_rdata, w_word;
    wire signed [WT-1:0] t_word;
    wire signed [WN-1:0] den_word;
    wire signed [WK-1:0] k_word;
    wire signed [WY-1:0] y_word, e_word;
    wire signed [WX-1:0] x_word = x;
    wire signed [WX-1:0] ra_wdata = clear ? {WX{1'b0}} : xx;
    wire signed [WW-1:0] rb_wdata = clear ? w0_word : w_word;
    sp_ram #(.W(WX), .DEPTH(M), .AW(AB)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));
    sp_ram #(.W(WW), .DEPTH(M), .AW(AB)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    wire t_over, den_over, y_over, e_over, w_over, k_over;

    // Exact values.
    localparam ST_T = NX + NT;                      // scale of L*t
    localparam FW = NW > ST_T ? NW : ST_T;          // scale of W + L*t
    localparam FE = ND > NY ? ND : NY;              // scale of d - y
    localparam UP = NK + NN > NM ? NK + NN - NM : 0;
    localparam DN = NM > NK + NN ? NM - NK - NN : 0;
    /* verilator lint_off WIDTH */
    wire signed [AW-1:0] l_wide = ra_rdata, w_wide = rb_rdata, x_wide = x_word, t_wide = tt;
    wire signed [AW-1:0] k_wide = kk, rr_wide = rr, d_wide = dd, y_wide = yy;
    wire signed [AW-1:0] mu_wide = MU, den_wide = den;
    wire signed [RRW-1:0] ra_word = ra_rdata, rb_word = rb_rdata;
    /* verilator lint_on WIDTH */
    wire signed [AW-1:0] mul_a   = mul_sel == 3'd1 ? x_wide : mul_sel == 3'd2 ? rr_wide
                                 : mul_sel == 3'd4 ? e_wide : l_wide;
    wire signed [AW-1:0] mul_b   = mul_sel == 3'd0 ? w_wide : mul_sel == 3'd1 ? x_wide
                                 : mul_sel == 3'd2 ? rr_wide : mul_sel == 3'd3 ? t_wide : k_wide;
    wire signed [AW-1:0] product = mul_a * mul_b;
    wire signed [AW-1:0] sum     = acc + p;
    wire signed [AW-1:0] energy  = ALPHA + norm;
    wire signed [AW-1:0] zero    = {AW{1'b0}};
    wire signed [AW-1:0] signed_k = ee[WY-1] ? -k_wide : ee == {WY{1'b0}} ? zero : k_wide;
    wire signed [AW-1:0] w_exact = (rr_wide <<< (FW - NW)) + (p <<< (FW - ST_T));
    wire signed [AW-1:0] e_exact = (d_wide <<< (FE - ND)) - (y_wide <<< (FE - NY));

    fx_store #(.FROM(2 * NX), .WIDTH(WN), .N(NN), .RND(RN), .SAT(SN)) store_den (
        .a(energy), .q(den_word), .over(den_over));
    fx_store #(.FROM(NX + NW), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY)) store_y (
        .a(sum), .q(y_word), .over(y_over));
    fx_store #(.FROM(FE), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY)) store_e (
        .a(e_exact), .q(e_word), .over(e_over));
    fx_store #(.FROM(NLMS != 0 ? NY + NK : NK), .WIDTH(WT), .N(NT), .RND(RT), .SAT(ST)) store_t (
        .a(NLMS != 0 ? product : signed_k), .q(t_word), .over(t_over));
    fx_store #(.FROM(FW), .WIDTH(WW), .N(NW), .RND(RW), .SAT(SW)) store_w (
        .a(w_exact), .q(w_word), .over(w_over));
    fx_div #(.WIDTH(WK), .RND(RK), .SAT(SK), .LATENCY(DIV_LATENCY)) div (
        .clk(clk), .rst(rst), .req(div_req), .a(mu_wide <<< UP), .b(den_wide <<< DN),
        .done(div_done), .q(k_word), .over(k_over));

    always @(posedge clk)
        if (rst) begin
            p    <= zero;
            acc  <= zero;
            norm <= zero;
            rr   <= {RRW{1'b0}};
            den  <= {WN{1'b0}};
            kk   <= {WK{1'b0}};
            xx   <= {WX{1'b0}};
            dd   <= {WD{1'b0}};
            ee   <= {WY{1'b0}};
            tt   <= {WT{1'b0}};
            yy   <= {WY{1'b0}};
        end else begin
            if (p_en)   p   <= product;
            if (acc_en) acc <= acc_first ? zero : sum;
            if (rr_a_en) rr <= ra_word;
            else if (rr_b_en) rr <= rb_word;
            if (den_en) den <= den_word;
            if (rcp_en) kk  <= k_word;
            if (in_en) begin
                dd <= d;
                xx <= x;
            end
            if (norm_en) norm <= norm_last ? norm - p : norm + p;
            if (e_en)   ee  <= e_word;
            if (e_gain) tt  <= e_held ? {WT{1'b0}} : t_word;
            if (y_en)   yy  <= y_word;
        end

    assign y = yy;
    assign overflow = (den_en & den_over) | (rcp_en & k_over) | (y_en & y_over) | (e_en & e_over)
                    | (e_gain & ~e_held & t_over) | (rb_we & ~clear & w_over);
    assign indefinite = den_en & (den_word <= 0);
endmodule

`default_nettype wire
