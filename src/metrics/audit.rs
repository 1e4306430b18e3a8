//! The trial of a denoiser: what it must cost in delay, and what theory says it will do.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::linear_algebra::singular_value_decomposition;
use crate::signal::{FilterShape, Section, WeightRule};
use crate::wording::{counted, decimals};

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

/// Most taps for which the bound and the autocovariance it needs are computed.
const BOUND_TAPS_MAX: usize = 256;

/// Why a filter has no delay at DC.
pub(crate) const NO_DELAY_AT_DC: &str =
    "the delay at DC is not defined: the weights do not sum to a finite number other than zero";

/// [`noise_delay_bound_coloured`] for the taps and ages of a filter.
///
/// # Errors
/// Why there is no bound: it needs a finite number of taps, at most [`BOUND_TAPS_MAX`], that can
/// have the delay, and noise.
pub(crate) fn filter_bound(
    shape: &FilterShape,
    delay_samples: f64,
    autocovariance: &[f64],
) -> Result<f64, String> {
    let Some(taps) = shape.taps else {
        return Err(
            "with unlimited taps there is no least noise gain at a delay at DC: more taps always \
             allow less"
                .to_owned(),
        );
    };
    if taps > BOUND_TAPS_MAX {
        return Err(format!(
            "{taps} taps: it is computed for up to {BOUND_TAPS_MAX}"
        ));
    }
    if !delay_samples.is_finite() {
        return Err(NO_DELAY_AT_DC.to_owned());
    }
    if autocovariance.first().is_none_or(|power| *power <= 0.0) {
        return Err("the raw channel has no noise".to_owned());
    }
    let newest = shape.newest_age_samples;
    noise_delay_bound_coloured(taps, newest, delay_samples, autocovariance).ok_or_else(|| {
        format!(
            "no filter of {} and unit DC gain has a delay of {} samples",
            counted(taps, "tap"),
            decimals(delay_samples, 3)
        )
    })
}

/// What a filter does to a stationary record, and what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    response: ImpulseResponse,
    newest_age_samples: usize,
}

/// The impulse response of a filter, the register left out.
#[derive(Clone, Debug, PartialEq)]
enum ImpulseResponse {
    /// Weights, newest sample first.
    Finite(Vec<f64>),
    /// A cascade.
    Infinite(Vec<Section>),
}

/// Number of lags, zero included, of the second moment that a filter's prediction and its bound need.
#[must_use]
pub fn lags_needed(shape: &FilterShape) -> usize {
    let taps = shape
        .taps
        .filter(|taps| *taps <= BOUND_TAPS_MAX)
        .unwrap_or(0);
    let desired = match &shape.rule {
        WeightRule::Adaptive {
            desired_weights, ..
        } => desired_weights.len(),
        WeightRule::Fixed(_) | WeightRule::Sections(_) => 0,
    };
    shape.newest_age_samples + taps + desired + shape.register_samples + 1
}

/// What a filter does to a stationary record: of an adaptive one the optimal weights, of one whose
/// weights are given those.
///
/// * `second_moment`: `E[x(k) x(k-lag)]` by lag, mean included (not centred): an adaptive filter
///   sees the mean as signal; at least [`lags_needed`] values.
///
/// `None` if the record has no power and the weights would adapt to it.
#[must_use]
pub fn predict(shape: &FilterShape, second_moment: &[f64]) -> Option<Prediction> {
    let response = match &shape.rule {
        WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one,
        } => {
            let weights = wiener_weights(shape, desired_weights, *is_dc_gain_one, second_moment)?;
            ImpulseResponse::Finite(weights)
        }
        WeightRule::Fixed(weights) => ImpulseResponse::Finite(weights.clone()),
        WeightRule::Sections(sections) => ImpulseResponse::Infinite(sections.clone()),
    };
    Some(Prediction {
        response,
        newest_age_samples: shape.newest_age_samples,
    })
}

/// Optimal weights `R^-1 p` of an adaptive filter, newest sample first.
///
/// `R_ij = E[x x]` at lag i-j of the weighed samples, `p_i` their product with the desired signal,
/// whose own samples are older by the output register than its weights say. Where R is singular the
/// weights of least norm are taken, which is where an adaptive filter that starts from zero goes.
/// Held to unit DC gain they are `R^-1 (p + m 1)`, with m such that their sum is 1.
///
/// Source: Haykin, Adaptive Filter Theory, chapter 2 (Wiener-Hopf equations, linear constraints).
fn wiener_weights(
    shape: &FilterShape,
    desired_weights: &[f64],
    is_dc_gain_one: bool,
    second_moment: &[f64],
) -> Option<Vec<f64>> {
    let taps = shape.taps?;
    if second_moment.len() < lags_needed(shape) || second_moment[0] <= 0.0 {
        return None;
    }
    let power = second_moment[0];
    let correlation = DMatrix::from_fn(taps, taps, |i, j| second_moment[i.abs_diff(j)] / power);
    let cross = DVector::from_fn(taps, |tap, _| {
        let age = shape.newest_age_samples + tap;
        desired_weights
            .iter()
            .enumerate()
            .map(|(desired_age, weight)| {
                weight * second_moment[age.abs_diff(desired_age + shape.register_samples)] / power
            })
            .sum::<f64>()
    });
    let decomposition = singular_value_decomposition(correlation, true, true)?;
    let cutoff = RANK_TOLERANCE * decomposition.singular_values.max();
    let mut weights = decomposition.solve(&cross, cutoff).ok()?;
    if is_dc_gain_one {
        let ones = decomposition
            .solve(&DVector::from_element(taps, 1.0), cutoff)
            .ok()?;
        weights += &ones * ((1.0 - weights.sum()) / ones.sum());
    }
    Some(weights.as_slice().to_vec())
}

