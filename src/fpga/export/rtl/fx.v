// Fixed-point units: fx_store rounds an exact value into a word, fx_sum does so in steps, fx_mul multiplies,
// fx_div divides.
//
// A word of WIDTH bits with N fraction bits stands for code / 2^N, two's complement. Exact values
// are AW bits wide. RND: 0 cuts off, 1 half up, 2 nearest even. SAT: 1 ends, 0 wraps.
//
// Operands are held for the LATENCY clocks of an operation, of which `first` is up in the first one; the result
// is right in the last. LATENCY 1 is combinational.
`default_nettype none

/* verilator lint_off DECLFILENAME */
// Rounds to a whole number of steps of a word.
module fx_round #(
    parameter AW    = 128,
    parameter FROM  = 0,            // fraction bits of the exact value
    parameter N     = 16,
    parameter RND   = 1
) (
    input  wire signed [AW-1:0] a,
    output wire signed [AW-1:0] q
);
    localparam DOWN = FROM > N ? FROM - N : 0;
    localparam UP   = N > FROM ? N - FROM : 0;
    generate
        if (DOWN == 0) begin : exact
            assign q = a <<< UP;
        end else begin : rounds
            wire signed [AW-1:0] below = a >>> DOWN;
            // The first bit below, and whether anything is below that.
            wire half = a[DOWN-1];
            wire rest = (a & ~({AW{1'b1}} << (DOWN - 1))) != {AW{1'b0}};
            wire up = RND == 0 ? 1'b0 : RND == 1 ? half : half & (rest | below[0]);
            assign q = below + $signed({{(AW-1){1'b0}}, up});
        end
    endgenerate
endmodule

// A whole number of steps into a word.
module fx_limit #(
    parameter AW    = 128,
    parameter WIDTH = 32,
    parameter SAT   = 1
) (
    input  wire signed [AW-1:0]    a,
    output wire signed [WIDTH-1:0] q,
    output wire                    over
);
    wire fits = a[AW-1:WIDTH-1] == {(AW-WIDTH+1){a[WIDTH-1]}};
    assign q = fits || SAT == 0 ? a[WIDTH-1:0] : {a[AW-1], {(WIDTH-1){~a[AW-1]}}};
    assign over = !fits;
endmodule

module fx_store #(
    parameter AW    = 128,
    parameter FROM  = 0,            // fraction bits of the exact value
    parameter WIDTH = 32,
    parameter N     = 16,
    parameter RND   = 1,
    parameter SAT   = 1
) (
    input  wire signed [AW-1:0]    a,
    output wire signed [WIDTH-1:0] q,
    output wire                    over     // beyond the ends of the word
);
    wire signed [AW-1:0] rounded;
    fx_round #(.AW(AW), .FROM(FROM), .N(N), .RND(RND)) round (.a(a), .q(rounded));
    fx_limit #(.AW(AW), .WIDTH(WIDTH), .SAT(SAT)) limit (.a(rounded), .q(q), .over(over));
endmodule

// A register, or a wire.
module fx_cut #(
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

// A sum into a word: LATENCY 2 has a register before the rounding, 3 another one behind it, 4 one before the
// sum; beyond it only waits. SUB: the difference.
module fx_sum #(
    parameter AW      = 128,        // bits of the sum
    parameter BW      = 128,        // bits of either operand
    parameter FROM    = 0,          // fraction bits of both operands
    parameter WIDTH   = 32,
    parameter N       = 16,
    parameter RND     = 1,
    parameter SAT     = 1,
    parameter SUB     = 0,
    parameter LATENCY = 1
) (
    input  wire                    clk,
    input  wire signed [BW-1:0]    a,
    input  wire signed [BW-1:0]    b,
    output wire signed [WIDTH-1:0] q,
    output wire                    over     // beyond the ends of the word
);
    wire signed [BW-1:0] a0, b0;
    wire signed [AW-1:0] exact, rounded, held;
    fx_cut #(.N(2 * BW), .ON(LATENCY > 3)) cut0 (.clk(clk), .d({a, b}), .q({a0, b0}));
    wire signed [AW-1:0] a1 = a0, b1 = b0;
    fx_cut #(.N(AW), .ON(LATENCY > 1)) cut1 (.clk(clk), .d(SUB != 0 ? a1 - b1 : a1 + b1), .q(exact));
    fx_round #(.AW(AW), .FROM(FROM), .N(N), .RND(RND)) round (.a(exact), .q(rounded));
    fx_cut #(.N(AW), .ON(LATENCY > 2)) cut2 (.clk(clk), .d(rounded), .q(held));
    fx_limit #(.AW(AW), .WIDTH(WIDTH), .SAT(SAT)) limit (.a(held), .q(q), .over(over));
endmodule

// q = a * b, exact. LATENCY 2 has a register before the product; n > 2 cuts b into n - 2 pieces and adds a
// product with one of them each clock.
module fx_mul #(
    parameter WA      = 32,
    parameter WB      = 32,
    parameter LATENCY = 1
) (
    input  wire                    clk,
    input  wire                    first,
    input  wire signed [WA-1:0]    a,
    input  wire signed [WB-1:0]    b,
    output wire signed [WA+WB-1:0] q
);
    generate
        if (LATENCY < 3) begin : at_once
            wire signed [WA-1:0] a0;
            wire signed [WB-1:0] b0;
            fx_cut #(.N(WA + WB), .ON(LATENCY > 1)) cut (.clk(clk), .d({a, b}), .q({a0, b0}));
            assign q = a0 * b0;
            /* verilator lint_off UNUSED */
            wire unused = first;
            /* verilator lint_on UNUSED */
        end else begin : serial
            localparam MOST = LATENCY - 2 < WB ? LATENCY - 2 : WB;
            localparam PB = (WB + MOST - 1) / MOST;     // bits of a piece
            localparam K  = (WB + PB - 1) / PB;         // pieces
            localparam SB = WA + PB + 1;                // bits of the upper part of the sum
            localparam F  = SB + (K - 1) * PB;
            localparam CB = $clog2(K + 1);
            /* verilator lint_off WIDTH */
            localparam [CB-1:0] ALL  = K;
            localparam [CB-1:0] LAST = K - 1;
            /* verilator lint_on WIDTH */
            reg         [CB-1:0]    piece;
            reg  signed [WA-1:0]    a0;
            reg  signed [K*PB-1:0]  b0;
            reg  signed [WA+PB:0]   part;
            reg  signed [F-1:0]     sum;
            // All pieces but the last are without a sign.
            wire signed [PB:0]      factor = {(piece == LAST) & b0[PB-1], b0[PB-1:0]};
            wire signed [SB-1:0]    upper = $signed(sum[F-1 -: SB]) + part;
            wire signed [F-1:0]     total;
            if (K > 1) begin : lower
                assign total = {upper, sum[(K-1)*PB-1:0]};
            end else begin : all
                assign total = upper;
            end
            always @(posedge clk)
                if (first) begin
                    piece <= {CB{1'b0}};
                    a0    <= a;
                    b0    <= {{(K*PB-WB){b[WB-1]}}, b};
                    sum   <= {F{1'b0}};
                end else if (piece != ALL) begin
                    piece <= piece + 1'b1;
                    b0    <= b0 >>> PB;
                    part  <= a0 * factor;
                    if (piece != {CB{1'b0}}) sum <= total >>> PB;
                end
            /* verilator lint_off WIDTH */
            assign q = total;
            /* verilator lint_on WIDTH */
        end
    endgenerate
endmodule

// q = a / b into a word, right when done; a and b are held while req is up; done rises LATENCY clocks after req.
// b = 0 gives the end that the sign of a points to. LATENCY 1 to 3 divides at once and waits; n > 3 forms the
// magnitudes, spreads the bits of the quotient over n - 3 clocks, restoring, and rounds in two more; from 5 on
// the first clock takes the operands, and a clock less is left for the quotient.
module fx_div #(
    parameter AW      = 128,        // bits of a
    parameter BW      = AW,         // bits of b
    parameter WIDTH   = 32,
    parameter RND     = 1,
    parameter SAT     = 1,
    parameter LATENCY = 1
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    req,
    input  wire signed [AW-1:0]    a,
    input  wire signed [BW-1:0]    b,
    output wire                    done,
    output wire signed [WIDTH-1:0] q,
    output wire                    over     // beyond the ends of the word, or b = 0
);
    reg [15:0] waited;
    wire start = waited == (LATENCY > 4 ? 16'd1 : 16'd0);
    always @(posedge clk)
        if (rst | ~req | done) waited <= 16'd0;
        else waited <= waited + 16'd1;
    assign done = req & ({16'd0, waited} == LATENCY - 1);

    // The magnitudes; the quotient is negative where their signs differ.
    localparam QB = (AW > WIDTH ? AW : WIDTH) + 1;  // bits of the quotient, a place for its rounding above
    localparam N  = LATENCY > 4 ? LATENCY - 4 : 1;  // clocks of the rows
    localparam ROWS = (AW + N - 1) / N;             // rows a clock
    localparam R  = (AW + ROWS - 1) / ROWS * ROWS;  // rows done, some more than needed
    // Operands may come from a memory, late in their clock.
    wire signed [AW-1:0] a0;
    wire signed [BW-1:0] b0;
    fx_cut #(.N(AW + BW), .ON(LATENCY > 4)) cut0 (.clk(clk), .d({a, b}), .q({a0, b0}));
    wire [AW-1:0] a_size = a0[AW-1] ? -a0 : a0;
    wire [BW-1:0] b_size = b0[BW-1] ? -b0 : b0;
    wire          minus, sign, zero;
    wire [BW-1:0] divisor;
    wire [R-1:0]  quotient;
    wire [BW-1:0] rest;
    generate
        if (LATENCY > 3) begin : serial
            localparam CB = $clog2(N + 1);
            /* verilator lint_off WIDTH */
            localparam [CB-1:0] STEPS = R / ROWS;
            /* verilator lint_on WIDTH */
            reg          minus_held, sign_held, zero_held;
            reg [BW-1:0] divisor_held, rest_held, rem;
            reg [R-1:0]  held, quo;
            reg [CB-1:0] left;
            reg [BW:0]   more, less;
            integer      k;
            // A bit of the quotient is whether the divisor fits; it takes the place of the bit of a that enters.
            always @* begin
                rem  = rest_held;
                quo  = held;
                more = {(BW+1){1'b0}};
                less = {(BW+1){1'b0}};
                for (k = 0; k < ROWS; k = k + 1) begin
                    more = {rem, quo[R-1]};
                    less = more - {1'b0, divisor_held};
                    quo  = {quo[R-2:0], ~less[BW]};
                    rem  = less[BW] ? more[BW-1:0] : less[BW-1:0];
                end
            end
            always @(posedge clk)
                if (start) begin
                    minus_held   <= a0[AW-1] ^ b0[BW-1];
                    sign_held    <= a0[AW-1];
                    zero_held    <= b0 == {BW{1'b0}};
                    divisor_held <= b_size;
                    rest_held    <= {BW{1'b0}};
                    held         <= {{(R-AW){1'b0}}, a_size};
                    left         <= STEPS;
                end else if (left != {CB{1'b0}}) begin
                    rest_held <= rem;
                    held      <= quo;
                    left      <= left - 1'b1;
                end
            assign minus    = minus_held;
            assign sign     = sign_held;
            assign zero     = zero_held;
            assign divisor  = divisor_held;
            assign quotient = held;
            assign rest     = rest_held;
        end else begin : at_once
            localparam XW = AW > BW ? AW : BW;
            wire [XW-1:0] n = {{(XW-AW){1'b0}}, a_size};
            wire [XW-1:0] m = zero ? {{(XW-1){1'b0}}, 1'b1} : {{(XW-BW){1'b0}}, b_size};
            wire [XW-1:0] whole = n / m;
            wire [XW-1:0] left  = n - whole * m;
            assign minus    = a0[AW-1] ^ b0[BW-1];
            assign sign     = a0[AW-1];
            assign zero     = b0 == {BW{1'b0}};
            assign divisor  = b_size;
            assign quotient = {{(R-AW){1'b0}}, whole[AW-1:0]};
            assign rest     = left[BW-1:0];
            /* verilator lint_off UNUSED */
            wire unused = start;
            /* verilator lint_on UNUSED */
        end
    endgenerate

    // The quotient below is wanted: of a negative one with a rest it is a step further down, which is ~ of the
    // quotient of the magnitudes, and the rest is what the divisor has more.
    wire          exact = rest == {BW{1'b0}};
    wire [BW:0]   twice = {rest, 1'b0};
    wire [BW:0]   whole_of = {1'b0, divisor};
    wire          is_half = twice == whole_of;
    wire          is_more = minus ? twice < whole_of : twice > whole_of;
    wire          odd = quotient[0] ^ minus;
    wire          up = RND == 0 ? 1'b0 : RND == 1 ? is_more | is_half : is_more | (is_half & odd);
    wire signed [QB-1:0] size = {{(QB-AW){1'b0}}, quotient[AW-1:0]};
    wire signed [QB-1:0] rounded = (minus ? ~size : size)
                                   + $signed({{(QB-1){1'b0}}, exact ? minus : up});
    wire signed [QB-1:0] held;
    wire signed [WIDTH-1:0] limited;
    wire too_large;
    fx_cut #(.N(QB), .ON(LATENCY > 3)) cut (.clk(clk), .d(rounded), .q(held));
    fx_limit #(.AW(QB), .WIDTH(WIDTH), .SAT(SAT)) limit (
        .a(held), .q(limited), .over(too_large));
    assign q = zero ? {sign, {(WIDTH-1){~sign}}} : limited;
    assign over = zero | too_large;
endmodule
/* verilator lint_on DECLFILENAME */

`default_nettype wire
