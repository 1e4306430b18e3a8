//! The two parameter files of an export: Verilog macros, and JSON for people and programs.

use std::fmt::Write as _;

use super::vectors::{ExportSettings, PipelineConfig};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::UpdateSign;
use crate::fpga::lms::DesiredSource;
use crate::fpga::rls::Division;
use crate::fpga::trace::hex;

/// Half a clock period in whole picoseconds, at least one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive finite period; the cast saturates for clocks of absurd length"
)]
pub(super) fn half_period_ps(clock_mhz: f64) -> u64 {
    ((5e5 / clock_mhz).round() as u64).max(1)
}

/// Constants of the parameter file for people: name and word.
fn constants<F: Fp>(pipeline: &PipelineConfig<F>) -> Vec<(&'static str, F)> {
    match pipeline {
        PipelineConfig::Rls(config) => vec![
            ("ONE", F::ONE),
            ("ALPHA", config.alpha()),
            ("IALPHA", config.inverse_alpha()),
            ("DELTA", config.delta()),
        ],
        PipelineConfig::Lms(config) => vec![
            ("ONE", F::ONE),
            ("HALF", F::from_f64(0.5)),
            ("MU", config.step_size()),
            ("EPS", config.regularisation().unwrap_or(F::ZERO)),
        ],
        PipelineConfig::SignLms(config) => vec![
            ("ONE", F::ONE),
            ("MU", config.step()),
            ("ALPHA", config.regularisation()),
            ("W0", config.initial_weight()),
            ("GUARD", config.guard().unwrap_or(F::ZERO)),
        ],
    }
}

/// Settings of the parameter file for people: name and number.
fn choices<F: Fp>(pipeline: &PipelineConfig<F>) -> Vec<(&'static str, usize)> {
    let (mut choices, sign) = match pipeline {
        PipelineConfig::Rls(config) => {
            let element = usize::from(config.division() == Division::Element);
            let choices = vec![("P", config.tap_count()), ("ELEM", element)];
            (choices, config.update_sign())
        }
        PipelineConfig::Lms(config) => {
            let mean = usize::from(config.desired() == DesiredSource::MeanOfTwoNewest);
            let choices = vec![
                ("N", config.tap_count()),
                ("NORMALISED", usize::from(config.is_normalised())),
                ("MEAN", mean),
            ];
            (choices, config.update_sign())
        }
        PipelineConfig::SignLms(config) => {
            let choices = vec![
                ("M", config.tap_count()),
                ("NORMALISED", usize::from(config.is_normalised())),
                ("GUARDED", usize::from(config.guard().is_some())),
                ("GUARD_HOLD_SAMPLES", config.hold_samples()),
                (
                    "NORM_RECOMPUTE_SAMPLES",
                    config.norm_recompute_samples() as usize,
                ),
            ];
            (choices, UpdateSign::Corrected)
        }
    };
    choices.push(("AS_PRINTED", usize::from(sign == UpdateSign::AsPrinted)));
    choices.push(("FTZ", usize::from(F::FLUSHES_SUBNORMALS)));
    choices
}

/// Verilog macros for the testbench; `README.txt` beside it states their meaning.
pub(super) fn params_vh<F: Fp>(
    settings: &ExportSettings<F>,
    samples: usize,
    trace_rows: u64,
) -> String {
    let word = |word: F| format!("{}'h{}", F::WIDTH, hex(word));
    let flag = |is_set: bool| u8::from(is_set).to_string();
    let (tap_count, own, update_sign) = match &settings.pipeline {
        PipelineConfig::Rls(config) => (
            config.tap_count(),
            vec![
                ("ALPHA", word(config.alpha())),
                ("IALPHA", word(config.inverse_alpha())),
                ("DELTA", word(config.delta())),
                ("DIV_ELEM", flag(config.division() == Division::Element)),
            ],
            config.update_sign(),
        ),
        PipelineConfig::Lms(config) => (
            config.tap_count(),
            vec![
                ("MU", word(config.step_size())),
                ("EPS", word(config.regularisation().unwrap_or(F::ZERO))),
                ("NLMS", flag(config.is_normalised())),
                ("D_PORT", flag(config.desired() == DesiredSource::Port)),
            ],
            config.update_sign(),
        ),
        PipelineConfig::SignLms(config) => (
            config.tap_count(),
            vec![
                ("MU", word(config.step())),
                ("ALPHA", word(config.regularisation())),
                ("W0", word(config.initial_weight())),
                ("GUARD", word(config.guard().unwrap_or(F::ZERO))),
                ("GUARDED", flag(config.guard().is_some())),
                ("HOLD", config.hold_samples().to_string()),
                ("NLMS", flag(config.is_normalised())),
                ("RECOMPUTE", config.norm_recompute_samples().to_string()),
            ],
            UpdateSign::Corrected,
        ),
    };
    let filter = match settings.pipeline {
        PipelineConfig::Rls(_) => "RLS",
        PipelineConfig::Lms(_) => "LMS",
        PipelineConfig::SignLms(_) => "SIGN_LMS",
    };
    let mut text = format!("// Parameters of this export.\n`define VEC_{filter}\n");
    let mut define = |name: &str, value: String| {
        writeln!(text, "`define VEC_{name} {value}").expect("writing to a string cannot fail");
    };
    define("TAPS", tap_count.to_string());
    for (name, value) in own {
        define(name, value);
    }
    define("UPDATE_SUB", flag(update_sign == UpdateSign::AsPrinted));
    define("WIDTH", F::WIDTH.to_string());
    define("FTZ", flag(F::FLUSHES_SUBNORMALS));
    define("SAMPLES", samples.to_string());
    define("PERIOD", settings.pipeline.clocks_per_sample().to_string());
    define("LATENCY", settings.pipeline.latency_clocks().to_string());
    define("TRACE_CLOCKS", trace_rows.to_string());
    // A Verilog number without a width has 32 bits.
    let period_ps = (2 * half_period_ps(settings.clock_mhz)).min(2_000_000_000);
    define("CLOCK_PS", period_ps.to_string());
    text
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
    let filter = match &settings.pipeline {
        PipelineConfig::Rls(_) => "rls",
        PipelineConfig::Lms(_) => "lms",
        PipelineConfig::SignLms(_) => "sign_lms",
    };
    add("filter", quote(filter));
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
    for (name, value) in choices(&settings.pipeline) {
        add(&name.to_lowercase(), value.to_string());
    }
    if filter == "rls" {
        add("alpha_first", "true".to_string());
        add("update_order", quote("(t_i * t_j) first"));
        add("gain", quote("R L with the updated R"));
    }
    for (name, word) in constants(&settings.pipeline) {
        let name = name.to_lowercase();
        add(&name, format!("{:e}", word.to_f64()));
        add(&format!("{name}_bits"), quote(&hex(word)));
    }
    add("front_end", quote(&settings.front_end));
    add("clock_mhz", format!("{}", settings.clock_mhz));
    add(
        "clocks_per_sample",
        settings.pipeline.clocks_per_sample().to_string(),
    );
    add(
        "latency_clocks",
        settings.pipeline.latency_clocks().to_string(),
    );
    add("samples", samples.to_string());
    add("trace_clocks", trace_rows.to_string());
    if let Some(codes) = &settings.codes {
        add("code_lsb", format!("{:e}", codes.lsb));
        add("code_unit", quote(&codes.unit));
    }
    let lines: Vec<String> = fields
        .iter()
        .map(|(name, value)| format!("  \"{name}\": {value}"))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}
