//! How much a metric changes with the condition under which it was measured.
//!
//! The temperature sensitivities of bias and scale factor are of this form: `Bt = max |B_i - B_m| /
//! |T_i - T_m|` and `Kt = max |K_i - K_m| / (K_m |T_i - T_m|)` about the test m at the reference
//! temperature. Source: GJB 2426A and IEEE Std 952; the interval is derived.

use crate::metrics::estimate::interval::student_quantile_of_many;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::MetricKey;
use crate::metrics::steps::staircase::SCALE_FACTOR_ERROR;

/// Degrees of freedom at which Student's t is normal.
const MANY: f64 = 1e6;

/// A metric under one condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConditionPoint {
    /// Condition, e.g. a temperature in C.
    pub condition: f64,
    /// The metric there, with its 95 % interval.
    pub estimate: Estimate,
}

/// Largest change of a metric per unit of the condition, and where it is.
///
/// `max_i |x_i - x_m| / |c_i - c_m|` about the reference m, in the metric's unit per unit of the
/// condition; points at the reference condition are left out. `None` if there is no other. The
/// second part is the index of the point that gives the largest.
///
/// Each difference has the square sum of the half widths of its two ends (Zou and Donner, 2008), as
/// of independent records; records that share their noise make that too wide, never too narrow. The
/// interval of the largest holds for all differences at once (Bonferroni) and reaches to zero if
/// none of them is told apart from zero.
#[must_use]
pub fn largest_change_per_unit(
    reference: ConditionPoint,
    points: &[ConditionPoint],
) -> Option<(Estimate, usize)> {
    let others = points.iter().enumerate();
    let others: Vec<(usize, &ConditionPoint)> = others
        .filter(|(_, point)| (point.condition - reference.condition).abs() > 0.0)
        .collect();
    let widening = student_quantile_of_many(MANY, others.len()) / student_quantile_of_many(MANY, 1);
    let changes = others.iter().map(|(index, point)| {
        let distance = (point.condition - reference.condition).abs();
        let change = magnitude_of_difference(point.estimate, reference.estimate, widening);
        (change.scaled(1.0 / distance), *index)
    });
    changes.reduce(|largest, next| {
        let is_larger = next.0.value > largest.0.value;
        let (kept, index) = if is_larger { next } else { largest };
        let hull = Estimate {
            low: largest.0.low.max(next.0.low),
            high: largest.0.high.max(next.0.high),
            ..kept
        };
        (hull, index)
    })
}

/// `|x - y|` with its interval, half widths times `widening`.
fn magnitude_of_difference(x: Estimate, y: Estimate, widening: f64) -> Estimate {
    let difference = x.value - y.value;
    let below = (x.value - x.low).hypot(y.high - y.value);
    let above = (x.high - x.value).hypot(y.value - y.low);
    let (low, high) = (difference - widening * below, difference + widening * above);
    let (low, high) = if low > 0.0 {
        (low, high)
    } else if high < 0.0 {
        (-high, -low)
    } else {
        (0.0, high.max(-low))
    };
    Estimate {
        confidence: x.confidence.min(y.confidence),
        ..Estimate::with_interval(difference.abs(), low, high)
    }
}

/// What a change of a metric is divided by: the scale factor at the reference for the error of a
/// scale factor, so that the change is relative to it; 1 for every other metric.
///
/// * `reference`: the metric at the reference, in its own unit.
#[must_use]
pub fn change_divisor(key: &MetricKey, reference: f64) -> f64 {
    if *key == SCALE_FACTOR_ERROR {
        (1.0 + 1e-6 * reference).abs()
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::scale_factor_temperature_sensitivity;

    fn point(condition: f64, value: f64, half_width: f64) -> ConditionPoint {
        let estimate = Estimate::symmetric(value, half_width);
        ConditionPoint {
            condition,
            estimate,
        }
    }

    #[test]
    fn a_scale_factor_changes_per_kelvin_as_the_standard_defines_it() {
        let errors = [(-40.0, 1513.0), (25.0, 2000.0), (60.0, 2262.0)];
        let factors = errors.map(|(temperature, ppm)| (temperature, 1.0 + 1e-6 * ppm));
        let expected = scale_factor_temperature_sensitivity(factors[1], &factors);
        let points = errors.map(|(temperature, ppm)| point(temperature, ppm, 0.0));
        let (change, at) = largest_change_per_unit(points[1], &points).expect("two changes");
        let found = change.value / change_divisor(&SCALE_FACTOR_ERROR, 2000.0);
        let expected = 1e6 * expected.expect("two changes");
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        assert_eq!(at, 0, "487 ppm of 65 K are more than 262 ppm of 35 K");
        assert!(change.high - change.low <= 0.0);
    }

    #[test]
    fn the_interval_adds_both_ends_and_holds_for_every_difference_at_once() {
        let reference = point(0.0, 1.0, 0.3);
        let one = largest_change_per_unit(reference, &[point(-2.0, 5.0, 0.4), reference]);
        let (one, _) = one.expect("a change");
        assert!((one.value - 2.0).abs() < 1e-12);
        assert!((one.low - 1.75).abs() < 1e-12 && (one.high - 2.25).abs() < 1e-12);
        // Quantile 1 - 0.0125 of the normal distribution over that of 0.975; Student's of a million
        // degrees of freedom is found by bisection, to 1e-4.
        let two = [point(-2.0, 5.0, 0.4), point(100.0, 1.0, 0.4)];
        let (two, at) = largest_change_per_unit(reference, &two).expect("a change");
        assert_eq!(at, 0);
        let expected = 0.25 * 2.241_403 / 1.959_964;
        assert!((two.high - 2.0 - expected).abs() < 1e-4, "{two:?}");
    }

    #[test]
    fn a_change_within_the_noise_reaches_to_zero_and_one_condition_gives_none() {
        let reference = point(25.0, 1.0, 0.3);
        let (change, _) =
            largest_change_per_unit(reference, &[point(26.0, 0.9, 0.4)]).expect("a change");
        assert!(change.low.abs() <= 0.0);
        assert!((change.high - 0.6).abs() < 1e-12);
        assert_eq!(largest_change_per_unit(reference, &[reference]), None);
    }
}
