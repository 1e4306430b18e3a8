// AXI4-Stream ports of a filter: a word of samples in, a word of results out for each of them.
//
//   s_axis ---->|            |----> sample, sample_valid      to the top level of the filter
//   m_axis <----| axi_stream |<---- result, result_valid      from it
//   flags  <----|            |<---- nan, overflow, indefinite
//
// One clock, aclk, for all of it; one reset, aresetn, active low and synchronous. It may come in any
// clock; the words under way are then gone.
//
// In: a word is taken in a clock in which tvalid and tready are both up. A source that can wait holds
// both tvalid and tdata until then. tready does not depend on tvalid, and on m_axis_tready only through
// registers. Out: tvalid and tdata stay as they are until m_axis_tready is up.
//
// The core cannot be stopped within a sample. A sample is therefore taken only when its result will find
// a place: one here and the output of the top level, so that at most two samples are under way. With a
// sink that is always ready that costs no clock.
//
// A source that cannot wait, as the converter of a gyro, gives each word for one clock (or for as long
// as it likes). If tready is not up in it, the word is lost: then overrun rises, two clocks later. It
// rises whenever a word that was not taken is withdrawn or changed.
//
// Flags stay up until a clock with flags_clear, or a reset; an event in that clock wins.
`default_nettype none

module axi_stream #(
    parameter SB = 32,                      // bits of a sample
    parameter RB = 64,                      // bits of a result
    parameter SD = 8 * ((SB + 7) / 8),      // bits of s_axis_tdata: whole bytes (derived)
    parameter RD = 8 * ((RB + 7) / 8)       // bits of m_axis_tdata (derived)
) (
    input  wire          aclk,
    input  wire          aresetn,
    input  wire          s_axis_tvalid,
    output wire          s_axis_tready,
    /* verilator lint_off UNUSED */
    input  wire [SD-1:0] s_axis_tdata,      // sample in the lower bits, others are not looked at
    /* verilator lint_on UNUSED */
    output wire          m_axis_tvalid,
    input  wire          m_axis_tready,
    output wire [RD-1:0] m_axis_tdata,      // result, sign-extended
    // The top level of the filter.
    output wire          sample_valid,
    input  wire          sample_ready,
    output wire [SB-1:0] sample,
    input  wire          result_valid,
    input  wire [RB-1:0] result,
    input  wire          nan,
    input  wire          overflow,
    input  wire          indefinite,
    // Flags.
    input  wire          flags_clear,
    output reg           flag_overrun,      // a sample was lost
    output reg           flag_nan,          // a filtered word is a NaN
    output reg           flag_overflow,     // one is infinite; fixed point: beyond the ends of a signal
    output reg           flag_indefinite    // a denominator or diagonal element of R is not above zero
);
    reg [1:0] due;          // samples under way: taken, result not given
    reg [1:0] held;         // results that wait
    // The oldest of them. A second one stays in the top level, whose next result is not due before this
    // one is given.
    reg [RB-1:0] oldest;

    wire taken = s_axis_tvalid & s_axis_tready;
    wire given = m_axis_tvalid & m_axis_tready;

    assign s_axis_tready = aresetn & sample_ready & ~due[1];
    assign sample_valid  = s_axis_tvalid & s_axis_tready;
    assign sample        = s_axis_tdata[SB-1:0];
    assign m_axis_tvalid = held != 2'd0;
    generate
        if (RD > RB) begin : extended
            assign m_axis_tdata = {{(RD-RB){oldest[RB-1]}}, oldest};
        end else begin : whole
            assign m_axis_tdata = oldest;
        end
    endgenerate

    always @(posedge aclk)
        if (!aresetn) begin
            due    <= 2'd0;
            held   <= 2'd0;
            oldest <= {RB{1'b0}};
        end else begin
            due  <= due + {1'b0, taken} - {1'b0, given};
            held <= held + {1'b0, result_valid} - {1'b0, given};
            if (given | (held == 2'd0)) oldest <= result;
        end

    // A word that waits for tready must neither go nor change.
    reg          waited;
    reg [SB-1:0] waiting;
    wire lost = waited & (~s_axis_tvalid | (sample != waiting));
    always @(posedge aclk)
        if (!aresetn) begin
            waited  <= 1'b0;
            waiting <= {SB{1'b0}};
        end else begin
            waited  <= s_axis_tvalid & ~s_axis_tready;
            waiting <= sample;
        end

    always @(posedge aclk)
        if (!aresetn) begin
            flag_overrun    <= 1'b0;
            flag_nan        <= 1'b0;
            flag_overflow   <= 1'b0;
            flag_indefinite <= 1'b0;
        end else begin
            flag_overrun    <= lost       | (flag_overrun & ~flags_clear);
            flag_nan        <= nan        | (flag_nan & ~flags_clear);
            flag_overflow   <= overflow   | (flag_overflow & ~flags_clear);
            flag_indefinite <= indefinite | (flag_indefinite & ~flags_clear);
        end
endmodule

`default_nettype wire
