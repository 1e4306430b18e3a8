//! Dwells found by themselves: stretches of a reference in which its rate stays.
//!
//! The rules, in the order in which they are applied:
//!
//! 1. The reference is taken in means of 0.1 s, of eight samples at least.
//! 2. Its scatter is that of the second differences of the means, by their lower quartile: a quarter of them may
//!    be dwells, and a ramp has none.
//! 3. A dwell goes on while each mean lies within six scatters and 100 ppm of the rate of the dwell so far.
//! 4. It holds ten means at least, and rises over its length by no more than rule 3 allows: a slow ramp is none.
//! 5. The first and the last mean are left out, as the transition ends and begins in them, and at the start as
//!    much more as the gyro is given to settle.

use crate::metrics::estimate::interval::{mean, round_to_count};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::record::Dwell;
use crate::wording::counted;

/// Time of a mean of the reference, s.
const MEAN_S: f64 = 0.1;
/// Samples that a mean holds, at least.
const MEAN_SAMPLES_MIN: usize = 8;
/// Means that a dwell holds, at least.
const MEANS_MIN: usize = 10;
/// Scatters by which a mean of a dwell may lie off it.
const SCATTERS: f64 = 6.0;
/// The same as a part of its rate.
const OF_RATE: f64 = 1e-4;
/// Factor `1 / (Phi^-1(5/8) sqrt 6)` from the lower quartile of the sizes of second differences to the standard
/// deviation of a mean.
const QUARTILE_TO_STD: f64 = 1.2812;

/// Finds the dwells of a reference in the order of time.
///
/// * `reference_deg_per_h`: rate of the table, whole.
/// * `settle_s`: time at the start of a dwell that the gyro is given to settle.
///
/// # Errors
/// The reference has none.
pub fn find_dwells(
    reference_deg_per_h: &[f64],
    sample_period_s: f64,
    settle_s: f64,
) -> Result<Vec<Dwell>, Unavailable> {
    let block = round_to_count(MEAN_S / sample_period_s).max(MEAN_SAMPLES_MIN);
    let means: Vec<f64> = reference_deg_per_h.chunks_exact(block).map(mean).collect();
    let scatter = scatter(&means);
    let settle = round_to_count((settle_s / sample_period_s).ceil()).max(block);
    let mut dwells = Vec::new();
    let mut first = 0;
    while first < means.len() {
        let end = end_of(&means, first, scatter);
        let own = &means[first..end];
        if own.len() < MEANS_MIN || rise(own).abs() > tolerance(mean(own), scatter) {
            // A dwell may begin inside of what is none.
            first += 1;
            continue;
        }
        let samples = first * block + settle..(end - 1) * block;
        if !samples.is_empty() {
            dwells.push(Dwell {
                rate_deg_per_h: mean(&reference_deg_per_h[samples.clone()]),
                samples,
            });
        }
        first = end;
    }
    if dwells.is_empty() {
        return Err(format!(
            "the reference holds no dwell: {} of {:.3} s, of which ten in a row stay within six of their scatters \
             and 100 ppm",
            counted(means.len(), "mean"),
            block as f64 * sample_period_s
        )
        .into());
    }
    Ok(dwells)
}

/// How far a mean may lie off the rate of its dwell.
fn tolerance(rate: f64, scatter: f64) -> f64 {
    SCATTERS * scatter + OF_RATE * rate.abs()
}

/// Standard deviation of a mean by the second differences of them.
fn scatter(means: &[f64]) -> f64 {
    let second = means
        .windows(3)
        .map(|it| (it[0] - 2.0 * it[1] + it[2]).abs());
    let mut second: Vec<f64> = second.collect();
    second.sort_by(f64::total_cmp);
    second
        .get(second.len() / 4)
        .map_or(0.0, |quartile| QUARTILE_TO_STD * quartile)
}

/// End of the dwell that begins with a mean.
fn end_of(means: &[f64], first: usize, scatter: f64) -> usize {
    let mut sum = 0.0;
    for (count, value) in means[first..].iter().enumerate() {
        let centre = if count == 0 {
            *value
        } else {
            sum / count as f64
        };
        if (value - centre).abs() > tolerance(centre, scatter) {
            return first + count;
        }
        sum += value;
    }
    means.len()
}

/// How far the line through equally spaced values rises over their length.
fn rise(values: &[f64]) -> f64 {
    let centre = 0.5 * (values.len() as f64 - 1.0);
    let (mut products, mut squares) = (0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let at = index as f64 - centre;
        products += at * value;
        squares += at * at;
    }
    products / squares * values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Streams;

    /// Rates of 10 s at 100 Hz with ramps of 1 s between them, and noise.
    fn staircase(rates: &[f64], noise: f64) -> Vec<f64> {
        let mut random = Streams::new(1, 0).stream("reference");
        let mut reference = Vec::new();
        for two in rates.windows(2) {
            reference.extend(std::iter::repeat_n(two[0], 1000));
            reference.extend((0..100).map(|at| two[0] + (two[1] - two[0]) * at as f64 / 100.0));
        }
        reference.extend(std::iter::repeat_n(rates[rates.len() - 1], 1000));
        for value in &mut reference {
            *value += noise * random.normal();
        }
        reference
    }

    #[test]
    fn every_rate_is_a_dwell_and_no_ramp_is_in_one() {
        let rates = [0.0, 3600.0, 3600.2, -3600.0, 180_000.0, 0.0];
        for noise in [0.0, 0.1] {
            let found = find_dwells(&staircase(&rates, noise), 0.01, 0.5).unwrap();
            // The step of 0.2 deg/h is within 100 ppm of 3600 deg/h: one dwell of both.
            assert_eq!(found.len(), 5, "{found:?}");
            for (dwell, rate) in found.iter().zip([0.0, 3600.1, -3600.0, 180_000.0, 0.0]) {
                let off = (dwell.rate_deg_per_h - rate).abs();
                assert!(off < 0.1 + 1e-6 * rate.abs(), "{dwell:?} {rate}");
            }
            assert!(found[0].samples.start == 50 && found[0].samples.end >= 970);
            assert!(found[0].samples.end <= 1000, "{found:?}");
        }
    }

    #[test]
    fn a_ramp_or_a_swing_alone_has_no_dwell() {
        let ramp: Vec<f64> = (0..5000).map(|at| 10.0 * f64::from(at)).collect();
        assert!(find_dwells(&ramp, 0.01, 0.0).is_err());
        let swing: Vec<f64> = (0..5000)
            .map(|at| 3600.0 * (0.02 * f64::from(at)).sin())
            .collect();
        assert!(find_dwells(&swing, 0.01, 0.0).is_err());
    }
}
