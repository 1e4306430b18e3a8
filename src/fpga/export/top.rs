//! The top level of an export: the filter with the exported constants and its front end.

use std::fmt::Write as _;

use super::params::{macro_value, unit_latencies};
use super::vectors::{ExportSettings, TopLevel};
use crate::fpga::board::Surroundings;
use crate::fpga::float_unit::Fp;
use crate::fpga::trace::hex;
use crate::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

/// File of the samples that a top level takes as words.
pub(super) const TOP_SAMPLES: &str = "samples.hex";

/// Head of the file of a top level.
pub(super) const TOP_HEAD: &str =
    "// The exported filter with its front end: every constant is that of params.json.
//
// A sample is taken in a clock in which sample_valid and sample_ready are both up; hold both
// sample and sample_valid until then. result is right from the clock with result_valid on.
// Reset is synchronous and may come in any clock; sample_ready may be up while the core still
// clears its memories, and the sample waits. Samples that come while sample_ready is low are
// lost unless they are held.
`default_nettype none

";

/// Samples of a top level that takes words; none if it takes codes, which have a file already.
pub(super) fn top_samples<F: Fp>(top: &TopLevel<F>) -> Option<String> {
    if top.surroundings.scale.is_some() {
        return None;
    }
    let lines = top.samples.iter().map(|word| hex(*word) + "\n");
    Some(lines.collect())
}

/// Verilog of the top level.
pub(super) fn top_verilog<F: Fp>(settings: &ExportSettings<F>, around: &Surroundings) -> String {
    let pipeline = settings.pipeline.as_pipeline();
    let kind = pipeline.kind();
    let name = kind.name;
    let width = F::WIDTH;
    let forms_mean = around.desired == DesiredSignal::TwoSampleMean;
    let bits = around.sample_bits::<F>();
    let (sample, unit) = match &around.scale {
        Some(scale) => (
            format!("two's complement, {:e} {} each", scale.lsb, scale.unit),
            scale.word_unit.as_str(),
        ),
        None => ("word".to_owned(), "the unit of the samples"),
    };
    let scale = around.scale.as_ref();
    let constant = |value: Option<f64>| {
        let bits = value.unwrap_or(1.0).to_bits();
        format!("64'h{bits:016x}")
    };
    let core = core_parameters(settings);
    let flushes = u8::from(F::FLUSHES_SUBNORMALS);
    let [(_, add), (_, mul), (_, div)] = unit_latencies(pipeline.units());
    let waits = latencies_of_core(kind.sources[1].1);
    let fraction = if width == 64 { 52 } else { 23 };
    let register = output_register(around.output_register, width);
    format!(
        "{TOP_HEAD}module {name}_top #(\n    parameter ADD_LATENCY = {add},      // clocks of the adder\n    \
         parameter MUL_LATENCY = {mul},      // clocks of the multiplier\n    \
         parameter DIV_LATENCY = {div}       // clocks of the divider\n) (\n    \
         input  wire        clk,\n    input  wire        rst,\n    \
         input  wire        sample_valid,\n    output wire        sample_ready,\n    \
         input  wire [{}:0] sample,         // {sample}\n    \
         output wire        result_valid,   // one clock\n    \
         output wire [{}:0] result,         // {}, {unit}\n    \
         output wire        nan,            // one clock each: the new y is a NaN,\n    \
         output wire        overflow,       // or infinite;\n    \
         output wire        indefinite      // its denominator is a NaN or not above zero\n);\n    \
         wire        pair_valid, pair_ready, core_valid;\n    \
         wire [{}:0] x, d, y;\n\n    \
         front_end #(\n        .W({width}), .CODE({}), .LSB({}), .FACTOR({}),\n        \
         .LAG({}), .MEAN({}), .FTZ({flushes}),\n        \
         .ADD_LATENCY(ADD_LATENCY), .MUL_LATENCY(MUL_LATENCY)\n    ) front (\n        \
         .clk(clk), .rst(rst), .valid(sample_valid), .ready(sample_ready), .sample(sample),\n        \
         .pair_valid(pair_valid), .pair_ready(pair_ready), .x(x), .d(d));\n\n    \
         {name}_core #(\n        {core},\n        .FTZ({flushes}), {waits}.DIV_LATENCY(DIV_LATENCY)\n    ) core (\n        \
         .clk(clk), .rst(rst), .in_valid(pair_valid), .in_ready(pair_ready), .x(x), .d(d),\n        \
         .out_valid(core_valid), .y(y), .indefinite(indefinite));\n\n    \
         wire no_number = &y[{}:{fraction}];\n    wire no_fraction = ~|y[{}:0];\n    \
         assign nan      = core_valid & no_number & ~no_fraction;\n    \
         assign overflow = core_valid & no_number & no_fraction;\n\n{register}endmodule\n\n`default_nettype wire\n",
        bits - 1,
        width - 1,
        F::NAME,
        width - 1,
        u8::from(scale.is_some()),
        constant(scale.map(|scale| scale.lsb)),
        constant(scale.map(|scale| scale.factor)),
        around.input_lag_samples,
        u8::from(forms_mean),
        width - 2,
        fraction - 1,
    )
}

/// Parameters of the core that its settings give.
fn core_parameters<F: Fp>(settings: &ExportSettings<F>) -> String {
    let pipeline = settings.pipeline.as_pipeline();
    let kind = pipeline.kind();
    let (taps, width) = (pipeline.tap_count(), F::WIDTH);
    let mut core = format!(".{}({taps}), .W({width})", kind.tap_parameter);
    for (own, value) in pipeline.parameters().macros {
        let _ = write!(core, ",\n        .{own}({})", macro_value(value));
    }
    // The line enhancer has one sign only.
    if kind.sources[1].1.contains(" UPDATE_SUB ") {
        let subtracts = pipeline.update_sign() == UpdateSign::AsPrinted;
        let _ = write!(core, ",\n        .UPDATE_SUB({})", u8::from(subtracts));
    }
    core
}

/// Verilog of the output register.
pub(super) fn output_register(register: OutputRegister, width: u32) -> String {
    match register {
        OutputRegister::NextSample => RESULT_AT_NEXT
            .replace("WIDTH-1", &(width - 1).to_string())
            .replace("WIDTH", &width.to_string()),
        OutputRegister::Immediate => RESULT_AT_ONCE.to_owned(),
    }
}

/// Latencies that the Verilog of a core takes beside its divider's.
pub(super) fn latencies_of_core(core: &str) -> &'static str {
    if core.contains(" ADD_LATENCY ") {
        ".ADD_LATENCY(ADD_LATENCY), .MUL_LATENCY(MUL_LATENCY),\n        "
    } else {
        ""
    }
}

/// Output register of [`OutputRegister::Immediate`]: the core's own.
const RESULT_AT_ONCE: &str = "    assign result_valid = core_valid;\n    assign result = y;\n";

/// Output register of [`OutputRegister::NextSample`].
const RESULT_AT_NEXT: &str =
    "    // The result of a sample appears when the core takes the next one: y is right by then.
    reg             late_valid;
    reg [WIDTH-1:0] late;
    always @(posedge clk)
        if (rst) begin
            late_valid <= 1'b0;
            late       <= {WIDTH{1'b0}};
        end else begin
            late_valid <= pair_valid & pair_ready;
            if (pair_valid & pair_ready) late <= y;
        end
    assign result_valid = late_valid;
    assign result       = late;
    /* verilator lint_off UNUSED */
    wire unused = core_valid;
    /* verilator lint_on UNUSED */
";
