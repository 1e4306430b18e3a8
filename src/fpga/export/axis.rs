//! The AXI4-Stream ports of an export, around the top level of any kind.

/// Handshakes and flags, and their testbench: the same for every filter.
pub(super) const SOURCES: [(&str, &str); 2] = [
    ("axi_stream.v", include_str!("rtl/axi_stream.v")),
    ("axis_bench.v", include_str!("rtl/axis_bench.v")),
];

/// What the stream ports must know of a top level.
#[derive(Clone, Copy, Debug)]
pub(super) struct StreamPorts<'a> {
    /// Name of the kind.
    pub(super) kind: &'a str,
    /// Bits of a sample and of a result.
    pub(super) bits: [u32; 2],
    /// Clocks of adder, multiplier and divider.
    pub(super) latencies: [u64; 3],
}

impl StreamPorts<'_> {
    /// File of the ports.
    pub(super) fn file(&self) -> String {
        format!("{}_axis.v", self.kind)
    }

    /// Verilog of the ports.
    pub(super) fn verilog(&self) -> String {
        let [sample, result] = self.bits;
        let [add, mul, div] = self.latencies;
        // A stream has whole bytes.
        let last_of_bytes = |bits: u32| bits.div_ceil(8) * 8 - 1;
        MODULE
            .replace("{kind}", self.kind)
            .replace("{sample}", &sample.to_string())
            .replace("{result}", &result.to_string())
            .replace("{sample_last}", &(sample - 1).to_string())
            .replace("{result_last}", &(result - 1).to_string())
            .replace("{s_last}", &last_of_bytes(sample).to_string())
            .replace("{m_last}", &last_of_bytes(result).to_string())
            .replace("{add}", &add.to_string())
            .replace("{mul}", &mul.to_string())
            .replace("{div}", &div.to_string())
    }
}

/// The module; words in braces stand for what the kind says.
const MODULE: &str =
    "// The exported filter with AXI4-Stream ports; axi_stream.v states handshakes and flags.
//
// One clock, aclk; one reset, aresetn, active low and synchronous, which may come in any clock.
// Everything that comes in has to be synchronous to aclk.
`default_nettype none

module {kind}_axis #(
    parameter ADD_LATENCY = {add},      // clocks of the adder
    parameter MUL_LATENCY = {mul},      // clocks of the multiplier
    parameter DIV_LATENCY = {div}       // clocks of the divider
) (
    input  wire        aclk,
    input  wire        aresetn,
    input  wire        s_axis_tvalid,
    output wire        s_axis_tready,
    input  wire [{s_last}:0] s_axis_tdata,   // sample of {kind}_top: {sample} bits
    output wire        m_axis_tvalid,
    input  wire        m_axis_tready,
    output wire [{m_last}:0] m_axis_tdata,   // result of {kind}_top: {result} bits, sign-extended
    input  wire        flags_clear,
    output wire        flag_overrun,
    output wire        flag_nan,
    output wire        flag_overflow,
    output wire        flag_indefinite
);
    wire        rst = ~aresetn;
    wire        sample_valid, sample_ready, result_valid, nan, overflow, indefinite;
    wire [{sample_last}:0] sample;
    wire [{result_last}:0] result;

    axi_stream #(.SB({sample}), .RB({result})) ports (
        .aclk(aclk), .aresetn(aresetn),
        .s_axis_tvalid(s_axis_tvalid), .s_axis_tready(s_axis_tready), .s_axis_tdata(s_axis_tdata),
        .m_axis_tvalid(m_axis_tvalid), .m_axis_tready(m_axis_tready), .m_axis_tdata(m_axis_tdata),
        .sample_valid(sample_valid), .sample_ready(sample_ready), .sample(sample),
        .result_valid(result_valid), .result(result),
        .nan(nan), .overflow(overflow), .indefinite(indefinite),
        .flags_clear(flags_clear), .flag_overrun(flag_overrun), .flag_nan(flag_nan),
        .flag_overflow(flag_overflow), .flag_indefinite(flag_indefinite));

    {kind}_top #(
        .ADD_LATENCY(ADD_LATENCY), .MUL_LATENCY(MUL_LATENCY), .DIV_LATENCY(DIV_LATENCY)
    ) top (
        .clk(aclk), .rst(rst),
        .sample_valid(sample_valid), .sample_ready(sample_ready), .sample(sample),
        .result_valid(result_valid), .result(result),
        .nan(nan), .overflow(overflow), .indefinite(indefinite));
endmodule

`default_nettype wire
";
