// Control of the RLS pipeline: 15 states, ring-buffer head, counters, memory addresses, selects.
//
//   in_valid --->|           |---> in_ready, out_valid
//   *_done   --->| rls_ctrl  |---> ra_addr, ra_we, rb_addr, rb_we      to the two memories
//                |           |---> mul_sel, add_sel, *_en, *_req, take to the data path
//
// Synthesizable Verilog-2005, any P from 1 to 64. No word of data passes through here, so the
// data path and its floating-point units can be exchanged while addresses and selects stay.
//
// Clocks of a sample, clock 0 = RiL_loading, i and j from 0 to P-1, j fastest:
//   RiL_loading  1          the regressor word enters the ring
//   RiL_reading  P*P        t = R L, one product per clock; RiL_writing P (last sum, both memories)
//   LRL_reading  P          den = alpha + L't;              LRL_writing 1
//   RFR_reading  2*P*P      t_i*t_j, then division;         RFR_writing P*P (element of R)
//   RFM_reading  P*P        M = R L with the updated R;     RFM_writing P
//   Out_reading  P          y = W'L;                        Out_writing 1
//   RFW_reading  1+P        e = d - y, then M_i*e;          RFW_writing P (weight)
// Interval 5P^2 + 6P + 4 clocks back to back, one more after Idle. Latency 5P^2 + 4P + 3: from
// RiL_loading to the clock in which out_valid is up.
//
// These are the clocks of units that are done at once. Each of them is a step, which lasts until
// every unit that it asks for is done; nothing moves before. With SPLIT the product with 1/alpha is a
// step of its own, the second of RFR_writing.
//
// Reset is synchronous and may come in any clock. It begins Clearing, P*P + 2P clocks in which every
// word of both memories is written: R, then what stands before it in RAMB and with it RAMA.
//
// Source: Ma et al., Chinese J. Lasers 49(21) 2106004 (2022), section 3: memory depths, unit
// counts and clocks per state; the place of each operation within a state is derived from them.
`default_nettype none

module rls_ctrl #(
    parameter P        = 4,         // taps, 1 to 64
    parameter DIV_ELEM = 0,         // 0: one division per sample; 1: one per element of R
    parameter SCALE    = 1,         // 0: 1/alpha is 1, its product is left out
    parameter SPLIT    = 0,         // 1: subtraction and product with 1/alpha in a step each
    parameter RA       = $clog2(2 * P),             // address bits of RAMA (derived)
    parameter RB       = $clog2(2 * P + P * P)      // address bits of RAMB (derived)
) (
    input  wire          clk,
    input  wire          rst,
    // A sample is taken in the clock in which in_valid and in_ready are both up. in_valid has to
    // stay up until then; withdrawn before, the sample is not taken.
    input  wire          in_valid,
    output wire          in_ready,
    output reg           out_valid,   // one clock; Y holds the result from here on
    // Units may take several clocks: all registers hold until those asked for are done. Results
    // are taken, and the next step begins, in the clock with take.
    output wire          add_req,
    input  wire          add_done,
    output wire          mul_req,
    input  wire          mul_done,
    output wire          div_req,
    input  wire          div_done,
    output wire          take,
    output reg  [3:0]    state,
    output reg  [RA-1:0] ra_addr,     // unused addresses are 0
    output wire          ra_we,
    output wire          ra_sel,      // RAMA write word: 0 adder, 1 input x
    output reg  [RB-1:0] rb_addr,
    output wire          rb_we,
    output wire          rb_sel,      // RAMB write word: 0 adder, 1 multiplier
    output reg  [1:0]    mul_sel,     // 0 A*B, 1 P*RCP, 2 adder (SPLIT: P) * IALPHA, 3 A*E
    output reg  [1:0]    add_sel,     // 0 ACC+P, 1 RR-P, 2 D-Y, 3 RR+P
    output wire          p_en,        // P   <- product
    output wire          p_div,       // P   <- quotient instead (DIV_ELEM only)
    output wire          p_sum,       // P   <- sum instead (SPLIT only)
    output wire          acc_en,      // ACC <- sum
    output wire          acc_first,   // ACC <- initial value instead ...
    output wire          acc_alpha,   // ... which is ALPHA, not +0
    output wire          rr_en,       // RR  <- RAMB
    output wire          den_en,      // DEN <- sum
    output wire          rcp_en,      // RCP <- quotient
    output wire          d_en,        // D   <- input d
    output wire          e_en,        // E   <- sum
    output wire          y_en,        // Y   <- sum
    output wire          clear,       // both memories <- initial words: +0 ...
    output wire          clear_diag   // ... but RAMB the diagonal of R
);
    localparam IB = P > 1 ? $clog2(P) : 1;   // bits of a tap index

    localparam [3:0] IDLE  = 4'd0,  LOAD  = 4'd1,
                     RIL_R = 4'd2,  RIL_W = 4'd3,  LRL_R = 4'd4,  LRL_W = 4'd5,
                     RFR_R = 4'd6,  RFR_W = 4'd7,  RFM_R = 4'd8,  RFM_W = 4'd9,
                     OUT_R = 4'd10, OUT_W = 4'd11, RFW_R = 4'd12, RFW_W = 4'd13,
                     CLEAR = 4'd14;

    // Widths are cut on purpose: the derived address widths hold these constants.
    /* verilator lint_off WIDTH */
    localparam [IB-1:0] LAST     = P - 1;      // last tap
    localparam [RA-1:0] A_SECOND = P;          // RAMA: second half, t then M
    localparam [RB-1:0] B_T      = P;          // RAMB: t
    localparam [RB-1:0] B_R      = 2 * P;      // RAMB: R, row by row
    localparam [RB-1:0] B_LAST   = 2 * P - 1;  // RAMB: last word before R
    /* verilator lint_on WIDTH */

    // RFR: second reading or writing step; RFW: the error is done; Clearing: R is done.
    reg           second;
    reg  [IB-1:0] i;        // row; tap in RFW
    reg  [IB-1:0] j;        // column, tap of a dot product
    reg  [IB-1:0] slot;     // ring slot of L_j, going down
    // Ring slot of the newest regressor word. P steps down bring slot back to it, so that only the
    // eye needs it: synthesis drops the register.
    /* verilator lint_off UNUSED */
    reg  [IB-1:0] head;
    /* verilator lint_on UNUSED */
    reg  [RB-1:0] element;  // RAMB address of R_ij

    wire last_i = i == LAST;
    wire last_j = j == LAST;
    wire last   = last_i & last_j;
    wire load   = (state == LOAD) & in_valid;
    wire stall  = (add_req & ~add_done) | (mul_req & ~mul_done) | (div_req & ~div_done);
    assign take = ~stall;

    // A dot product is being read: regressor word from RAMA, other factor from RAMB.
    wire dot = (state == RIL_R) | (state == LRL_R) | (state == RFM_R) | (state == OUT_R);

    wire [IB-1:0] head_next = slot == LAST ? {IB{1'b0}} : slot + 1'b1;
    wire [IB-1:0] slot_next = slot == {IB{1'b0}} ? LAST : slot - 1'b1;
    wire [IB-1:0] i_next    = last_i ? {IB{1'b0}} : i + 1'b1;
    wire [IB-1:0] j_next    = last_j ? {IB{1'b0}} : j + 1'b1;

    // The element's last step, in which it is written.
    wire corrected = (state == RFR_W) & (SPLIT == 0 | second);

    // Clearing has written all of R but its last word, or more.
    wire clear_matrix = (state == CLEAR) & ~second;
    wire clear_rest   = (state == CLEAR) & second;

    // The element counter runs through R once in each of RiL, RFR and RFM; in Clearing it goes on
    // through the words before R, and so ends where it began.
    wire element_step = (state == RIL_R) | corrected | (state == RFM_R) | (state == CLEAR);
    wire i_step = (state == RIL_W) | (state == RFM_W) | (state == RFW_W)
                | ((corrected | clear_matrix) & last_j);

    always @(posedge clk)
        if (rst) begin
            state   <= CLEAR;
            second  <= 1'b0;
            i       <= {IB{1'b0}};
            j       <= {IB{1'b0}};
            head    <= LAST;          // so that sample 0 goes to slot 0
            slot    <= LAST;
            element <= B_R;
        end else if (!stall) begin
            if (load) begin
                head <= head_next;
                slot <= head_next;
            end else if (dot)
                slot <= slot_next;
            if (dot | corrected | clear_matrix)        j <= j_next;
            if (i_step)                                i <= i_next;
            if (element_step)
                element <= !last | clear_rest ? element + 1'b1
                         : state == CLEAR ? {RB{1'b0}} : B_R;
            second <= ((state == RFR_R) & ~second) | (state == RFW_R)
                    | ((state == RFR_W) & ~corrected)
                    | ((state == RFW_W) & ~last_i)
                    | (clear_matrix & last) | (clear_rest & (element != B_LAST));
            case (state)
                IDLE:    state <= in_valid ? LOAD : IDLE;
                LOAD:    state <= in_valid ? RIL_R : IDLE;
                RIL_R:   state <= last_j ? RIL_W : RIL_R;
                RIL_W:   state <= last_i ? LRL_R : RIL_R;
                LRL_R:   state <= last_j ? LRL_W : LRL_R;
                LRL_W:   state <= RFR_R;
                RFR_R:   state <= second ? RFR_W : RFR_R;
                RFR_W:   state <= !corrected ? RFR_W : last ? RFM_R : RFR_R;
                RFM_R:   state <= last_j ? RFM_W : RFM_R;
                RFM_W:   state <= last_i ? OUT_R : RFM_R;
                OUT_R:   state <= last_j ? OUT_W : OUT_R;
                OUT_W:   state <= RFW_R;
                RFW_R:   state <= second ? RFW_W : RFW_R;
                // Passing through Idle would cost a clock of the sample period.
                RFW_W:   state <= !last_i ? RFW_R : in_valid ? LOAD : IDLE;
                CLEAR:   state <= second & (element == B_LAST) ? IDLE : CLEAR;
                default: state <= IDLE;
            endcase
        end

    // Tap indices widen to addresses with leading zeros.
    /* verilator lint_off WIDTH */
    always @* begin
        ra_addr = {RA{1'b0}};
        case (state)
            LOAD:                       if (in_valid) ra_addr = head_next;
            RIL_R, LRL_R, RFM_R, OUT_R: ra_addr = slot;
            RIL_W, RFM_W:               ra_addr = A_SECOND + i;
            RFR_R:                      if (!second) ra_addr = A_SECOND + i;
            RFW_R:                      if (second) ra_addr = A_SECOND + i;
            CLEAR:                      if (second) ra_addr = element[RA-1:0];
            default:                    ;
        endcase
        rb_addr = {RB{1'b0}};
        case (state)
            RIL_R, RFM_R, CLEAR: rb_addr = element;
            RFR_W:               if (corrected) rb_addr = element;
            RIL_W:               rb_addr = B_T + i;
            LRL_R:               rb_addr = B_T + j;
            RFR_R:               rb_addr = second ? element : B_T + j;
            OUT_R:               rb_addr = j;
            RFW_R:               if (second) rb_addr = i;
            RFW_W:               rb_addr = i;
            default:             ;
        endcase
        case (state)
            RFR_R:   mul_sel = {1'b0, second};
            RFR_W:   mul_sel = 2'd2;
            RFW_R:   mul_sel = 2'd3;
            default: mul_sel = 2'd0;
        endcase
        case (state)
            RFR_W:   add_sel = 2'd1;
            RFW_R:   add_sel = 2'd2;
            RFW_W:   add_sel = 2'd3;
            default: add_sel = 2'd0;
        endcase
    end
    /* verilator lint_on WIDTH */

    assign in_ready  = state == LOAD;
    // Y is right from the clock after it was taken.
    always @(posedge clk) out_valid <= ~rst & y_en;
    assign ra_we     = load | ((state == RIL_W) & take) | ((state == RFM_W) & take) | clear_rest;
    assign ra_sel    = state == LOAD;
    assign rb_we     = (((state == RIL_W) | corrected | (state == RFW_W)) & take) | clear;
    assign rb_sel    = state == RFR_W;
    assign div_req   = (state == RFR_R)
                     & (DIV_ELEM != 0 ? second : ~second & (i == {IB{1'b0}}) & (j == {IB{1'b0}}));
    // The first product of a sum has nothing to be added to.
    assign add_req   = (dot & ~acc_first) | (state == RIL_W) | (state == LRL_W) | (state == RFM_W)
                     | (state == OUT_W) | ((state == RFR_W) & (SPLIT == 0 | ~second))
                     | ((state == RFW_R) & ~second) | (state == RFW_W);
    assign mul_req   = dot | ((state == RFR_R) & (~second | DIV_ELEM == 0))
                     | ((state == RFW_R) & second) | (SCALE != 0 & corrected);
    assign p_en      = (dot | (state == RFR_R) | ((state == RFW_R) & second) | p_sum) & take;
    assign p_div     = (DIV_ELEM != 0) & second & (state == RFR_R);
    assign p_sum     = (state == RFR_W) & ~corrected;
    assign acc_en    = dot & take;
    assign acc_first = j == {IB{1'b0}};
    assign acc_alpha = state == LRL_R;
    assign rr_en     = ((state == RFR_R) | (state == RFW_R)) & second & take;
    assign den_en    = (state == LRL_W) & take;
    assign rcp_en    = (DIV_ELEM == 0) & div_req & take;
    assign d_en      = load;
    assign e_en      = (state == RFW_R) & ~second & take;
    assign y_en      = (state == OUT_W) & take;
    assign clear      = state == CLEAR;
    assign clear_diag = clear_matrix & (i == j);

`ifndef SYNTHESIS
    // For waveforms only: the phase within an element or a tap, and the state in letters.
    /* verilator lint_off UNUSED */
    wire [1:0] ph = (state == RFR_W) | (state == RFW_W) ? 2'd2 : {1'b0, second};
    reg [8*11-1:0] state_name;
    /* verilator lint_on UNUSED */
    always @*
        case (state)
            IDLE:    state_name = "Idle";
            LOAD:    state_name = "RiL_loading";
            RIL_R:   state_name = "RiL_reading";
            RIL_W:   state_name = "RiL_writing";
            LRL_R:   state_name = "LRL_reading";
            LRL_W:   state_name = "LRL_writing";
            RFR_R:   state_name = "RFR_reading";
            RFR_W:   state_name = "RFR_writing";
            RFM_R:   state_name = "RFM_reading";
            RFM_W:   state_name = "RFM_writing";
            OUT_R:   state_name = "Out_reading";
            OUT_W:   state_name = "Out_writing";
            RFW_R:   state_name = "RFW_reading";
            RFW_W:   state_name = "RFW_writing";
            CLEAR:   state_name = "Clearing";
            default: state_name = "illegal";
        endcase
`endif
endmodule

`default_nettype wire
