//! The parameter files of a fixed-point export.

use std::fmt::Write as _;

use super::fixed::FixedExport;
use super::params::clock_ps;
use crate::fpga::fixed::{
    Format, fixed_board_usage, fixed_rls_clocks_per_sample, fixed_rls_latency_clocks,
};
use crate::vocabulary::{OutputRegister, Overflow, Rounding};

/// Letter of each signal in the names of the core's parameters.
const LETTERS: [char; 8] = ['X', 'D', 'T', 'N', 'K', 'R', 'W', 'Y'];

/// Verilog macros of the testbenches; the core's parameters all in one.
pub(super) fn fixed_macros(export: &FixedExport, rows: usize) -> String {
    let mut text = "// Parameters of this export.\n`define VEC_RLS_FIXED\n".to_owned();
    let mut define = |name: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "`define VEC_{name} {value}");
    };
    let config = &export.config;
    let p = config.tap_count();
    let formats = config.formats().named();
    define("TAPS", &p.to_string());
    define("MW", &widest(export).to_string());
    for ((_, format), letter) in formats.iter().zip(LETTERS) {
        define(&format!("W{letter}"), &format.width().to_string());
    }
    define("WIDTH", "64");
    define("SAMPLES", &export.samples.len().to_string());
    define("TRACE_CLOCKS", &rows.to_string());
    define("PERIOD", &fixed_rls_clocks_per_sample(p).to_string());
    define("LATENCY", &fixed_rls_latency_clocks(p).to_string());
    define("CLOCK_PS", &clock_ps(export.clock_mhz).to_string());
    define("CORE", &core_parameters(export));
    let board = fixed_board_usage(*config);
    let is_late = export.output_register == OutputRegister::NextSample;
    define("TOP", "rls_fixed_top");
    define("TOP_CODE", "0");
    define("TOP_NEXT", &u8::from(is_late).to_string());
    define("TOP_FRONT", &board.front_end_clocks.to_string());
    define("TOP_PERIOD", &board.clocks_per_sample.to_string());
    let formats = config.formats();
    define("TOP_SAMPLE_BITS", &formats.desired.width().to_string());
    define("TOP_RESULT_BITS", &formats.output.width().to_string());
    text
}

/// Bits of a memory's word.
fn widest(export: &FixedExport) -> u32 {
    let formats = export.config.formats().named();
    let widths = formats.iter().map(|(_, format)| format.width());
    widths.max().unwrap_or(0)
}

/// Parameters of the core as its instance names them.
pub(super) fn core_parameters(export: &FixedExport) -> String {
    let config = &export.config;
    let mut core = format!(".P({}), .MW({})", config.tap_count(), widest(export));
    for ((_, format), letter) in config.formats().named().iter().zip(LETTERS) {
        // Nothing is rounded into the input's words.
        let is_rounded = letter != 'X' && letter != 'D';
        core.push_str(", ");
        core.push_str(&format_parameters(*format, letter, is_rounded));
    }
    let (factor, factor_bits) = config.inverse_alpha().unwrap_or((0, 0));
    let _ = write!(
        core,
        ", .ALPHA(128'sh{:032x}), .SCALES({}), .IALPHA(64'sh{factor:016x}), .NI({factor_bits}), \
         .DELTA(64'sh{:016x}), .FLOOR(64'sh{:016x})",
        config.alpha(),
        u8::from(factor != 0),
        config.delta(),
        config.floor()
    );
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
    let config = &export.config;
    let p = config.tap_count();
    let named = config.formats().named();
    let formats: Vec<String> = named
        .iter()
        .map(|(name, format)| {
            format!(
                "    \"{name}\": {{ \"integer_bits\": {}, \"fraction_bits\": {}, \"rounding\": \"{}\", \
                 \"overflow\": \"{}\" }}",
                format.integer_bits, format.fraction_bits, format.rounding, format.overflow
            )
        })
        .collect();
    let board = fixed_board_usage(*config);
    let (factor, factor_bits) = config.inverse_alpha().map_or_else(
        || ("null".to_owned(), "null".to_owned()),
        |(code, bits)| (code.to_string(), bits.to_string()),
    );
    let fields: Vec<(&str, String)> = vec![
        ("filter", "\"rls_fixed\"".to_owned()),
        ("format", "\"fixed\"".to_owned()),
        ("p", p.to_string()),
        ("formats", format!("{{\n{}\n  }}", formats.join(",\n"))),
        ("full_scale", format!("\"{}\"", export.full_scale)),
        ("alpha_code", config.alpha().to_string()),
        (
            "alpha_fraction_bits",
            config.alpha_fraction_bits().to_string(),
        ),
        ("inverse_alpha_code", factor),
        ("inverse_alpha_fraction_bits", factor_bits),
        ("delta_code", config.delta().to_string()),
        ("floor_code", config.floor().to_string()),
        ("desired", format!("\"{}\"", export.desired)),
        ("input_lag_samples", export.input_lag_samples.to_string()),
        ("output_register", format!("\"{}\"", export.output_register)),
        ("clock_mhz", export.clock_mhz.to_string()),
        (
            "clocks_per_sample",
            fixed_rls_clocks_per_sample(p).to_string(),
        ),
        ("latency_clocks", fixed_rls_latency_clocks(p).to_string()),
        ("front_end_clocks", board.front_end_clocks.to_string()),
        (
            "system_clocks_per_sample",
            board.clocks_per_sample.to_string(),
        ),
        ("samples", export.samples.len().to_string()),
        ("trace_clocks", rows.to_string()),
    ];
    let lines: Vec<String> = fields
        .iter()
        .map(|(name, value)| format!("  \"{name}\": {value}"))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}
