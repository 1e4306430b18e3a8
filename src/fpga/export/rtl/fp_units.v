// Synthesizable floating-point units: fp_add, fp_mul, fp_div. They take the place of fp_sim.v.
//
//   req   ---->|         |----> done   q is right: LATENCY clocks counted from the rise of req, the
//   a, b  ---->|  unit   |              first included; stays up until take
//   take  ---->|         |----> q
//
// a, b and req are held until take, which ends an operation in a clock with done; req may stay up,
// and the next clock then begins another one.
//
// q = RN(a op b), to nearest, ties to even. W = 64 is IEEE 754 binary64, W = 32 binary32. Every NaN
// leaves as the canonical quiet NaN. FTZ = 1 replaces subnormal operands and results by a zero of the
// same sign; a result is judged after rounding. FTZ = 0 keeps them.
//
// LATENCY of fp_add and fp_mul: 1 is combinational; from 2 on registers cut the path, as many less one;
// beyond 6 (fp_add) and 8 (fp_mul) a unit only waits. LATENCY of fp_div: 1 and 2 do all rows of the division in
// a clock, 3 to 5 spread them over as many clocks less two, n > 5 over n - 3 and round in two: 4 rows of
// binary64 each with 17, one with 58.
//
// Plain Verilog-2005 without vendor primitives; the product is one of LIMB x LIMB bit products, which
// synthesis places into multiplier blocks.
`default_nettype none

// A register, or a wire.
/* verilator lint_off DECLFILENAME */
module fp_cut #(
    parameter N  = 1,
    parameter ON = 0
) (
    input  wire         clk,
    input  wire [N-1:0] d,
    output wire [N-1:0] q
);
    generate
        if (ON != 0) begin : cut
            reg [N-1:0] held;
            always @(posedge clk) held <= d;
            assign q = held;
        end else begin : through
            assign q = d;
            /* verilator lint_off UNUSED */
            wire unused = clk;
            /* verilator lint_on UNUSED */
        end
    endgenerate
endmodule

// A word taken apart, its significand shifted until the leading one is at the top.
module fp_open #(
    parameter W   = 64,
    parameter FTZ = 0,
    parameter CUT = 0,                      // 1: a register between the larger shifts and the smaller ones
    parameter EB  = W == 64 ? 11 : 8,       // exponent bits (derived)
    parameter FB  = W - 1 - EB              // fraction bits (derived)
) (
    input  wire          clk,
    input  wire [W-1:0]  word,
    output wire          is_zero,
    output wire          is_inf,
    output wire          is_nan,
    output wire [EB+1:0] exponent,          // biased, two's complement: below 1 if subnormal
    output wire [FB:0]   significand        // top bit set unless zero
);
    localparam N = FB + 1;
    wire [EB-1:0] e = word[W-2:FB];
    wire [FB-1:0] f = word[FB-1:0];
    wire low  = e == {EB{1'b0}};
    wire high = e == {EB{1'b1}};
    wire none = f == {FB{1'b0}};
    fp_cut #(.N(3), .ON(CUT)) kinds (.clk(clk), .d({low & (FTZ != 0 | none), high & none, high & ~none}),
        .q({is_zero, is_inf, is_nan}));

    generate
        if (FTZ != 0) begin : flushed
            fp_cut #(.N(EB + 2 + N), .ON(CUT)) cut (.clk(clk),
                .d({2'b00, e, ~low, low ? {FB{1'b0}} : f}), .q({exponent, significand}));
        end else begin : kept
            reg  [N-1:0]  s, t;
            reg  [5:0]    shift, all;
            wire [N-1:0]  c_s;
            wire [5:0]    c_shift;
            wire [EB-1:0] c_e;
            integer       k;
            always @* begin
                s     = {~low, f};
                shift = 6'd0;
                for (k = 5; k >= 3; k = k - 1)
                    if ((1 << k) < N && s >> (N - (1 << k)) == {N{1'b0}}) begin
                        s        = s << (1 << k);
                        shift[k] = 1'b1;
                    end
            end
            fp_cut #(.N(EB + 6 + N), .ON(CUT)) cut (.clk(clk),
                .d({e | {{(EB-1){1'b0}}, low}, shift, s}), .q({c_e, c_shift, c_s}));
            integer       j;
            always @* begin
                t   = c_s;
                all = c_shift;
                for (j = 2; j >= 0; j = j - 1)
                    if (t >> (N - (1 << j)) == {N{1'b0}}) begin
                        t      = t << (1 << j);
                        all[j] = 1'b1;
                    end
            end
            assign significand = t;
            assign exponent    = {2'b00, c_e} - {{(EB-4){1'b0}}, all};
        end
    endgenerate
endmodule

// Rounds and packs a normalised number of any exponent: below the smallest normal one it loses bits.
module fp_close #(
    parameter W   = 64,
    parameter FTZ = 0,
    parameter CUT = 0,                      // 1: a register between shift and rounding
    parameter EB  = W == 64 ? 11 : 8,       // exponent bits (derived)
    parameter FB  = W - 1 - EB              // fraction bits (derived)
) (
    input  wire          clk,
    input  wire          sign,
    input  wire          is_zero,
    input  wire          is_inf,
    input  wire          is_nan,
    input  wire [EB+2:0] exponent,          // biased, two's complement
    input  wire [FB+1:0] significand,       // top bit set, one bit to round by at the end
    input  wire          sticky,            // anything below
    output wire [W-1:0]  q
);
    localparam N = FB + 2;
    /* verilator lint_off WIDTH */
    localparam [EB+2:0] ONE  = 1;
    localparam [EB+2:0] MOST = N + 1;
    localparam [EB+2:0] HIGH = (1 << EB) - 1;
    /* verilator lint_on WIDTH */
    wire          is_low = exponent[EB+2] | exponent == {(EB+3){1'b0}};
    wire [EB+2:0] below = ONE - exponent;
    reg  [5:0]    shift;
    reg  [N-1:0]  s, lost;
    reg           rest;
    integer       k;
    always @* begin
        shift = !is_low ? 6'd0 : below > MOST ? MOST[5:0] : below[5:0];
        s     = significand;
        rest  = sticky;
        lost  = {N{1'b0}};
        for (k = 5; k >= 0; k = k - 1)
            if (shift[k]) begin
                lost = (1 << k) < N ? s << (N - (1 << k)) : s;
                rest = rest | lost != {N{1'b0}};
                s    = s >> (1 << k);
            end
    end
    // At and above HIGH the number is infinite whatever its bits.
    wire          over  = ~exponent[EB+2] & exponent >= HIGH;
    wire [EB-1:0] based = is_low ? {EB{1'b0}} : exponent[EB-1:0] - 1'b1;

    wire          c_sign, c_zero, c_inf, c_nan, c_rest;
    wire [EB-1:0] c_based;
    wire [N-1:0]  c_s;
    fp_cut #(.N(5 + EB + N), .ON(CUT)) cut (.clk(clk),
        .d({sign, is_zero, is_inf | (over & ~is_zero), is_nan, rest, based, s}),
        .q({c_sign, c_zero, c_inf, c_nan, c_rest, c_based, c_s}));

    // A carry out of the fraction raises the exponent, also from subnormal and to infinity.
    wire         up     = c_s[0] & (c_rest | c_s[1]);
    wire [W-2:0] whole = {c_based, {FB{1'b0}}} + {{(W-2-FB){1'b0}}, c_s[N-1:1]}
                         + {{(W-2){1'b0}}, up};
    wire         none   = c_zero | (FTZ != 0 & whole[W-2:FB] == {EB{1'b0}});
    assign q = c_nan  ? {1'b0, {(EB+1){1'b1}}, {(FB-1){1'b0}}}
             : c_inf  ? {c_sign, {EB{1'b1}}, {FB{1'b0}}}
             : none   ? {c_sign, {(W-1){1'b0}}}
             : {c_sign, whole};
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
    localparam EB = W == 64 ? 11 : 8;
    localparam FB = W - 1 - EB;
    localparam N  = FB + 4;                 // significand, and three bits below it
    localparam ON1 = LATENCY > 4;
    localparam ON2 = LATENCY > 2;
    localparam ON3 = LATENCY == 2 || LATENCY > 3;
    localparam ON4 = LATENCY > 2;
    localparam ON5 = LATENCY > 5;

    /* verilator lint_off UNUSED */
    wire first;
    /* verilator lint_on UNUSED */
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(first), .done(done));

    // 1: flushed and ordered by magnitude, which is the order of the bits.
    wire         a_low = a[W-2:FB] == {EB{1'b0}};
    wire         b_low = b[W-2:FB] == {EB{1'b0}};
    wire [W-2:0] ma    = FTZ != 0 && a_low ? {(W-1){1'b0}} : a[W-2:0];
    wire [W-2:0] mb    = FTZ != 0 && b_low ? {(W-1){1'b0}} : b[W-2:0];
    wire         sb    = b[W-1] ^ sub;
    wire         swap  = mb > ma;
    wire         s1_minus, s1_sign;
    wire [W-2:0] s1_x, s1_y;
    fp_cut #(.N(2 * W), .ON(ON1)) cut1 (.clk(clk),
        .d({a[W-1] ^ sb, swap ? sb : a[W-1], swap ? mb : ma, swap ? ma : mb}),
        .q({s1_minus, s1_sign, s1_x, s1_y}));

    // 2: the smaller one shifted to the exponent of the larger one.
    wire          x_low  = s1_x[W-2:FB] == {EB{1'b0}};
    wire          y_low  = s1_y[W-2:FB] == {EB{1'b0}};
    wire          x_high = s1_x[W-2:FB] == {EB{1'b1}};
    wire          y_high = s1_y[W-2:FB] == {EB{1'b1}};
    wire          x_nan  = x_high & s1_x[FB-1:0] != {FB{1'b0}};
    wire [EB-1:0] ex     = s1_x[W-2:FB] | {{(EB-1){1'b0}}, x_low};
    wire [EB-1:0] ey     = s1_y[W-2:FB] | {{(EB-1){1'b0}}, y_low};
    wire [EB-1:0] apart  = ex - ey;
    reg  [5:0]    shift;
    reg  [N-1:0]  y, lost;
    reg           rest;
    integer       k;
    always @* begin
        shift = apart > 63 ? 6'd63 : apart[5:0];
        y     = {~y_low, s1_y[FB-1:0], 3'd0};
        rest  = 1'b0;
        lost  = {N{1'b0}};
        for (k = 5; k >= 0; k = k - 1)
            if (shift[k]) begin
                lost = (1 << k) < N ? y << (N - (1 << k)) : y;
                rest = rest | lost != {N{1'b0}};
                y    = y >> (1 << k);
            end
    end
    // Infinity minus infinity; a NaN is the larger one.
    wire          nan2 = x_nan | (x_high & y_high & s1_minus);
    wire          s2_minus, s2_sign, s2_nan, s2_inf;
    wire [EB-1:0] s2_e;
    wire [N-1:0]  s2_x, s2_y;
    fp_cut #(.N(4 + EB + 2 * N), .ON(ON2)) cut2 (.clk(clk),
        .d({s1_minus, s1_sign, nan2, x_high, ex,
            {~x_low, s1_x[FB-1:0], 3'd0}, {y[N-1:1], y[0] | rest}}),
        .q({s2_minus, s2_sign, s2_nan, s2_inf, s2_e, s2_x, s2_y}));

    // 3: sum or difference, never negative.
    wire [N:0]    sum = s2_minus ? {1'b0, s2_x} - {1'b0, s2_y} : {1'b0, s2_x} + {1'b0, s2_y};
    wire          s3_minus, s3_sign, s3_nan, s3_inf;
    wire [EB-1:0] s3_e;
    wire [N:0]    s3_s;
    fp_cut #(.N(5 + EB + N), .ON(ON3)) cut3 (.clk(clk),
        .d({s2_minus, s2_sign, s2_nan, s2_inf, s2_e, sum}),
        .q({s3_minus, s3_sign, s3_nan, s3_inf, s3_e, s3_s}));

    // 4: shifted up until the leading one is at the top, or the exponent is the smallest; larger shifts first.
    reg  [N:0]    w;
    reg  [EB:0]   f;
    integer       i;
    always @* begin
        w = s3_s;
        // The carry's place is the top one, an exponent higher.
        f = {1'b0, s3_e};
        for (i = 5; i >= 3; i = i - 1)
            if ((1 << i) < N + 1 && f >> i != {(EB+1){1'b0}} && w >> (N + 1 - (1 << i)) == {(N+1){1'b0}})
            begin
                w = w << (1 << i);
                f = f - (1 << i);
            end
    end
    wire          h_minus, h_sign, h_nan, h_inf, zero4;
    wire [EB:0]   h_e;
    wire [N:0]    h_s;
    fp_cut #(.N(7 + EB + N), .ON(ON5)) half (.clk(clk),
        .d({s3_minus, s3_sign, s3_nan, s3_inf, s3_s == {(N+1){1'b0}}, f, w}),
        .q({h_minus, h_sign, h_nan, h_inf, zero4, h_e, h_s}));
    reg  [N:0]    s;
    reg  [EB:0]   e;
    integer       j;
    always @* begin
        s = h_s;
        e = h_e;
        for (j = 2; j >= 0; j = j - 1)
            if (e >> j != {(EB+1){1'b0}} && s >> (N + 1 - (1 << j)) == {(N+1){1'b0}}) begin
                s = s << (1 << j);
                e = e - (1 << j);
            end
    end
    // Zero has the sign of both, or none; +0 from a difference.
    wire          s4_sign, s4_nan, s4_inf;
    wire [EB:0]   s4_e;
    wire [N:0]    s4_s;
    fp_cut #(.N(5 + EB + N), .ON(ON4)) cut4 (.clk(clk),
        .d({h_sign & ~(zero4 & h_minus), h_nan, h_inf, zero4 ? {(EB+1){1'b0}} : e, s}),
        .q({s4_sign, s4_nan, s4_inf, s4_e, s4_s}));

    // 5: rounded; e counts from 0 for numbers below the smallest normal one.
    wire          up     = s4_s[3] & (s4_s[2:0] != 3'd0 | s4_s[4]);
    wire [W-1:0]  whole = {s4_e[EB:0], {FB{1'b0}}} + {{(EB){1'b0}}, s4_s[N:4]}
                         + {{(W-1){1'b0}}, up};
    wire          over   = s4_inf | whole[W-1] | whole[W-2:FB] == {EB{1'b1}};
    wire          none   = FTZ != 0 & whole[W-2:FB] == {EB{1'b0}};
    assign q = s4_nan ? {1'b0, {(EB+1){1'b1}}, {(FB-1){1'b0}}}
             : over   ? {s4_sign, {EB{1'b1}}, {FB{1'b0}}}
             : none   ? {s4_sign, {(W-1){1'b0}}}
             : {s4_sign, whole[W-2:0]};
endmodule

// q = a * b.
module fp_mul #(
    parameter W       = 64,
    parameter FTZ     = 0,
    parameter LATENCY = 1,
    parameter LIMB    = 18                  // bits of a factor of a multiplier block
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
    localparam EB = W == 64 ? 11 : 8;
    localparam FB = W - 1 - EB;
    localparam L  = (FB + LIMB) / LIMB;     // limbs of a significand
    localparam N  = 2 * L * LIMB;           // bits of their product
    localparam ON0 = LATENCY > 5;
    localparam ON1 = LATENCY > 2;
    localparam ON2 = LATENCY == 2 || LATENCY > 3;
    localparam ON3 = LATENCY > 2;
    localparam ON4 = LATENCY > 4;
    localparam ON5 = LATENCY > 6;
    localparam ON6 = LATENCY > 7;
    /* verilator lint_off WIDTH */
    localparam [EB+2:0] BIAS = (1 << (EB - 1)) - 1;
    /* verilator lint_on WIDTH */

    /* verilator lint_off UNUSED */
    wire first;
    /* verilator lint_on UNUSED */
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(first), .done(done));

    // 1: taken apart. Operands may come from a memory, late in their clock.
    wire [W-1:0]  s0_a, s0_b;
    fp_cut #(.N(2 * W), .ON(ON0)) cut0 (.clk(clk), .d({a, b}), .q({s0_a, s0_b}));
    wire          a_zero, a_inf, a_nan, b_zero, b_inf, b_nan;
    wire [EB+1:0] ea, eb;
    wire [FB:0]   fa, fb;
    fp_open #(.W(W), .FTZ(FTZ), .CUT(ON5)) open_a (.clk(clk), .word(s0_a), .is_zero(a_zero), .is_inf(a_inf), .is_nan(a_nan),
        .exponent(ea), .significand(fa));
    fp_open #(.W(W), .FTZ(FTZ), .CUT(ON5)) open_b (.clk(clk), .word(s0_b), .is_zero(b_zero), .is_inf(b_inf), .is_nan(b_nan),
        .exponent(eb), .significand(fb));
    wire nan1 = a_nan | b_nan | (a_inf & b_zero) | (b_inf & a_zero);
    wire sign1;
    fp_cut #(.N(1), .ON(ON5)) signs (.clk(clk), .d(s0_a[W-1] ^ s0_b[W-1]), .q(sign1));
    wire          s1_sign, s1_zero, s1_inf, s1_nan;
    wire [EB+1:0] s1_ea, s1_eb;
    wire [FB:0]   s1_fa, s1_fb;
    fp_cut #(.N(2 * EB + 2 * FB + 10), .ON(ON1)) cut1 (.clk(clk),
        .d({sign1, a_zero | b_zero, a_inf | b_inf, nan1, ea, eb, fa, fb}),
        .q({s1_sign, s1_zero, s1_inf, s1_nan, s1_ea, s1_eb, s1_fa, s1_fb}));

    // 2: products of limbs, and the exponent as if the product were in [2, 4).
    wire [L*LIMB-1:0] xa = {{(L*LIMB-FB-1){1'b0}}, s1_fa};
    wire [L*LIMB-1:0] xb = {{(L*LIMB-FB-1){1'b0}}, s1_fb};
    wire [2*LIMB*L*L-1:0] parts, s2_parts;
    genvar i, j;
    generate
        for (i = 0; i < L; i = i + 1) begin : row
            for (j = 0; j < L; j = j + 1) begin : column
                wire [LIMB-1:0] u = xa[i*LIMB +: LIMB];
                wire [LIMB-1:0] v = xb[j*LIMB +: LIMB];
                assign parts[2*LIMB*(i*L+j) +: 2*LIMB] = u * v;
            end
        end
    endgenerate
    wire [EB+2:0] e2 = {s1_ea[EB+1], s1_ea} + {s1_eb[EB+1], s1_eb} - BIAS + 1'b1;
    wire          s2_sign, s2_zero, s2_inf, s2_nan;
    wire [EB+2:0] s2_e;
    fp_cut #(.N(EB + 7 + 2 * LIMB * L * L), .ON(ON2)) cut2 (.clk(clk),
        .d({s1_sign, s1_zero, s1_inf, s1_nan, e2, parts}),
        .q({s2_sign, s2_zero, s2_inf, s2_nan, s2_e, s2_parts}));

    // 3: their sum, that of each row first.
    localparam RW = (L + 1) * LIMB;         // bits of the sum of a row
    wire [RW*L-1:0] rows, h_rows;
    reg  [RW-1:0]   of_row;
    reg  [RW*L-1:0] all_rows;
    integer         m, n;
    always @* begin
        all_rows = {(RW*L){1'b0}};
        of_row   = {RW{1'b0}};
        for (m = 0; m < L; m = m + 1) begin
            of_row = {RW{1'b0}};
            for (n = 0; n < L; n = n + 1)
                of_row = of_row + ({{(RW-2*LIMB){1'b0}}, s2_parts[2*LIMB*(m*L+n) +: 2*LIMB]} << (LIMB * n));
            all_rows[RW*m +: RW] = of_row;
        end
    end
    assign rows = all_rows;
    wire          h_sign, h_zero, h_inf, h_nan;
    wire [EB+2:0] h_e;
    fp_cut #(.N(EB + 7 + RW * L), .ON(ON6)) half (.clk(clk),
        .d({s2_sign, s2_zero, s2_inf, s2_nan, s2_e, rows}),
        .q({h_sign, h_zero, h_inf, h_nan, h_e, h_rows}));
    reg [N-1:0] total;
    integer     k;
    always @* begin
        total = {N{1'b0}};
        for (k = 0; k < L; k = k + 1)
            total = total + ({{(N-RW){1'b0}}, h_rows[RW*k +: RW]} << (LIMB * k));
    end
    wire          s3_sign, s3_zero, s3_inf, s3_nan;
    wire [EB+2:0] s3_e;
    wire [2*FB+1:0] s3_t;
    fp_cut #(.N(EB + 7 + 2 * FB + 2), .ON(ON3)) cut3 (.clk(clk),
        .d({h_sign, h_zero, h_inf, h_nan, h_e, total[2*FB+1:0]}),
        .q({s3_sign, s3_zero, s3_inf, s3_nan, s3_e, s3_t}));

    // 4 and 5: normalised by one place at most, rounded.
    wire            top = s3_t[2*FB+1];
    wire [2*FB+1:0] t   = top ? s3_t : s3_t << 1;
    fp_close #(.W(W), .FTZ(FTZ), .CUT(ON4)) close (
        .clk(clk), .sign(s3_sign), .is_zero(s3_zero), .is_inf(s3_inf), .is_nan(s3_nan),
        .exponent(top ? s3_e : s3_e - 1'b1), .significand(t[2*FB+1:FB]),
        .sticky(t[FB-1:0] != {FB{1'b0}}), .q(q));
endmodule

// q = a / b: one bit of the quotient a row, restoring.
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
    localparam EB = W == 64 ? 11 : 8;
    localparam FB = W - 1 - EB;
    localparam QB   = FB + 3;               // bits of the quotient
    localparam CUT  = LATENCY > 5;          // a register within the rounding
    localparam N    = LATENCY > 3 ? LATENCY - 2 - CUT : 1;  // clocks of the rows
    localparam ROWS = (QB + N - 1) / N;     // rows a clock
    localparam R    = (QB + ROWS - 1) / ROWS * ROWS;    // rows done, some more than needed
    /* verilator lint_off WIDTH */
    localparam [EB+2:0] BIAS = (1 << (EB - 1)) - 1;
    /* verilator lint_on WIDTH */

    wire first;
    fp_wait #(.LATENCY(LATENCY)) count (
        .clk(clk), .rst(rst), .req(req), .take(take), .first(first), .done(done));

    wire          a_zero, a_inf, a_nan, b_zero, b_inf, b_nan;
    wire [EB+1:0] ea, eb;
    wire [FB:0]   fa, fb;
    fp_open #(.W(W), .FTZ(FTZ)) open_a (.clk(clk), .word(a), .is_zero(a_zero), .is_inf(a_inf), .is_nan(a_nan),
        .exponent(ea), .significand(fa));
    fp_open #(.W(W), .FTZ(FTZ)) open_b (.clk(clk), .word(b), .is_zero(b_zero), .is_inf(b_inf), .is_nan(b_nan),
        .exponent(eb), .significand(fb));

    // What is known at once, held from the first clock on where there are more.
    wire nan1  = a_nan | b_nan | (a_inf & b_inf) | (a_zero & b_zero);
    wire zero1 = a_zero | b_inf;
    wire inf1  = a_inf | b_zero;
    wire [EB+2:0] e1 = {ea[EB+1], ea} - {eb[EB+1], eb} + BIAS;
    wire          s_sign, s_zero, s_inf, s_nan;
    wire [EB+2:0] s_e;
    wire [FB:0]   s_fb;
    fp_cut #(.N(EB + 7 + FB + 1), .ON(LATENCY > 1)) cut (.clk(clk),
        .d({a[W-1] ^ b[W-1], zero1, inf1, nan1, e1, fb}),
        .q({s_sign, s_zero, s_inf, s_nan, s_e, s_fb}));

    // Rows: a bit of the quotient is whether the divisor still fits.
    wire [FB+1:0] rem_in, rem_out;
    wire [R-1:0]  quo_in, quo_out;
    wire [FB:0]   divisor;
    reg  [FB+1:0] rem;
    reg  [R-1:0]  quo;
    reg  [FB+2:0] less;
    integer       k;
    always @* begin
        rem  = rem_in;
        quo  = quo_in;
        less = {(FB+3){1'b0}};
        for (k = 0; k < (LATENCY > 2 ? ROWS : R); k = k + 1) begin
            less = {1'b0, rem} - {2'b00, divisor};
            quo  = {quo[R-2:0], ~less[FB+2]};
            rem  = less[FB+2] ? rem << 1 : less[FB+1:0] << 1;
        end
    end
    assign rem_out = rem;
    assign quo_out = quo;

    wire [FB+1:0] end_rem;
    wire [R-1:0]  end_quo;
    generate
        if (LATENCY > 2) begin : serial
            localparam CB = $clog2(N + 1);
            /* verilator lint_off WIDTH */
            localparam [CB-1:0] STEPS = R / ROWS;
            /* verilator lint_on WIDTH */
            reg [FB+1:0] rem_held;
            reg [R-1:0]  quo_held;
            reg [CB-1:0] left;
            always @(posedge clk)
                if (first) begin
                    rem_held <= {1'b0, fa};
                    quo_held <= {R{1'b0}};
                    left     <= STEPS;
                end else if (left != {CB{1'b0}}) begin
                    rem_held <= rem_out;
                    quo_held <= quo_out;
                    left     <= left - 1'b1;
                end
            assign rem_in  = rem_held;
            assign quo_in  = quo_held;
            assign divisor = s_fb;
            assign end_rem = rem_held;
            assign end_quo = quo_held;
        end else begin : at_once
            assign rem_in  = {1'b0, fa};
            assign quo_in  = {R{1'b0}};
            assign divisor = fb;
            fp_cut #(.N(FB + 2 + R), .ON(LATENCY > 1)) held (.clk(clk),
                .d({rem_out, quo_out}), .q({end_rem, end_quo}));
            /* verilator lint_off UNUSED */
            wire unused = first | ^s_fb;
            /* verilator lint_on UNUSED */
        end
    endgenerate

    // The quotient is in (1/2, 2): its first bit may be 0.
    wire         top = end_quo[R-1];
    wire [R-1:0] t   = top ? end_quo : end_quo << 1;
    fp_close #(.W(W), .FTZ(FTZ), .CUT(CUT)) close (
        .clk(clk), .sign(s_sign), .is_zero(s_zero), .is_inf(s_inf), .is_nan(s_nan),
        .exponent(top ? s_e : s_e - 1'b1), .significand(t[R-1 -: FB+2]),
        .sticky(t[R-FB-3:0] != {(R-FB-2){1'b0}} | end_rem != {(FB+2){1'b0}}), .q(q));
endmodule
/* verilator lint_on DECLFILENAME */

`default_nettype wire
