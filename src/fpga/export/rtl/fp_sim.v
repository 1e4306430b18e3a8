// Behavioural floating-point units for simulation: fp_add, fp_mul, fp_div.
//
// These three modules are the place for a vendor's or an open unit. What the pipelines need:
//   q = RN(a op b) in the clock in which done rises, LATENCY clocks counted from the rise of req, and
//   on until take; a, b and req are held until then. LATENCY = 1 is combinational. fp_wait.v counts.
//   Units whose clocks vary are waited for as well. fp_units.v has units for synthesis.
// RN = round to nearest, ties to even. W = 64 is IEEE 754 binary64, W = 32 binary32. Every NaN
// leaves as the canonical quiet NaN (sign 0, top fraction bit 1), as vendor units do. FTZ = 1
// replaces subnormal operands and results by a zero of the same sign, as most vendor units do.
//
// binary32 is computed in binary64 and rounded again. For + - * / that double rounding is
// harmless, because 53 >= 2*24 + 2 (Figueroa, SIGNUM Newsletter 30(3), 1995).
`default_nettype none

// What the three units share. One file for all of them, so that it can be exchanged as a whole.
/* verilator lint_off DECLFILENAME */
module fp_unit #(
    parameter W   = 64,
    parameter FTZ = 0,
    parameter OP  = 0               // 0 a+b, 1 a*b, 2 a/b
) (
    input  wire         enable,     // q is +0 without
    input  wire         negate,     // negates b first: a-b
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    output reg  [W-1:0] q
);
    localparam EB = W == 64 ? 11 : 8;           // exponent bits
    localparam FB = W - 1 - EB;                 // fraction bits

    // Both branches of the width tests below have to elaborate; only one is ever used.
    /* verilator lint_off WIDTH */
    /* verilator lint_off SELRANGE */

    function [W-1:0] flush(input [W-1:0] word);
        flush = FTZ != 0 && word[W-2:FB] == {EB{1'b0}} ? {word[W-1], {(W-1){1'b0}}} : word;
    endfunction

    function [W-1:0] canonical(input [W-1:0] word);
        canonical = word[W-2:FB] == {EB{1'b1}} && word[FB-1:0] != {FB{1'b0}}
                  ? {1'b0, {(EB+1){1'b1}}, {(FB-1){1'b0}}} : word;
    endfunction

    // Bits of the equal binary64 number: exact.
    function [63:0] widen(input [31:0] word);
        reg [10:0] e;
        reg [23:0] f;
        begin
            e = word[30:23] + 11'd896;
            f = {1'b0, word[22:0]};
            if (word[30:23] == 8'hff) e = 11'h7ff;
            else if (word[30:0] == 31'd0) e = 11'd0;
            else if (word[30:23] == 8'h00) begin
                e = 11'd897;                    // subnormal: normalise
                while (!f[23]) begin
                    f = f << 1;
                    e = e - 11'd1;
                end
            end
            widen = {word[31], e, f[22:0], 29'd0};
        end
    endfunction

    // Nearest binary32 of a binary64 number, ties to even.
    function [31:0] narrow(input [63:0] word);
        integer      e, shift;
        reg   [53:0] f, kept, rest, half;
        begin
            e = word[62:52] - 896;
            f = {1'b0, word[62:52] != 11'd0, word[51:0]};
            if (word[62:52] == 11'h7ff)
                narrow = {word[63], 8'hff, word[51:0] != 52'd0, 22'd0};
            else begin
                shift = e > 0 ? 29 : 30 - e;    // results below 2^-126 lose more bits
                if (shift > 54) shift = 54;
                if (e < 1) e = 1;
                kept = f >> shift;
                rest = f - (kept << shift);
                half = 54'd1 << (shift - 1);
                if (rest > half || (rest == half && kept[0])) kept = kept + 54'd1;
                // A carry out of the fraction raises the exponent, also from subnormal.
                kept = kept + (e - 1 << 23);
                if (kept >= 54'h7f800000) kept = 54'h7f800000;
                narrow = {word[63], kept[30:0]};
            end
        end
    endfunction

    function real value(input [W-1:0] word);
        value = $bitstoreal(W == 64 ? word : widen(word));
    endfunction

    function [W-1:0] bits(input real number);
        bits = W == 64 ? $realtobits(number) : narrow($realtobits(number));
    endfunction

    generate
        if (W == 64 && FTZ == 0) begin : plain
            // The same without the conversions, which do nothing here: twice as fast.
            reg [63:0] r;
            always @* begin
                r = 64'd0;
                if (enable)
                    case (OP)
                        0: if (negate) r = $realtobits($bitstoreal(a) - $bitstoreal(b));
                           else        r = $realtobits($bitstoreal(a) + $bitstoreal(b));
                        1:             r = $realtobits($bitstoreal(a) * $bitstoreal(b));
                        default:       r = $realtobits($bitstoreal(a) / $bitstoreal(b));
                    endcase
                if (&r[62:52] && |r[51:0]) r = 64'h7ff8000000000000;
                q = r;
            end
        end else begin : converted
            reg [W-1:0] fa, fb;
            always @* begin
                fa = flush(a);
                fb = flush({b[W-1] ^ negate, b[W-2:0]});
                q  = {W{1'b0}};
                if (enable)
                    case (OP)
                        0:       q = flush(canonical(bits(value(fa) + value(fb))));
                        1:       q = flush(canonical(bits(value(fa) * value(fb))));
                        default: q = flush(canonical(bits(value(fa) / value(fb))));
                    endcase
            end
        end
    endgenerate

    /* verilator lint_on SELRANGE */
    /* verilator lint_on WIDTH */

`ifdef WAVE
    real a_real, b_real, q_real;
    always @* a_real = value(a);
    always @* b_real = value(b);
    always @* q_real = value(q);
