//! Recursive least squares in hardware.

use super::fixed::FixedConstant;
use super::pipeline::{Around, PipelineSettings};
use super::words::format;
use crate::filters::rls::RlsFilterConfig;
use crate::filters::words::{FixedWords, HardwareWords};
use crate::fpga::fixed::SignalName;
use crate::fpga::fixed::rls::{FixedRlsSettings, RlsFormats};
use crate::fpga::kinds::CoreSettings;
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::vocabulary::{Division, UpdateOrder, UpdateSign};

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

/// Constants that a refusal may name.
pub(super) const CONSTANTS: &[FixedConstant] = &[FixedConstant {
    name: "initial inverse correlation",
    key: "initial_inverse_correlation",
    unit: " (deg/h)^-2",
    power: -2,
    signal: SignalName::R,
}];

/// The same pipeline on fixed-point words; the inverse correlation is given in the inverse square of the
/// words' unit, whose full scale they name.
pub(super) fn fixed_rls(core: &RlsCore, words: &FixedWords) -> FixedRlsSettings {
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
pub(super) fn twin(core: RlsCore) -> RlsCore {
    RlsCore {
        settings: RlsSettings {
            division: Division::Reciprocal,
            update_sign: UpdateSign::Corrected,
            ..core.settings
        },
        order: UpdateOrder::Schedule,
    }
}
