//! How far outputs lie from their line, of full scale and of reading, and what noise alone does.
//!
//! Source: IEEE Std 952 and GJB 2426A for both definitions; the intervals and the noise floor are
//! derived here.

use statrs::function::erf::erf;

use crate::metrics::estimate::magnitude::{LargestOf, REACH};
use crate::metrics::estimate::value::Estimate;

/// Intervals of Simpson's rule in [`expected_largest`]; the error is then below 1e-6.
const INTERVALS: u32 = 400;

/// Distance of one point from the line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Residual {
    /// Output minus the line, deg/h.
    pub value_deg_per_h: f64,
    /// Its standard deviation by the noise of all points, deg/h; 0 where that is not known.
    pub deviation_deg_per_h: f64,
    /// Degrees of freedom of that standard deviation.
    pub degrees_of_freedom: f64,
    /// The same standard deviation by the noise that the points have in common, as far as their own differ
    /// by no more than chance, deg/h.
    pub pooled_deviation_deg_per_h: f64,
    /// The line at the point, deg/h.
    pub reading_deg_per_h: f64,
    /// Whether the table moved, so that there is a reading to compare with.
    pub is_moved: bool,
}

/// The largest distance of all points as a ratio, and how large noise alone would make it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Nonlinearity {
    /// Largest ratio, with the interval of its mean over many records: the largest of many residuals
    /// is large by chance, and so is its mean.
    pub value: Estimate,
    /// Expected largest ratio of an ideal gyro with the noise of these points.
    pub noise_floor: f64,
}

impl Nonlinearity {
    /// `max_j |F_j - (K W_j + F0)| / |F_max|`.
    #[must_use]
    pub fn of_full_scale(residuals: &[Residual], full_scale_deg_per_h: f64) -> Self {
        Self::largest(residuals, |_| Some(full_scale_deg_per_h))
    }

    /// `max_j |F_j - (K W_j + F0)| / |K W_j + F0|` without the points at rest.
    #[must_use]
    pub fn of_reading(residuals: &[Residual]) -> Self {
        Self::largest(residuals, |residual| {
            residual
                .is_moved
                .then_some(residual.reading_deg_per_h.abs())
        })
    }

    /// The largest of the residuals over their `divisor`; those without one are left out.
    fn largest(residuals: &[Residual], divisor: impl Fn(&Residual) -> Option<f64>) -> Self {
        let parts: Vec<(f64, f64, f64)> = residuals
            .iter()
            .filter_map(|residual| {
                let divisor = divisor(residual)?;
                let size = residual.value_deg_per_h.abs() / divisor;
                let pooled = residual.pooled_deviation_deg_per_h / divisor;
                let own = residual.deviation_deg_per_h / divisor;
                Some((size, pooled, own))
            })
            .collect();
        let sizes: Vec<(f64, f64)> = parts.iter().map(|part| (part.0, part.1)).collect();
        let deviations: Vec<f64> = parts.iter().map(|part| part.2).collect();
        Self {
            value: LargestOf::of(&sizes),
            noise_floor: expected_largest(&deviations),
        }
    }
}

/// Expected largest magnitude of independent normal deviates of these standard deviations.
///
/// `integral of 1 - prod erf(x / (s_j sqrt 2))` from 0. The residuals of a line are correlated by
/// one part in their number; by Sidak's inequality that can only lower the expectation.
#[must_use]
pub fn expected_largest(deviations: &[f64]) -> f64 {
    let noisy: Vec<f64> = deviations.iter().copied().filter(|s| *s > 0.0).collect();
    let widest = noisy.iter().copied().fold(0.0, f64::max);
    let reach = REACH * widest;
    let exceeded = |x: f64| {
        let inside = noisy
            .iter()
            .map(|deviation| erf(x / (deviation * std::f64::consts::SQRT_2)));
        1.0 - inside.product::<f64>()
    };
    let step = reach / f64::from(INTERVALS);
    let weighted = (0..=INTERVALS).map(|node| {
        let weight = match node {
            0 | INTERVALS => 1.0,
            _ if node % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * exceeded(f64::from(node) * step)
    });
    if noisy.is_empty() {
        return 0.0;
    }
    weighted.sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expected_largest_of_normal_deviates_is_that_of_the_tables() {
        let close = |got: f64, want: f64| assert!((got - want).abs() < 1e-5, "{got} {want}");
        // One: sqrt(2 / pi). Two: 2 / sqrt(pi). A silent third changes nothing.
        close(expected_largest(&[1.0]), 0.797_884_56);
        close(
            expected_largest(&[1.0, 1.0]),
            std::f64::consts::FRAC_2_SQRT_PI,
        );
        close(
            expected_largest(&[3.0, 0.0, 3.0]),
            3.0 * std::f64::consts::FRAC_2_SQRT_PI,
        );
        // Two unequal ones: sqrt(2 / pi) sqrt(s1^2 + s2^2).
        close(expected_largest(&[3.0, 4.0]), 5.0 * 0.797_884_56);
        assert!(expected_largest(&[]).abs() < f64::MIN_POSITIVE);
    }
}
