//! Least mean squares in hardware.

use super::pipeline::{Around, PipelineSettings};
use crate::filters::lms::LmsFilterConfig;
use crate::filters::words::HardwareWords;
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
