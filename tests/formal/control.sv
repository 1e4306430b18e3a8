// Properties of the control of a core, for any source and for units that withhold their results as they like.
//
// Words are left out: what a memory gives and what a unit computes (free_units.sv) is anything, so that the
// properties hold for all data. core.vh says which core it is, and what to call its states.
`include "core.vh"

module sp_ram #(
    parameter W = 64, parameter DEPTH = 8, parameter AW = $clog2(DEPTH), parameter DIAG_FIRST = 0,
    parameter DIAG_STRIDE = 1, parameter DIAG_COUNT = 0, parameter [W-1:0] DIAG_WORD = {W{1'b0}}
) (
    input  wire          clk, we,
    input  wire [AW-1:0] addr,
    input  wire [W-1:0]  wdata,
    output wire [W-1:0]  rdata
);
    assign rdata = $anyseq;
endmodule

module control_properties (
    input wire               clk,
    input wire               rst,
    input wire               in_valid,
    input wire [`X_BITS-1:0] x,
    input wire [`D_BITS-1:0] d
);
    wire in_ready, out_valid;
    `CORE #(`PARAMETERS) dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .x(x), .d(d), .out_valid(out_valid));

    // Connected by name.
    wire [3:0] state;
    wire       second, ra_we, rb_we;
    wire       waits_a, waits_b, waits_c;       // a unit that is asked for a result withholds it
    wire       waits = waits_a | waits_b | waits_c;

    // A sample is under way from the clock after it was taken to the one with its result.
    reg under_way;
    always @(posedge clk)
        if (rst) under_way <= 1'b0;
        else     under_way <= (under_way & ~out_valid) | (in_valid & in_ready);

    // Clocks without waiting: since the sample was taken, and since the source offers the next.
    reg [7:0] since, offered;
    always @(posedge clk) begin
        if (rst | (in_valid & in_ready)) since <= 8'd1;
        else if (!waits)                 since <= since + 8'd1;
        if (rst | ~in_valid | in_ready)  offered <= 8'd0;
        else if (!waits)                 offered <= offered + 8'd1;
    end

    // The clock before, and whether there was one; the first clock is one of a reset.
    reg       before, b_rst, b_waits;
    reg [3:0] b_state;
    reg       b_second;
    initial before = 1'b0;
    always @(posedge clk) begin
        before   <= 1'b1;
        b_rst    <= rst;
        b_waits  <= waits;
        b_state  <= state;
        b_second <= second;
    end

    always @* begin
        if (!before) assume (rst);
`ifdef BOUNDED
        if (before) assume (!rst);
`endif
`ifdef STATES
        if (before) assume (!rst && !waits);
`endif
        if (before) begin
            state_has_a_name:        assert (`LEGAL);
            result_of_a_sample:      assert (!out_valid || under_way);
            takes_none_before_result: assert (!(in_ready && under_way));
            still_while_a_unit_waits: assert (!(b_waits && !b_rst) || (state == b_state && second == b_second));
            writes_no_unready_word:  assert (!waits || !(ra_we || rb_we));
            // What an induction has to be told: where a sample is under way, and second is up.
            assert (`TOLD);
            under_way_by_state:      assert (under_way == (`UNDER_WAY));
`ifdef BOUNDED
            // Neither of these is the step of an induction: from one reset on, as far as the run goes.
            result_in_its_clock:     assert (!under_way || out_valid == (since == `LATENCY && !(`OUT_WAITS)));
            takes_what_is_offered:   assert (offered <= `PERIOD);
`endif
            // States.
        end
    end
endmodule
