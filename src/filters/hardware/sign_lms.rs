//! Line enhancer in hardware.

use super::pipeline::{Around, PipelineSettings};
use crate::filters::sign_lms::SignLmsFilterConfig;
use crate::filters::words::HardwareWords;
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
