//! Line enhancer in hardware.

use super::fixed::FixedConstant;
use super::lms::lms_formats;
use super::pipeline::{Around, PipelineSettings};
use crate::filters::sign_lms::SignLmsFilterConfig;
use crate::filters::words::{FixedWords, HardwareWords};
use crate::fpga::fixed::SignalName;
use crate::fpga::fixed::sign_lms::FixedSignLmsSettings;
use crate::fpga::kinds::CoreSettings;
use crate::fpga::sign_lms::SignLmsSettings;
use crate::vocabulary::{DesiredSignal, SignLmsForm};

/// The pipeline that the keys stand for.
pub(in crate::filters) fn sign_lms(
    config: &SignLmsFilterConfig,
    words: &HardwareWords,
) -> PipelineSettings {
    let textbook = config.on_words();
    let core = CoreSettings::SignLms(SignLmsSettings {
        tap_count: textbook.taps,
        delay_samples: textbook.delay_samples,
        // The reader has refused the unity-gain form, which is no hardware's.
        normalised: textbook.form != SignLmsForm::Sign,
        step: textbook.step,
        regularisation: textbook.regularisation,
        initial_weight: textbook.initial_weight,
        guard: textbook.guard,
        norm_recompute_samples: config.norm_recompute_samples,
    });
    let around = Around {
        desired: DesiredSignal::Current,
        input_lag_samples: textbook.delay_samples,
        output_register: config.output_register,
        clock_mhz: config.clock_mhz,
    };
    PipelineSettings::of(core, around, words)
}

/// Constants that a refusal may name.
pub(super) const CONSTANTS: &[FixedConstant] = &[
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
pub(super) fn fixed_sign_lms(core: &SignLmsSettings, words: &FixedWords) -> FixedSignLmsSettings {
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
