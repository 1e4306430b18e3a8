//! Differences of the angle of a record that span its gaps.

use std::ops::Range;

use super::angle::angle_about_mean;
use crate::signal::Bridge;

/// A mean rate holds at most one assumed word in so many.
const ASSUMED_PART: usize = 10;

/// The angle of a record with gaps, some of which differences may span.
pub(crate) struct BridgedAngle {
    /// Angle about the mean, `[n + 1]`, in units of one sample period.
    pub(crate) angle: Vec<f64>,
    /// Missing rates before each angle.
    pub(crate) missing: Vec<usize>,
    /// Those of gaps that no difference spans.
    uncrossed: Vec<usize>,
    /// Those whose mean is that of the words on both sides.
    assumed: Vec<usize>,
    /// Whether an angle is known: none within a gap is.
    exists: Vec<bool>,
}

impl BridgedAngle {
    /// * `rates`: deg/h, NaN where one is missing.
    pub(crate) fn of(rates: &[f64], bridges: &[Bridge]) -> Self {
        let mut filled = rates.to_vec();
        let mut is_assumed = vec![false; rates.len()];
        let mut exists = vec![true; rates.len() + 1];
        for bridge in bridges {
            let Range { start, end } = bridge.words.clone();
            filled[start..end].fill(bridge.mean_deg_per_h);
            is_assumed[start..end].fill(!bridge.is_known);
            exists[start + 1..end].fill(false);
        }
        let is_missing = |rates: &[f64]| rates.iter().map(|rate| rate.is_nan()).collect::<Vec<_>>();
        Self {
            angle: angle_about_mean(&filled),
            missing: counts(&is_missing(rates)),
            uncrossed: counts(&is_missing(&filled)),
            assumed: counts(&is_assumed),
            exists,
        }
    }

    /// Sum of the squared second differences that exist at an averaging factor, and their number.
    pub(crate) fn second_difference_sum(&self, m: usize) -> (f64, usize) {
        let angle = &self.angle;
        let starts =
            (0..angle.len().saturating_sub(2 * m)).filter(|start| self.holds(*start, m, 2));
        starts.fold((0.0, 0), |(sum, count), k| {
            let difference = (angle[k + 2 * m] - angle[k + m]) - (angle[k + m] - angle[k]);
            (sum + difference * difference, count + 1)
        })
    }

    /// Whether a difference exists: that of the angles at `start` and each of `span` times `m` behind it.
    ///
    /// All of them are known, no rate between the first and the last is missing but for those of spanned gaps,
    /// and each of the mean rates between them holds at most a tenth of assumed words.
    pub(crate) fn holds(&self, start: usize, m: usize, span: usize) -> bool {
        let end = start + span * m;
        let assumed = |step: usize| {
            let from = start + step * m;
            self.assumed[from + m] - self.assumed[from]
        };
        self.uncrossed[end] == self.uncrossed[start]
            && (0..=span).all(|step| self.exists[start + step * m])
            && (0..span).all(|step| ASSUMED_PART * assumed(step) <= m)
    }
}

/// How many are set before each place.
fn counts(is_set: &[bool]) -> Vec<usize> {
    let mut counts = Vec::with_capacity(is_set.len() + 1);
    let mut sum = 0;
    counts.push(sum);
    for is_set in is_set {
        sum += usize::from(*is_set);
        counts.push(sum);
    }
    counts
}
