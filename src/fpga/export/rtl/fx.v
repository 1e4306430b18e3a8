// Fixed-point units: fx_store rounds an exact value into a word, fx_div divides.
//
// A word of WIDTH bits with N fraction bits stands for code / 2^N, two's complement. Exact values
// are AW bits wide. RND: 0 cuts off, 1 half up, 2 nearest even. SAT: 1 ends, 0 wraps.
`default_nettype none

/* verilator lint_off DECLFILENAME */
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
    localparam DOWN = FROM > N ? FROM - N : 0;
    localparam UP   = N > FROM ? N - FROM : 0;
    wire signed [AW-1:0] below, rounded;
    generate
        if (DOWN == 0) begin : exact
            assign below   = a <<< UP;
            assign rounded = below;
        end else begin : rounds
            wire [AW-1:0] rest = a - (below <<< DOWN);
            wire [AW-1:0] half = {{(AW-1){1'b0}}, 1'b1} << (DOWN - 1);
            wire up = RND == 0 ? 1'b0 : RND == 1 ? rest >= half
                    : rest > half || (rest == half && below[0]);
            assign below   = a >>> DOWN;
            assign rounded = below + $signed({{(AW-1){1'b0}}, up});
        end
    endgenerate
    fx_limit #(.AW(AW), .WIDTH(WIDTH), .SAT(SAT)) limit (.a(rounded), .q(q), .over(over));
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

// q = a / b into a word, right when done; a and b are held while req is up; done rises LATENCY
// clocks after req, 1 = combinational. b = 0 gives the end that the sign of a points to.
module fx_div #(
    parameter AW      = 128,
    parameter WIDTH   = 32,
    parameter RND     = 1,
    parameter SAT     = 1,
    parameter LATENCY = 1
) (
    input  wire                    clk,
    input  wire                    rst,
    input  wire                    req,
    input  wire signed [AW-1:0]    a,
    input  wire signed [AW-1:0]    b,
    output wire                    done,
    output wire signed [WIDTH-1:0] q,
    output wire                    over     // beyond the ends of the word, or b = 0
);
    reg [15:0] waited;
    always @(posedge clk)
        if (rst | ~req | done) waited <= 16'd0;
        else waited <= waited + 16'd1;
    assign done = req & ({16'd0, waited} == LATENCY - 1);

    wire                 zero = b == {AW{1'b0}};
    wire signed [AW-1:0] one  = {{(AW-1){1'b0}}, 1'b1};
    wire signed [AW-1:0] n    = b[AW-1] ? -a : a;
    wire signed [AW-1:0] m    = zero ? one : b[AW-1] ? -b : b;
    // Verilog divides towards zero; the quotient below is wanted.
    wire signed [AW-1:0] towards = n / m;
    wire signed [AW-1:0] left    = n - towards * m;
    wire                 negative = left[AW-1];
    wire signed [AW-1:0] below   = negative ? towards - one : towards;
    wire signed [AW-1:0] rest    = negative ? left + m : left;
    wire signed [AW-1:0] twice   = rest <<< 1;
    wire up = RND == 0 ? 1'b0 : RND == 1 ? twice >= m : twice > m || (twice == m && below[0]);
    wire signed [AW-1:0] rounded = below + $signed({{(AW-1){1'b0}}, up});
    wire signed [WIDTH-1:0] limited;
    wire too_large;
    fx_limit #(.AW(AW), .WIDTH(WIDTH), .SAT(SAT)) limit (
        .a(rounded), .q(limited), .over(too_large));
    assign q = zero ? {a[AW-1], {(WIDTH-1){~a[AW-1]}}} : limited;
    assign over = zero | too_large;
endmodule
/* verilator lint_on DECLFILENAME */

`default_nettype wire
