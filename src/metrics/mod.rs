//! Measures: what a record of rate words says, and how sure it is.
//!
//! Invariant: metrics see samples, a sample period and plain parameters; never a scenario, a gyro
//! or a filter. Everything is in deg/h and s.
//!
//! [`measure`] turns one channel's [`Record`] into a [`ChannelMetrics`]; [`aggregate`] pools
//! independent repeats. The estimators stand alone as well: [`overlapping_allan`], [`fit_noise`],
//! [`block_means`], [`welch`], [`fit_swing`], [`noise_delay_bound`], [`predict`],
//! [`settling`](fn@settling).

mod aggregate;
mod allan;
mod allan_covariance;
mod allan_least_squares;
mod audit;
mod autocovariance;
mod bias;
mod catalogue;
mod channel;
mod delay;
mod estimate;
mod interval;
mod noise_fit;
mod psd;
mod record;
mod settling;
mod steady;
mod support;
mod swing;
mod table;
mod weight_noise;

pub use aggregate::aggregate;
pub use allan::{
    AllanPoint, NoiseType, degrees_of_freedom, overlapping_allan, overlapping_allan_at,
};
pub use audit::{
    Prediction, lags_needed, noise_delay_bound, noise_delay_bound_coloured, noise_power_gain,
    predict,
};
pub use bias::{block_means, effective_degrees_of_freedom, expected_bias_stability, samples_in};
pub use catalogue::{Applies, KnownMetric, known_metrics};
pub use channel::measure;
pub use delay::{SineFit, SwingClock, SwingFit, fit_sine, fit_swing};
pub use estimate::{ChannelFailure, ChannelMetrics, Estimate, Metric};
pub use noise_fit::{
    FIT_TAU_PER_RECORD_MAX, FLICKER_ALLAN_VARIANCE, FitRange, NoiseCoefficients, NoiseFit, Term,
    fit_noise, mixed_degrees_of_freedom,
};
pub use psd::{Spectrum, log_binned, segment_samples, welch};
pub use record::{FilterFacts, Motion, Record, Settings};
pub use settling::{Settling, settling};
pub use support::support;
