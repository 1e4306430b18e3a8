// LMS or NLMS filter core on the structure of the RLS pipeline.
//
//              +--------------------------------------------------------+
//  x, d ------>| RAMA  N words        L (ring)                          |
//  in_valid -->| RAMB  N words        W                                 |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider (NLMS)          |---> y
//              | registers P ACC RR DEN RCP D E Y XP; control lms_ctrl  |
//              +--------------------------------------------------------+
//
// Word for word, with RN after every operation and j ascending:
//   d    = (x + XP) * 0.5 with XP the previous x; D_PORT: the port d as it is
//   den  = ((EPS + L_0*L_0) + L_1*L_1) + ...        NLMS
//   y    = ((+0 + L_0*W_0) + ...                    weights before the update
//   g    = (d - y) * MU                             NLMS: (d - y) * (MU/den)
//   W_j  = W_j + L_j*g                              UPDATE_SUB: the sign the paper prints
//
// Reset, in any clock: registers +0, DEN 1; then N clocks write +0 into the memories, and in_ready
// stays low. y is right from the clock with out_valid until the next one.
`default_nettype none

module lms_core #(
    parameter         N           = 10,                     // taps, 1 to 64
    parameter         W           = 64,                     // bits of a word: 64 or 32
    // The binary64 defaults do not fit W = 32, which comes with constants of its own.
    /* verilator lint_off WIDTH */
    parameter [W-1:0] MU          = 64'h3fe999999999999a,   // step size
    parameter [W-1:0] EPS         = 64'h3ff0000000000000,   // NLMS: added to L'L
    /* verilator lint_on WIDTH */
    parameter         NLMS        = 0,      // 1: normalised
    parameter         D_PORT      = 0,      // 1: desired word from port d, not the mean
    parameter         UPDATE_SUB  = 0,      // 1: W - L*g, as printed; diverges
    parameter         FTZ         = 0,      // 1: units flush subnormals
    parameter         DIV_LATENCY = 1       // clocks of the divider
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         in_valid,   // hold x, d and in_valid until in_ready
    output wire         in_ready,
    input  wire [W-1:0] x,          // regressor word
    input  wire [W-1:0] d,          // desired word, used with D_PORT only
    output wire         out_valid,  // one clock
    output wire [W-1:0] y,          // filtered word
    output wire         indefinite  // one clock: the new DEN is a NaN or not above zero
);
    localparam AB = N > 1 ? $clog2(N) : 1;
    /* verilator lint_off WIDTH */
    localparam [W-1:0] ONE  = W == 64 ? 64'h3ff0000000000000 : 64'h3f800000;
    localparam [W-1:0] HALF = W == 64 ? 64'h3fe0000000000000 : 64'h3f000000;
    /* verilator lint_on WIDTH */

    wire          ra_we, rb_we, p_en, acc_en, acc_first, acc_eps, rr_en, den_en, rcp_en;
    wire          d_en, d_half, e_en, e_gain, y_en, div_req, div_done, clear;
    wire [AB-1:0] ra_addr, rb_addr;
    wire [2:0]    mul_sel;
    wire [1:0]    add_sel;
    /* verilator lint_off UNUSED */
    wire [3:0]    state;      // for the eye and the testbench
    /* verilator lint_on UNUSED */
    wire [W-1:0]  ra_rdata, rb_rdata, mul_q, add_q, div_q;
    reg  [W-1:0]  p, acc, rr, rcp, dd, ee, yy, xp;
    /* verilator lint_off UNUSED */
    reg  [W-1:0]  den;        // NLMS only
    /* verilator lint_on UNUSED */

    lms_ctrl #(.N(N), .NLMS(NLMS)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .div_req(div_req), .div_done(div_done), .state(state),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we),
        .mul_sel(mul_sel), .add_sel(add_sel), .p_en(p_en), .acc_en(acc_en),
        .acc_first(acc_first), .acc_eps(acc_eps), .rr_en(rr_en), .den_en(den_en),
        .rcp_en(rcp_en), .d_en(d_en), .d_half(d_half), .e_en(e_en), .e_gain(e_gain), .y_en(y_en), .clear(clear));

    wire [W-1:0] ra_wdata = clear ? {W{1'b0}} : x;
    wire [W-1:0] rb_wdata = clear ? {W{1'b0}} : add_q;

    sp_ram #(.W(W), .DEPTH(N), .AW(AB)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));

    sp_ram #(.W(W), .DEPTH(N), .AW(AB)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    wire [W-1:0] gain = NLMS != 0 ? rcp : MU;
    /* verilator lint_off UNUSED */
    wire add_done, mul_done;       // at once
    /* verilator lint_on UNUSED */
    fp_mul #(.W(W), .FTZ(FTZ)) mul (
        .clk(clk), .rst(rst), .req(1'b1), .take(1'b1), .done(mul_done),
        .a(mul_sel == 3'd3 ? dd : mul_sel == 3'd4 ? ee : ra_rdata),
        .b(mul_sel == 3'd0 ? rb_rdata : mul_sel == 3'd1 ? ra_rdata : mul_sel == 3'd2 ? ee
         : mul_sel == 3'd3 ? HALF : gain),
        .q(mul_q));

    fp_add #(.W(W), .FTZ(FTZ)) add (
        .clk(clk), .rst(rst), .req(1'b1), .take(1'b1), .done(add_done),
        .a(add_sel == 2'd0 ? acc : add_sel == 2'd1 ? rr : add_sel == 2'd2 ? dd : x),
        .b(add_sel == 2'd2 ? yy : add_sel == 2'd3 ? xp : p),
        .sub(add_sel == 2'd2 || (add_sel == 2'd1 && UPDATE_SUB != 0)),
        .q(add_q));

    // Plain LMS never divides.
    generate
        if (NLMS != 0) begin : with_divider
            fp_div #(.W(W), .FTZ(FTZ), .LATENCY(DIV_LATENCY)) div (
                .clk(clk), .rst(rst), .req(div_req), .take(div_done), .a(MU), .b(den), .done(div_done), .q(div_q));
        end else begin : without_divider
            assign div_done = div_req;
            assign div_q    = {W{1'b0}};
        end
    endgenerate

    always @(posedge clk)
        if (rst) begin
            p   <= {W{1'b0}};
            acc <= {W{1'b0}};
            rr  <= {W{1'b0}};
            den <= ONE;
            rcp <= {W{1'b0}};
            dd  <= {W{1'b0}};
            ee  <= {W{1'b0}};
            yy  <= {W{1'b0}};
            xp  <= {W{1'b0}};
        end else begin
            if (p_en)   p   <= mul_q;
            if (acc_en) acc <= !acc_first ? add_q : acc_eps ? EPS : {W{1'b0}};
            if (rr_en)  rr  <= rb_rdata;
            if (den_en) den <= add_q;
            if (rcp_en) rcp <= div_q;
            if (d_en) begin
                dd <= D_PORT != 0 ? d : add_q;
                xp <= x;
            end else if (d_half && D_PORT == 0) dd <= mul_q;
            if (e_en) ee <= add_q;
            else if (e_gain) ee <= mul_q;
            if (y_en)   yy  <= add_q;
        end

    assign y = yy;

    den_check #(.W(W)) check (
        .clk(clk), .rst(rst), .load(den_en), .den(den), .indefinite(indefinite));

`ifdef WAVE
    // Readable twins of the binary64 words.
    /* verilator lint_off UNUSED */
    real x_real, d_real, p_real, acc_real, rr_real, den_real, rcp_real;
    real dd_real, ee_real, yy_real;
    /* verilator lint_on UNUSED */
    always @* x_real   = W == 64 ? $bitstoreal(x) : 0.0;
    always @* d_real   = W == 64 ? $bitstoreal(d) : 0.0;
    always @* p_real   = W == 64 ? $bitstoreal(p) : 0.0;
    always @* acc_real = W == 64 ? $bitstoreal(acc) : 0.0;
    always @* rr_real  = W == 64 ? $bitstoreal(rr) : 0.0;
    always @* den_real = W == 64 ? $bitstoreal(den) : 0.0;
    always @* rcp_real = W == 64 ? $bitstoreal(rcp) : 0.0;
    always @* dd_real  = W == 64 ? $bitstoreal(dd) : 0.0;
    always @* ee_real  = W == 64 ? $bitstoreal(ee) : 0.0;
    always @* yy_real  = W == 64 ? $bitstoreal(yy) : 0.0;
`endif
endmodule

`default_nettype wire
