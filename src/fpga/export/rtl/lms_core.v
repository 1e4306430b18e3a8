// LMS and NLMS pipeline on the structure of the RLS pipeline.
`timescale 1ns/1ps

module lms_core #(
    parameter N = 10,
    parameter W = 64,
    parameter FTZ = 0,
    parameter NORMALISED = 0,
    parameter MEAN = 1,                 // 1: d = (x + previous x) * 0.5; 0: the port d
    parameter AS_PRINTED = 0,           // 1: W - mu*e*L as the paper prints it (diverges)
    parameter [W-1:0] ONE = 0,
    parameter [W-1:0] HALF = 0,
    parameter [W-1:0] MU = 0,
    parameter [W-1:0] EPS = 0
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
    localparam CW = (N > 1) ? $clog2(N) : 1;
    localparam [3:0] L_LOADING = 1, LL_READING = 2, LL_WRITING = 3, OUT_READING = 4,
                     OUT_WRITING = 5, ERR = 6, GAIN = 7, LMW_READING = 8, LMW_WRITING = 9;

    wire [3:0] state;
    wire [CW-1:0] i, j, head, ra_addr, rb_addr;
    wire ra_we, rb_we;
    lms_ctrl #(.N(N), .NORMALISED(NORMALISED)) ctrl (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .out_valid(out_valid),
        .state(state), .i(i), .j(j), .head(head),
        .ra_addr(ra_addr), .ra_we(ra_we), .rb_addr(rb_addr), .rb_we(rb_we)
    );

    wire [W-1:0] ra_rdata, rb_rdata, ra_wdata, rb_wdata, add_q, mul_q, div_q;
    ram_sp #(.W(W), .DEPTH(N), .AW(CW)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata)
    );
    ram_sp #(.W(W), .DEPTH(N), .AW(CW)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata)
    );

    reg [W-1:0] p, acc, rr, den, rcp, dd, ee, yy, xp;
    assign y = yy;

    wire first = (j == 0);
    wire [W-1:0] add_a = (state == L_LOADING) ? x : (state == ERR) ? dd
                       : (state == LMW_WRITING) ? rr : acc;
    wire [W-1:0] add_b = (state == L_LOADING) ? xp : (state == ERR) ? yy : p;
    wire subtracts = (state == ERR) || ((AS_PRINTED != 0) && (state == LMW_WRITING));
    fp_add #(.W(W), .FTZ(FTZ)) add (.a(add_a), .b(add_b), .sub(subtracts), .q(add_q));

    wire [W-1:0] mul_a = (state == OUT_WRITING) ? dd : (state == GAIN) ? ee : ra_rdata;
    wire [W-1:0] mul_b = (state == OUT_WRITING) ? HALF
                       : (state == GAIN) ? ((NORMALISED != 0) ? rcp : MU)
                       : (state == LMW_READING) ? ee
                       : (state == LL_READING) ? ra_rdata : rb_rdata;
    fp_mul #(.W(W), .FTZ(FTZ)) mul (.a(mul_a), .b(mul_b), .q(mul_q));

    generate
        if (NORMALISED != 0) begin : divider
            fp_div #(.W(W), .FTZ(FTZ)) div (.a(MU), .b(den), .q(div_q));
        end else begin : no_divider
            assign div_q = 0;
        end
    endgenerate

    assign ra_wdata = ra_we ? x : {W{1'b0}};
    assign rb_wdata = rb_we ? add_q : {W{1'b0}};

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
            xp <= 0;
        end else begin
            if (in_ready) begin
                dd <= (MEAN != 0) ? add_q : d;
                xp <= x;
            end
            if (state == LL_READING || state == OUT_READING) begin
                p <= mul_q;
                acc <= !first ? add_q : (state == LL_READING) ? EPS : {W{1'b0}};
            end
            if (state == LL_WRITING) den <= add_q;
            if (state == OUT_WRITING) begin
                yy <= add_q;
                if (MEAN != 0) dd <= mul_q;
            end
            if (state == ERR) begin
                ee <= add_q;
                if (NORMALISED != 0) rcp <= div_q;
            end
            if (state == GAIN) ee <= mul_q;
            if (state == LMW_READING) begin
                p <= mul_q;
                rr <= rb_rdata;
            end
        end
    end
endmodule
