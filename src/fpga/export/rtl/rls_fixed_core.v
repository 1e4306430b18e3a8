// Recursive least squares in fixed point: gain first, one triangle of R computed and mirrored.
//
//              +--------------------------------------------------------+
//  x, d ------>| RAMA  2P words       L (ring) | k                      |
//  in_valid -->| RAMB  2P+P*P words   W | t | R row by row              |---> out_valid
//  in_ready <--| one multiplier, one adder, one divider                 |---> y
//              | registers P ACC RR DEN D E Y                           |
//              +--------------------------------------------------------+
//
//   t_i  = Qt(L_0*R_i0 + L_1*R_i1 + ...)             sums exact, rounded once
//   den  = Qden(ALPHA + L_0*t_0 + ...)
//   k_i  = Qk(t_i / den)
//   R_ij = QR(QR(R_ij - k_i*t_j) * IALPHA)           i <= j, also to R_ji; SCALES = 0: no IALPHA
//   R_ii >= FLOOR, if there is one
//   y    = Qy(L_0*W_0 + ...)                         weights before the update
//   W_i  = QW(W_i + k_i*Qy(d - y))
//
// Each signal S has WS bits, NS of them behind the point, a rounding RS (0 cut off, 1 half up, 2
// nearest even) and SS (1 saturates, 0 wraps). Words stand sign-extended in memories of MW bits.
//
// Clocks: RiL_loading 1, RiL_reading P*P, RiL_writing P, LRL_reading P, LRL_writing 1, GAIN_dividing
// P, RFR_reading P*P+P, RFR_writing P(P+1)/2, RFR_mirroring P(P-1)/2, Out_reading P, Out_writing 1,
// RFW_reading 1+P, RFW_writing P: 3P^2 + 7P + 4, one more after Idle; out_valid after 3P^2 + 5P + 3.
// These are the clocks of units that are done at once. Each of them is a step, which lasts until every unit
// that it asks for is done; nothing moves before. With slow units and IALPHA, RFR_writing takes three steps for
// an element: the difference to P, its product to P, the rounding of that to RAMB.
// Reset is synchronous and may come in any clock; P*P + 2P clocks of Clearing follow it.
`default_nettype none

module rls_fixed_core #(
    parameter P  = 4,               // taps, 1 to 64
    parameter MW = 32,              // bits of a memory's word, the widest signal
    parameter WX = 32, parameter NX = 31,
    parameter WD = 32, parameter ND = 31,
    parameter WT = 32, parameter NT = 21, parameter RT = 1, parameter ST = 1,
    parameter WN = 32, parameter NN = 20, parameter RN = 1, parameter SN = 1,   // denominator
    parameter WK = 32, parameter NK = 23, parameter RK = 1, parameter SK = 1,
    parameter WR = 32, parameter NR = 18, parameter RR = 1, parameter SR = 1,
    parameter WW = 32, parameter NW = 29, parameter RW = 1, parameter SW = 1,
    parameter WY = 32, parameter NY = 31, parameter RY = 1, parameter SY = 1,
    parameter signed [127:0] ALPHA = 128'sd1 <<< 52,    // at NX + NT fraction bits
    parameter SCALES = 0,           // 1: R is multiplied by IALPHA
    parameter signed [63:0] IALPHA = 64'sd1,
    parameter NI = 0,               // fraction bits of IALPHA
    parameter signed [63:0] DELTA  = 64'sd1,            // initial diagonal of R
    parameter signed [63:0] FLOOR  = 64'sd0,            // smallest diagonal element of R; 0: none
    parameter ADD_LATENCY = 1,      // clocks of the adder, the rounding among them
    parameter MUL_LATENCY = 1,      // clocks of the multiplier
    parameter DIV_LATENCY = 1       // clocks of the divider
) (
    input  wire          clk,
    input  wire          rst,
    input  wire          in_valid,  // hold x, d and in_valid until in_ready
    output wire          in_ready,
    input  wire [WX-1:0] x,
    input  wire [WD-1:0] d,
    output reg           out_valid, // one clock
    output wire [WY-1:0] y,
    // One clock each: a word is stored that was beyond the ends of its signal; a denominator or a
    // diagonal element of R is stored that is not above zero.
    output wire          overflow,
    output wire          indefinite
);
    localparam SPLIT = SCALES != 0 && (ADD_LATENCY > 1 || MUL_LATENCY > 1);
    // Bits of a factor from RAMA and from RAMB, of a product, of a sum of products.
    localparam WA = max(max(WX, WK), SPLIT ? WR : 0);
    localparam WB = max(max(WR, WT), max(WW, WY));
    localparam PW = WA + WB;
    localparam CW = max(PW, NX + NT + 2) + $clog2(P + 1) + 1;
    localparam RA = $clog2(2 * P);
    localparam RB = $clog2(2 * P + P * P);
    localparam IB = P > 1 ? $clog2(P) : 1;
    localparam [3:0] IDLE  = 4'd0,  LOAD  = 4'd1,  RIL_R = 4'd2,  RIL_W = 4'd3,  LRL_R = 4'd4,
                     LRL_W = 4'd5,  GAIN  = 4'd6,  RFR_R = 4'd7,  RFR_W = 4'd8,  RFR_M = 4'd9,
                     OUT_R = 4'd10, OUT_W = 4'd11, RFW_R = 4'd12, RFW_W = 4'd13, CLEAR = 4'd14;
    // Widths are cut on purpose: the derived address widths hold these constants.
    /* verilator lint_off WIDTH */
    localparam [IB-1:0] LAST     = P - 1;
    localparam [RA-1:0] A_SECOND = P;
    localparam [RB-1:0] B_T      = P;
    localparam [RB-1:0] B_R      = 2 * P;
    localparam [RB-1:0] B_LAST   = 2 * P - 1;
    localparam [RB-1:0] ROW      = P;
    localparam [RB-1:0] DIAGONAL = P + 1;
    /* verilator lint_on WIDTH */

    reg  [3:0]    state;
    reg           second;           // RFR: second step of its kind; RFW: error done; Clearing: R done
    reg           third;            // RFR_writing: difference and product are done
    reg  [IB-1:0] i, j, head;
    reg  [RB-1:0] element;          // R_ij, row by row; above the diagonal in RFR
    reg  [RB-1:0] mirror;           // R_ji
    reg  [RB-1:0] diagonal;         // R_ii
    reg  signed [PW-1:0] p;
    reg  signed [CW-1:0] acc;
    reg  signed [MW-1:0] rr, den;
    reg  signed [WD-1:0] dd;
    reg  signed [WY-1:0] ee, yy;

    wire last_i = i == LAST;
    wire last_j = j == LAST;
    wire take   = (state == LOAD) & in_valid;
    wire dot    = (state == RIL_R) | (state == LRL_R) | (state == OUT_R);
    // The first product of a sum has nothing to be added to.
    wire add_req = (dot & (j != {IB{1'b0}})) | (state == RIL_W) | (state == LRL_W) | (state == OUT_W)
                 | ((state == RFR_W) & (~second | third)) | ((state == RFW_R) & ~second) | (state == RFW_W);
    wire mul_req = dot | ((state == RFR_R) & ~second) | ((state == RFW_R) & second)
                 | ((state == RFR_W) & second & ~third);
    wire div_req = state == GAIN;
    wire add_done, mul_done, div_done, mul_first;
    wire stall  = (add_req & ~add_done) | (mul_req & ~mul_done) | (div_req & ~div_done);
    wire clear  = state == CLEAR;
    // An element of R is written, it and its copy are done.
    wire writes    = (state == RFR_W) & (third | ~SPLIT);
    wire corrected = (writes & (i == j)) | (state == RFR_M);

    wire [IB-1:0] one_i     = {{(IB-1){1'b0}}, 1'b1};
    wire [IB-1:0] head_next = head == LAST ? {IB{1'b0}} : head + one_i;
    wire [IB-1:0] i_next    = last_i ? {IB{1'b0}} : i + one_i;
    wire [IB-1:0] j_next    = last_j ? {IB{1'b0}} : j + one_i;
    /* verilator lint_off WIDTH */
    wire [IB-1:0] slot      = head >= j ? head - j : head + P - j;
    /* verilator lint_on WIDTH */

    always @(posedge clk)
        if (rst) begin
            state    <= CLEAR;
            second   <= 1'b0;
            third    <= 1'b0;
            i        <= {IB{1'b0}};
            j        <= {IB{1'b0}};
            head     <= LAST;
            element  <= B_R;
            mirror   <= B_R;
            diagonal <= B_R;
        end else if (!stall) begin
            if (take) head <= head_next;
            case (state)
                IDLE:  state <= in_valid ? LOAD : IDLE;
                LOAD:  state <= in_valid ? RIL_R : IDLE;
                RIL_R: begin
                    j       <= j_next;
                    element <= last_i & last_j ? B_R : element + 1'b1;
                    if (last_j) state <= RIL_W;
                end
                RIL_W: begin
                    i     <= i_next;
                    state <= last_i ? LRL_R : RIL_R;
                end
                LRL_R: begin
                    j <= j_next;
                    if (last_j) state <= LRL_W;
                end
                LRL_W: state <= GAIN;
                GAIN:  begin
                    i     <= i_next;
                    state <= last_i ? RFR_R : GAIN;
                end
                RFR_R: begin
                    second <= ~second;
                    if (second) state <= RFR_W;
                end
                RFR_W, RFR_M: begin
                    second <= (state == RFR_W) & ~writes;
                    third  <= (state == RFR_W) & ~writes & second;
                    if ((state == RFR_W) & ~writes) state <= RFR_W;
                    else if (!corrected) state <= RFR_M;
                    else if (!last_j) begin
                        j       <= j + one_i;
                        element <= element + 1'b1;
                        mirror  <= mirror + ROW;
                        state   <= RFR_R;
                    end else if (!last_i) begin
                        i        <= i + one_i;
                        j        <= i + one_i;
                        element  <= diagonal + DIAGONAL;
                        mirror   <= diagonal + DIAGONAL;
                        diagonal <= diagonal + DIAGONAL;
                        state    <= RFR_R;
                    end else begin
                        i        <= {IB{1'b0}};
                        j        <= {IB{1'b0}};
                        element  <= B_R;
                        mirror   <= B_R;
                        diagonal <= B_R;
                        state    <= OUT_R;
                    end
                end
                OUT_R: begin
                    j <= j_next;
                    if (last_j) state <= OUT_W;
                end
                OUT_W: state <= RFW_R;
                RFW_R: begin
                    second <= 1'b1;
                    if (second) state <= RFW_W;
                end
                // Passing through Idle would cost a clock of the sample period.
                RFW_W: begin
                    i      <= i_next;
                    second <= ~last_i;
                    state  <= !last_i ? RFW_R : in_valid ? LOAD : IDLE;
                end
                CLEAR: if (!second) begin
                    j       <= j_next;
                    if (last_j) i <= i_next;
                    second  <= last_i & last_j;
                    element <= last_i & last_j ? {RB{1'b0}} : element + 1'b1;
                end else begin
                    element <= element + 1'b1;
                    if (element == B_LAST) begin
                        second <= 1'b0;
                        state  <= IDLE;
                    end
                end
                default: state <= CLEAR;
            endcase
        end

    // Addresses; unused ones are 0.
    reg [RA-1:0] ra_addr;
    reg [RB-1:0] rb_addr;
    /* verilator lint_off WIDTH */
    always @* begin
        ra_addr = {RA{1'b0}};
        rb_addr = {RB{1'b0}};
        case (state)
            LOAD:  if (in_valid) ra_addr = head_next;
            RIL_R: begin ra_addr = slot; rb_addr = element; end
            RIL_W: rb_addr = B_T + i;
            LRL_R: begin ra_addr = slot; rb_addr = B_T + j; end
            GAIN:  begin ra_addr = A_SECOND + i; rb_addr = B_T + i; end
            RFR_R: if (second) rb_addr = element;
                   else begin ra_addr = A_SECOND + i; rb_addr = B_T + j; end
            RFR_W: if (writes) rb_addr = element;
            RFR_M: rb_addr = mirror;
            OUT_R: begin ra_addr = slot; rb_addr = j; end
            RFW_R: if (second) begin ra_addr = A_SECOND + i; rb_addr = i; end
            RFW_W: rb_addr = i;
            CLEAR: begin
                rb_addr = element;
                if (second) ra_addr = element;
            end
            default: ;
        endcase
    end
    /* verilator lint_on WIDTH */

    wire signed [MW-1:0] ra_rdata, rb_rdata;
    wire signed [WT-1:0] t_word;
    wire signed [WN-1:0] den_word;
    wire signed [WK-1:0] k_word;
    wire signed [WR-1:0] r_diff, r_word;
    wire signed [WY-1:0] y_word, e_word;
    wire signed [WW-1:0] w_word;
    wire signed [WX-1:0] x_word = x;

    wire ra_we = take | (div_req & ~stall) | (clear & second);
    wire rb_we = (((state == RIL_W) | writes | (state == RFW_W)) & ~stall) | (state == RFR_M) | clear;
    // Sign extension and cutting of constants.
    /* verilator lint_off WIDTH */
    wire signed [MW-1:0] delta_word = DELTA;
    wire signed [MW-1:0] floor_word = FLOOR;
    wire signed [MW-1:0] zero = {MW{1'b0}};
    wire signed [MW-1:0] xm = x_word, km = k_word, tm = t_word, wm = w_word;
    wire signed [MW-1:0] r_mw = r_word;
    /* verilator lint_on WIDTH */
    wire signed [MW-1:0] rm = FLOOR > 0 && i == j && r_mw < floor_word ? floor_word : r_mw;
    wire signed [MW-1:0] ra_wdata = clear ? zero : state == LOAD ? xm : km;
    wire signed [MW-1:0] rb_wdata = clear ? (!second && i == j ? delta_word : zero)
                                  : state == RIL_W ? tm : state == RFW_W ? wm : rm;
    sp_ram #(.W(MW), .DEPTH(2 * P)) rama (
        .clk(clk), .we(ra_we), .addr(ra_addr), .wdata(ra_wdata), .rdata(ra_rdata));
    sp_ram #(.W(MW), .DEPTH(2 * P + P * P)) ramb (
        .clk(clk), .we(rb_we), .addr(rb_addr), .wdata(rb_wdata), .rdata(rb_rdata));

    wire t_over, den_over, y_over, e_over, w_over, diff_over, r_over, k_over;

    // Exact values.
    localparam SP = NK + NT;                        // scale of k*t
    localparam FR = NR > SP ? NR : SP;              // scale of R - k*t
    localparam SE = NK + NY;                        // scale of k*e
    localparam FW = NW > SE ? NW : SE;              // scale of W + k*e
    localparam FE = ND > NY ? ND : NY;              // scale of d - y
    localparam UP = NK + NN > NT ? NK + NN - NT : 0;
    localparam DN = NT > NK + NN ? NT - NK - NN : 0;
    localparam RB_W = max(WR + FR - NR, WK + WT + FR - SP);     // bits of the operands of R - k*t
    localparam WB_W = max(WW + FW - NW, WK + WY + FW - SE);     // of W + k*e
    localparam EB_W = max(WD + FE - ND, WY + FE - NY);          // of d - y
    /* verilator lint_off WIDTH */
    wire signed [WA-1:0] a_word = ra_rdata;
    wire signed [WB-1:0] b_word = rb_rdata, e_factor = ee, ia_factor = IALPHA;
    wire signed [WA-1:0] p_factor = p;
    wire signed [CW-1:0] p_term = p;
    wire signed [RB_W-1:0] r_whole = rr, r_part = p;
    wire signed [WB_W-1:0] w_whole = rr, w_part = p;
    wire signed [EB_W-1:0] d_whole = dd, y_whole = yy;
    wire signed [WT+UP-1:0] t_whole = $signed(rb_rdata[WT-1:0]);
    wire signed [WN+DN-1:0] n_whole = $signed(den[WN-1:0]);
    /* verilator lint_on WIDTH */
    wire signed [CW-1:0] sum = acc + p_term;
    wire signed [PW-1:0] product;
    wire                 scales = SPLIT & (state == RFR_W);

    fp_wait #(.LATENCY(MUL_LATENCY)) mul (
        .clk(clk), .rst(rst), .req(mul_req), .take(~stall), .first(mul_first), .done(mul_done));
    fx_mul #(.WA(WA), .WB(WB), .LATENCY(MUL_LATENCY)) multiply (
        .clk(clk), .first(mul_first), .a(scales ? p_factor : a_word),
        .b(scales ? ia_factor : state == RFW_R ? e_factor : b_word), .q(product));
    /* verilator lint_off PINCONNECTEMPTY */
    fp_wait #(.LATENCY(ADD_LATENCY)) add (
        .clk(clk), .rst(rst), .req(add_req), .take(~stall), .first(), .done(add_done));
    /* verilator lint_on PINCONNECTEMPTY */

    fx_sum #(.AW(room(CW, NX + NR, WT, NT)), .BW(CW), .FROM(NX + NR), .WIDTH(WT), .N(NT), .RND(RT), .SAT(ST),
             .LATENCY(ADD_LATENCY)) store_t (
        .clk(clk), .a(acc), .b(p_term), .q(t_word), .over(t_over));
    fx_sum #(.AW(room(CW, NX + NT, WN, NN)), .BW(CW), .FROM(NX + NT), .WIDTH(WN), .N(NN), .RND(RN), .SAT(SN),
             .LATENCY(ADD_LATENCY)) store_den (
        .clk(clk), .a(acc), .b(p_term), .q(den_word), .over(den_over));
    fx_sum #(.AW(room(CW, NX + NW, WY, NY)), .BW(CW), .FROM(NX + NW), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY),
             .LATENCY(ADD_LATENCY)) store_y (
        .clk(clk), .a(acc), .b(p_term), .q(y_word), .over(y_over));
    fx_sum #(.AW(room(RB_W, FR, WR, NR)), .BW(RB_W), .FROM(FR), .WIDTH(WR), .N(NR), .RND(RR), .SAT(SR), .SUB(1),
             .LATENCY(ADD_LATENCY)) store_diff (
        .clk(clk), .a(r_whole <<< (FR - NR)), .b(r_part <<< (FR - SP)), .q(r_diff), .over(diff_over));
    fx_sum #(.AW(room(WB_W, FW, WW, NW)), .BW(WB_W), .FROM(FW), .WIDTH(WW), .N(NW), .RND(RW), .SAT(SW),
             .LATENCY(ADD_LATENCY)) store_w (
        .clk(clk), .a(w_whole <<< (FW - NW)), .b(w_part <<< (FW - SE)), .q(w_word), .over(w_over));
    fx_sum #(.AW(room(EB_W, FE, WY, NY)), .BW(EB_W), .FROM(FE), .WIDTH(WY), .N(NY), .RND(RY), .SAT(SY), .SUB(1),
             .LATENCY(ADD_LATENCY)) store_e (
        .clk(clk), .a(d_whole <<< (FE - ND)), .b(y_whole <<< (FE - NY)), .q(e_word), .over(e_over));
    generate
        if (SCALES != 0) begin : scaled
            /* verilator lint_off WIDTH */
            wire signed [2*WR-1:0] diff_wide = r_diff;
            wire signed [2*WR-1:0] ia_wide   = IALPHA;
            wire signed [2*WR-1:0] grown     = SPLIT ? p : diff_wide * ia_wide;
            /* verilator lint_on WIDTH */
            fx_sum #(.AW(room(2 * WR, NR + NI, WR, NR)), .BW(2 * WR), .FROM(NR + NI), .WIDTH(WR), .N(NR), .RND(RR),
                     .SAT(SR), .LATENCY(ADD_LATENCY)) store_r (
                .clk(clk), .a(grown), .b({2*WR{1'b0}}), .q(r_word), .over(r_over));
        end else begin : unscaled
            assign r_word = r_diff;
            assign r_over = 1'b0;
        end
    endgenerate
    fx_div #(.AW(WT + UP), .BW(WN + DN), .WIDTH(WK), .RND(RK), .SAT(SK), .LATENCY(DIV_LATENCY)) div (
        .clk(clk), .rst(rst), .req(div_req), .a(t_whole <<< UP), .b(n_whole <<< DN),
        .done(div_done), .q(k_word), .over(k_over));

    function integer max(input integer a, input integer b);
        max = a > b ? a : b;
    endfunction
    // Bits of a sum of operands of so many, with room for its rounding into a word.
    function integer room(input integer bits, input integer from, input integer width, input integer n);
        room = max(bits + 1 + (n > from ? n - from : 0), width + 1);
    endfunction

    /* verilator lint_off WIDTH */
    wire signed [MW-1:0] den_mw = den_word;
    wire signed [PW-1:0] diff_p = r_diff;
    wire signed [CW-1:0] alpha = ALPHA;
    /* verilator lint_on WIDTH */
    always @(posedge clk)
        if (rst) begin
            p   <= {PW{1'b0}};
            acc <= {CW{1'b0}};
            rr  <= {MW{1'b0}};
            den <= {MW{1'b0}};
            dd  <= {WD{1'b0}};
            ee  <= {WY{1'b0}};
            yy  <= {WY{1'b0}};
        end else if (!stall) begin
            if (mul_req) p <= product;
            else if (SPLIT & (state == RFR_W) & ~second) p <= diff_p;
            if (dot) acc <= j != {IB{1'b0}} ? sum : state == LRL_R ? alpha : {CW{1'b0}};
            if (((state == RFR_R) | (state == RFW_R)) & second) rr <= rb_rdata;
            if (state == LRL_W) den <= den_mw;
            if (take) dd <= d;
            if ((state == RFW_R) & ~second) ee <= e_word;
            if (state == OUT_W) yy <= y_word;
        end
    always @(posedge clk) out_valid <= ~rst & (state == OUT_W) & ~stall;

    assign in_ready  = state == LOAD;
    assign y         = yy;
    assign overflow  = (((state == RIL_W) & t_over) | ((state == LRL_W) & den_over)
                        | (div_req & k_over) | ((state == RFR_W) & ~third & ~second & diff_over)
                        | (writes & r_over) | ((state == OUT_W) & y_over)
                        | ((state == RFW_R) & ~second & e_over) | ((state == RFW_W) & w_over)) & ~stall;
    assign indefinite = (((state == LRL_W) & (den_word <= 0)) | (writes & (i == j) & (rm <= 0))) & ~stall;
endmodule

`default_nettype wire
