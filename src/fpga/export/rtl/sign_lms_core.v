// Line enhancer of patent CN101221046 on the structure of the RLS pipeline.
//
//              +------------------------------------------------------------+
//  x, d ------>| RAMA  M words        L (ring)                              |
//  in_valid -->| RAMB  M words        W                                     |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider                     |---> y
//              | registers P ACC RR DEN RCP D E Y X S T; control            |
//              +------------------------------------------------------------+
//
// x is the sample that the front end has delayed, d the newest one. Word for word, with RN after
// every operation and j ascending; o is the word that leaves the ring:
//   T    = T + x*x               in the M samples before S is replaced, the first from +0
//   S    = (S + x*x) - o*o       +0 if that is negative; T in the last sample of RECOMPUTE
//   den  = ALPHA + S
//   y    = ((+0 + L_0*W_0) + ...                    weights before the update
//   g    = sgn(d - y) * (MU/den)                    NLMS: (d - y) * (MU/den); held: +0
//   W_j  = W_j + L_j*g
// The guard holds while |d - y| > GUARD, for at most HOLD samples on end.
//
// Reset, in any clock: registers +0, DEN 1; then M clocks write +0 into RAMA and W0 into RAMB, and
// in_ready stays low. y is right from the clock with out_valid until the next one.
`default_nettype none

module sign_lms_core #(
    parameter         M           = 20,                     // taps, 1 to 64
    parameter         W           = 64,                     // bits of a word: 64 or 32
    // The binary64 defaults do not fit W = 32, which comes with constants of its own.
    /* verilator lint_off WIDTH */
    parameter [W-1:0] MU          = 64'h3f747ae147ae147b,   // step
    parameter [W-1:0] ALPHA       = 64'h3f1a36e2eb1c432d,   // added to the norm
    parameter [W-1:0] W0          = 64'h3fa999999999999a,   // weights at the start
    parameter [W-1:0] GUARD       = 64'h0,                  // largest error that corrects
    /* verilator lint_on WIDTH */
    parameter         GUARDED     = 0,      // 1: the guard is there
    parameter         HOLD        = 35,     // samples on end that it may hold
    parameter         NLMS        = 0,      // 1: the error itself, not its sign
    parameter         RECOMPUTE   = 1000,   // samples between two fresh norms, 0 = never
    parameter         FTZ         = 0,      // 1: units flush subnormals
    parameter         DIV_LATENCY = 1       // clocks of the divider
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         in_valid,   // hold x, d and in_valid until in_ready
    output wire         in_ready,
    input  wire [W-1:0] x,          // regressor word
    input  wire [W-1:0] d,          // desired word
    output wire         out_valid,  // one clock
    output wire [W-1:0] y,          // filtered word
    output wire         indefinite  // one clock: the new DEN is a NaN or not above zero
);
    localparam AB = M > 1 ? $clog2(M) : 1;
    localparam FB = W == 64 ? 52 : 23;              // fraction bits
    /* verilator lint_off WIDTH */
    localparam [W-1:0] ONE = W == 64 ? 64'h3ff0000000000000 : 64'h3f800000;
    /* verilator lint_on WIDTH */

    wire          ra_we, rb_we, p_en, acc_en, acc_first, rr_a_en, rr_b_en, den_en, rcp_en, in_en;
    wire          fresh_en, fresh_first, norm_en, norm_last, norm_fresh;
    wire          e_en, e_gain, e_held, y_en, div_req, div_done, clear;
    wire [AB-1:0] ra_addr, rb_addr;
    wire [2:0]    mul_sel, add_sel;
    /* verilator lint_off UNUSED */
    wire [3:0]    state;      // for the eye and the testbench
    /* verilator lint_on UNUSED */
    wire [W-1:0]  ra_rdata, rb_rdata, mul_q, add_q, div_q;
    reg  [W-1:0]  p, acc, rr, den, rcp, dd, ee, yy, xx, norm, fresh;

    // The guard and the sign are told from the bits of E: no arithmetic.
    wire e_nan  = (&ee[W-2:FB]) & (|ee[FB-1:0]);
    wire beyond = (GUARDED != 0) & (ee[W-2:0] > GUARD[W-2:0]);
    wire e_none = e_nan | (ee[W-2:0] == {(W-1){1'b0}});
    // A NaN keeps its sign, as the units' NaN is the canonical one.
    wire rcp_nan = (&rcp[W-2:FB]) & (|rcp[FB-1:0]);
    wire [W-1:0] signed_rcp = e_none ? {W{1'b0}} : {rcp[W-1] ^ (ee[W-1] & ~rcp_nan), rcp[W-2:0]};

    sign_lms_ctrl #(.M(M), .HOLD(HOLD), .RECOMPUTE(RECOMPUTE)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .div_req(div_req), .div_done(div_done), .beyond(beyond), .state(state),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we),
        .mul_sel(mul_sel), .add_sel(add_sel), .p_en(p_en), .acc_en(acc_en),
        .acc_first(acc_first), .rr_a_en(rr_a_en), .rr_b_en(rr_b_en), .den_en(den_en),
        .rcp_en(rcp_en), .in_en(in_en), .fresh_en(fresh_en), .fresh_first(fresh_first),
        .norm_en(norm_en), .norm_last(norm_last), .norm_fresh(norm_fresh),
        .e_en(e_en), .e_gain(e_gain), .e_held(e_held), .y_en(y_en), .clear(clear));

    wire [W-1:0] ra_wdata = clear ? {W{1'b0}} : xx;
    wire [W-1:0] rb_wdata = clear ? W0 : add_q;

    sp_ram #(.W(W), .DEPTH(M), .AW(AB)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));

    sp_ram #(.W(W), .DEPTH(M), .AW(AB), .DIAG_COUNT(M), .DIAG_WORD(W0)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    /* verilator lint_off UNUSED */
    wire add_done, mul_done;       // at once
    /* verilator lint_on UNUSED */
    fp_mul #(.W(W), .FTZ(FTZ)) mul (
        .clk(clk), .rst(rst), .req(1'b1), .take(1'b1), .done(mul_done),
        .a(mul_sel == 3'd1 ? x : mul_sel == 3'd2 ? rr : mul_sel == 3'd4 ? ee : ra_rdata),
        .b(mul_sel == 3'd0 ? rb_rdata : mul_sel == 3'd1 ? x : mul_sel == 3'd2 ? rr
         : mul_sel == 3'd3 ? ee : rcp),
        .q(mul_q));

    fp_add #(.W(W), .FTZ(FTZ)) add (
        .clk(clk), .rst(rst), .req(1'b1), .take(1'b1), .done(add_done),
        .a(add_sel == 3'd0 ? acc : add_sel == 3'd1 ? rr : add_sel == 3'd2 ? dd
         : add_sel == 3'd3 ? (fresh_first ? {W{1'b0}} : fresh) : add_sel == 3'd6 ? ALPHA : norm),
        .b(add_sel == 3'd2 ? yy : add_sel == 3'd6 ? norm : p),
        .sub(add_sel == 3'd2 || add_sel == 3'd5),
        .q(add_q));

    fp_div #(.W(W), .FTZ(FTZ), .LATENCY(DIV_LATENCY)) div (
        .clk(clk), .rst(rst), .req(div_req), .take(div_done), .a(MU), .b(den), .done(div_done), .q(div_q));

    always @(posedge clk)
        if (rst) begin
            p     <= {W{1'b0}};
            acc   <= {W{1'b0}};
            rr    <= {W{1'b0}};
            den   <= ONE;
            rcp   <= {W{1'b0}};
            dd    <= {W{1'b0}};
            ee    <= {W{1'b0}};
            yy    <= {W{1'b0}};
            xx    <= {W{1'b0}};
            norm  <= {W{1'b0}};
            fresh <= {W{1'b0}};
        end else begin
            if (p_en)     p   <= mul_q;
            if (acc_en)   acc <= acc_first ? {W{1'b0}} : add_q;
            if (rr_a_en)  rr  <= ra_rdata;
            else if (rr_b_en) rr <= rb_rdata;
            if (den_en)   den <= add_q;
            if (rcp_en)   rcp <= div_q;
            if (in_en) begin
                dd <= d;
                xx <= x;
            end
            if (fresh_en) fresh <= add_q;
            // Rounding can leave a sum of squares below zero.
            if (norm_en)
                norm <= !norm_last ? add_q : norm_fresh ? fresh : add_q[W-1] ? {W{1'b0}} : add_q;
            if (e_en)        ee <= add_q;
            else if (e_gain) ee <= e_held ? {W{1'b0}} : NLMS != 0 ? mul_q : signed_rcp;
            if (y_en)     yy  <= add_q;
        end

    assign y = yy;

    den_check #(.W(W)) check (
        .clk(clk), .rst(rst), .load(den_en), .den(den), .indefinite(indefinite));

`ifdef WAVE
    // Readable twins of the binary64 words.
    /* verilator lint_off UNUSED */
    real x_real, d_real, p_real, acc_real, rr_real, den_real, rcp_real;
    real dd_real, ee_real, yy_real, norm_real;
    /* verilator lint_on UNUSED */
    always @* x_real    = W == 64 ? $bitstoreal(x) : 0.0;
    always @* d_real    = W == 64 ? $bitstoreal(d) : 0.0;
    always @* p_real    = W == 64 ? $bitstoreal(p) : 0.0;
    always @* acc_real  = W == 64 ? $bitstoreal(acc) : 0.0;
    always @* rr_real   = W == 64 ? $bitstoreal(rr) : 0.0;
    always @* den_real  = W == 64 ? $bitstoreal(den) : 0.0;
    always @* rcp_real  = W == 64 ? $bitstoreal(rcp) : 0.0;
    always @* dd_real   = W == 64 ? $bitstoreal(dd) : 0.0;
    always @* ee_real   = W == 64 ? $bitstoreal(ee) : 0.0;
    always @* yy_real   = W == 64 ? $bitstoreal(yy) : 0.0;
    always @* norm_real = W == 64 ? $bitstoreal(norm) : 0.0;
`endif
endmodule

`default_nettype wire
