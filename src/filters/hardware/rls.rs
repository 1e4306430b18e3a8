//! Recursive least squares in hardware.

use super::pipeline::{Around, PipelineSettings};
use crate::filters::rls::RlsFilterConfig;
use crate::filters::words::HardwareWords;
use crate::fpga::kinds::CoreSettings;
use crate::fpga::rls::{RlsCore, RlsSettings};

/// The pipeline that the keys stand for.
pub(in crate::filters) fn rls(config: &RlsFilterConfig, words: &HardwareWords) -> PipelineSettings {
    let core = CoreSettings::Rls(RlsCore {
        settings: RlsSettings {
            tap_count: config.taps as usize,
            forgetting_factor: config.forgetting_factor,
            initial_inverse_correlation: config.initial_inverse_correlation,
            division: config.division,
            update_sign: config.update_sign,
        },
        order: config.update_order,
    });
    let around = Around {
        desired: config.desired,
        input_lag_samples: config.input_lag_samples as usize,
        output_register: config.output_register,
        clock_mhz: config.clock_mhz,
    };
    PipelineSettings::of(core, around, words)
}
