//! The configuration of the filters: names are the keys of the scenario file, units included.

use serde::Deserialize;

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

/// What an adaptive filter aims at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DesiredSignal {
    /// The current sample.
    Current,
    /// The mean of the newest two samples.
    TwoSampleMean,
}

/// How the weights of a line enhancer are corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SignLmsForm {
    /// By the sign of the error, over the energy: the patent's.
    Sign,
    /// By the error, over the energy.
    Nlms,
    /// By the error, over the energy, the sum of the weights left alone.
    UnityGain,
}

/// Unit in which the constants of a line enhancer are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum ConstantUnit {
    /// Degrees per hour, the unit of the words.
    #[serde(rename = "deg/h")]
    DegPerH,
    /// Degrees per second.
    #[serde(rename = "deg/s")]
    DegPerS,
    /// Radians per second.
    #[serde(rename = "rad/s")]
    RadPerS,
}

/// Weights of a line enhancer at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InitialWeights {
    /// 1/M in every tap: the mean of the taps.
    Mean,
    /// Zero.
    Zero,
}

/// When a filter's result appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputRegister {
    /// At the next sample tick.
    NextSample,
    /// As soon as it is computed.
    Immediate,
}

/// Sign before the error term of the weight update.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateSign {
    /// Plus: the form that converges.
    Corrected,
    /// Minus, as the paper's equations (6) and (9) print it: diverges.
    AsPrinted,
}

/// Arithmetic of a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pipeline {
    /// The textbook recursion.
    Textbook,
    /// The pipeline of the hardware: every bit and every clock.
    Fpga,
}

/// Words of a hardware pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum NumberFormat {
    /// IEEE 754 binary64.
    #[serde(rename = "binary64")]
    Binary64,
    /// IEEE 754 binary32.
    #[serde(rename = "binary32")]
    Binary32,
    /// binary64 whose subnormal numbers count as zero.
    #[serde(rename = "binary64-ftz")]
    Binary64FlushToZero,
    /// binary32 whose subnormal numbers count as zero.
    #[serde(rename = "binary32-ftz")]
    Binary32FlushToZero,
}

/// Where a hardware pipeline divides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Division {
    /// Once per sample; the products are multiplied by the reciprocal.
    Reciprocal,
    /// Once for each element of the matrix.
    Elementwise,
}

/// Order of the products in the update of the inverse correlation matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateOrder {
    /// `(t_i t_j) r`, the hardware's: the matrix stays symmetric to the last bit.
    Schedule,
    /// `(t_i r) t_j`, the gain vector first: fails below a forgetting factor of 1.
    GainFirst,
}
