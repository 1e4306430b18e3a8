//! The trial of a denoiser: what it must cost in delay, and what theory says it will do.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::signal::FilterShape;

/// Singular values below this part of the largest count as zero: input directions the record does
/// not contain, in which an adaptive filter keeps its initial zero weights.
const RANK_TOLERANCE: f64 = 1e-12;

/// How far, in samples, a single tap may be from the delay asked of it.
const SINGLE_TAP_TOLERANCE_SAMPLES: f64 = 0.01;

/// Power gain of weights on noise of given autocovariance: `sum w_i w_j R(i-j) / R(0)`.
///
/// `autocovariance` has at least as many lags as there are weights.
#[must_use]
pub fn noise_power_gain(weights: &[f64], autocovariance: &[f64]) -> f64 {
    let sum: f64 = weights
        .iter()
        .enumerate()
        .flat_map(|(i, a)| {
            weights
                .iter()
                .enumerate()
                .map(move |(j, b)| a * b * autocovariance[i.abs_diff(j)])
        })
        .sum();
    sum / autocovariance[0]
}

/// Least noise power gain for white noise at unit DC gain and a given delay at DC.
///
/// `1/p + 12 (l + (p-1)/2 - t)^2 / (p (p^2-1))` for p taps on samples of age l ... l+p-1 and a delay
/// of t samples; for p = 1 it is 1 at t = l and no filter exists elsewhere.
///
/// Source: derived (least norm of w under sum w = 1 and sum age w = t).
#[must_use]
pub fn noise_delay_bound(
    taps: usize,
    newest_age_samples: usize,
    delay_samples: f64,
) -> Option<f64> {
    let p = taps as f64;
    let off_centre = newest_age_samples as f64 + (p - 1.0) / 2.0 - delay_samples;
    match taps {
        0 => None,
        1 => (off_centre.abs() <= SINGLE_TAP_TOLERANCE_SAMPLES).then_some(1.0),
        _ => Some(1.0 / p + 12.0 * off_centre * off_centre / (p * (p * p - 1.0))),
    }
}

/// Least noise power gain for noise of any colour at unit DC gain and a given delay at DC.
///
/// Minimises `sum w_i w_j R(i-j)` subject to `sum w = 1` and `sum age w = delay` by the
/// Karush-Kuhn-Tucker equations `[2R C; C^T 0]`. `autocovariance` holds at least `taps` lags.
/// `None` where no filter meets both constraints (one tap elsewhere than its age) or the noise has
/// no power.
///
/// Source: derived; reduces to [`noise_delay_bound`] for white noise.
#[must_use]
pub fn noise_delay_bound_coloured(
    taps: usize,
    newest_age_samples: usize,
    delay_samples: f64,
    autocovariance: &[f64],
) -> Option<f64> {
    if taps < 2 {
        return noise_delay_bound(taps, newest_age_samples, delay_samples);
    }
    let power = *autocovariance.first()?;
    if power <= 0.0 || autocovariance.len() < taps {
        return None;
    }
    // Ages from the middle of the window keep the equations well scaled.
    let middle = (taps as f64 - 1.0) / 2.0;
    let centred = |tap: usize| tap as f64 - middle;
    let matrix = DMatrix::from_fn(taps + 2, taps + 2, |row, column| {
        match (row < taps, column < taps) {
            (true, true) => autocovariance[row.abs_diff(column)] / power,
            (true, false) if column == taps => 1.0,
            (true, false) => centred(row),
            (false, true) if row == taps => 1.0,
            (false, true) => centred(column),
            (false, false) => 0.0,
        }
    });
    let mut right = DVector::zeros(taps + 2);
    right[taps] = 1.0;
    right[taps + 1] = delay_samples - newest_age_samples as f64 - middle;
    let solved = matrix.lu().solve(&right)?;
    let gain = noise_power_gain(&solved.as_slice()[..taps], autocovariance);
    gain.is_finite().then_some(gain)
}

