//! Noise-delay bound: the least noise gain of consecutive taps with unit DC gain at a given delay.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::theory::memory::memory_samples;
use crate::signal::FilterShape;
use crate::wording::{counted, decimals};

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
    Equations::new(taps, autocovariance)?.least_gain(newest_age_samples, delay_samples)
}

/// The Karush-Kuhn-Tucker equations of [`noise_delay_bound_coloured`], which hold the delay on their
/// right side alone: factored once for all delays.
struct Equations<'a> {
    taps: usize,
    factors: LU<f64, Dyn, Dyn>,
    autocovariance: &'a [f64],
}

impl<'a> Equations<'a> {
    /// The equations of two taps or more; `None` without power or with fewer lags than taps.
    fn new(taps: usize, autocovariance: &'a [f64]) -> Option<Self> {
        let power = *autocovariance.first()?;
        if power <= 0.0 || autocovariance.len() < taps {
            return None;
        }
        // Ages from the middle of the window keep the equations well scaled.
        let centred = |tap: usize| tap as f64 - middle_of(taps);
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
        Some(Self {
            taps,
            factors: matrix.lu(),
            autocovariance,
        })
    }

    fn least_gain(&self, newest_age_samples: usize, delay_samples: f64) -> Option<f64> {
        let taps = self.taps;
        let mut right = DVector::zeros(taps + 2);
        right[taps] = 1.0;
        right[taps + 1] = delay_samples - newest_age_samples as f64 - middle_of(taps);
        let solved = self.factors.solve(&right)?;
        let gain = noise_power_gain(&solved.as_slice()[..taps], self.autocovariance);
        gain.is_finite().then_some(gain)
    }
}

/// Distance from the newest of a number of consecutive taps to their middle, samples.
fn middle_of(taps: usize) -> f64 {
    (taps as f64 - 1.0) / 2.0
}

/// Most taps for which the bound and the autocovariance it needs are computed.
pub(crate) const BOUND_TAPS_MAX: usize = 256;

/// Why a filter has no delay at DC.
pub(crate) const NO_DELAY_AT_DC: &str =
    "the delay at DC is not defined: the weights do not sum to a finite number other than zero";

/// Taps that the bound of a filter has: as many as the filter, and of one without a number of taps as
/// many as it remembers samples to 1 %.
#[must_use]
pub fn bound_taps(shape: &FilterShape) -> usize {
    shape.taps.unwrap_or_else(|| memory_samples(shape))
}

/// A noise power gain and the consecutive samples that reach it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LeastNoise {
    /// Noise power gain.
    pub noise_gain: f64,
    /// Age of the newest weighed sample before the register, samples.
    pub first_age_samples: usize,
}

/// The least noise power gain of a number of consecutive taps with unit DC gain over the delay, for
/// one autocovariance and whatever age the first of them has.
///
/// The autocovariance of a window is the same read backwards. The least gain at a delay is therefore a
/// parabola about the middle of the window, and the best window is the one whose middle is nearest to
/// the delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseDelayBound {
    taps: usize,
    register_samples: usize,
    /// Noise power gain in the middle of the window.
    least: f64,
    /// What it gains with the square of the distance from there in samples; infinite for one tap.
    curvature: f64,
}

impl NoiseDelayBound {
    /// The bound of taps behind an output register; `None` without taps, without noise, or with fewer
    /// lags of the autocovariance than taps.
    #[must_use]
    pub fn new(taps: usize, register_samples: usize, autocovariance: &[f64]) -> Option<Self> {
        if taps < 2 {
            return Self::white(taps, register_samples);
        }
        let equations = Equations::new(taps, autocovariance)?;
        Self::of(taps, register_samples, |delay| {
            equations.least_gain(0, delay)
        })
    }

    /// The same for white noise.
    #[must_use]
    pub fn white(taps: usize, register_samples: usize) -> Option<Self> {
        Self::of(taps, register_samples, |delay| {
            noise_delay_bound(taps, 0, delay)
        })
    }

