//! How long the samples of a channel stay correlated: behind a filter, and as a record shows it.
//!
//! An Allan variance is that of the input's noise terms only at averaging times beyond it.

use rayon::prelude::*;

use super::autocovariance::products_at;
use crate::metrics::allan::pulses::recognition::PulseWords;
use crate::metrics::estimate::interval;
use crate::metrics::theory::memory::memory_samples;
use crate::signal::FilterShape;

/// Averaging times of a fit, in memories of the filter: those of filter and gyro add up, and either
/// half of this or half the gyro's own limit is the longer one.
const FIT_TAU_PER_MEMORY: f64 = 2.0;

/// Shortest averaging time of a fit to what a filter made of the words of a gyro, s.
///
/// `fit_tau_min_s` is that of the gyro and at least twice as long as its own words are correlated.
/// The output is correlated over the sum of both, which is at most the longer of that time and two
/// memories of the filter. From there on `AVAR = N^2/tau + c/tau^2 + ...` holds with a constant c that
/// the fit leaves free in sign.
pub(crate) fn fit_tau_min_s(shape: &FilterShape, sample_period_s: f64, fit_tau_min_s: f64) -> f64 {
    let memory_s = memory_samples(shape) as f64 * sample_period_s;
    fit_tau_min_s.max(FIT_TAU_PER_MEMORY * memory_s)
}

/// Part of the record that the largest lag of its autocovariance spans.
const LAGS_PER_RECORD: usize = 64;

/// Largest such lag, samples.
const LAG_MAX: usize = 1 << 16;

/// Samples that all lags see before the next ones.
const PIECE: usize = 1 << 15;

/// Ratio of one lag to the next.
const LAG_RATIO: f64 = 1.15;

/// Correlation that counts as none, and standard errors that it may be off.
const UNCORRELATED: f64 = 0.05;
const SIGNIFICANCE: f64 = 4.0;

/// Averaging times of a fit, in correlation lengths of a record: 12 time constants of a one-pole
/// filter.
const FIT_TAU_PER_LENGTH: f64 = 4.0;

/// Samples over which the fast noise of a record is correlated, from its autocovariance.
///
/// The first lag from which on it stays within a twentieth of its fast part, or within four standard
/// errors (Bartlett), of what it is at the longest lags, a 128th to a 64th of the record. That
/// plateau is the slow noise: drift does not die out. Looked at are 1, 2, 3, ... samples and, further
/// out, lags with a ratio of 1.15. White noise has length 1, a moving average its own, a one-pole
/// filter three time constants.
///
/// Missing samples (NaN) are left out. Nothing where it does not die out within a quarter of these lags: a record of slow noise only, a
/// periodic disturbance, or too short a record.
#[must_use]
pub fn correlation_length_samples(values: &[f64]) -> Option<usize> {
    let largest = (values.len() / LAGS_PER_RECORD).min(LAG_MAX);
    let mut lags = vec![0];
    while lags[lags.len() - 1] < largest {
        let last = lags[lags.len() - 1];
        let next = interval::round_to_count(last as f64 * LAG_RATIO).max(last + 1);
        lags.push(next.min(largest));
    }
    let mean = interval::mean_of_present(values);
    let deviations: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let covariances = lagged_means(&deviations, &lags);
    let far: Vec<f64> = lags
        .iter()
        .zip(&covariances)
        .filter(|(lag, _)| **lag > largest / 2)
        .map(|(_, product)| *product)
        .collect();
    let plateau = interval::mean(&far);
    let fast = covariances[0] - plateau;
    if far.is_empty() || fast <= 0.0 {
        return None;
    }
    let mut squares = 0.0;
    let mut length = 1;
    for (index, pair) in lags
        .windows(2)
        .enumerate()
        .take_while(|(_, pair)| pair[1] <= largest / 2)
    {
        let product = covariances[index + 1] - plateau;
        squares += (pair[1] - pair[0]) as f64 * (product / fast).powi(2);
        let error = fast * ((1.0 + 2.0 * squares) / values.len() as f64).sqrt();
        if product.abs() > (UNCORRELATED * fast).max(SIGNIFICANCE * error) {
            length = lags[index + 2];
        }
    }
    (length <= largest / 4).then_some(length)
}

/// Mean products of the deviations at some lags, piece by piece: all lags see a piece while it is in the cache.
fn lagged_means(deviations: &[f64], lags: &[usize]) -> Vec<f64> {
    let count = deviations.len();
    let starts: Vec<usize> = (0..count).step_by(PIECE).collect();
    let of_pieces = starts.into_par_iter().map(|start| {
        let own = PIECE.min(count - start);
        products_at(&deviations[start..], own, lags.iter().copied())
    });
    let of_pieces: Vec<Vec<(f64, usize)>> = of_pieces.collect();
    // In the order of the pieces, whichever thread was first.
    let mut all = vec![(0.0, 0); lags.len()];
    for piece in of_pieces {
        for ((sum, pairs), (more, more_pairs)) in all.iter_mut().zip(piece) {
            *sum += more;
            *pairs += more_pairs;
        }
    }
    let mean = |(sum, pairs): (f64, usize)| sum / pairs.max(1) as f64;
    all.into_iter().map(mean).collect()
}

/// Shortest averaging time of a fit to a record that nothing is known of, s: four correlation
/// lengths, and ten samples at least where successive words are correlated, as behind the loop of a
/// gyro. White words are fitted from four samples on; of words that count pulses, whose correlation is that
/// of the pulses, ten samples are taken.
#[must_use]
pub fn record_fit_tau_min_s(values: &[f64], sample_period_s: f64) -> f64 {
    const CORRELATED_SAMPLES_MIN: f64 = 10.0;
    let of_correlated_s = CORRELATED_SAMPLES_MIN * sample_period_s;
    if PulseWords::recognise(values, sample_period_s, of_correlated_s).is_some() {
        return of_correlated_s;
    }
    let length = correlation_length_samples(values).unwrap_or(1);
    let least = if length > 1 {
        CORRELATED_SAMPLES_MIN
    } else {
        0.0
    };
    (FIT_TAU_PER_LENGTH * length as f64).max(least) * sample_period_s
}
