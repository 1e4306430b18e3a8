//! Sums of products over stretches of words, with sharp ends or such that fade.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use nalgebra::{DMatrix, DVectorView};

/// Variance of a sum of white values over that of the sums under tapers of raised cosines, which
/// overlap by half.
pub(super) const TAPERED_POWER: f64 = 4.0 / 3.0;

/// A stretch whose ends fade into its neighbours.
///
/// Behind a motion the error of a filter has next to no noise at its frequency: what a stretch with
/// sharp ends sums is what the ends cut off, which the next stretch takes back.
pub(super) struct Taper {
    /// Words under the taper.
    pub(super) range: Range<usize>,
    /// Its value at each.
    pub(super) weights: Vec<f64>,
}

impl Taper {
    /// From the middle of the stretch before to that of the one behind; the first and the last of all
    /// have sharp outer ends.
    pub(super) fn of(ranges: &[Range<usize>], stretch: usize) -> Self {
        let middle = |range: &Range<usize>| usize::midpoint(range.start, range.end);
        let own = &ranges[stretch];
        let before = stretch.checked_sub(1).map(|at| middle(&ranges[at]));
        let behind = ranges.get(stretch + 1).map(middle);
        let range = before.unwrap_or(own.start)..behind.unwrap_or(own.end);
        let centre = middle(own);
        let part = |index: usize, from: usize, to: usize| {
            (index as f64 + 0.5 - from as f64) / (to as f64 - from as f64)
        };
        let weights = range
            .clone()
            .map(|index| match (index < centre, before, behind) {
                (true, Some(before), _) => (FRAC_PI_2 * part(index, before, centre)).sin().powi(2),
                (false, _, Some(behind)) => (FRAC_PI_2 * part(index, centre, behind)).cos().powi(2),
                _ => 1.0,
            })
            .collect();
        Self { range, weights }
    }
}

/// What a least-squares filter regresses on what.
pub(super) struct Regression<'a> {
    /// Age of the newest regressor, samples.
    pub(super) lag: usize,
    /// Regressors.
    pub(super) taps: usize,
    /// Weights of the desired signal, newest sample first.
    pub(super) desired_weights: &'a [f64],
}

impl Regression<'_> {
    /// Sums of products of regressors, desired signal and 1 over the words of a range, weighted or not.
    pub(super) fn products(
        &self,
        words: &[f64],
        range: Range<usize>,
        weights: Option<&[f64]>,
    ) -> DMatrix<f64> {
        let taps = self.taps;
        let aged = |age: usize| &words[range.start - age..range.end - age];
        let mut desired = vec![0.0; range.len()];
        for (age, weight) in self.desired_weights.iter().enumerate() {
            for (sum, word) in desired.iter_mut().zip(aged(age)) {
                *sum += weight * word;
            }
        }
        let ones = vec![1.0; range.len()];
        let column = |index: usize| match index.checked_sub(taps) {
            None => aged(self.lag + index),
            Some(0) => desired.as_slice(),
            Some(_) => ones.as_slice(),
        };
        let mut moments = DMatrix::zeros(taps + 2, taps + 2);
        let mut weighted = Vec::with_capacity(range.len());
        for row in 0..taps + 2 {
            let own = match weights {
                None => column(row),
                Some(weights) => {
                    weighted.clear();
                    weighted.extend(column(row).iter().zip(weights).map(|(word, by)| word * by));
                    weighted.as_slice()
                }
            };
            for other in row..taps + 2 {
                let sum = dot(own, column(other));
                moments[(row, other)] = sum;
                moments[(other, row)] = sum;
            }
        }
        moments
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    let view = DVectorView::from_slice(one, one.len());
    view.dot(&DVectorView::from_slice(other, other.len()))
}
