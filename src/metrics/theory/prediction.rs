//! What theory says a filter will do to a stationary record.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::bound::{BOUND_TAPS_MAX, bound_taps};
use crate::linear_algebra::singular_value_decomposition;
use crate::signal::{FilterShape, Section, WeightRule};

/// Singular values below this part of the largest count as zero: input directions the record does
/// not contain, in which an adaptive filter keeps its initial zero weights.
const RANK_TOLERANCE: f64 = 1e-12;

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
    let taps = Some(bound_taps(shape))
        .filter(|taps| *taps <= BOUND_TAPS_MAX)
        .unwrap_or(0);
    let desired = match &shape.rule {
        WeightRule::Adaptive {
            desired_weights, ..
        } => desired_weights.len(),
        WeightRule::Fixed(_) | WeightRule::Sections(_) | WeightRule::Hidden(_) => 0,
    };
    shape.newest_age_samples + taps + desired + shape.register_samples + 1
}

/// What a filter does to a stationary record: of an adaptive one the optimal weights, of one whose
/// weights are given those.
///
/// * `second_moment`: `E[x(k) x(k-lag)]` by lag, mean included (not centred): an adaptive filter
///   sees the mean as signal; at least [`lags_needed`] values.
///
/// `None` if the record has no power and the weights would adapt to it, or if they are hidden.
#[must_use]
pub fn predict(shape: &FilterShape, second_moment: &[f64]) -> Option<Prediction> {
    let response = match &shape.rule {
        WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one,
            ..
        } => {
            let weights = wiener_weights(shape, desired_weights, *is_dc_gain_one, second_moment)?;
            ImpulseResponse::Finite(weights)
        }
        WeightRule::Fixed(weights) => ImpulseResponse::Finite(weights.clone()),
        WeightRule::Sections(sections) => ImpulseResponse::Infinite(sections.clone()),
        WeightRule::Hidden(_) => return None,
    };
    Some(Prediction {
        response,
        newest_age_samples: shape.newest_age_samples,
    })
}

/// Why [`predict`] predicts nothing of a filter.
pub(crate) fn prediction_lack(shape: &FilterShape) -> &'static str {
    let hidden = shape.hidden_reason();
    hidden.unwrap_or("the raw channel has no power")
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
