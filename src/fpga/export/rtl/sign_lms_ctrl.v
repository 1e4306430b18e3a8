// Control of the line enhancer, on the structure of the LMS pipeline (lms_ctrl.v).
//
//   in_valid --->|               |---> in_ready, out_valid
//   div_done --->| sign_lms_ctrl |---> ra_addr, ra_we, rb_addr, rb_we      to the two memories
//   beyond ----->|               |---> mul_sel, add_sel, *_en, div_req     to the data path
//
// Synthesizable Verilog-2005, any M from 1 to 64.
//
// Clocks of a sample, clock 0 = L_reading, j from 0 to M-1:
//   L_reading    1   the word that leaves the taps is read; x*x
//   L_writing    1   the new word enters the ring; T + x*x when the norm is soon replaced
//   NRM_adding   1   S + x*x;  NRM_writing 1  S - old*old, or T
//   Out_reading  M   y = W'L (first clock: den = ALPHA + S);                Out_writing 1
//   ERR          1   e = d - y; rcp = MU / den
//   GAIN         1   sgn(e)*rcp, or e*rcp; +0 while the guard holds
//   LMW_reading  M   L_j * e;                                               LMW_writing M
// Interval 3M + 7 clocks back to back, one more after Idle. Latency M + 5: from L_reading to the
// clock in which out_valid is up.
//
// Reset is synchronous and may come in any clock. It begins Clearing, M clocks in which every word
// of both memories is written.
//
// Source: patent CN101221046, equations (25), (26), (34), (35); schedule derived.
`default_nettype none

module sign_lms_ctrl #(
    parameter M         = 20,                       // taps, 1 to 64
    parameter HOLD      = 35,                       // samples on end that the guard may hold
    parameter RECOMPUTE = 1000,                     // samples between two fresh norms, 0 = never
    parameter AB        = M > 1 ? $clog2(M) : 1     // address bits of both memories (derived)
) (
    input  wire          clk,
    input  wire          rst,
    // A sample is taken in the clock in which in_valid and in_ready are both up. in_valid has to
    // stay up until then; withdrawn before, the sample is not taken.
    input  wire          in_valid,
    output wire          in_ready,
    output wire          out_valid,   // one clock; Y holds the result from here on
    // The divider may take several clocks: all registers hold while div_req waits for div_done.
    output wire          div_req,
    input  wire          div_done,
    input  wire          beyond,      // the error E is beyond the guard
    output reg  [3:0]    state,
    output reg  [AB-1:0] ra_addr,     // unused addresses are 0
    output wire          ra_we,       // RAMA <- X
    output wire [AB-1:0] rb_addr,
    output wire          rb_we,       // RAMB <- sum
    output reg  [2:0]    mul_sel,     // 0 A*B, 1 x*x, 2 RR*RR, 3 A*E, 4 E*RCP
    output reg  [2:0]    add_sel,     // 0 ACC+P, 1 RR+P, 2 D-Y, 3 T+P, 4 S+P, 5 S-P, 6 ALPHA+S
    output wire          p_en,        // P   <- product
    output wire          acc_en,      // ACC <- sum, or +0 ...
    output wire          acc_first,   // ... in the first clock of the dot product
    output wire          rr_a_en,     // RR  <- RAMA
    output wire          rr_b_en,     // RR  <- RAMB
    output wire          den_en,      // DEN <- sum
    output wire          rcp_en,      // RCP <- quotient
    output wire          in_en,       // X <- x, D <- d
    output wire          fresh_en,    // T   <- sum
    output wire          fresh_first, // the sum starts at +0
    output wire          norm_en,     // S   <- sum
    output wire          norm_last,   // S   <- sum without sign, or T ...
    output wire          norm_fresh,  // ... which it is
    output wire          e_en,        // E   <- sum
    output wire          e_gain,      // E   <- factor of the taps ...
    output wire          e_held,      // ... which is +0
    output wire          y_en,        // Y   <- sum
    output wire          clear        // both memories <- initial words
);
    localparam [3:0] IDLE = 4'd0, L_R = 4'd1, L_W = 4'd2, NRM_A = 4'd3, NRM_W = 4'd4,
                     OUT_R = 4'd5, OUT_W = 4'd6, ERR = 4'd7, GAIN = 4'd8, LMW_R = 4'd9,
                     LMW_W = 4'd10, CLEAR = 4'd11;

    // The width is cut on purpose: the derived widths hold these constants.
    /* verilator lint_off WIDTH */
    localparam [AB-1:0] LAST      = M - 1;
    localparam [7:0]    HOLD_LAST = HOLD;
    // Where in the interval the fresh sum starts, and where it is complete.
    localparam [19:0]   AGE_START = RECOMPUTE != 0 ? RECOMPUTE - M : 0;
    localparam [19:0]   AGE_LAST  = RECOMPUTE != 0 ? RECOMPUTE - 1 : 0;
    /* verilator lint_on WIDTH */

    reg [AB-1:0] j;         // tap
    reg [AB-1:0] slot;      // ring slot of L_j, going down
    reg [AB-1:0] head;      // ring slot of the newest regressor word
    reg [19:0]   age;       // samples since the norm was replaced
    reg [7:0]    held;      // samples on end that the guard has held

    wire last  = j == LAST;
    wire take  = (state == L_R) & in_valid;
    wire stall = div_req & ~div_done;
    wire gain  = state == GAIN;

    wire [AB-1:0] head_next = head == LAST ? {AB{1'b0}} : head + 1'b1;
    wire [AB-1:0] slot_next = slot == {AB{1'b0}} ? LAST : slot - 1'b1;

    always @(posedge clk)
        if (rst) begin
            state <= CLEAR;
            j     <= {AB{1'b0}};
            head  <= LAST;            // so that sample 0 goes to slot 0
            slot  <= LAST;
            age   <= 20'd0;
            held  <= 8'd0;
        end else if (!stall) begin
            if (state == L_W) begin
                head <= head_next;
                slot <= head_next;
            end else if ((state == OUT_R) | (state == LMW_W))
                slot <= slot_next;
            if ((state == OUT_R) | (state == LMW_W) | (state == CLEAR))
                j <= last ? {AB{1'b0}} : j + 1'b1;
            if (state == NRM_W && RECOMPUTE != 0) age <= norm_fresh ? 20'd0 : age + 20'd1;
            if (gain) held <= !beyond ? 8'd0 : e_held ? held + 8'd1 : held;
            case (state)
                IDLE:    state <= in_valid ? L_R : IDLE;
                L_R:     state <= in_valid ? L_W : IDLE;
                L_W:     state <= NRM_A;
                NRM_A:   state <= NRM_W;
                NRM_W:   state <= OUT_R;
                OUT_R:   state <= last ? OUT_W : OUT_R;
                OUT_W:   state <= ERR;
                ERR:     state <= GAIN;
                GAIN:    state <= LMW_R;
                LMW_R:   state <= LMW_W;
                // Passing through Idle would cost a clock of the sample period.
                LMW_W:   state <= !last ? LMW_R : in_valid ? L_R : IDLE;
                CLEAR:   state <= last ? IDLE : CLEAR;
                default: state <= IDLE;
            endcase
        end

    always @* begin
        case (state)
            L_R:          ra_addr = in_valid ? head_next : {AB{1'b0}};
            L_W:          ra_addr = head_next;
            OUT_R, LMW_R: ra_addr = slot;
            CLEAR:        ra_addr = j;
            default:      ra_addr = {AB{1'b0}};
        endcase
        case (state)
            L_R:     mul_sel = 3'd1;
            NRM_A:   mul_sel = 3'd2;
            LMW_R:   mul_sel = 3'd3;
            GAIN:    mul_sel = 3'd4;
            default: mul_sel = 3'd0;
        endcase
        case (state)
            LMW_W:   add_sel = 3'd1;
            ERR:     add_sel = 3'd2;
            L_W:     add_sel = 3'd3;
            NRM_A:   add_sel = 3'd4;
            NRM_W:   add_sel = 3'd5;
            OUT_R:   add_sel = acc_first ? 3'd6 : 3'd0;
            default: add_sel = 3'd0;
        endcase
    end

    assign rb_addr     = (state == OUT_R) | (state == LMW_R) | (state == LMW_W) | (state == CLEAR)
                       ? j : {AB{1'b0}};
    assign in_ready    = state == L_R;
    assign out_valid   = (state == ERR) & ~stall;
    assign ra_we       = (state == L_W) | (state == CLEAR);
    assign rb_we       = (state == LMW_W) | (state == CLEAR);
    assign div_req     = state == ERR;
    assign p_en        = take | (state == NRM_A) | (state == OUT_R) | (state == LMW_R);
    assign acc_en      = state == OUT_R;
    assign acc_first   = j == {AB{1'b0}};
    assign rr_a_en     = take;
    assign rr_b_en     = state == LMW_R;
    assign den_en      = (state == OUT_R) & acc_first;
    assign rcp_en      = div_req & div_done;
    assign in_en       = take;
    // Without an interval the age starts nothing.
    /* verilator lint_off UNSIGNED */
    assign fresh_en    = (state == L_W) & (RECOMPUTE != 0) & (age >= AGE_START);
    /* verilator lint_on UNSIGNED */
    assign fresh_first = age == AGE_START;
    assign norm_en     = (state == NRM_A) | (state == NRM_W);
    assign norm_last   = state == NRM_W;
    assign norm_fresh  = (RECOMPUTE != 0) & (age == AGE_LAST);
    assign e_en        = (state == ERR) & ~stall;
    assign e_gain      = gain;
    assign e_held      = beyond & (held < HOLD_LAST);
    assign y_en        = state == OUT_W;
    assign clear       = state == CLEAR;

`ifndef SYNTHESIS
    // For waveforms only: the state in letters.
    /* verilator lint_off UNUSED */
    reg [8*11-1:0] state_name;
    /* verilator lint_on UNUSED */
    always @*
        case (state)
            IDLE:    state_name = "Idle";
            L_R:     state_name = "L_reading";
            L_W:     state_name = "L_writing";
            NRM_A:   state_name = "NRM_adding";
            NRM_W:   state_name = "NRM_writing";
            OUT_R:   state_name = "Out_reading";
            OUT_W:   state_name = "Out_writing";
            ERR:     state_name = "ERR";
            GAIN:    state_name = "GAIN";
            LMW_R:   state_name = "LMW_reading";
            LMW_W:   state_name = "LMW_writing";
            CLEAR:   state_name = "Clearing";
            default: state_name = "illegal";
        endcase
`endif
endmodule

`default_nettype wire
