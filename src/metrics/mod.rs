//! Measures: what a record of rate words says, and how sure it is.
//!
//! Invariant: metrics see samples, a sample period and plain parameters; never a scenario, a gyro
//! or a filter. Everything is in deg/h and s; the angle of an encoder is in rad.
//!
//! [`measure`] turns one channel's [`Record`] into a [`ChannelMetrics`]; [`aggregate`] pools
//! independent repeats. The estimators stand alone as well: [`overlapping_allan`], [`fit_noise`],
//! [`block_means`], [`welch`], [`fit_swing`], [`noise_delay_bound`], [`predict`],
//! [`settling`](fn@settling), [`fit_scale_factor`], [`fit_tones`].

mod allan;
mod calibration;
pub mod catalogue;
mod estimate;
mod key;
mod measure;
mod motion;
mod noise;
mod pipeline;
mod pool;
mod record;
mod sine;
mod steps;
mod theory;
mod trial;

pub use allan::noise_fit::{
    FIT_TAU_PER_RECORD_MAX, FLICKER_ALLAN_VARIANCE, FitRange, NoiseCoefficients, NoiseFit, Term,
    fit_noise, fit_pooled_noise, mixed_degrees_of_freedom,
};
pub use allan::noise_identification::PowerLaw;
pub use allan::overlapping::{
    AllanPoint, NoiseType, degrees_of_freedom, overlapping_allan, overlapping_allan_at,
};
pub use allan::stream::AllanStream;
pub use allan::variants::{
    AllanEstimator, AllanOptions, AllanVariantPoint, allan_variant, allan_variant_at,
};
pub(crate) use catalogue::names::{meant, unknown};
pub use catalogue::support::{encoder_lack, repeats_lack, support, truth_lack};
pub use catalogue::{find, known_metrics, repeated_metrics};
pub use estimate::missing::MissingMetric;
pub use estimate::repeat_statistics::RepeatStatistics;
pub(crate) use estimate::text::{estimate_text, is_exact, plain, wants_exponent};
pub use estimate::value::{ChannelFailure, ChannelMetrics, Estimate, Metric};
pub(crate) use key::metric::{Against, Headline, Table};
pub use key::metric::{Applies, MetricKey};
pub use measure::measure;
pub use noise::autocovariance::autocovariance;
pub use noise::bias_stability::{
    block_label_s, block_means, effective_degrees_of_freedom, expected_bias_stability,
    is_sample_or_longer, paired_ratio, samples_in,
};
pub use noise::memory::{correlation_length_samples, memory_samples, record_fit_tau_min_s};
pub use noise::spectrum::{Spectrum, log_binned, segment_samples, welch};
pub use pool::aggregate::aggregate;
pub use pool::sensitivity::{ConditionPoint, change_divisor, largest_change_per_unit};
pub use record::{Dwell, FilterFacts, Motion, RateGain, Record, Settings, Staircase};
pub use sine::correlation::correlation_delay_s;
pub use sine::fit::{SineFit, SwingClock, SwingFit, fit_sine, fit_swing};
pub use sine::free_frequency::{FreeSineFit, fit_sine_free_frequency};
pub use sine::tones::{ToneClock, ToneFits, ToneResponse, bandwidth_hz, fit_tones};
pub use steps::nonlinearity::{Nonlinearity, Residual, expected_largest};
pub use steps::scale_factor::{
    Asymmetry, RATES_MIN, RATES_PER_SENSE_MIN, RatePoint, ScaleFactorFit, StaticZero,
    distinct_rates, distinct_rates_by_sense, fit_scale_factor, scale_factor_repeatability,
    scale_factor_temperature_sensitivity,
};
pub use steps::settling::{Settling, settling};
pub use steps::shape::Step;
pub use steps::small_input::smallest_answered;
pub use theory::prediction::{
    Prediction, lags_needed, noise_delay_bound, noise_delay_bound_coloured, noise_power_gain,
    predict,
};
pub use trial::readaptation::{GainUnits, Readaptation};
pub use trial::verdict::{AgainstOne, Deed, FilterVerdict, Finding, filter_verdict};
