//! Measures: what a record of rate words says, and how sure it is.
//!
//! Invariant: metrics see samples, a sample period and plain parameters; never a scenario, a gyro
//! or a filter. Everything is in deg/h and s; the angle of an encoder is in rad.
//!
//! [`measure`] turns one channel's [`Record`] into a [`ChannelMetrics`]; [`aggregate`] pools
//! independent repeats. The estimators stand alone as well: [`overlapping_allan`], [`fit_noise`],
//! [`block_means`], [`welch`], [`fit_swing`], [`noise_delay_bound`], [`predict`],
//! [`settling`](fn@settling), [`fit_scale_factor`], [`fit_tones`].

mod aggregate;
mod allan;
mod allan_covariance;
mod allan_curves;
mod allan_least_squares;
mod allan_sampling;
mod allan_stream;
mod allan_sums;
mod allan_variants;
mod angle;
mod audit;
mod autocovariance;
mod bias;
pub mod catalogue;
mod channel;
mod combined_freedom;
mod correlation;
mod delay;
mod estimate;
mod estimate_text;
mod estimates;
mod frozen_response;
mod interval;
mod key;
mod memory;
mod missing;
mod multi_sine;
mod names;
mod noise_delay;
mod noise_fit;
mod noise_identification;
mod noise_level;
mod nonlinearity;
mod pipeline;
mod psd;
mod readaptation;
mod record;
mod repeat_statistics;
mod response;
mod scale_factor;
mod sensitivity;
mod settling;
mod sine_frequency;
mod small_input;
mod staircase;
mod steady;
mod step_shape;
mod support;
mod swing;
mod table;
mod truth_response;
mod verdict;
mod weight_noise;

pub use aggregate::aggregate;
pub use allan::{
    AllanPoint, NoiseType, degrees_of_freedom, overlapping_allan, overlapping_allan_at,
};
pub use allan_stream::AllanStream;
pub use allan_variants::{
    AllanEstimator, AllanOptions, AllanVariantPoint, TauGrid, allan_variant, allan_variant_at,
};
pub use audit::{
    Prediction, lags_needed, noise_delay_bound, noise_delay_bound_coloured, noise_power_gain,
    predict,
};
pub use autocovariance::autocovariance;
pub use bias::{
    block_label_s, block_means, effective_degrees_of_freedom, expected_bias_stability,
    is_sample_or_longer, paired_ratio, samples_in,
};
pub use catalogue::{find, known_metrics, repeated_metrics};
pub use channel::measure;
pub use correlation::correlation_delay_s;
pub use delay::{SineFit, SwingClock, SwingFit, fit_sine, fit_swing};
pub use estimate::{ChannelFailure, ChannelMetrics, Estimate, Metric};
pub(crate) use estimate_text::{estimate_text, is_exact, plain, wants_exponent};
pub(crate) use key::{Against, Headline, Table};
pub use key::{Applies, MetricKey};
pub use memory::{correlation_length_samples, memory_samples, record_fit_tau_min_s};
pub use missing::MissingMetric;
pub(crate) use names::{meant, unknown};
pub use noise_fit::{
    FIT_TAU_PER_RECORD_MAX, FLICKER_ALLAN_VARIANCE, FitRange, NoiseCoefficients, NoiseFit, Term,
    fit_noise, fit_pooled_noise, mixed_degrees_of_freedom,
};
pub use noise_identification::PowerLaw;
pub use nonlinearity::{Nonlinearity, Residual, expected_largest};
pub use psd::{Spectrum, log_binned, segment_samples, welch};
pub use readaptation::{GainUnits, Readaptation};
pub use record::{Dwell, FilterFacts, Motion, RateGain, Record, Settings, Staircase};
pub use repeat_statistics::RepeatStatistics;
pub use response::{ToneClock, ToneFits, ToneResponse, bandwidth_hz, fit_tones};
pub use scale_factor::{
    Asymmetry, RATES_MIN, RATES_PER_SENSE_MIN, RatePoint, ScaleFactorFit, StaticZero,
    distinct_rates, distinct_rates_by_sense, fit_scale_factor, scale_factor_repeatability,
    scale_factor_temperature_sensitivity,
};
pub use sensitivity::{ConditionPoint, change_divisor, largest_change_per_unit};
pub use settling::{Settling, settling};
pub use sine_frequency::{FreeSineFit, fit_sine_free_frequency};
pub use small_input::smallest_answered;
pub use step_shape::Step;
pub use support::{encoder_lack, repeats_lack, support, truth_lack};
pub use verdict::{AgainstOne, Deed, FilterVerdict, Finding, filter_verdict};
