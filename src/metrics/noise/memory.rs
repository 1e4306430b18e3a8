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

/// Largest lags of one look over those of the next, and fewest that a look needs.
const NEARER: usize = 4;
const NEAREST_LAGS: usize = 40;

/// Samples within which the loop of a gyro answers, and bend of a covariance beyond them, in that at lag 0,
/// up to which the noise at lag 0 is white.
const LOOP_REACH_SAMPLES: usize = 5;
const BEND_MAX: f64 = 0.15;

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
    Autocorrelation::of(values)?.length()
}

/// Autocovariance of a record at some lags.
struct Autocorrelation {
    /// Samples; 0, 1, 2, ... and further apart beyond.
    lags: Vec<usize>,
    covariances: Vec<f64>,
    /// What the slow noise has at all lags.
    plateau: f64,
    samples: usize,
}

impl Autocorrelation {
    /// Nothing of a record without fast noise, or too short a one.
    fn of(values: &[f64]) -> Option<Self> {
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
        Self::with_plateau(lags, covariances, values.len())
    }

    fn with_plateau(lags: Vec<usize>, covariances: Vec<f64>, samples: usize) -> Option<Self> {
        let largest = lags[lags.len() - 1];
        let far: Vec<f64> = lags
            .iter()
            .zip(&covariances)
            .filter(|(lag, _)| **lag > largest / 2)
            .map(|(_, product)| *product)
            .collect();
        let plateau = interval::mean(&far);
        (!far.is_empty() && covariances[0] > plateau).then_some(Self {
            lags,
            covariances,
            plateau,
            samples,
        })
    }

    /// The same with lags up to a quarter, over which drift changes less; nothing of fewer than
    /// [`NEAREST_LAGS`].
    fn nearer(mut self) -> Option<Self> {
        let largest = self.largest() / NEARER;
        if largest < NEAREST_LAGS {
            return None;
        }
        self.lags.retain(|lag| *lag <= largest);
        self.covariances.truncate(self.lags.len());
        Self::with_plateau(self.lags, self.covariances, self.samples)
    }

    fn largest(&self) -> usize {
        self.lags[self.lags.len() - 1]
    }

    /// Covariance of what is not slow.
    fn fast(&self) -> f64 {
        self.covariances[0] - self.plateau
    }

    fn length(&self) -> Option<usize> {
        let (fast, largest) = (self.fast(), self.largest());
        let mut squares = 0.0;
        let mut length = 1;
        for (index, pair) in self
            .lags
            .windows(2)
            .enumerate()
            .take_while(|(_, pair)| pair[1] <= largest / 2)
        {
            let product = self.covariances[index + 1] - self.plateau;
            squares += (pair[1] - pair[0]) as f64 * (product / fast).powi(2);
            let error = fast * ((1.0 + 2.0 * squares) / self.samples as f64).sqrt();
            if product.abs() > (UNCORRELATED * fast).max(SIGNIFICANCE * error) {
                length = self.lags[index + 2];
            }
        }
        (length <= largest / 4).then_some(length)
    }

    /// Whether white noise lies beside the correlated one: a covariance that bends at lag 0 and hardly
    /// any more beyond the reach of a loop.
    ///
    /// Behind a mean nothing bends there, and behind a pole all bends fade with the covariance.
    fn has_white_floor(&self) -> bool {
        let shown = 0..LOOP_REACH_SAMPLES + 3;
        if !self.lags.iter().copied().take(shown.len()).eq(shown) {
            return false;
        }
        let bend = |lag: usize| {
            let at = &self.covariances[lag..lag + 3];
            at[0] - 2.0 * at[1] + at[2]
        };
        let [own, next, second] = [0, 1, 2].map(|lag| self.covariances[lag]);
        // The bend at a lag is the mean of products of words and second differences.
        let of_differences = (6.0 * own - 8.0 * next + 2.0 * second).max(0.0);
        let error = (own * of_differences / self.samples as f64).sqrt();
        let floor = bend(0);
        floor > (UNCORRELATED * self.fast()).max(SIGNIFICANCE * error)
            && bend(LOOP_REACH_SAMPLES).abs() + 2.0 * error <= BEND_MAX * floor
    }
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
/// gyro. Drift that hides how the fast noise dies out is looked past at shorter lags. White words are fitted
/// from four samples on; of words that count pulses, whose correlation is that
/// of the pulses, ten samples are taken, and of noise with a correlation time beside white noise as well:
/// that is a term of the fit.
#[must_use]
pub fn record_fit_tau_min_s(values: &[f64], sample_period_s: f64) -> f64 {
    const CORRELATED_SAMPLES_MIN: f64 = 10.0;
    let of_correlated_s = CORRELATED_SAMPLES_MIN * sample_period_s;
    if PulseWords::recognise(values, sample_period_s, of_correlated_s).is_some() {
        return of_correlated_s;
    }
    let mut found = Autocorrelation::of(values);
    let mut length = None;
    while let Some(correlation) = found.take() {
        length = correlation.length();
        if length.is_some() {
            found = Some(correlation);
            break;
        }
        found = correlation.nearer();
    }
    let samples = match length.unwrap_or(1) {
        1 => FIT_TAU_PER_LENGTH,
        length => (FIT_TAU_PER_LENGTH * length as f64).max(CORRELATED_SAMPLES_MIN),
    };
    let is_term = samples > CORRELATED_SAMPLES_MIN
        && found.is_some_and(|correlation| correlation.has_white_floor());
    if is_term {
        of_correlated_s
    } else {
        samples * sample_period_s
    }
}