impl Prediction {
    /// The response of given weights, newest sample first, the newest of the given age.
    #[must_use]
    pub fn of_weights(weights: Vec<f64>, newest_age_samples: usize) -> Self {
        Self {
            response: ImpulseResponse::Finite(weights),
            newest_age_samples,
        }
    }

    /// The response of a cascade whose newest sample has the given age.
    #[must_use]
    pub fn of_sections(sections: Vec<Section>, newest_age_samples: usize) -> Self {
        Self {
            response: ImpulseResponse::Infinite(sections),
            newest_age_samples,
        }
    }

    /// The weights, newest sample first; `None` for an infinite impulse response.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        match &self.response {
            ImpulseResponse::Finite(weights) => Some(weights),
            ImpulseResponse::Infinite(_) => None,
        }
    }

    /// Response to a small added constant rate: the sum of the impulse response.
    #[must_use]
    pub fn dc_gain(&self) -> f64 {
        self.at(0.0).0
    }

    /// Delay at DC, samples: `sum age w / sum w`.
    #[must_use]
    pub fn delay_at_dc_samples(&self) -> f64 {
        /// First moment over sum of a polynomial in `z^-1`.
        fn centroid(coefficients: &[f64]) -> f64 {
            let moments = coefficients.iter().enumerate();
            let first: f64 = moments.map(|(age, value)| age as f64 * value).sum();
            first / coefficients.iter().sum::<f64>()
        }
        let own = match &self.response {
            ImpulseResponse::Finite(weights) => centroid(weights),
            ImpulseResponse::Infinite(sections) => sections
                .iter()
                .map(|section| {
                    let [a1, a2] = section.denominator;
                    centroid(&section.numerator) - centroid(&[1.0, a1, a2])
                })
                .sum(),
        };
        self.newest_age_samples as f64 + own
    }

    /// Real and imaginary part of the response, the newest age factored out.
    fn at(&self, cycles_per_sample: f64) -> (f64, f64) {
        let polynomial = |coefficients: &[f64]| {
            coefficients
                .iter()
                .enumerate()
                .fold((0.0, 0.0), |(real, imaginary), (age, value)| {
                    let phase = TAU * cycles_per_sample * age as f64;
                    (real + value * phase.cos(), imaginary - value * phase.sin())
                })
        };
        match &self.response {
            ImpulseResponse::Finite(weights) => polynomial(weights),
            ImpulseResponse::Infinite(sections) => {
                sections.iter().fold((1.0, 0.0), |(re, im), section| {
                    let [a1, a2] = section.denominator;
                    let (top_re, top_im) = polynomial(&section.numerator);
                    let (low_re, low_im) = polynomial(&[1.0, a1, a2]);
                    let power = low_re * low_re + low_im * low_im;
                    let (ratio_re, ratio_im) = (
                        (top_re * low_re + top_im * low_im) / power,
                        (top_im * low_re - top_re * low_im) / power,
                    );
                    (re * ratio_re - im * ratio_im, re * ratio_im + im * ratio_re)
                })
            }
        }
    }

    /// Phase delay at a frequency, s, register included.
    #[must_use]
    pub fn delay_s(&self, frequency_hz: f64, sample_period_s: f64) -> f64 {
        let (real, imaginary) = self.at(frequency_hz * sample_period_s);
        self.newest_age_samples as f64 * sample_period_s
            - imaginary.atan2(real) / (TAU * frequency_hz)
    }

    /// Amplitude gain at a frequency.
    #[must_use]
    pub fn amplitude(&self, frequency_hz: f64, sample_period_s: f64) -> f64 {
        let (real, imaginary) = self.at(frequency_hz * sample_period_s);
        real.hypot(imaginary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_that_is_none_says_what_is_the_matter() {
        let mut shape = FilterShape {
            rule: WeightRule::Fixed(vec![1.0, -1.0]),
            taps: Some(2),
            newest_age_samples: 1,
            register_samples: 0,
        };
        let of_zero_sum = Prediction::of_weights(vec![1.0, -1.0], 1).delay_at_dc_samples();
        for delay in [of_zero_sum, f64::NAN] {
            let reason = filter_bound(&shape, delay, &[1.0, 0.0]).unwrap_err();
            assert_eq!(reason, NO_DELAY_AT_DC);
        }
        let reason = filter_bound(&shape, 1.5, &[0.0, 0.0]).unwrap_err();
        assert_eq!(reason, "the raw channel has no noise");
        shape.taps = Some(1);
        let reason = filter_bound(&shape, 7.25, &[1.0]).unwrap_err();
        let said = "no filter of 1 tap and unit DC gain has a delay of 7.250 samples";
        assert_eq!(reason, said);
    }
}
