//! How long the samples of a channel stay correlated: what a filter remembers, what a record shows.
//!
//! An Allan variance is that of the input's noise terms only at averaging times beyond it.

use rayon::prelude::*;

use super::autocovariance::dot;
use crate::metrics::estimate::interval;
use crate::signal::{FilterShape, Section, WeightRule};

/// Part of the first moment of the impulse response that may lie beyond the memory.
const TAIL: f64 = 0.01;

/// Longest impulse response that is looked at, samples.
const RESPONSE_MAX: usize = 1 << 20;

/// Part of the first moment below which the newest half of a response no longer counts.
const DIED_OUT: f64 = 1e-4;

/// Averaging times of a fit, in memories of the filter: those of filter and gyro add up, and either
/// half of this or half the gyro's own limit is the longer one.
const FIT_TAU_PER_MEMORY: f64 = 2.0;

/// Samples a filter remembers: beyond them lies at most a hundredth of `sum k |h(k)|`.
///
/// h is the impulse response; an adaptive filter remembers as many samples as it has taps. A moving
/// average of p samples remembers p, a one-pole filter with a time constant of t samples 6.6 t.
#[must_use]
pub fn memory_samples(shape: &FilterShape) -> usize {
    match &shape.rule {
        WeightRule::Adaptive { .. } => shape.taps.unwrap_or(0),
        WeightRule::Fixed(weights) => memory_of(weights),
        WeightRule::Sections(sections) => memory_of(&impulse_response(sections)),
    }
}

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

fn memory_of(response: &[f64]) -> usize {
    let moment = |(age, weight): (usize, &f64)| age as f64 * weight.abs();
    let total: f64 = response.iter().enumerate().map(moment).sum();
    let mut beyond = 0.0;
    for (age, weight) in response.iter().enumerate().rev() {
        beyond += moment((age, weight));
        if beyond > TAIL * total {
            return age + 1;
        }
    }
    // Nothing is remembered but the newest sample.
    usize::from(!response.is_empty())
}

/// Impulse response of a cascade until it has died out.
fn impulse_response(sections: &[Section]) -> Vec<f64> {
    // Transposed direct form II: two states a section.
    let mut states = vec![[0.0; 2]; sections.len()];
    let mut response = Vec::new();
    let (mut moment, mut of_half, mut half_end) = (0.0, 0.0, 64);
    while response.len() < RESPONSE_MAX {
        let mut value = if response.is_empty() { 1.0 } else { 0.0 };
        for (section, state) in sections.iter().zip(&mut states) {
            let [b0, b1, b2] = section.numerator;
            let [a1, a2] = section.denominator;
            let output = b0 * value + state[0];
            state[0] = b1 * value - a1 * output + state[1];
            state[1] = b2 * value - a2 * output;
            value = output;
        }
        of_half += response.len() as f64 * value.abs();
        response.push(value);
        if response.len() == half_end {
            moment += of_half;
            if of_half <= DIED_OUT * moment {
                break;
            }
            (of_half, half_end) = (0.0, 2 * half_end);
        }
    }
    response
}

/// Part of the record that the largest lag of its autocovariance spans.
const LAGS_PER_RECORD: usize = 64;

/// Largest such lag, samples.
const LAG_MAX: usize = 1 << 16;

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
/// Nothing where it does not die out within a quarter of these lags: a record of slow noise only, a
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
    let mean = interval::mean(values);
    let deviations: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let products: Vec<f64> = lags
        .par_iter()
        .map(|&lag| {
            let pairs = deviations.len() - lag;
            dot(&deviations[..pairs], &deviations[lag..]) / pairs.max(1) as f64
        })
        .collect();
    let far: Vec<f64> = lags
        .iter()
        .zip(&products)
        .filter(|(lag, _)| **lag > largest / 2)
        .map(|(_, product)| *product)
        .collect();
    let plateau = interval::mean(&far);
    let fast = products[0] - plateau;
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
        let product = products[index + 1] - plateau;
        squares += (pair[1] - pair[0]) as f64 * (product / fast).powi(2);
        let error = fast * ((1.0 + 2.0 * squares) / values.len() as f64).sqrt();
        if product.abs() > (UNCORRELATED * fast).max(SIGNIFICANCE * error) {
            length = lags[index + 2];
        }
    }
    (length <= largest / 4).then_some(length)
}

/// Shortest averaging time of a fit to a record that nothing is known of, s: four correlation
/// lengths, ten samples at least.
#[must_use]
pub fn record_fit_tau_min_s(values: &[f64], sample_period_s: f64) -> f64 {
    const SAMPLES_MIN: f64 = 10.0;
    let length = correlation_length_samples(values).unwrap_or(1) as f64;
    (FIT_TAU_PER_LENGTH * length).max(SAMPLES_MIN) * sample_period_s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(rule: WeightRule) -> FilterShape {
        FilterShape {
            taps: Some(10),
            newest_age_samples: 1,
            register_samples: 1,
            rule,
        }
    }

    #[test]
    fn filters_remember_their_taps_or_their_time_constants() {
        let of = |rule: WeightRule| memory_samples(&shape(rule));
        assert_eq!(of(WeightRule::Fixed(vec![1.0])), 1);
        assert_eq!(of(WeightRule::Fixed(vec![0.01; 100])), 100);
        let adaptive = WeightRule::Adaptive {
            desired_weights: vec![1.0],
            is_dc_gain_one: false,
            forgetting_factor: None,
        };
        assert_eq!(of(adaptive), 10);
        let pole = (-1.0_f64 / 100.0).exp();
        let section = Section {
            numerator: [1.0 - pole, 0.0, 0.0],
            denominator: [-pole, 0.0],
        };
        // (1 + x) exp(-x) = 0.01 at x = 6.64.
        let one_pole = of(WeightRule::Sections(vec![section]));
        assert!((655..675).contains(&one_pole), "{one_pole}");
        let two = of(WeightRule::Sections(vec![section; 2]));
        assert!(two > one_pole && two < 2 * one_pole, "{two}");
    }
}