    /// The parabola through the least gains of the window of ages from 0 on, in its middle and beside.
    fn of(
        taps: usize,
        register_samples: usize,
        gain_at: impl Fn(f64) -> Option<f64>,
    ) -> Option<Self> {
        let middle = middle_of(taps);
        let (least, curvature) = match taps {
            0 => return None,
            1 => (1.0, f64::INFINITY),
            _ => {
                let least = gain_at(middle)?;
                (least, gain_at(middle + 1.0)? - least)
            }
        };
        Some(Self {
            taps,
            register_samples,
            least,
            curvature,
        })
    }

    /// The least gain at a delay in samples, register included; `None` where no such filter has it: a
    /// single tap delays by whole samples only.
    #[must_use]
    pub fn at(&self, delay_samples: f64) -> Option<LeastNoise> {
        let middle = self.register_samples as f64 + middle_of(self.taps);
        let first_age_samples = interval::round_to_count((delay_samples - middle).max(0.0));
        let off_middle = delay_samples - middle - first_age_samples as f64;
        if self.taps == 1 {
            let is_met = off_middle.abs() <= SINGLE_TAP_TOLERANCE_SAMPLES;
            return is_met.then_some(LeastNoise {
                noise_gain: 1.0,
                first_age_samples,
            });
        }
        let noise_gain = self.least + self.curvature * off_middle * off_middle;
        noise_gain.is_finite().then_some(LeastNoise {
            noise_gain,
            first_age_samples,
        })
    }
}

/// [`NoiseDelayBound`] for the taps and the register of a filter.
///
/// # Errors
/// Why there is no bound: it needs at most [`BOUND_TAPS_MAX`] taps, and noise.
pub(crate) fn filter_bound(
    shape: &FilterShape,
    autocovariance: &[f64],
) -> Result<NoiseDelayBound, Unavailable> {
    if let Some(reason) = shape.hidden_reason() {
        return Err(reason.into());
    }
    let taps = bound_taps(shape);
    if taps > BOUND_TAPS_MAX {
        return Err(format!("{taps} taps: it is computed for up to {BOUND_TAPS_MAX}").into());
    }
    if autocovariance.first().is_none_or(|power| *power <= 0.0) {
        return Err("the raw channel has no noise".into());
    }
    NoiseDelayBound::new(taps, shape.register_samples, autocovariance)
        .ok_or_else(|| "the noise of the raw channel determines no least noise gain".into())
}

/// The bound of a filter at one delay.
///
/// # Errors
/// As [`filter_bound`]; and that no filter of its taps can have the delay.
pub(crate) fn filter_bound_at(
    shape: &FilterShape,
    delay_samples: f64,
    autocovariance: &[f64],
) -> Result<LeastNoise, Unavailable> {
    if !delay_samples.is_finite() {
        return Err(NO_DELAY_AT_DC.into());
    }
    let bound = filter_bound(shape, autocovariance)?;
    bound.at(delay_samples).ok_or_else(|| {
        format!(
            "no filter of {} and unit DC gain has a delay of {} samples",
            counted(bound.taps, "tap"),
            decimals(delay_samples, 3)
        )
        .into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::theory::prediction::Prediction;
    use crate::signal::WeightRule;

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
            let reason = filter_bound_at(&shape, delay, &[1.0, 0.0]).unwrap_err();
            assert_eq!(reason.as_str(), NO_DELAY_AT_DC);
        }
        let reason = filter_bound_at(&shape, 1.5, &[0.0, 0.0]).unwrap_err();
        assert_eq!(reason.as_str(), "the raw channel has no noise");
        shape.taps = Some(1);
        let reason = filter_bound_at(&shape, 7.25, &[1.0]).unwrap_err();
        let said = "no filter of 1 tap and unit DC gain has a delay of 7.250 samples";
        assert_eq!(reason.as_str(), said);
    }
}
