//! Textbook filters from their configuration.

use super::line_enhancer::sign_lms;
use crate::filters::{
    ConstrainedRls, Filter, FixedFilter, FrontEndConfig, Kalman, Lms, LmsConfig, Normalisation,
    RecursiveFilter, Rls, RlsConfig, SignLms, butterworth, moving_average, one_pole,
    savitzky_golay,
};
use crate::scenario::{ConstrainedRlsFilterConfig, FilterKind, LmsFilterConfig, RlsFilterConfig};
use crate::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

/// The filter of a kind for words that come every `sample_period_s`.
///
/// # Panics
/// If a constant is one that the reader or the plan refuses.
pub(super) fn textbook_filter(kind: &FilterKind, sample_period_s: f64) -> Box<dyn Filter> {
    match kind {
        FilterKind::Rls(config) => Box::new(Rls::new(&rls(config))),
        FilterKind::Lms(config) => Box::new(Lms::new(&lms(config))),
        FilterKind::SignLms(config) => Box::new(SignLms::new(&sign_lms(config))),
        FilterKind::ConstrainedRls(config) => {
            Box::new(ConstrainedRls::new(&constrained_rls(config)))
        }
        FilterKind::MovingAverage(config) => Box::new(FixedFilter::delayed(
            moving_average(config.taps as usize),
            config.delay_samples as usize,
            config.output_register,
        )),
        FilterKind::SavitzkyGolay(config) => Box::new(FixedFilter::new(
            savitzky_golay(config.taps as usize, config.polynomial_order as usize),
            config.output_register,
        )),
        FilterKind::OnePole(config) => Box::new(RecursiveFilter::new(
            one_pole(config.cutoff_hz * sample_period_s),
            config.output_register,
        )),
        FilterKind::Butterworth(config) => Box::new(RecursiveFilter::new(
            butterworth(config.order as usize, config.cutoff_hz * sample_period_s),
            config.output_register,
        )),
        FilterKind::Kalman(config) => Box::new(Kalman::new(
            config.measurement_noise_deg_per_h,
            config.rate_random_walk_deg_per_h_per_sqrt_s * sample_period_s.sqrt(),
            config.output_register,
        )),
    }
}

/// Least cut-off frequencies over the output rate. The gain at DC is the quotient of sums in which the
/// poles leave `2 pi f T` of a single one and its square of a pair: rounding moves it by 1e-8 of a
/// one-pole filter and by 1e-5 of a pair there.
const ONE_POLE_SHARE_MIN: f64 = 1e-9;
const PAIR_SHARE_MIN: f64 = 1e-6;

/// The key to blame and the complaint about a low pass whose cut-off frequency lies beyond the reach
/// of the words.
pub(super) fn cutoff_complaint(
    index: usize,
    kind: &FilterKind,
    sample_rate_hz: f64,
) -> Option<(String, String)> {
    let (table, cutoff_hz, least_share) = match kind {
        FilterKind::OnePole(config) => ("one_pole", config.cutoff_hz, ONE_POLE_SHARE_MIN),
        FilterKind::Butterworth(config) => ("butterworth", config.cutoff_hz, PAIR_SHARE_MIN),
        _ => return None,
    };
    let key = format!("filter[{index}].{table}.cutoff_hz");
    let (least_hz, limit_hz) = (least_share * sample_rate_hz, 0.5 * sample_rate_hz);
    let range = format!("allowed [{least_hz:.3e}, {limit_hz:.3}) Hz");
    let message = if cutoff_hz >= limit_hz {
        format!("{key} = {cutoff_hz} Hz is not below half the output rate: {range}")
    } else if cutoff_hz < least_hz {
        format!(
            "{key} = {cutoff_hz} Hz is below {least_share:e} of the output rate, where the poles lie too \
             near 1 for binary64: {range}, or a larger gyro.output.average_samples"
        )
    } else {
        return None;
    };
    Some((key, message))
}

fn constrained_rls(config: &ConstrainedRlsFilterConfig) -> RlsConfig {
    RlsConfig {
        taps: config.taps as usize,
        forgetting_factor: config.forgetting_factor,
        initial_inverse_correlation: config.initial_inverse_correlation,
        update_sign: UpdateSign::Corrected,
        front_end: front_end(
            config.desired,
            config.input_lag_samples,
            config.output_register,
        ),
    }
}

fn rls(config: &RlsFilterConfig) -> RlsConfig {
    RlsConfig {
        taps: config.taps as usize,
        forgetting_factor: config.forgetting_factor,
        initial_inverse_correlation: config.initial_inverse_correlation,
        update_sign: config.update_sign,
        front_end: front_end(
            config.desired,
            config.input_lag_samples,
            config.output_register,
        ),
    }
}

fn lms(config: &LmsFilterConfig) -> LmsConfig {
    let regularisation_deg2_per_h2 = config.regularisation_deg2_per_h2;
    LmsConfig {
        taps: config.taps as usize,
        step_size: config.step_size,
        normalisation: if config.normalised {
            Normalisation::Energy {
                regularisation_deg2_per_h2,
            }
        } else {
            Normalisation::None
        },
        update_sign: config.update_sign,
        front_end: front_end(
            config.desired,
            config.input_lag_samples,
            config.output_register,
        ),
    }
}

fn front_end(
    desired: DesiredSignal,
    input_lag_samples: u32,
    output_register: OutputRegister,
) -> FrontEndConfig {
    FrontEndConfig {
        desired,
        input_lag_samples: input_lag_samples as usize,
        output_register,
    }
}
