//! The top level of a fixed-point export: core and front end with the exported constants.

use super::fixed::FixedExport;
use super::fixed_params::{core_parameters, format_parameters};
use super::params::unit_latencies;
use super::top::{TOP_HEAD, latencies_of_core, output_register};
use crate::fpga::fixed::TapFormats;
use crate::vocabulary::DesiredSignal;

/// Verilog of the top level.
pub(super) fn fixed_top_verilog(export: &FixedExport) -> String {
    let pipeline = export.config.as_pipeline();
    let TapFormats {
        input,
        desired,
        output,
        ..
    } = pipeline.tap_formats();
    let kind = pipeline.kind().name;
    let [(_, add), (_, mul), (_, div)] = unit_latencies(pipeline.units());
    let sources = pipeline.kind().sources;
    let own = sources.iter().map(|(_, text)| latencies_of_core(text));
    let waits = own.max_by_key(|text| text.len()).unwrap_or_default();
    let comment = if waits.is_empty() {
        "    // Adder and multiplier take one clock; a bench of any filter may say so.\n"
    } else {
        ""
    };
    let sample_bits = desired.width() - 1;
    let result_bits = output.width() - 1;
    let means = export.desired == DesiredSignal::TwoSampleMean;
    format!(
        "{TOP_HEAD}module {kind}_top #(\n{comment}    \
         parameter ADD_LATENCY = {add},\n    parameter MUL_LATENCY = {mul},\n    \
         parameter DIV_LATENCY = {div}       // clocks of the divider\n) (\n    \
         input  wire        clk,\n    input  wire        rst,\n    \
         input  wire        sample_valid,\n    output wire        sample_ready,\n    \
         input  wire [{sample_bits}:0] sample,         // Q{}.{} of {}\n    \
         output wire        result_valid,   // one clock\n    \
         output wire [{result_bits}:0] result,         // Q{}.{} of the same\n    \
         output wire        nan,            // never\n    \
         output wire        overflow,       // one clock: a word was beyond the ends of its signal\n    \
         output wire        indefinite      // one clock: a word was not above zero that has to be\n);\n    \
         wire        pair_valid, pair_ready, core_valid, front_overflow, core_overflow;\n    \
         wire [{}:0] x;\n    wire [{sample_bits}:0] d;\n    wire [{result_bits}:0] y;\n\n    \
         fx_front_end #(\n        {},\n        {},\n        .LAG({}), .MEAN({})\n    ) front (\n        \
         .clk(clk), .rst(rst), .valid(sample_valid), .ready(sample_ready), .sample(sample),\n        \
         .pair_valid(pair_valid), .pair_ready(pair_ready), .x(x), .d(d), .overflow(front_overflow));\n\n    \
         {kind}_core #(\n        {},\n        {waits}.DIV_LATENCY(DIV_LATENCY)\n    ) core (\n        \
         .clk(clk), .rst(rst), .in_valid(pair_valid), .in_ready(pair_ready), .x(x), .d(d),\n        \
         .out_valid(core_valid), .y(y), .overflow(core_overflow), .indefinite(indefinite));\n\n    \
         assign nan      = 1'b0;\n    assign overflow = front_overflow | core_overflow;\n\n{}endmodule\n\n`default_nettype wire\n",
        desired.integer_bits,
        desired.fraction_bits,
        export.full_scale,
        output.integer_bits,
        output.fraction_bits,
        input.width() - 1,
        format_parameters(input, 'X', true),
        format_parameters(desired, 'D', true),
        export.input_lag_samples,
        u8::from(means),
        core_parameters(export).replace(", .", ",\n        ."),
        output_register(export.output_register, result_bits + 1),
    )
}
