//! The two parameter files of an export: Verilog macros, and JSON for people and programs.

use std::fmt::Write as _;

use super::vectors::{ExportSettings, TopLevel};
use crate::fpga::float_unit::Fp;
use crate::fpga::pipeline::Macro;
use crate::fpga::timing::Units;
use crate::fpga::trace::hex;
use crate::vocabulary::{OutputRegister, UpdateSign};

/// Period of the clock for Verilog, ps: a number without a width has 32 bits.
pub(super) fn clock_ps(clock_mhz: f64) -> u64 {
    (2 * half_period_ps(clock_mhz)).min(2_000_000_000)
}

/// Half a clock period in whole picoseconds, at least one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive finite period; the cast saturates for clocks of absurd length"
)]
pub(super) fn half_period_ps(clock_mhz: f64) -> u64 {
    ((5e5 / clock_mhz).round() as u64).max(1)
}

/// Verilog text of a constant.
pub(super) fn macro_value<F: Fp>(value: Macro<F>) -> String {
    match value {
        Macro::Word(word) => format!("{}'h{}", F::WIDTH, hex(word)),
        Macro::Flag(is_set) => u8::from(is_set).to_string(),
        Macro::Count(count) => count.to_string(),
    }
}

/// Verilog macros for the testbench; `README.txt` beside it states their meaning.
pub(super) fn params_vh<F: Fp>(
    settings: &ExportSettings<F>,
    samples: usize,
    trace_rows: u64,
) -> String {
    let pipeline = settings.pipeline.as_pipeline();
    let flag = |is_set: bool| u8::from(is_set).to_string();
    let filter = pipeline.kind().name.to_uppercase();
    let mut text = format!("// Parameters of this export.\n`define VEC_{filter}\n");
    let mut define = |name: &str, value: String| {
        writeln!(text, "`define VEC_{name} {value}").expect("writing to a string cannot fail");
    };
    define("TAPS", pipeline.tap_count().to_string());
    for (name, own) in pipeline.parameters().macros {
        define(name, macro_value(own));
    }
    let subtracts = pipeline.update_sign() == UpdateSign::AsPrinted;
    define("UPDATE_SUB", flag(subtracts));
    define("WIDTH", F::WIDTH.to_string());
    define("FTZ", flag(F::FLUSHES_SUBNORMALS));
    define("SAMPLES", samples.to_string());
    define("PERIOD", pipeline.clocks_per_sample().to_string());
    define("LATENCY", pipeline.latency_clocks().to_string());
    let waits = pipeline.units().wait();
    if waits {
        let used = pipeline.clocked().usage();
        define("UNITS_PERIOD", used.clocks_per_sample.to_string());
        define("UNITS_LATENCY", used.latency_clocks.to_string());
    }
    define("TRACE_CLOCKS", trace_rows.to_string());
    define("CLOCK_PS", clock_ps(settings.clock_mhz).to_string());
    if let Some(TopLevel {
        surroundings: around,
        ..
    }) = &settings.top
    {
        let clocks = pipeline.clocked().board_usage(around.clone());
        let kind = pipeline.kind().name;
        let is_late = around.output_register == OutputRegister::NextSample;
        define("TOP", format!("{kind}_top"));
        define("AXIS", format!("{kind}_axis"));
        define("TOP_CODE", flag(around.scale.is_some()));
        define("TOP_NEXT", flag(is_late));
        define("TOP_FRONT", clocks.front_end_clocks.to_string());
        define("TOP_PERIOD", clocks.clocks_per_sample.to_string());
    }
    // Latencies given to run.sh win.
    if waits {
        for (name, clocks) in unit_latencies(pipeline.units()) {
            let name = format!("VEC_{name}");
            let _ = writeln!(text, "`ifndef {name}\n`define {name} {clocks}\n`endif");
        }
    }
    text
}

