//! Least mean squares in hardware.

use super::fixed::FixedConstant;
use super::pipeline::{Around, PipelineSettings};
use super::words::format;
use crate::filters::lms::LmsFilterConfig;
use crate::filters::words::{FixedWords, HardwareWords};
use crate::fpga::fixed::lms::FixedLmsSettings;
use crate::fpga::fixed::{LmsFormats, SignalName};
use crate::fpga::kinds::CoreSettings;
use crate::fpga::lms::{DesiredSource, LmsSettings};

/// The pipeline that the keys stand for.
pub(in crate::filters) fn lms(config: &LmsFilterConfig, words: &HardwareWords) -> PipelineSettings {
    let desired = config.desired;
    let input_lag_samples = config.input_lag_samples as usize;
    let core = CoreSettings::Lms(LmsSettings {
        tap_count: config.taps as usize,
        step_size: config.step_size,
        regularisation: config
            .normalised
            .then_some(config.regularisation_deg2_per_h2),
        // The core forms the mean of the two words it holds; behind a lag they are not the newest.
        desired: match input_lag_samples {
            0 => DesiredSource::of(desired),
            _ => DesiredSource::Port,
        },
        update_sign: config.update_sign,
    });
    let around = Around {
        desired,
        input_lag_samples,
        output_register: config.output_register,
        clock_mhz: config.clock_mhz,
    };
    PipelineSettings::of(core, around, words)
}

/// Constants that a refusal may name.
pub(super) const CONSTANTS: &[FixedConstant] = &[
    FixedConstant {
        name: "step size",
        key: "step_size",
        unit: " (deg/h)^-2",
        power: -2,
        signal: SignalName::K,
    },
    FixedConstant {
        name: "regularisation",
        key: "regularisation_deg2_per_h2",
        unit: " (deg/h)^2",
        power: 2,
        signal: SignalName::Den,
    },
];

/// The same pipeline on fixed-point words: step and regularisation in powers of their full scale.
pub(super) fn fixed_lms(core: &LmsSettings, words: &FixedWords) -> FixedLmsSettings {
    let full_scale = words.full_scale_deg_per_h;
    let step = core.step_size;
    FixedLmsSettings {
        tap_count: core.tap_count,
        step_size: match core.regularisation {
            Some(_) => step,
            None => step * full_scale * full_scale,
        },
        regularisation: core
            .regularisation
            .map(|value| value / full_scale / full_scale),
        formats: lms_formats(words),
    }
}

/// Formats of the least-mean-squares filters.
pub(super) fn lms_formats(words: &FixedWords) -> LmsFormats {
    LmsFormats {
        input: format(words, SignalName::X),
        desired: format(words, SignalName::D),
        intermediate: format(words, SignalName::T),
        denominator: format(words, SignalName::Den),
        gain: format(words, SignalName::K),
        weight: format(words, SignalName::W),
        output: format(words, SignalName::Y),
    }
}
