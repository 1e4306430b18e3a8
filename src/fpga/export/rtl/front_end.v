// Front end of a filter core: from the gyro's samples to the pairs that the core takes.
//
//   sample ---->|           |---> x   the word LAG samples ago
//   valid ----->| front_end |---> d   the newest word, or with MEAN that of the two newest
//   ready <-----|           |---> pair_valid, held until pair_ready
//
// CODE = 1: sample is a two's complement integer of 32 bits. Its word is RN((code * LSB) * FACTOR),
// in binary64: two products, each rounded; a single one with LSB * FACTOR has other bits. For W = 32
// that is rounded once more. CODE = 0: sample is the word itself.
//
// Clocks from taking a sample to pair_valid: 1, with codes 2 products more, with MEAN a sum and a
// product more. A sample is taken in the clock in which the core takes the pair, so that the front end
// works while the core does.
// Reset is synchronous. Synthesizable, given fp_add and fp_mul.
`default_nettype none

module front_end #(
    parameter        W      = 64,           // bits of a word: 64 or 32
    parameter        CODE   = 1,            // 1: samples are integer codes
    parameter [63:0] LSB    = 64'h3ff0000000000000,     // binary64: value of one code
    parameter [63:0] FACTOR = 64'h3ff0000000000000,     // binary64: words per unit of LSB
    parameter        LAG    = 1,            // samples by which x is older than the newest, 0 to 64
    parameter        MEAN   = 0,            // 1: d is the mean of the two newest
    parameter        FTZ    = 0,            // 1: units flush subnormals
    parameter        ADD_LATENCY = 1,       // clocks of a sum
    parameter        MUL_LATENCY = 1,       // clocks of a product
    parameter        SB     = CODE != 0 ? 32 : W        // bits of a sample (derived)
) (
    input  wire          clk,
    input  wire          rst,
    input  wire          valid,     // hold sample and valid until ready
    output wire          ready,
    input  wire [SB-1:0] sample,
    output wire          pair_valid,
    input  wire          pair_ready,
    output wire [W-1:0]  x,
    output wire [W-1:0]  d
);
    localparam [2:0] WAITING = 3'd0, SCALING = 3'd1, CONVERTING = 3'd2, ADDING = 3'd3,
                     HALVING = 3'd4, OFFERING = 3'd5;
    localparam [2:0] AFTER_WORD = MEAN != 0 ? ADDING : OFFERING;
    localparam DEPTH = LAG > 1 ? LAG : 1;

    reg  [2:0]         state;
    reg  [SB-1:0]      taken;       // the sample as it came
    /* verilator lint_off UNUSED */
    reg  [W*DEPTH-1:0] held;        // older words, newest in the lowest bits
    /* verilator lint_on UNUSED */
    wire [W-1:0]       word;        // its word
    wire [W-1:0]       mean;

    // What a state asks its unit for is done.
    wire scaled_done, sum_done, half_done;
    wire handed = pair_valid & pair_ready;
    wire take   = valid & ready;
    assign ready      = (state == WAITING) | handed;
    assign pair_valid = state == OFFERING;

    always @(posedge clk)
        if (rst) state <= WAITING;
        else if (take) state <= CODE != 0 ? SCALING : AFTER_WORD;
        else
            case (state)
                SCALING:    if (scaled_done) state <= CONVERTING;
                CONVERTING: if (scaled_done) state <= AFTER_WORD;
                ADDING:     if (sum_done) state <= HALVING;
                HALVING:    if (half_done) state <= OFFERING;
                OFFERING:   state <= handed ? WAITING : OFFERING;
                default:    state <= WAITING;
            endcase

    always @(posedge clk)
        if (rst) taken <= {SB{1'b0}};
        else if (take) taken <= sample;

    generate
        if (CODE != 0) begin : coded
            // Bits of the equal binary64 number: exact.
            function [63:0] widen(input [31:0] code);
                reg     [31:0] m;
                reg     [10:0] e;
                integer        k;
                begin
                    m = code[31] ? ~code + 32'd1 : code;
                    e = 11'd1054;
                    for (k = 4; k >= 0; k = k - 1)
                        if (m >> (32 - (1 << k)) == 32'd0) begin
                            m = m << (1 << k);
                            e = e - (11'd1 << k);
                        end
                    widen = m == 32'd0 ? 64'd0 : {code[31], e, m[30:0], 21'd0};
                end
            endfunction

            reg  [63:0] scaled;
            reg  [W-1:0] converted;
            wire [63:0] product;
            fp_mul #(.W(64), .FTZ(0), .LATENCY(MUL_LATENCY)) scale (
                .clk(clk), .rst(rst), .req(state == SCALING || state == CONVERTING),
                .take(scaled_done), .done(scaled_done),
                .a(state == CONVERTING ? scaled : widen(taken)),
                .b(state == CONVERTING ? FACTOR : LSB),
                .q(product));
            wire [W-1:0] rounded;
            if (W == 64) begin : wide
                assign rounded = FTZ != 0 && product[62:52] == 11'd0
                               ? {product[63], {(W-1){1'b0}}} : product;
            end else begin : narrow
                fp_narrow #(.FTZ(FTZ)) unit (.a(product), .q(rounded));
            end
            always @(posedge clk)
                if (rst) begin
                    scaled    <= 64'd0;
                    converted <= {W{1'b0}};
                end else begin
                    if (state == SCALING && scaled_done)    scaled    <= product;
                    if (state == CONVERTING && scaled_done) converted <= rounded;
                end
            assign word = converted;
        end else begin : uncoded
            assign word        = taken;
            assign scaled_done = 1'b1;
        end

        if (MEAN != 0) begin : averaged
            reg  [W-1:0] sum;
            wire [W-1:0] added, halved;
            /* verilator lint_off WIDTH */
            localparam [W-1:0] HALF = W == 64 ? 64'h3fe0000000000000 : 64'h3f000000;
            /* verilator lint_on WIDTH */
            fp_add #(.W(W), .FTZ(FTZ), .LATENCY(ADD_LATENCY)) add (
                .clk(clk), .rst(rst), .req(state == ADDING), .take(sum_done), .done(sum_done),
                .a(word), .b(held[W-1:0]), .sub(1'b0), .q(added));
            fp_mul #(.W(W), .FTZ(FTZ), .LATENCY(MUL_LATENCY)) half (
                .clk(clk), .rst(rst), .req(state == HALVING), .take(half_done), .done(half_done),
                .a(sum), .b(HALF), .q(halved));
            always @(posedge clk)
                if (rst) sum <= {W{1'b0}};
                else if (sum_done) sum <= added;
                else if (half_done) sum <= halved;
            assign mean = sum;
        end else begin : newest
            assign mean      = word;
            assign sum_done  = 1'b1;
            assign half_done = 1'b1;
        end

        if (LAG == 0) begin : direct
            assign x = word;
        end else begin : delayed
            assign x = held[W*DEPTH-1 -: W];
        end
        if (DEPTH > 1) begin : chain
            always @(posedge clk)
                if (rst) held <= {(W*DEPTH){1'b0}};
                else if (handed) held <= {held[W*(DEPTH-1)-1:0], word};
        end else begin : single
            always @(posedge clk)
                if (rst) held <= {W{1'b0}};
                else if (handed) held <= word;
        end
    endgenerate

    assign d = mean;
endmodule

// Nearest binary32 of a binary64 number, ties to even.
/* verilator lint_off DECLFILENAME */
module fp_narrow #(
    parameter FTZ = 0               // 1: subnormal results become a zero of the same sign
) (
    input  wire [63:0] a,
    output reg  [31:0] q
);
/* verilator lint_on DECLFILENAME */
    reg [11:0] e;                   // exponent as of binary32, two's complement
    reg [5:0]  shift;
    reg [53:0] f, kept, rest, half;
    always @* begin
        e     = {1'b0, a[62:52]} - 12'd896;
        f     = {1'b0, a[62:52] != 11'd0, a[51:0]};
        // Results below 2^-126 lose more bits.
        shift = 6'd29;
        if (e[11] || e == 12'd0) begin
            shift = ~e + 12'd1 > 12'd24 ? 6'd54 : 6'd30 + (~e[5:0] + 6'd1);
            e     = 12'd1;
        end
        kept  = f >> shift;
        rest  = f - (kept << shift);
        half  = 54'd1 << (shift - 6'd1);
        if (rest > half || (rest == half && kept[0])) kept = kept + 54'd1;
        // A carry out of the fraction raises the exponent, also from subnormal.
        kept = kept + {19'd0, e - 12'd1, 23'd0};
        if (kept >= 54'h7f800000) kept = 54'h7f800000;
        q = a[62:52] == 11'h7ff && a[51:0] != 52'd0 ? 32'h7fc00000 : {a[63], kept[30:0]};
        if (FTZ != 0 && q[30:23] == 8'd0) q[22:0] = 23'd0;
    end
endmodule

`default_nettype wire
