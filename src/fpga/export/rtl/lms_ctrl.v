// Control of the LMS and NLMS pipelines, on the structure of the RLS pipeline (rls_ctrl.v).
//
//   in_valid --->|           |---> in_ready, out_valid
//   div_done --->| lms_ctrl  |---> ra_addr, ra_we, rb_addr, rb_we      to the two memories
//                |           |---> mul_sel, add_sel, *_en, div_req     to the data path
//
// Synthesizable Verilog-2005, any N from 1 to 64.
//
// Clocks of a sample, clock 0 = L_loading, j from 0 to N-1:
//   L_loading    1   the regressor word enters the ring
//   LL_reading   N   NLMS only: den = EPS + L'L, one product per clock; LL_writing 1
//   Out_reading  N   y = W'L;                                           Out_writing 1
//   ERR          1   e = d - y (NLMS: also rcp = MU / den)
//   GAIN         1   e * MU, or e * rcp
//   LMW_reading  N   L_j * e;                                           LMW_writing N (weight)
// Interval 3N + 4 clocks (LMS), 4N + 5 (NLMS) back to back, one more after Idle. Latency N + 2
// and 2N + 3: from L_loading to the clock in which out_valid is up.
//
// Reset is synchronous and may come in any clock. It begins Clearing, N clocks in which every word
// of both memories is written.
//
// Source: the paper states no schedule for its LMS filter; derived: the same memories, units and
// read/write rhythm as its RLS pipeline.
`default_nettype none

module lms_ctrl #(
    parameter N    = 10,                            // taps, 1 to 64
    parameter NLMS = 0,                             // 1: normalised
    parameter AB   = N > 1 ? $clog2(N) : 1          // address bits of both memories (derived)
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
    output reg  [3:0]    state,
    output reg  [AB-1:0] ra_addr,     // unused addresses are 0
    output wire          ra_we,       // RAMA <- x
    output wire [AB-1:0] rb_addr,
    output wire          rb_we,       // RAMB <- sum
    output reg  [2:0]    mul_sel,     // 0 A*B, 1 A*A, 2 A*E, 3 D*0.5, 4 E*gain
    output reg  [1:0]    add_sel,     // 0 ACC+P, 1 RR+P, 2 D-Y, 3 x+XP
    output wire          p_en,        // P   <- product
    output wire          acc_en,      // ACC <- sum
    output wire          acc_first,   // ACC <- initial value instead ...
    output wire          acc_eps,     // ... which is EPS, not +0
    output wire          rr_en,       // RR  <- RAMB
    output wire          den_en,      // DEN <- sum
    output wire          rcp_en,      // RCP <- quotient
    output wire          d_en,        // D   <- input, XP <- x
    output wire          d_half,      // D   <- product, if D is the mean of two inputs
    output wire          e_en,        // E   <- sum
    output wire          e_gain,      // E   <- product
    output wire          y_en,        // Y   <- sum
    output wire          clear        // both memories <- initial words
);
    localparam [3:0] IDLE = 4'd0, LOAD  = 4'd1, LL_R = 4'd2, LL_W  = 4'd3, OUT_R = 4'd4,
                     OUT_W = 4'd5, ERR  = 4'd6, GAIN = 4'd7, LMW_R = 4'd8, LMW_W = 4'd9,
                     CLEAR = 4'd10;

    // The width is cut on purpose: the derived address width holds this constant.
    /* verilator lint_off WIDTH */
    localparam [AB-1:0] LAST = N - 1;
    /* verilator lint_on WIDTH */

    reg [AB-1:0] j;         // tap
    reg [AB-1:0] slot;      // ring slot of L_j, going down
    // Ring slot of the newest regressor word. N steps down bring slot back to it, so that only the
    // eye needs it: synthesis drops the register.
    /* verilator lint_off UNUSED */
    reg [AB-1:0] head;
    /* verilator lint_on UNUSED */

    wire last  = j == LAST;
    wire take  = (state == LOAD) & in_valid;
    wire stall = div_req & ~div_done;
    wire dot   = (state == LL_R) | (state == OUT_R);

    wire [AB-1:0] head_next = slot == LAST ? {AB{1'b0}} : slot + 1'b1;
    wire [AB-1:0] slot_next = slot == {AB{1'b0}} ? LAST : slot - 1'b1;

    always @(posedge clk)
        if (rst) begin
            state <= CLEAR;
            j     <= {AB{1'b0}};
            head  <= LAST;            // so that sample 0 goes to slot 0
            slot  <= LAST;
        end else if (!stall) begin
            if (take) begin
                head <= head_next;
                slot <= head_next;
            end else if (dot | (state == LMW_W))
                slot <= slot_next;
            if (dot | (state == LMW_W) | (state == CLEAR)) j <= last ? {AB{1'b0}} : j + 1'b1;
            case (state)
                IDLE:    state <= in_valid ? LOAD : IDLE;
                LOAD:    state <= !in_valid ? IDLE : NLMS != 0 ? LL_R : OUT_R;
                LL_R:    state <= last ? LL_W : LL_R;
                LL_W:    state <= OUT_R;
                OUT_R:   state <= last ? OUT_W : OUT_R;
                OUT_W:   state <= ERR;
                ERR:     state <= GAIN;
                GAIN:    state <= LMW_R;
                LMW_R:   state <= LMW_W;
                // Passing through Idle would cost a clock of the sample period.
                LMW_W:   state <= !last ? LMW_R : in_valid ? LOAD : IDLE;
                CLEAR:   state <= last ? IDLE : CLEAR;
                default: state <= IDLE;
            endcase
        end

    always @* begin
        case (state)
            LOAD:               ra_addr = in_valid ? head_next : {AB{1'b0}};
            LL_R, OUT_R, LMW_R: ra_addr = slot;
            CLEAR:              ra_addr = j;
            default:            ra_addr = {AB{1'b0}};
        endcase
        case (state)
            LL_R:    mul_sel = 3'd1;
            LMW_R:   mul_sel = 3'd2;
            OUT_W:   mul_sel = 3'd3;
            GAIN:    mul_sel = 3'd4;
            default: mul_sel = 3'd0;
        endcase
        case (state)
            LMW_W:   add_sel = 2'd1;
            ERR:     add_sel = 2'd2;
            LOAD:    add_sel = 2'd3;
            default: add_sel = 2'd0;
        endcase
    end

    assign rb_addr   = (state == OUT_R) | (state == LMW_R) | (state == LMW_W) | (state == CLEAR)
                     ? j : {AB{1'b0}};
    assign in_ready  = state == LOAD;
    assign out_valid = (state == ERR) & ~stall;
    assign ra_we     = take | (state == CLEAR);
    assign rb_we     = (state == LMW_W) | (state == CLEAR);
    assign div_req   = (NLMS != 0) & (state == ERR);
    assign p_en      = dot | (state == LMW_R);
    assign acc_en    = dot;
    assign acc_first = j == {AB{1'b0}};
    assign acc_eps   = state == LL_R;
    assign rr_en     = state == LMW_R;
    assign den_en    = state == LL_W;
    assign rcp_en    = div_req & div_done;
    assign d_en      = take;
    assign d_half    = state == OUT_W;
    assign e_en      = (state == ERR) & ~stall;
    assign e_gain    = state == GAIN;
    assign y_en      = state == OUT_W;
    assign clear     = state == CLEAR;

`ifndef SYNTHESIS
    // For waveforms only: the state in letters.
    /* verilator lint_off UNUSED */
    reg [8*11-1:0] state_name;
    /* verilator lint_on UNUSED */
    always @*
        case (state)
            IDLE:    state_name = "Idle";
            LOAD:    state_name = "L_loading";
            LL_R:    state_name = "LL_reading";
            LL_W:    state_name = "LL_writing";
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
