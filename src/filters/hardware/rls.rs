//! Recursive least squares in hardware.

use super::fixed::FixedSettings;
use super::pipeline::PipelineSettings;
use super::settings::FloatSettings;
use crate::filters::rls::RlsFilterConfig;
use crate::filters::rls_words::{RlsWords, SignalWord};
use crate::fpga::fixed::{FixedRlsSettings, Format, RlsFormats};
use crate::fpga::kinds::CoreSettings;
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::vocabulary::WordFormat;

/// The pipeline that the keys stand for.
pub(in crate::filters) fn rls(config: &RlsFilterConfig) -> PipelineSettings {
    let settings = RlsSettings {
        tap_count: config.taps as usize,
        forgetting_factor: config.forgetting_factor,
        initial_inverse_correlation: config.initial_inverse_correlation,
        division: config.division,
        update_sign: config.update_sign,
    };
    let format = match config.number_format {
        WordFormat::Float(format) => format,
        WordFormat::Fixed => {
            let words = config.words();
            return PipelineSettings::Fixed(FixedSettings {
                core: fixed_rls(&settings, &words),
                full_scale_deg_per_h: words.full_scale_deg_per_h,
                desired: config.desired,
                input_lag_samples: config.input_lag_samples as usize,
                output_register: config.output_register,
                clock_mhz: config.clock_mhz,
            });
        }
    };
    PipelineSettings::Float(FloatSettings {
        core: CoreSettings::Rls(RlsCore {
            settings,
            order: config.update_order,
        }),
        desired: config.desired,
        input_lag_samples: config.input_lag_samples as usize,
        output_register: config.output_register,
        format,
        clock_mhz: config.clock_mhz,
    })
}

/// The pipeline with these constants on fixed-point words; the inverse correlation is given in the
/// inverse square of the words' unit, whose full scale they name.
#[must_use]
pub fn fixed_rls(settings: &RlsSettings, words: &RlsWords) -> FixedRlsSettings {
    let full_scale = words.full_scale_deg_per_h;
    let delta = settings.initial_inverse_correlation * full_scale * full_scale;
    let signals = words.signals();
    FixedRlsSettings {
        tap_count: settings.tap_count,
        forgetting_factor: settings.forgetting_factor,
        initial_inverse_correlation: delta,
        inverse_floor: i64::from(words.r_floor_steps),
        formats: RlsFormats {
            input: format(signals.x),
            desired: format(signals.d),
            intermediate: format(signals.t),
            denominator: format(signals.den),
            gain: format(signals.k),
            inverse: format(signals.r),
            weight: format(signals.w),
            output: format(signals.y),
        },
    }
}

fn format(word: SignalWord) -> Format {
    Format {
        integer_bits: word.integer_bits,
        // More integer bits than bits are refused before.
        fraction_bits: word.word_bits.saturating_sub(word.integer_bits),
        rounding: word.rounding,
        overflow: word.overflow,
    }
}