/// Latencies of the units under the names of the cores' parameters.
pub(super) fn unit_latencies(units: Units) -> [(&'static str, u64); 3] {
    [
        ("ADD_LATENCY", units.adder.latency_clocks),
        ("MUL_LATENCY", units.multiplier.latency_clocks),
        ("DIV_LATENCY", units.divider.latency_clocks),
    ]
}

/// Parameters for people and programs: numbers, their bits, and the choices behind the bits.
pub(super) fn params_json<F: Fp>(
    settings: &ExportSettings<F>,
    samples: usize,
    trace_rows: u64,
) -> String {
    let mut fields: Vec<(String, String)> = Vec::new();
    let quote = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
    let mut add = |name: &str, value: String| fields.push((name.to_string(), value));
    let pipeline = settings.pipeline.as_pipeline();
    let own = pipeline.parameters();
    add("filter", quote(pipeline.kind().name));
    add("format", quote(F::NAME));
    add(
        "rounding",
        quote("nearest, ties to even, every operation alone"),
    );
    add("fused_multiply_add", "false".to_string());
    add(
        "subnormals",
        quote(if F::FLUSHES_SUBNORMALS {
            "flushed"
        } else {
            "kept"
        }),
    );
    add("word_bits", F::WIDTH.to_string());
    let prints_sign = usize::from(pipeline.update_sign() == UpdateSign::AsPrinted);
    let flushes = usize::from(F::FLUSHES_SUBNORMALS);
    let shared = [("as_printed", prints_sign), ("ftz", flushes)];
    for (name, value) in own.choices.into_iter().chain(shared) {
        add(name, value.to_string());
    }
    for (name, value) in pipeline.kind().fixed_choices {
        add(name, (*value).to_string());
    }
    for (name, word) in [("one", F::ONE)].into_iter().chain(own.constants) {
        add(name, format!("{:e}", word.to_f64()));
        add(&format!("{name}_bits"), quote(&hex(word)));
    }
    add("front_end", quote(&settings.front_end));
    add("clock_mhz", format!("{}", settings.clock_mhz));
    let used = pipeline.clocked().usage();
    add("clocks_per_sample", used.clocks_per_sample.to_string());
    add("latency_clocks", used.latency_clocks.to_string());
    if pipeline.units().wait() {
        for (name, clocks) in unit_latencies(pipeline.units()) {
            add(&name.to_lowercase(), clocks.to_string());
        }
    }
    add("samples", samples.to_string());
    add("trace_clocks", trace_rows.to_string());
    for (name, value) in board_fields(settings) {
        add(name, value);
    }
    let lines: Vec<String> = fields
        .iter()
        .map(|(name, value)| format!("  \"{name}\": {value}"))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}

/// What stands between the gyro and the core, and what that costs: names and JSON values.
fn board_fields<F: Fp>(settings: &ExportSettings<F>) -> Vec<(&'static str, String)> {
    let quote = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
    let mut fields = Vec::new();
    if let Some(codes) = &settings.codes {
        let scale = &codes.scale;
        fields.extend([
            ("code_lsb", format!("{:e}", scale.lsb)),
            ("code_unit", quote(&scale.unit)),
            ("word_factor", format!("{:e}", scale.factor)),
            ("word_unit", quote(&scale.word_unit)),
        ]);
    }
    if let Some(TopLevel {
        surroundings: around,
        ..
    }) = &settings.top
    {
        let order = match around.scale {
            Some(_) => "(code * code_lsb) * word_factor, each product rounded in binary64",
            None => "the sample is the word",
        };
        let clocked = settings.pipeline.as_pipeline().clocked();
        let clocks = clocked.board_usage(around.clone());
        fields.extend([
            ("top_sample", quote(order)),
            ("input_lag_samples", around.input_lag_samples.to_string()),
            ("desired", quote(around.desired.word())),
            ("output_register", quote(around.output_register.word())),
            ("front_end_clocks", clocks.front_end_clocks.to_string()),
            (
                "system_clocks_per_sample",
                clocks.clocks_per_sample.to_string(),
            ),
        ]);
    }
    fields
}
