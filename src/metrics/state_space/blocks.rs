//! Noise processes as linear systems whose output is the mean rate over a sample.
//!
//! All are exact: the mean over a sample of the continuous process, not the process at its stamp. What the
//! process does within a sample is noise of state and of measurement at once, whence S.

use nalgebra::{DMatrix, DVector};

/// One state.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct State {
    /// Name, unique in its system.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// What it holds.
    pub holds: &'static str,
}

impl State {
    pub(super) fn new(name: impl Into<String>, unit: &'static str, holds: &'static str) -> Self {
        Self {
            name: name.into(),
            unit,
            holds,
        }
    }
}

/// `x[k+1] = F x[k] + w[k]`, `y[k] = H x[k] + v[k]` of one process.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) states: Vec<State>,
    pub(super) transition: DMatrix<f64>,
    pub(super) process_noise: DMatrix<f64>,
    pub(super) observation: DVector<f64>,
    pub(super) measurement_noise: f64,
    pub(super) cross_covariance: DVector<f64>,
    pub(super) initial: DMatrix<f64>,
}

/// White noise of this two-sided density, `(deg/h)^2 s`: it has no state.
pub(super) fn white(density: f64, sample_period_s: f64) -> Block {
    Block {
        states: Vec::new(),
        transition: DMatrix::zeros(0, 0),
        process_noise: DMatrix::zeros(0, 0),
        observation: DVector::zeros(0),
        measurement_noise: density / sample_period_s,
        cross_covariance: DVector::zeros(0),
        initial: DMatrix::zeros(0, 0),
    }
}

/// Exponentially correlated noise, stationary from the first sample on.
///
/// With `x = T/Tc`, `e = exp(-x)` and unit variance: the mean over a sample is `(1 - e)/x` of the state
/// at its start and a rest of variance `2/x - 2(1 - e)/x^2 - (1 - e)^2/x^2`, which covaries with the
/// noise of the state by `(1 - e)^2/x`.
///
/// Source: derived from the covariance `exp(-|t|/Tc)`.
pub(super) fn exponential(
    state: State,
    variance: f64,
    correlation_time_s: f64,
    sample_period_s: f64,
) -> Block {
    let x = sample_period_s / correlation_time_s;
    let fallen = -(-x).exp_m1();
    // The three terms of the rest cancel where a sample is short.
    let rest = if x < 0.01 {
        x * (2.0 / 3.0 - x * (0.5 - x * 7.0 / 30.0))
    } else {
        2.0 / x - fallen * (2.0 + fallen) / (x * x)
    };
    Block {
        states: vec![state],
        transition: DMatrix::from_row_slice(1, 1, &[1.0 - fallen]),
        process_noise: DMatrix::from_row_slice(1, 1, &[variance * fallen * (2.0 - fallen)]),
        observation: DVector::from_column_slice(&[fallen / x]),
        measurement_noise: variance * rest,
        cross_covariance: DVector::from_column_slice(&[variance * fallen * fallen / x]),
        initial: DMatrix::from_row_slice(1, 1, &[variance]),
    }
}

/// Bias that walks by `walk` `(deg/h)^2/s` from zero on, with a slope of this variance, `(deg/h/s)^2`.
///
/// The mean of a walk over a sample is its value at the start and a rest of variance `K^2 T/3`, which
/// covaries with the step by `K^2 T/2`.
pub(super) fn drift(walk: f64, slope_variance: f64, sample_period_s: f64) -> Block {
    let period = sample_period_s;
    let bias = State::new(
        "bias",
        "deg/h",
        "rate random walk and ramp, zero at the start",
    );
    let slope = State::new("rate_ramp", "deg/h/s", "slope of the bias, constant");
    Block {
        states: vec![bias, slope],
        transition: DMatrix::from_row_slice(2, 2, &[1.0, period, 0.0, 1.0]),
        process_noise: DMatrix::from_row_slice(2, 2, &[walk * period, 0.0, 0.0, 0.0]),
        observation: DVector::from_column_slice(&[1.0, 0.5 * period]),
        measurement_noise: walk * period / 3.0,
        cross_covariance: DVector::from_column_slice(&[0.5 * walk * period, 0.0]),
        initial: DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, slope_variance]),
    }
}

/// Rounding of the angle to which every sample is turned, of this variance, `arcsec^2`: the error at the
/// end of one sample is taken back in the next.
pub(super) fn quantisation(variance_arcsec2: f64, sample_period_s: f64) -> Block {
    // An arcsecond in a second is a degree in an hour.
    let per_sample = 1.0 / sample_period_s;
    let error = "error of the angle at the end of the sample before";
    Block {
        states: vec![State::new("quantisation", "arcsec", error)],
        transition: DMatrix::from_row_slice(1, 1, &[0.0]),
        process_noise: DMatrix::from_row_slice(1, 1, &[variance_arcsec2]),
        observation: DVector::from_column_slice(&[-per_sample]),
        measurement_noise: variance_arcsec2 * per_sample * per_sample,
        cross_covariance: DVector::from_column_slice(&[variance_arcsec2 * per_sample]),
        initial: DMatrix::from_row_slice(1, 1, &[variance_arcsec2]),
    }
}

/// Sine of this amplitude in the samples, of a phase that nobody knows.
pub(super) fn sine(amplitude_deg_per_h: f64, period_s: f64, sample_period_s: f64) -> Block {
    let (s, c) = (std::f64::consts::TAU * sample_period_s / period_s).sin_cos();
    let power = 0.5 * amplitude_deg_per_h * amplitude_deg_per_h;
    Block {
        states: vec![
            State::new("sine", "deg/h", "sine in the samples"),
            State::new(
                "sine_quadrature",
                "deg/h",
                "the same a quarter of a period later",
            ),
        ],
        transition: DMatrix::from_row_slice(2, 2, &[c, s, -s, c]),
        process_noise: DMatrix::zeros(2, 2),
        observation: DVector::from_column_slice(&[1.0, 0.0]),
        measurement_noise: 0.0,
        cross_covariance: DVector::zeros(2),
        initial: DMatrix::from_row_slice(2, 2, &[power, 0.0, 0.0, power]),
    }
}
