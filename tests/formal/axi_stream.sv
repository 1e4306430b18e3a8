// Properties of the stream ports, for any source, any sink and a filter that takes any time.
//
// The filter is what the head of axi_stream.v asks of it: it takes a sample where sample_valid and
// sample_ready are both up, gives one result for each in their order, and holds its newest result until the
// next. Words are numbers in order, so that a lost or doubled one shows as a wrong number.
module axi_stream_properties #(
    parameter B = 4                     // bits of a word
) (
    input wire         aclk,
    input wire         aresetn,
    input wire         s_axis_tvalid,
    input wire [B-1:0] s_axis_tdata,
    input wire         m_axis_tready,
    input wire         sample_ready,
    input wire         finishes,        // the filter gives its next result, if a sample is under way
    input wire         nan,
    input wire         overflow,
    input wire         indefinite,
    input wire         flags_clear
);
    wire         s_axis_tready, m_axis_tvalid, sample_valid;
    wire [7:0]   s_tdata = {{(8-B){1'b0}}, s_axis_tdata};
    wire [7:0]   m_axis_tdata;
    wire [B-1:0] sample;
    wire         flag_overrun, flag_nan, flag_overflow, flag_indefinite;

    // Registers of the ports, connected by name: what an induction has to know of them.
    wire [1:0]   dut_due, dut_held;
    wire         dut_waited;
    wire [B-1:0] dut_waiting;

    // Samples that the filter took, results that it gave, results that the sink took.
    reg [B-1:0] taken, produced, given;
    wire        result_valid = finishes & (produced != taken);
    wire [B-1:0] result = result_valid ? produced : produced - 1'b1;

    axi_stream #(.SB(B), .RB(B)) dut (
        .aclk(aclk), .aresetn(aresetn),
        .s_axis_tvalid(s_axis_tvalid), .s_axis_tready(s_axis_tready), .s_axis_tdata(s_tdata),
        .m_axis_tvalid(m_axis_tvalid), .m_axis_tready(m_axis_tready), .m_axis_tdata(m_axis_tdata),
        .sample_valid(sample_valid), .sample_ready(sample_ready), .sample(sample),
        .result_valid(result_valid), .result(result),
        .nan(nan), .overflow(overflow), .indefinite(indefinite),
        .flags_clear(flags_clear), .flag_overrun(flag_overrun), .flag_nan(flag_nan),
        .flag_overflow(flag_overflow), .flag_indefinite(flag_indefinite));

    always @(posedge aclk)
        if (!aresetn) begin
            taken    <= {B{1'b0}};
            produced <= {B{1'b0}};
            given    <= {B{1'b0}};
        end else begin
            taken    <= taken + {{(B-1){1'b0}}, sample_valid & sample_ready};
            produced <= produced + {{(B-1){1'b0}}, result_valid};
            given    <= given + {{(B-1){1'b0}}, m_axis_tvalid & m_axis_tready};
        end

    wire [B-1:0] under_way = taken - given;
    wire [B-1:0] waiting   = produced - given;

    // The clock before, and whether there was one; the first clock is one of a reset.
    reg         before;
    reg         b_resetn, b_s_waits, b_m_waits, b_lost, b_flags, b_clear;
    reg [B-1:0] b_word;
    reg [7:0]   b_data;
    reg [3:0]   b_up, b_events;
    wire        lost = b_s_waits & (~s_axis_tvalid | (s_axis_tdata != b_word));
    initial before = 1'b0;
    always @(posedge aclk) begin
        before    <= 1'b1;
        b_resetn  <= aresetn;
        b_s_waits <= aresetn & s_axis_tvalid & ~s_axis_tready;
        b_word    <= s_axis_tdata;
        b_m_waits <= aresetn & m_axis_tvalid & ~m_axis_tready;
        b_data    <= m_axis_tdata;
        b_clear   <= flags_clear;
        b_up      <= {flag_overrun, flag_nan, flag_overflow, flag_indefinite};
        b_events  <= {lost, nan, overflow, indefinite};
    end

    always @* begin
        if (!before) assume (!aresetn);
        if (before) begin
            // A word that the source sees taken goes to the filter, in that clock and no other.
            source_is_filter: assert ((s_axis_tvalid & s_axis_tready) == (sample_valid & sample_ready));
            word_is_sample: assert (!sample_valid || sample == s_axis_tdata);
            not_in_reset: assert (aresetn || !s_axis_tready);
            // One at the port, one in the filter.
            at_most_two: assert (under_way <= 2);
            // The sink is offered a word as long as one waits, and each in its turn.
            none_lost: assert (m_axis_tvalid == (waiting != 0));
            in_order: assert (!m_axis_tvalid || m_axis_tdata == {{(8-B){given[B-1]}}, given});
            // Follows from the two above a clock later; an induction has to be told.
            assert (waiting <= under_way);
            held_counts: assert (dut_held == waiting[1:0] && dut_due == under_way[1:0]);
            if (b_m_waits && aresetn && b_resetn)
                waits: assert (m_axis_tvalid && m_axis_tdata == b_data);
            // Flags: of the clock before, up until they are cleared.
            flags: assert ({flag_overrun, flag_nan, flag_overflow, flag_indefinite}
                           == (b_resetn ? b_events | (b_clear ? 4'd0 : b_up) : 4'd0));
            memory: assert (dut_waited == b_s_waits && (!b_s_waits || dut_waiting == b_word));
        end
    end

    // What is proved of no run at all would be proved of none: two words wait, and go.
    reg  saw_two;
    always @(posedge aclk) saw_two <= aresetn & (saw_two | (waiting == 2));
    always @* if (before) two_wait_and_go: cover (saw_two && aresetn && given == 3);
endmodule
