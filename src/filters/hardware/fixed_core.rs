//! From a pipeline of the books and the words of a scenario to the same pipeline on fixed-point words.
//!
//! Lengths in deg/h become parts of the full scale, in whatever power a constant has them.

use crate::filters::words::FixedWords;
use crate::fpga::fixed::lms::FixedLmsSettings;
use crate::fpga::fixed::rls::{FixedRlsSettings, RlsFormats};
use crate::fpga::fixed::sign_lms::FixedSignLmsSettings;
use crate::fpga::fixed::{FixedCoreSettings, Format, LmsFormats, SignalName};
use crate::fpga::kinds::CoreSettings;
use crate::fpga::lms::LmsSettings;
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::fpga::sign_lms::SignLmsSettings;
use crate::vocabulary::{Division, UpdateOrder, UpdateSign};

/// A constant of a pipeline that its words may not hold.
pub(super) struct FixedConstant {
    /// Its name in a refusal.
    pub(super) name: &'static str,
    /// Key that it comes from.
    pub(super) key: &'static str,
    /// Unit of the key behind a blank; nothing without.
    pub(super) unit: &'static str,
    /// Power of deg/h in that unit.
    pub(super) power: i32,
    /// Signal whose words hold it.
    pub(super) signal: SignalName,
}

/// The pipeline on fixed-point words, and the filter of the books that it stands for.
pub(super) fn fixed_core(
    core: &CoreSettings,
    words: &FixedWords,
) -> (FixedCoreSettings, CoreSettings) {
    match core {
        CoreSettings::Rls(rls) => (
            FixedCoreSettings::Rls(fixed_rls(rls, words)),
            CoreSettings::Rls(twin_rls(*rls)),
        ),
        CoreSettings::Lms(lms) => (FixedCoreSettings::Lms(fixed_lms(lms, words)), *core),
        CoreSettings::SignLms(sign_lms) => (
            FixedCoreSettings::SignLms(fixed_sign_lms(sign_lms, words)),
            *core,
        ),
    }
}

/// Constants of a pipeline that a refusal may name.
pub(super) fn constants_of(core: &FixedCoreSettings) -> &'static [FixedConstant] {
    match core {
        FixedCoreSettings::Rls(_) => OF_RLS,
        FixedCoreSettings::Lms(_) => OF_LMS,
        FixedCoreSettings::SignLms(_) => OF_SIGN_LMS,
    }
}

/// Constants of least squares that a refusal may name.
const OF_RLS: &[FixedConstant] = &[FixedConstant {
    name: "initial inverse correlation",
    key: "initial_inverse_correlation",
    unit: " (deg/h)^-2",
    power: -2,
    signal: SignalName::R,
}];

/// The same pipeline on fixed-point words; the inverse correlation is given in the inverse square of the
/// words' unit, whose full scale they name.
fn fixed_rls(core: &RlsCore, words: &FixedWords) -> FixedRlsSettings {
    let settings = &core.settings;
    let full_scale = words.full_scale_deg_per_h;
    let delta = settings.initial_inverse_correlation * full_scale * full_scale;
    FixedRlsSettings {
        tap_count: settings.tap_count,
        forgetting_factor: settings.forgetting_factor,
        initial_inverse_correlation: delta,
        inverse_floor: words.r_floor_steps.map_or(0, i64::from),
        formats: RlsFormats {
            input: format(words, SignalName::X),
            desired: format(words, SignalName::D),
            intermediate: format(words, SignalName::T),
            denominator: format(words, SignalName::Den),
            gain: format(words, SignalName::K),
            inverse: format(words, SignalName::R),
            weight: format(words, SignalName::W),
            output: format(words, SignalName::Y),
        },
    }
}

/// The filter of the books that fixed-point words stand for.
fn twin_rls(core: RlsCore) -> RlsCore {
    RlsCore {
        settings: RlsSettings {
            division: Division::Reciprocal,
            update_sign: UpdateSign::Corrected,
            ..core.settings
        },
        order: UpdateOrder::Schedule,
    }
}

/// Constants of least mean squares that a refusal may name.
const OF_LMS: &[FixedConstant] = &[
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
fn fixed_lms(core: &LmsSettings, words: &FixedWords) -> FixedLmsSettings {
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
fn lms_formats(words: &FixedWords) -> LmsFormats {
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

/// Constants of the line enhancer that a refusal may name.
const OF_SIGN_LMS: &[FixedConstant] = &[
    FixedConstant {
        name: "regularisation",
        key: "regularisation",
        unit: " (deg/h)^2",
        power: 2,
        signal: SignalName::Den,
    },
    FixedConstant {
        name: "guard",
        key: "guard_deg_per_h",
        unit: " deg/h",
        power: 1,
        signal: SignalName::Y,
    },
];

/// The same pipeline on fixed-point words: step, regularisation and guard in powers of their full scale.
fn fixed_sign_lms(core: &SignLmsSettings, words: &FixedWords) -> FixedSignLmsSettings {
    let full_scale = words.full_scale_deg_per_h;
    FixedSignLmsSettings {
        tap_count: core.tap_count,
        delay_samples: core.delay_samples,
        normalised: core.normalised,
        step: if core.normalised {
            core.step
        } else {
            core.step / full_scale
        },
        regularisation: core.regularisation / full_scale / full_scale,
        initial_weight: core.initial_weight,
        guard: core.guard.map(|guard| guard / full_scale),
        formats: lms_formats(words),
    }
}

/// The format of a signal, whose table has its name in small letters.
fn format(words: &FixedWords, signal: SignalName) -> Format {
    let word = words.word(&signal.name().to_lowercase());
    Format {
        integer_bits: word.integer_bits,
        // More integer bits than bits are refused before.
        fraction_bits: word.word_bits.saturating_sub(word.integer_bits),
        rounding: word.rounding,
        overflow: word.overflow,
    }
}
