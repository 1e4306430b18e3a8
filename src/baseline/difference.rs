//! How sure the difference of two figures is.

use statrs::distribution::{ContinuousCDF as _, FisherSnedecor, Normal, StudentsT};

use super::record::{Entry, Interval};
use crate::metrics::NORMAL_QUANTILE;

/// Repeats from which on pairs are compared.
pub(super) const PAIRS_MIN: usize = 5;

/// How likely differences as large are between figures of the same ensemble value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chance {
    /// Probability of a rise as large.
    pub(super) rise: f64,
    /// Probability of a fall as large.
    pub(super) fall: f64,
}

impl Chance {
    /// Probability of a difference as large in either direction.
    pub(super) fn either(self) -> f64 {
        (2.0 * self.rise.min(self.fall)).min(1.0)
    }
}

/// Of a difference with its standard error, of which `tolerance` counts for nothing.
fn of_deviates(difference: f64, tolerance: f64, tail: impl Fn(f64, bool) -> f64) -> Chance {
    Chance {
        rise: tail(difference - tolerance, difference > 0.0),
        fall: tail(-difference - tolerance, difference > 0.0),
    }
}

/// Pairs of figures that share their noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pairs {
    /// Repeats, so many.
    Repeats(usize),
    /// Blocks of the samples, so many.
    Blocks(usize),
}

/// Pair by pair: Student's t of the differences of figures that share their noise, and their mean. `None`
/// where there are no pairs, or they do not differ.
pub(super) fn paired(old: &Entry, new: &Entry, tolerance: f64) -> Option<(Pairs, f64, Chance)> {
    if old.seed != new.seed {
        return None;
    }
    let of = |old: &[f64], new: &[f64]| {
        let count = old.len();
        if count < PAIRS_MIN || count != new.len() {
            return None;
        }
        let pairs = old.iter().zip(new);
        let differences: Vec<f64> = pairs.map(|(old, new)| new - old).collect();
        let (mean, chance) = student(&differences, tolerance)?;
        Some((count, mean, chance))
    };
    if let Some((count, mean, chance)) = of(&old.repeats, &new.repeats) {
        return Some((Pairs::Repeats(count), mean, chance));
    }
    let (count, mean, chance) = of(&old.blocks, &new.blocks)?;
    Some((Pairs::Blocks(count), mean, chance))
}

/// Mean of differences and the chance of it; `None` where all are zero.
fn student(differences: &[f64], tolerance: f64) -> Option<(f64, Chance)> {
    if differences.iter().all(|difference| *difference == 0.0) {
        return None;
    }
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let squares: f64 = differences.iter().map(|it| (it - mean).powi(2)).sum();
    let error = (squares / (n - 1.0) / n).sqrt();
    let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
    let chance = of_deviates(mean, tolerance, |excess, _| {
        tail(excess, error, |t| student.sf(t))
    });
    Some((mean, chance))
}

/// As independent: two standard deviations by their degrees of freedom (Fisher's F), else the two intervals.
///
/// The side of each interval that faces the other counts (MOVER): a figure whose interval reaches far up
/// is not far below another.
///
/// # Source
/// G. Y. Zou, A. Donner, "Construction of confidence limits about effect measures", Stat. Med. 27 (2008).
pub(super) fn unpaired(old: &Entry, new: &Entry, tolerance: f64) -> Option<Chance> {
    let (old_ends, new_ends) = (ends(old)?, ends(new)?);
    let difference = new.value - old.value;
    let freedom = old.degrees_of_freedom.zip(new.degrees_of_freedom);
    if let Some((old_freedom, new_freedom)) = freedom
        && old.value > 0.0
        && new.value > 0.0
        && old_freedom > 0.0
        && new_freedom > 0.0
    {
        let rise = FisherSnedecor::new(new_freedom, old_freedom).ok()?;
        let fall = FisherSnedecor::new(old_freedom, new_freedom).ok()?;
        let ratio = |more: f64, less: f64| (more / (less + tolerance)).powi(2);
        return Some(Chance {
            rise: rise.sf(ratio(new.value, old.value)),
            fall: fall.sf(ratio(old.value, new.value)),
        });
    }
    let normal = Normal::standard();
    let above = f64::hypot(new.value - new_ends.0, old_ends.1 - old.value) / NORMAL_QUANTILE;
    let below = f64::hypot(new_ends.1 - new.value, old.value - old_ends.0) / NORMAL_QUANTILE;
    Some(of_deviates(difference, tolerance, |excess, is_above| {
        let error = if is_above { above } else { below };
        tail(excess, error, |z| normal.sf(z))
    }))
}

/// Probability beyond an excess of so many errors.
fn tail(excess: f64, error: f64, beyond: impl Fn(f64) -> f64) -> f64 {
    if error > 0.0 {
        beyond(excess / error)
    } else if excess > 0.0 {
        0.0
    } else {
        1.0
    }
}

/// Ends of an interval; those of an exact value are itself.
pub(super) fn ends(entry: &Entry) -> Option<(f64, f64)> {
    let (low, high) = match entry.interval {
        Interval::Confidence { low, high } => (low, high),
        Interval::Exact => (entry.value, entry.value),
        Interval::Absent => return None,
    };
    (low.is_finite() && high.is_finite()).then_some((low, high))
}
