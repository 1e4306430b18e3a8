//! The parameter files of a fixed-point export.

use std::fmt::Write as _;

use super::fixed::FixedExport;
use super::params::{clock_ps, unit_latencies};
use crate::fpga::fixed::{FixedPipeline, Format, fixed_board_usage, fixed_clearing_clocks};
use crate::vocabulary::{OutputRegister, Overflow, Rounding};

/// Verilog macros of the testbenches; the core's parameters all in one.
pub(super) fn fixed_macros(export: &FixedExport, rows: usize) -> String {
    let pipeline = export.config.as_pipeline();
    let kind = pipeline.kind();
    let upper = kind.name.to_uppercase();
    let mut text = format!("// Parameters of this export.\n`define VEC_{upper}\n");
    let mut define = |name: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "`define VEC_{name} {value}");
    };
    let words = pipeline.clocked().memories().map(<[i64]>::len);
    define("BENCH", &format!("tb_{}", kind.name));
    define("CORE_MODULE", &format!("{}_core", kind.name));
    define("CONTROL", kind.control);
    define("KIND_NAME", &format!("\"{}\"", kind.name));
    define("TAPS", &pipeline.tap_count().to_string());
    let [a_bits, b_bits] = pipeline.memory_bits();
    define("MA", &a_bits.to_string());
    define("MB", &b_bits.to_string());
    define("A_WORDS", &words[0].to_string());
    define("WORDS", &(words[0] + words[1]).to_string());
    define("CLEAR", &(kind.states.len() - 1).to_string());
    define("CLEAR_CLOCKS", &fixed_clearing_clocks(pipeline).to_string());
    define("DIVISIONS", &pipeline.divisions().to_string());
    let formats = pipeline.tap_formats();
    for (name, format) in [
        ("WX", formats.input),
        ("WD", formats.desired),
        ("WY", formats.output),
    ] {
        define(name, &format.width().to_string());
    }
    if kind.has_gain_registers {
        define("GAIN_REGISTERS", "1");
    }
    define("WIDTH", "64");
    define("SAMPLES", &export.samples.len().to_string());
    define("TRACE_CLOCKS", &rows.to_string());
    define("PERIOD", &pipeline.clocks_per_sample().to_string());
    define("LATENCY", &pipeline.latency_clocks().to_string());
    define("CLOCK_PS", &clock_ps(export.clock_mhz).to_string());
    define("CORE", &core_parameters(export));
    let board = fixed_board_usage(pipeline);
    let is_late = export.output_register == OutputRegister::NextSample;
    define("TOP", &format!("{}_top", kind.name));
    define("AXIS", &format!("{}_axis", kind.name));
    let names = ["AXIS_OVERFLOW_AT", "AXIS_INDEFINITE_AT"];
    for (name, at) in names.into_iter().zip(export.first_faults()) {
        define(name, &at.map_or("-1".to_owned(), |at| at.to_string()));
    }
    define("TOP_CODE", "0");
    define("TOP_NEXT", &u8::from(is_late).to_string());
    define("TOP_FRONT", &board.front_end_clocks.to_string());
    define("TOP_PERIOD", &board.clocks_per_sample.to_string());
    define("TOP_SAMPLE_BITS", &formats.desired.width().to_string());
    define("TOP_RESULT_BITS", &formats.output.width().to_string());
    text.push_str(&unit_macros(pipeline));
    text
}

/// Macros of the units: whether R is multiplied by 1/alpha, and in steps of its own; latencies, over which those
/// given to run.sh win.
fn unit_macros(pipeline: &dyn FixedPipeline) -> String {
    let mut text = String::new();
    let core = pipeline.parameters().core;
    let scales = core
        .iter()
        .any(|(name, value)| *name == "SCALES" && value == "1");
    for (name, holds) in [("SPLIT", pipeline.splits()), ("SCALES", scales)] {
        if holds {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "`define VEC_{name} 1");
        }
    }
    if pipeline.units().wait() {
        for (name, clocks) in unit_latencies(pipeline.units()) {
            let _ = writeln!(
                text,
                "`ifndef VEC_{name}\n`define VEC_{name} {clocks}\n`endif"
            );
        }
    }
    text
}

/// Parameters of the core as its instance names them.
pub(super) fn core_parameters(export: &FixedExport) -> String {
    let pipeline = export.config.as_pipeline();
    let taps = pipeline.tap_count();
    let mut core = format!(".{}({taps})", pipeline.kind().tap_parameter);
    for signal in pipeline.signals() {
        let (letter, is_rounded) = (signal.name.letter(), signal.name.is_rounded());
        core.push_str(", ");
        core.push_str(&format_parameters(signal.format, letter, is_rounded));
    }
    for (name, value) in pipeline.parameters().core {
        // Writing to a string cannot fail.
        let _ = write!(core, ", .{name}({value})");
    }
    core
}

/// Parameters of one signal.
pub(super) fn format_parameters(format: Format, letter: char, is_rounded: bool) -> String {
    let mut text = format!(
        ".W{letter}({}), .N{letter}({})",
        format.width(),
        format.fraction_bits
    );
    if is_rounded {
        let rounding = match format.rounding {
            Rounding::Truncate => 0,
            Rounding::HalfUp => 1,
            Rounding::NearestEven => 2,
        };
        let saturates = u8::from(format.overflow == Overflow::Saturate);
        let _ = write!(text, ", .R{letter}({rounding}), .S{letter}({saturates})");
    }
    text
}

/// Parameters for people and programs: formats, constants with their codes, clocks.
pub(super) fn fixed_json(export: &FixedExport, rows: usize) -> String {
    let pipeline = export.config.as_pipeline();
    let kind = pipeline.kind();
    let signals = pipeline.signals().into_iter();
    let formats: Vec<String> = signals
        .map(|signal| {
            let format = signal.format;
            format!(
                "    \"{}\": {{ \"integer_bits\": {}, \"fraction_bits\": {}, \"rounding\": \"{}\", \
                 \"overflow\": \"{}\" }}",
                signal.name.name(),
                format.integer_bits,
                format.fraction_bits,
                format.rounding,
                format.overflow
            )
        })
        .collect();
    let board = fixed_board_usage(pipeline);
    let taps = kind.tap_parameter.to_lowercase();
    let mut fields: Vec<(&str, String)> = vec![
        ("filter", format!("\"{}\"", kind.name)),
        ("format", "\"fixed\"".to_owned()),
        (&taps, pipeline.tap_count().to_string()),
        ("formats", format!("{{\n{}\n  }}", formats.join(",\n"))),
        ("full_scale", format!("\"{}\"", export.full_scale)),
    ];
    fields.extend(pipeline.parameters().constants);
    fields.extend([
        ("desired", format!("\"{}\"", export.desired)),
        ("input_lag_samples", export.input_lag_samples.to_string()),
        ("output_register", format!("\"{}\"", export.output_register)),
        ("clock_mhz", export.clock_mhz.to_string()),
        (
            "clocks_per_sample",
            pipeline.clocks_per_sample().to_string(),
        ),
        ("latency_clocks", pipeline.latency_clocks().to_string()),
        ("front_end_clocks", board.front_end_clocks.to_string()),
        (
            "system_clocks_per_sample",
            board.clocks_per_sample.to_string(),
        ),
        ("samples", export.samples.len().to_string()),
        ("trace_clocks", rows.to_string()),
    ]);
    let lines: Vec<String> = fields
        .iter()
        .map(|(name, value)| format!("  \"{name}\": {value}"))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}
