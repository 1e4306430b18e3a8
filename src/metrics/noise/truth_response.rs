//! What a channel shows of the true rate, taken out by regression, so that noise alone is left.

use nalgebra::{DMatrix, DVector};

use crate::linear_algebra::singular_value_decomposition;
use crate::metrics::estimate::interval;
use crate::metrics::record::{FilterFacts, Record};

/// Lagged copies of the truth that the regression weighs.
const COLUMNS: usize = 16;

/// Lags, at least, that the response of a gyro spans, samples.
const GYRO_LAGS: usize = 15;

/// Lags, at most.
const LAGS_MAX: usize = 120;

/// Part of the channel's own scatter below which the truth's is left alone.
const NEGLIGIBLE: f64 = 1e-6;

/// Part of a rate within which it stands still but for rounding.
const STILL: f64 = 1e-9;

/// Eigenvalues below this part of the largest count as zero: a slow truth makes its lagged copies
/// nearly alike.
const RANK_TOLERANCE: f64 = 1e-11;

/// Samples of the truth that reach an output: those of the gyro, and the taps of a filter.
pub(crate) fn reach(filter: Option<&FilterFacts>) -> usize {
    let of_filter = filter.map_or(0, |facts| {
        facts.shape.newest_age_samples + facts.shape.taps.unwrap_or(GYRO_LAGS)
    });
    (GYRO_LAGS + of_filter).min(LAGS_MAX)
}

/// Words without their noise: what a finite impulse response to the truth explains, mean included.
///
/// Both series have the same length.
#[must_use]
pub fn known_motion(words: &[f64], truth: &[f64]) -> Vec<f64> {
    let (mean, mean_truth) = (interval::mean(words), interval::mean(truth));
    let mut noise: Vec<f64> = words.iter().map(|word| word - mean).collect();
    let about: Vec<f64> = truth.iter().map(|rate| rate - mean_truth).collect();
    remove_response(&mut noise, &about, reach(None));
    words
        .iter()
        .zip(noise)
        .map(|(word, noise)| word - noise)
        .collect()
}

/// Takes out of `values` what a finite impulse response of length `reach` to `truth` explains.
///
/// Both are about their means or fitted sines. The harmonics that friction puts into a table's
/// swing, its unsteadiness and the Earth's rate on an axis that turns are no noise of the gyro: the
/// truth is known, and 16 lagged copies of it, equally spaced, span any smooth response to it. The
/// least-squares weights of least norm are taken. Values are left alone where the truth hardly
/// scatters. Where no weights can be found (squares beyond binary64) nothing is left of the values, so
/// that no metric rests on them. Source: derived (linear regression on lagged inputs).
pub(crate) fn remove_response(values: &mut [f64], truth: &[f64], reach: usize) {
    let power = |series: &[f64]| series.iter().map(|value| value * value).sum::<f64>();
    let (own, of_truth) = (power(values), power(truth));
    if of_truth <= NEGLIGIBLE * NEGLIGIBLE * own || values.len() < 10 * COLUMNS {
        return;
    }
    let stride = reach.div_ceil(COLUMNS - 1).max(1);
    let fill = |index: usize, lagged: &mut [f64; COLUMNS]| {
        for (column, value) in lagged.iter_mut().enumerate() {
            *value = truth[index.saturating_sub(column * stride)];
        }
    };
    let mut normal = [[0.0; COLUMNS]; COLUMNS];
    let mut right = [0.0; COLUMNS];
    let mut lagged = [0.0; COLUMNS];
    for (index, value) in values.iter().enumerate() {
        fill(index, &mut lagged);
        for (row, own) in normal.iter_mut().zip(&lagged) {
            for (entry, other) in row.iter_mut().zip(&lagged) {
                *entry += own * other;
            }
        }
        for (entry, own) in right.iter_mut().zip(&lagged) {
            *entry += own * value;
        }
    }
    let matrix = DMatrix::from_fn(COLUMNS, COLUMNS, |row, column| normal[row][column]);
    let solved = singular_value_decomposition(matrix, true, true).and_then(|decomposition| {
        let cutoff = RANK_TOLERANCE * decomposition.singular_values.max();
        let solved = decomposition.solve(&DVector::from_row_slice(&right), cutoff);
        solved.ok()
    });
    let Some(weights) = solved else {
        values.fill(f64::NAN);
        return;
    };
    for (index, value) in values.iter_mut().enumerate() {
        fill(index, &mut lagged);
        let explained: f64 = weights.iter().zip(&lagged).map(|(w, x)| w * x).sum();
        *value -= explained;
    }
}

/// Channel and raw of a steady record without what they show of a truth that varies; `None` where
/// it does not. The means stay.
pub(crate) fn without_motion(
    record: &Record,
    filter: Option<&FilterFacts>,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let truth = record.truth()?;
    let first = truth.first()?;
    if truth
        .iter()
        .all(|rate| (rate - first).abs() <= STILL * first.abs())
    {
        return None;
    }
    let mean = interval::mean(truth);
    let about: Vec<f64> = truth.iter().map(|rate| rate - mean).collect();
    let cleaned = |values: &[f64], reach: usize| {
        let level = interval::mean(values);
        let mut left: Vec<f64> = values.iter().map(|value| value - level).collect();
        remove_response(&mut left, &about, reach);
        let shift = level - interval::mean(&left);
        left.iter().map(|value| value + shift).collect::<Vec<f64>>()
    };
    let raw = cleaned(record.raw_deg_per_h, reach(None));
    let channel = match filter {
        Some(_) => cleaned(record.channel_deg_per_h, reach(filter)),
        None => raw.clone(),
    };
    Some((channel, raw))
}
