// RLS pipeline: control, two single-port memories, one adder, one multiplier, one divider.
`timescale 1ns/1ps

module rls_core #(
    parameter P = 4,
    parameter W = 64,
    parameter FTZ = 0,
    parameter ELEM = 0,                 // 1: divide per element; 0: one reciprocal per sample
    parameter AS_PRINTED = 0,           // 1: W - M*e as the paper prints it (diverges)
    parameter [W-1:0] ONE = 0,
    parameter [W-1:0] ALPHA = 0,
    parameter [W-1:0] IALPHA = 0,
    parameter [W-1:0] DELTA = 0
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         in_valid,
    output wire         in_ready,
    input  wire [W-1:0] x,
    input  wire [W-1:0] d,
    output wire         out_valid,
    output wire [W-1:0] y
);
    localparam CW = (P > 1) ? $clog2(P) : 1;
    localparam AW = $clog2(2 * P);
    localparam BW = $clog2(2 * P + P * P);
    localparam [3:0] RIL_LOADING = 1, RIL_READING = 2, RIL_WRITING = 3,
                     LRL_READING = 4, LRL_WRITING = 5, RFR_READING = 6, RFR_WRITING = 7,
                     RFM_READING = 8, RFM_WRITING = 9, OUT_READING = 10, OUT_WRITING = 11,
                     RFW_READING = 12, RFW_WRITING = 13;

    wire [3:0] state;
    wire [1:0] ph;
    wire [CW-1:0] i, j, head;
    wire [AW-1:0] ra_addr;
    wire [BW-1:0] rb_addr;
    wire ra_we, rb_we;
    rls_ctrl #(.P(P)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .state(state), .ph(ph), .i(i), .j(j), .head(head),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we)
    );

    wire [W-1:0] ra_rdata, rb_rdata, ra_wdata, rb_wdata, add_q, mul_q, div_q;
    ram_sp #(.W(W), .DEPTH(2 * P), .AW(AW)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata)
    );
    ram_sp #(
        .W(W), .DEPTH(2 * P + P * P), .AW(BW),
        .FIRST(2 * P), .STEP(P + 1), .COUNT(P), .VALUE(DELTA)
    ) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata)
    );

    reg [W-1:0] p, acc, rr, den, rcp, dd, ee, yy;
    assign y = yy;

    wire accumulates = (state == RIL_READING) || (state == LRL_READING)
                    || (state == RFM_READING) || (state == OUT_READING);
    wire first = (j == 0);
    wire scales = (state == RFR_READING) && (ph != 0);
    wire forms_error = (state == RFW_READING) && (ph == 0);
    wire corrects = (state == RFR_WRITING) || (state == RFW_WRITING);

    // The adder continues a sum, forms the error, or corrects the latched word.
    wire [W-1:0] add_a = forms_error ? dd : corrects ? rr : acc;
    wire [W-1:0] add_b = forms_error ? yy : p;
    wire subtracts = forms_error || (state == RFR_WRITING)
                  || ((AS_PRINTED != 0) && (state == RFW_WRITING));
    fp_add #(.W(W), .FTZ(FTZ)) add (.a(add_a), .b(add_b), .sub(subtracts), .q(add_q));

    // The multiplier works on the memories' words, rescales a product, or applies 1/alpha.
    wire [W-1:0] mul_a = (state == RFR_WRITING) ? add_q : scales ? p : ra_rdata;
    wire [W-1:0] mul_b = (state == RFR_WRITING) ? IALPHA : scales ? rcp
                       : (state == RFW_READING) ? ee : rb_rdata;
    fp_mul #(.W(W), .FTZ(FTZ)) mul (.a(mul_a), .b(mul_b), .q(mul_q));

    fp_div #(.W(W), .FTZ(FTZ)) div (.a((ELEM != 0) ? p : ONE), .b(den), .q(div_q));

    // Write data is zero without write enable, so that traces compare as text.
    assign ra_wdata = !ra_we ? {W{1'b0}} : (state == RIL_LOADING) ? x : add_q;
    // Without forgetting the product with 1/alpha is wired away: x * 1 = x to the bit.
    assign rb_wdata = !rb_we ? {W{1'b0}}
                    : (state == RFR_WRITING && IALPHA != ONE) ? mul_q : add_q;

    always @(posedge clk) begin
        if (rst) begin
            p <= 0;
            acc <= 0;
            rr <= 0;
            den <= ONE;
            rcp <= 0;
            dd <= 0;
            ee <= 0;
            yy <= 0;
        end else begin
            if (in_ready) dd <= d;
            if (accumulates) begin
                p <= mul_q;
                acc <= !first ? add_q : (state == LRL_READING) ? ALPHA : {W{1'b0}};
            end
            if (state == LRL_WRITING) den <= add_q;
            if (state == RFR_READING && ph == 0) begin
                p <= mul_q;
                if (ELEM == 0 && i == 0 && j == 0) rcp <= div_q;
            end
            if (scales) begin
                rr <= rb_rdata;
                p <= (ELEM != 0) ? div_q : mul_q;
            end
            if (state == OUT_WRITING) yy <= add_q;
            if (forms_error) ee <= add_q;
            if (state == RFW_READING && ph != 0) begin
                p <= mul_q;
                rr <= rb_rdata;
            end
        end
    end
endmodule
