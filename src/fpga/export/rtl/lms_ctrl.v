// Control machine of the LMS and NLMS pipeline.
// Clocks per sample back to back: 3N + 4, normalised 4N + 5. One more after Idle.
`timescale 1ns/1ps

module lms_ctrl #(
    parameter N  = 10,                                  // taps, 1 to 64
    parameter NORMALISED = 0,
    parameter CW = (N > 1) ? $clog2(N) : 1
) (
    input  wire          clk,
    input  wire          rst,                           // synchronous
    input  wire          in_valid,                      // hold until in_ready
    output wire          in_ready,
    output wire          out_valid,
    output reg  [3:0]    state,
    output wire [CW-1:0] i,                             // no rows here: 0
    output reg  [CW-1:0] j,
    output reg  [CW-1:0] head,
    output reg  [CW-1:0] ra_addr,
    output wire          ra_we,
    output reg  [CW-1:0] rb_addr,
    output wire          rb_we
);
    localparam [3:0] IDLE = 0, L_LOADING = 1, LL_READING = 2, LL_WRITING = 3, OUT_READING = 4,
                     OUT_WRITING = 5, ERR = 6, GAIN = 7, LMW_READING = 8, LMW_WRITING = 9;
    localparam [CW-1:0] LAST = N - 1;

    wire last_j = (j == LAST);
    wire [CW-1:0] next_head = (head == LAST) ? {CW{1'b0}} : head + 1'b1;
    wire [CW:0] difference = {1'b0, head} - {1'b0, j};
    wire [CW:0] wrapped = difference + N;
    wire [CW-1:0] slot = difference[CW] ? wrapped[CW-1:0] : difference[CW-1:0];

    assign i = 0;
    assign in_ready = (state == L_LOADING) && in_valid;
    assign out_valid = (state == ERR);
    assign ra_we = in_ready;
    assign rb_we = (state == LMW_WRITING);

    always @* begin
        ra_addr = 0;
        rb_addr = 0;
        case (state)
            L_LOADING: if (in_valid) ra_addr = next_head;
            LL_READING: ra_addr = slot;
            OUT_READING, LMW_READING: begin
                ra_addr = slot;
                rb_addr = j;
            end
            LMW_WRITING: rb_addr = j;
            default: ;
        endcase
    end

    always @(posedge clk) begin
        if (rst) begin
            state <= IDLE;
            j <= 0;
            head <= LAST;
        end else case (state)
            IDLE: if (in_valid) state <= L_LOADING;
            L_LOADING: if (in_valid) begin
                head <= next_head;
                state <= (NORMALISED != 0) ? LL_READING : OUT_READING;
            end else state <= IDLE;
            LL_READING, OUT_READING: begin
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                if (last_j) state <= (state == LL_READING) ? LL_WRITING : OUT_WRITING;
            end
            LL_WRITING: state <= OUT_READING;
            OUT_WRITING: state <= ERR;
            ERR: state <= GAIN;
            GAIN: state <= LMW_READING;
            LMW_READING: state <= LMW_WRITING;
            LMW_WRITING: begin
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                if (!last_j) state <= LMW_READING;
                else state <= in_valid ? L_LOADING : IDLE;
            end
            default: state <= IDLE;
        endcase
    end
endmodule
