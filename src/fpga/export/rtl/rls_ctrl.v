// Control machine of the RLS pipeline: states, counters, memory addresses and write enables.
// Synthesizable; keeps no data, so the datapath can be replaced around it.
// Clocks per sample back to back: 4 + 6P + 5P^2. One more after Idle.
`timescale 1ns/1ps

module rls_ctrl #(
    parameter P  = 4,                                   // taps, 1 to 64
    parameter CW = (P > 1) ? $clog2(P) : 1,             // counter width
    parameter AW = $clog2(2 * P),                       // RAMA address width
    parameter BW = $clog2(2 * P + P * P)                // RAMB address width
) (
    input  wire          clk,
    input  wire          rst,                           // synchronous
    input  wire          in_valid,                      // hold until in_ready
    output wire          in_ready,
    output wire          out_valid,
    output reg  [3:0]    state,
    output reg  [1:0]    ph,                            // phase within an element or a tap
    output reg  [CW-1:0] i,
    output reg  [CW-1:0] j,
    output reg  [CW-1:0] head,                          // slot of the newest L
    output reg  [AW-1:0] ra_addr,
    output wire          ra_we,
    output reg  [BW-1:0] rb_addr,
    output wire          rb_we
);
    localparam [3:0] IDLE = 0, RIL_LOADING = 1, RIL_READING = 2, RIL_WRITING = 3,
                     LRL_READING = 4, LRL_WRITING = 5, RFR_READING = 6, RFR_WRITING = 7,
                     RFM_READING = 8, RFM_WRITING = 9, OUT_READING = 10, OUT_WRITING = 11,
                     RFW_READING = 12, RFW_WRITING = 13;
    localparam [CW-1:0] LAST = P - 1;

    reg [BW-1:0] n;                                     // element of R: i*P + j
    wire last_i = (i == LAST);
    wire last_j = (j == LAST);
    wire [CW-1:0] next_head = (head == LAST) ? {CW{1'b0}} : head + 1'b1;

    // Slot of tap j: (head - j) mod P.
    wire [CW:0] difference = {1'b0, head} - {1'b0, j};
    wire [CW:0] wrapped = difference + P;
    wire [CW-1:0] slot = difference[CW] ? wrapped[CW-1:0] : difference[CW-1:0];

    assign in_ready = (state == RIL_LOADING) && in_valid;
    assign out_valid = (state == RFW_READING) && (ph == 0);
    assign ra_we = in_ready || (state == RIL_WRITING) || (state == RFM_WRITING);
    assign rb_we = (state == RIL_WRITING) || (state == RFR_WRITING) || (state == RFW_WRITING);

    always @* begin
        ra_addr = 0;
        rb_addr = 0;
        case (state)
            RIL_LOADING: if (in_valid) ra_addr = next_head;
            RIL_READING, RFM_READING: begin
                ra_addr = slot;
                rb_addr = 2 * P + n;
            end
            RIL_WRITING: begin
                ra_addr = P + i;
                rb_addr = P + i;
            end
            LRL_READING: begin
                ra_addr = slot;
                rb_addr = P + j;
            end
            RFR_READING: begin
                if (ph == 0) ra_addr = P + i;
                rb_addr = (ph == 0) ? P + j : 2 * P + n;
            end
            RFR_WRITING: rb_addr = 2 * P + n;
            RFM_WRITING: ra_addr = P + i;
            OUT_READING: begin
                ra_addr = slot;
                rb_addr = j;
            end
            RFW_READING: if (ph != 0) begin
                ra_addr = P + i;
                rb_addr = i;
            end
            RFW_WRITING: rb_addr = i;
            default: ;
        endcase
    end

    always @(posedge clk) begin
        if (rst) begin
            state <= IDLE;
            ph <= 0;
            i <= 0;
            j <= 0;
            n <= 0;
            head <= LAST;
        end else case (state)
            IDLE: if (in_valid) state <= RIL_LOADING;
            RIL_LOADING: if (in_valid) begin
                head <= next_head;
                state <= RIL_READING;
            end else state <= IDLE;
            RIL_READING, RFM_READING: begin
                n <= n + 1'b1;
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                if (last_j) state <= (state == RIL_READING) ? RIL_WRITING : RFM_WRITING;
            end
            RIL_WRITING: begin
                i <= last_i ? {CW{1'b0}} : i + 1'b1;
                if (last_i) n <= 0;
                state <= last_i ? LRL_READING : RIL_READING;
            end
            LRL_READING: begin
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                if (last_j) state <= LRL_WRITING;
            end
            LRL_WRITING: state <= RFR_READING;
            RFR_READING: begin
                ph <= ph + 1'b1;
                if (ph != 0) state <= RFR_WRITING;
            end
            RFR_WRITING: begin
                ph <= 0;
                n <= n + 1'b1;
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                state <= RFR_READING;
                if (last_j) begin
                    i <= last_i ? {CW{1'b0}} : i + 1'b1;
                    if (last_i) begin
                        n <= 0;
                        state <= RFM_READING;
                    end
                end
            end
            RFM_WRITING: begin
                i <= last_i ? {CW{1'b0}} : i + 1'b1;
                if (last_i) n <= 0;
                state <= last_i ? OUT_READING : RFM_READING;
            end
            OUT_READING: begin
                j <= last_j ? {CW{1'b0}} : j + 1'b1;
                if (last_j) state <= OUT_WRITING;
            end
            OUT_WRITING: state <= RFW_READING;
            RFW_READING: begin
                ph <= ph + 1'b1;
                if (ph != 0) state <= RFW_WRITING;
            end
            RFW_WRITING: begin
                ph <= last_i ? 2'd0 : 2'd1;
                i <= last_i ? {CW{1'b0}} : i + 1'b1;
                if (!last_i) state <= RFW_READING;
                else state <= in_valid ? RIL_LOADING : IDLE;
            end
            default: state <= IDLE;
        endcase
    end
endmodule