`endif
endmodule

// q = a + b, or a - b if sub.
module fp_add #(
    parameter W       = 64,
    parameter FTZ     = 0,
    parameter LATENCY = 1
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         req,
    input  wire         take,
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    input  wire         sub,
    output wire         done,
    output wire [W-1:0] q
);
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(), .done(done));

    fp_unit #(.W(W), .FTZ(FTZ), .OP(0)) unit (
        .enable(done), .negate(sub), .a(a), .b(b), .q(q));
`ifdef WAVE
    /* verilator lint_off UNUSED */
    real a_real, b_real, q_real;
    /* verilator lint_on UNUSED */
    always @(unit.a_real) a_real = unit.a_real;
    always @(unit.b_real) b_real = unit.b_real;
    always @(unit.q_real) q_real = unit.q_real;
`endif
endmodule

// q = a * b.
module fp_mul #(
    parameter W       = 64,
    parameter FTZ     = 0,
    parameter LATENCY = 1
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         req,
    input  wire         take,
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    output wire         done,
    output wire [W-1:0] q
);
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(), .done(done));

    fp_unit #(.W(W), .FTZ(FTZ), .OP(1)) unit (
        .enable(done), .negate(1'b0), .a(a), .b(b), .q(q));
`ifdef WAVE
    /* verilator lint_off UNUSED */
    real a_real, b_real, q_real;
    /* verilator lint_on UNUSED */
    always @(unit.a_real) a_real = unit.a_real;
    always @(unit.b_real) b_real = unit.b_real;
    always @(unit.q_real) q_real = unit.q_real;
`endif
endmodule

// q = a / b.
module fp_div #(
    parameter W       = 64,
    parameter FTZ     = 0,
    parameter LATENCY = 1
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         req,
    input  wire         take,
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    output wire         done,
    output wire [W-1:0] q
);
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(), .done(done));

    fp_unit #(.W(W), .FTZ(FTZ), .OP(2)) unit (
        .enable(done), .negate(1'b0), .a(a), .b(b), .q(q));
`ifdef WAVE
    /* verilator lint_off UNUSED */
    real a_real, b_real, q_real;
    /* verilator lint_on UNUSED */
    always @(unit.a_real) a_real = unit.a_real;
    always @(unit.b_real) b_real = unit.b_real;
    always @(unit.q_real) q_real = unit.q_real;
`endif
endmodule

`default_nettype wire
