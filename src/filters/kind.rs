//! The configuration of the filters: names are the keys of the scenario file, units included.

use serde::Deserialize;

use crate::vocabulary::{
    ConstantUnit, DesiredSignal, Division, InitialWeights, NumberFormat, OutputRegister, Pipeline,
    SignLmsForm, UpdateOrder, UpdateSign,
};

/// One filter channel.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct FilterConfig {
    /// Channel name.
    pub name: String,
    /// Kind and settings (`[filter.rls]` or `[filter.lms]`).
    #[serde(flatten)]
    pub kind: FilterKind,
}

/// Kind of a filter and its settings.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilterKind {
    /// Recursive least squares.
    Rls(RlsFilterConfig),
    /// Least mean squares, normalised or not.
    Lms(LmsFilterConfig),
    /// Line enhancer with the sign of the error, and its normalised forms.
    SignLms(SignLmsFilterConfig),
    /// Recursive least squares held to unit DC gain.
    ConstrainedRls(ConstrainedRlsFilterConfig),
    /// Mean of the newest samples.
    MovingAverage(MovingAverageFilterConfig),
    /// Savitzky-Golay filter at the newest sample.
    SavitzkyGolay(SavitzkyGolayFilterConfig),
    /// One-pole low pass.
    OnePole(OnePoleFilterConfig),
    /// Butterworth low pass.
    Butterworth(ButterworthFilterConfig),
    /// Kalman filter for a constant rate.
    Kalman(KalmanFilterConfig),
}

/// Recursive least squares.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RlsFilterConfig {
    /// Number of weights p.
    pub taps: u32,
    /// Forgetting factor alpha, (0, 1].
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, (deg/h)^-2.
    pub initial_inverse_correlation: f64,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
    /// Arithmetic.
    pub pipeline: Pipeline,
    /// Words of the hardware.
    pub number_format: NumberFormat,
    /// Clock of the hardware, MHz.
    pub clock_mhz: f64,
    /// Where the hardware divides.
    pub division: Division,
    /// Order of the products in the update of the inverse correlation matrix.
    pub update_order: UpdateOrder,
}

/// Least mean squares.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LmsFilterConfig {
    /// Number of weights N.
    pub taps: u32,
    /// Step size mu.
    pub step_size: f64,
    /// Whether the step is divided by the input's energy (NLMS).
    pub normalised: bool,
    /// Added to the energy (normalised form), (deg/h)^2.
    pub regularisation_deg2_per_h2: f64,
    /// Run an un-normalised step beyond its stability bound.
    pub allow_unstable: bool,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
    /// Arithmetic.
    pub pipeline: Pipeline,
    /// Words of the hardware.
    pub number_format: NumberFormat,
    /// Clock of the hardware, MHz.
    pub clock_mhz: f64,
}

/// Line enhancer of patent CN101221046.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SignLmsFilterConfig {
    /// Number of weights M.
    pub taps: u32,
    /// Age of the newest weighed sample, samples.
    pub delay_samples: u32,
    /// How the weights are corrected.
    pub form: SignLmsForm,
    /// Step mu: in `unit` in the sign form, else without unit.
    pub step: f64,
    /// Regularisation alpha, in the square of `unit`.
    pub regularisation: f64,
    /// Unit of the words in which step and regularisation are meant.
    pub unit: ConstantUnit,
    /// Weights at the start.
    pub initial_weights: InitialWeights,
    /// Errors beyond this leave the weights alone for at most a delay and a filter length, deg/h.
    pub guard_deg_per_h: Option<f64>,
    /// Samples between two fresh sums of the norm; 0 = never.
    pub norm_recompute_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Arithmetic.
    pub pipeline: Pipeline,
    /// Words of the hardware.
    pub number_format: NumberFormat,
    /// Clock of the hardware, MHz.
    pub clock_mhz: f64,
}

/// Recursive least squares held to unit DC gain.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstrainedRlsFilterConfig {
    /// Number of weights p, one more than are free.
    pub taps: u32,
    /// Forgetting factor, (0, 1].
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, (deg/h)^-2.
    pub initial_inverse_correlation: f64,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// Mean of the newest samples.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MovingAverageFilterConfig {
    /// Number of samples.
    pub taps: u32,
    /// Age of the newest sample of the mean, samples.
    pub delay_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// Savitzky-Golay filter at the newest sample.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavitzkyGolayFilterConfig {
    /// Number of samples the polynomial is fitted to.
    pub taps: u32,
    /// Degree of the polynomial.
    pub polynomial_order: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// One-pole low pass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnePoleFilterConfig {
    /// Half-power frequency, Hz.
    pub cutoff_hz: f64,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// Butterworth low pass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ButterworthFilterConfig {
    /// Number of poles.
    pub order: u32,
    /// Half-power frequency, Hz.
    pub cutoff_hz: f64,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// Kalman filter for a rate that walks slowly, in white noise.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KalmanFilterConfig {
    /// Standard deviation of the white noise of one word, deg/h.
    pub measurement_noise_deg_per_h: f64,
    /// Random walk of the rate that the filter reckons with, deg/h/sqrt(s).
    pub rate_random_walk_deg_per_h_per_sqrt_s: f64,
    /// When the result appears.
    pub output_register: OutputRegister,
}
