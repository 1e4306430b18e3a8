//! What a temperature says of a record: metrics, their fields, and the curve of the means.

use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::key::metric::{Applies, MetricKey, Needs};

/// Linear coefficient of the bias.
pub static BIAS_PER_K: MetricKey = MetricKey::new(
    "bias_temperature_coefficient_deg_per_h_per_k",
    "deg/h/K",
    Applies::Log,
    "linear coefficient of the bias against the temperature, at the reference temperature",
)
.heading("bias over temperature")
.needs(Needs::Samples);

/// Quadratic coefficient of the bias.
pub static BIAS_PER_K2: MetricKey = MetricKey::new(
    "bias_temperature_coefficient_deg_per_h_per_k2",
    "deg/h/K^2",
    Applies::Log,
    "quadratic coefficient of the bias against the temperature",
)
.heading("bias over temperature squared")
.needs(Needs::Samples);

/// Coefficient of the rate of the temperature.
pub static BIAS_PER_K_PER_MIN: MetricKey = MetricKey::new(
    "bias_temperature_rate_coefficient_deg_per_h_per_k_per_min",
    "deg/h/(K/min)",
    Applies::Log,
    "coefficient of the bias against the rate of the temperature, the Shupe effect",
)
.heading("bias over temperature rate")
.needs(Needs::Samples);

/// Linear coefficient of the scale factor.
pub static SCALE_FACTOR_PER_K: MetricKey = MetricKey::new(
    "scale_factor_temperature_coefficient_ppm_per_k",
    "ppm/K",
    Applies::Log,
    "linear coefficient of the scale factor against the temperature, of a swing or beside a reference that varies",
)
.heading("scale factor over temperature")
.needs(Needs::Samples);

/// Hysteresis of the bias.
pub static HYSTERESIS: MetricKey = MetricKey::new(
    "temperature_hysteresis_deg_per_h",
    "deg/h",
    Applies::Log,
    "mean of the bias while the temperature rises minus that while it falls, at one temperature",
)
.heading("hysteresis")
.needs(Needs::Samples);

/// Hysteresis that the coefficients leave.
pub static HYSTERESIS_LEFT: MetricKey = MetricKey::new(
    "temperature_hysteresis_left_deg_per_h",
    "deg/h",
    Applies::Log,
    "the same of the words without what the significant coefficients explain",
)
.heading("hysteresis left")
.needs(Needs::Samples);

/// Standard deviation of the means that the coefficients leave.
pub static STD_LEFT: MetricKey = MetricKey::new(
    "temperature_residual_std_deg_per_h",
    "deg/h",
    Applies::Log,
    "standard deviation of the means behind the significant coefficients; the field before_deg_per_h is that of the means as they are",
)
.lower_is_better()
.heading("residual over temperature")
.needs(Needs::Samples);

/// Everything that a temperature gives a channel.
pub(crate) const TEMPERATURE_METRICS: [&MetricKey; 7] = [
    &BIAS_PER_K,
    &BIAS_PER_K2,
    &BIAS_PER_K_PER_MIN,
    &SCALE_FACTOR_PER_K,
    &HYSTERESIS,
    &HYSTERESIS_LEFT,
    &STD_LEFT,
];

/// Middle of a mean.
pub static TIME: Column = Column::new("time_s", "s", "middle of a mean");
/// Temperature of a mean.
pub static TEMPERATURE_C: Column = Column::new("temperature_c", "C", "mean temperature");
/// Its rate.
pub static RATE: Column = Column::new(
    "temperature_rate_k_per_min",
    "K/min",
    "rate of the temperature, over as many neighbours as the readings want",
);
/// Error of a mean.
pub static BIAS: Column = Column::new(
    "bias_deg_per_h",
    "deg/h",
    "mean of the words, less the true rate where a reference shows it",
);
/// What the coefficients say of it.
pub static FITTED: Column = Column::new(
    "fitted_deg_per_h",
    "deg/h",
    "the same by all coefficients, beside what depends on the true rate",
);
/// What they leave.
pub static LEFT: Column = Column::new(
    "residual_deg_per_h",
    "deg/h",
    "what the significant coefficients leave of it",
);

/// Means against the temperature.
pub static TEMPERATURE: CurveKey = CurveKey::new(
    "temperature",
    &[&TIME, &TEMPERATURE_C, &RATE, &BIAS, &FITTED, &LEFT],
    "means of a log with a column of the temperature",
)
.csv("temperature.csv")
.picture("temperature.svg");

/// Field of a coefficient: that of the model that compensates; 0 where it is not significant.
pub(crate) const APPLIED: &str = "applied";
/// Field of a coefficient: probability of one as far from zero without any effect.
pub(crate) const P_VALUE: &str = "p_value";
/// Field of a coefficient: temperature that it is told at, deg C.
pub(crate) const REFERENCE: &str = "reference_c";
/// Field of what is left: the same before.
pub(crate) const BEFORE: &str = "before_deg_per_h";
/// Field of what is left: time of each mean, s.
pub(crate) const MEAN_LENGTH: &str = "averaging_time_s";
