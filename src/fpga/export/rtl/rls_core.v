// RLS filter core: the alternate-storage multiply-accumulate pipeline.
//
//              +--------------------------------------------------------+
//  x, d ------>| RAMA  2P words       L (ring) | t, then M              |
//  in_valid -->| RAMB  2P+P*P words   W | t | R row by row              |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider                 |---> y
//              | registers P ACC RR DEN RCP D E Y; control in rls_ctrl  |
//              +--------------------------------------------------------+
//
// Word for word, with RN after every operation and j ascending:
//   t_i  = ((+0 + L_0*R_i0) + L_1*R_i1) + ...
//   den  = ((ALPHA + L_0*t_0) + L_1*t_1) + ...
//   R_ij = (R_ij - (t_i*t_j)*(1/den)) * IALPHA      DIV_ELEM: (t_i*t_j)/den
//   M_i  = ((+0 + L_0*R_i0) + ...                   updated R
//   y    = ((+0 + L_0*W_0) + ...                    weights before the update
//   W_i  = W_i + M_i*(d - y)                        UPDATE_SUB: the sign the paper prints
// (t_i*t_j) first keeps R exactly symmetric; (t_i*rcp)*t_j diverges for ALPHA < 1.
//
// Reset, in any clock: registers +0, DEN 1; then P*P + 2P clocks write the memories, +0 and
// R = DELTA * I, and in_ready stays low. y is right from the clock with out_valid until the next one.
`default_nettype none

module rls_core #(
    parameter         P           = 4,                      // taps, 1 to 64
    parameter         W           = 64,                     // bits of a word: 64 or 32
    // The binary64 defaults do not fit W = 32, which comes with constants of its own.
    /* verilator lint_off WIDTH */
    parameter [W-1:0] ALPHA       = 64'h3ff0000000000000,   // forgetting factor
    parameter [W-1:0] IALPHA      = 64'h3ff0000000000000,   // RN(1 / ALPHA)
    parameter [W-1:0] DELTA       = 64'h40c3880000000000,   // initial diagonal of R
    /* verilator lint_on WIDTH */
    parameter         DIV_ELEM    = 0,      // 0: one division per sample; 1: one per element
    parameter         UPDATE_SUB  = 0,      // 1: W - M*e, as printed; diverges
    parameter         FTZ         = 0,      // 1: units flush subnormals
    parameter         ADD_LATENCY = 1,      // clocks of the adder
    parameter         MUL_LATENCY = 1,      // clocks of the multiplier
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
    localparam RA = $clog2(2 * P);
    localparam RB = $clog2(2 * P + P * P);
    /* verilator lint_off WIDTH */
    localparam [W-1:0] ONE = W == 64 ? 64'h3ff0000000000000 : 64'h3f800000;
    /* verilator lint_on WIDTH */

    wire          ra_we, ra_sel, rb_we, rb_sel, p_en, p_div, p_sum, acc_en, acc_first, acc_alpha;
    wire          rr_en, den_en, rcp_en, d_en, e_en, y_en, clear, clear_diag;
    wire          add_req, add_done, mul_req, mul_done, div_req, div_done, take;
    wire [RA-1:0] ra_addr;
    wire [RB-1:0] rb_addr;
    wire [1:0]    mul_sel, add_sel;
    /* verilator lint_off UNUSED */
    wire [3:0]    state;      // for the eye and the testbench
    /* verilator lint_on UNUSED */
    wire [W-1:0]  ra_rdata, rb_rdata, mul_q, add_q, div_q;
    reg  [W-1:0]  p, acc, rr, den, rcp, dd, ee, yy;

    // x * 1.0 = x for every word that leaves a unit: with ALPHA = 1 the multiplier is by-passed,
    // so that subtract and multiply do not share a clock.
    localparam UNITY = IALPHA == ONE;
    localparam SPLIT = !UNITY && (ADD_LATENCY > 1 || MUL_LATENCY > 1);

    rls_ctrl #(.P(P), .DIV_ELEM(DIV_ELEM), .SCALE(!UNITY), .SPLIT(SPLIT)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .add_req(add_req), .add_done(add_done), .mul_req(mul_req), .mul_done(mul_done),
        .div_req(div_req), .div_done(div_done), .take(take), .state(state),
        .ra_addr(ra_addr), .ra_we(ra_we), .ra_sel(ra_sel),
        .rb_addr(rb_addr), .rb_we(rb_we), .rb_sel(rb_sel),
        .mul_sel(mul_sel), .add_sel(add_sel), .p_en(p_en), .p_div(p_div),
        .p_sum(p_sum), .acc_en(acc_en), .acc_first(acc_first), .acc_alpha(acc_alpha), .rr_en(rr_en),
        .den_en(den_en), .rcp_en(rcp_en), .d_en(d_en), .e_en(e_en), .y_en(y_en),
        .clear(clear), .clear_diag(clear_diag));

    wire [W-1:0] zero  = {W{1'b0}};
    wire [W-1:0] ra_wdata = clear ? zero : ra_sel ? x : add_q;
    wire [W-1:0] rb_wdata = clear_diag ? DELTA : clear ? zero : rb_sel ? mul_q : add_q;

    sp_ram #(.W(W), .DEPTH(2 * P)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));

    sp_ram #(.W(W), .DEPTH(2 * P + P * P), .DIAG_FIRST(2 * P), .DIAG_STRIDE(P + 1),
             .DIAG_COUNT(P), .DIAG_WORD(DELTA)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    wire          scale = mul_sel == 2'd2;
    wire [W-1:0]  scaled = SPLIT ? p : add_q;
    wire [W-1:0]  product;
    fp_mul #(.W(W), .FTZ(FTZ), .LATENCY(MUL_LATENCY)) mul (
        .clk(clk), .rst(rst), .req(mul_req), .take(take),
        .a(mul_sel == 2'd1 ? p : scale && !UNITY ? scaled : ra_rdata),
        .b(mul_sel == 2'd1 ? rcp : mul_sel == 2'd3 ? ee : scale ? IALPHA : rb_rdata),
        .done(mul_done), .q(product));
    assign mul_q = scale && UNITY ? add_q : product;

    fp_add #(.W(W), .FTZ(FTZ), .LATENCY(ADD_LATENCY)) add (
        .clk(clk), .rst(rst), .req(add_req), .take(take),
        .a(add_sel == 2'd0 ? acc : add_sel == 2'd2 ? dd : rr),
        .b(add_sel == 2'd2 ? yy : p),
        .sub(add_sel == 2'd1 || add_sel == 2'd2 || (add_sel == 2'd3 && UPDATE_SUB != 0)),
        .done(add_done), .q(add_q));

    fp_div #(.W(W), .FTZ(FTZ), .LATENCY(DIV_LATENCY)) div (
        .clk(clk), .rst(rst), .req(div_req), .take(take), .a(DIV_ELEM != 0 ? p : ONE), .b(den),
        .done(div_done), .q(div_q));

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
        end else begin
            if (p_en)   p   <= p_div ? div_q : p_sum ? add_q : mul_q;
            if (acc_en) acc <= !acc_first ? add_q : acc_alpha ? ALPHA : {W{1'b0}};
            if (rr_en)  rr  <= rb_rdata;
            if (den_en) den <= add_q;
            if (rcp_en) rcp <= div_q;
            if (d_en)   dd  <= d;
            if (e_en)   ee  <= add_q;
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