/// The weights a least-squares filter settles at, and what follows from them.
#[derive(Clone, Debug, PartialEq)]
pub struct WienerPrediction {
    /// Optimal weights, newest sample first.
    pub weights: Vec<f64>,
    newest_age_samples: usize,
}

/// Number of lags, zero included, of the second moment that a filter's prediction needs.
#[must_use]
pub fn lags_needed(shape: &FilterShape) -> usize {
    shape.newest_age_samples + shape.taps + shape.desired_weights.len() + shape.register_samples + 1
}

/// Optimal weights `R^-1 p` of a filter on a stationary record.
///
/// * `second_moment`: `E[x(k) x(k-lag)]` by lag, mean included (not centred): an adaptive filter
///   sees the mean as signal; at least [`lags_needed`] values.
///
/// `R_ij = E[x x]` at lag i-j of the weighed samples, `p_i` their product with the desired signal,
/// whose own samples are older by the output register than its weights say. Where R is singular the
/// weights of least norm are taken, which is where an adaptive filter that starts from zero goes.
/// `None` if the record has no power.
///
/// Source: Haykin, Adaptive Filter Theory, chapter 2 (Wiener-Hopf equations).
#[must_use]
pub fn wiener_prediction(shape: &FilterShape, second_moment: &[f64]) -> Option<WienerPrediction> {
    if second_moment.len() < lags_needed(shape) || second_moment[0] <= 0.0 || shape.taps == 0 {
        return None;
    }
    let power = second_moment[0];
    let correlation = DMatrix::from_fn(shape.taps, shape.taps, |i, j| {
        second_moment[i.abs_diff(j)] / power
    });
    let cross = DVector::from_fn(shape.taps, |tap, _| {
        let age = shape.newest_age_samples + tap;
        shape
            .desired_weights
            .iter()
            .enumerate()
            .map(|(desired_age, weight)| {
                weight * second_moment[age.abs_diff(desired_age + shape.register_samples)] / power
            })
            .sum::<f64>()
    });
    let decomposition = correlation.svd(true, true);
    let cutoff = RANK_TOLERANCE * decomposition.singular_values.max();
    let weights = decomposition.solve(&cross, cutoff).ok()?;
    Some(WienerPrediction {
        weights: weights.as_slice().to_vec(),
        newest_age_samples: shape.newest_age_samples,
    })
}

impl WienerPrediction {
    /// Response to a small added constant rate: the sum of the weights.
    #[must_use]
    pub fn dc_gain(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// Delay at DC, samples: `sum age w / sum w`.
    #[must_use]
    pub fn delay_at_dc_samples(&self) -> f64 {
        let first_moment: f64 = self
            .weights
            .iter()
            .enumerate()
            .map(|(tap, weight)| (self.newest_age_samples + tap) as f64 * weight)
            .sum();
        first_moment / self.dc_gain()
    }

    /// Real and imaginary part of `sum w exp(-i w age T)`, the newest age factored out.
    fn response(&self, cycles_per_sample: f64) -> (f64, f64) {
        self.weights
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(real, imaginary), (tap, weight)| {
                let phase = TAU * cycles_per_sample * tap as f64;
                (
                    real + weight * phase.cos(),
                    imaginary - weight * phase.sin(),
                )
            })
    }

    /// Phase delay at a frequency, s, register included.
    #[must_use]
    pub fn delay_s(&self, frequency_hz: f64, sample_period_s: f64) -> f64 {
        let (real, imaginary) = self.response(frequency_hz * sample_period_s);
        self.newest_age_samples as f64 * sample_period_s
            - imaginary.atan2(real) / (TAU * frequency_hz)
    }

    /// Amplitude gain at a frequency.
    #[must_use]
    pub fn amplitude(&self, frequency_hz: f64, sample_period_s: f64) -> f64 {
        let (real, imaginary) = self.response(frequency_hz * sample_period_s);
        real.hypot(imaginary)
    }
}
