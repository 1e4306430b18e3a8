//! Blocks of a record: how many samples an averaging time holds, and their means.

use super::interval;
use super::interval::round_to_count;

/// Blocks of time whose scatter gives the intervals of ratios.
pub(crate) const RATIO_BLOCKS: usize = 20;

/// Means of `count` blocks of equal length that cover all values; missing ones (NaN) are left out.
pub(crate) fn equal_block_means(values: &[f64], count: usize) -> Vec<f64> {
    let blocks = count.min(values.len());
    (0..blocks)
        .map(|block| {
            let start = values.len() * block / blocks;
            let end = values.len() * (block + 1) / blocks;
            interval::mean_of_present(&values[start..end])
        })
        .filter(|mean| !mean.is_nan())
        .collect()
}

/// Means of consecutive blocks of `block_samples`; what is left over at the end is not used.
///
/// Missing samples (NaN) are left out, and so is a block of which more than half is missing.
#[must_use]
pub fn block_means(rate_deg_per_h: &[f64], block_samples: usize) -> Vec<f64> {
    rate_deg_per_h
        .chunks_exact(block_samples.max(1))
        .map(interval::mean_of_present)
        .filter(|mean| !mean.is_nan())
        .collect()
}

/// Number of whole samples in an averaging time, at least 1.
#[must_use]
pub fn samples_in(averaging_time_s: f64, sample_period_s: f64) -> usize {
    round_to_count(averaging_time_s / sample_period_s).max(1)
}

/// Slack of a comparison of times that were rounded.
const TIME_SLACK: f64 = 1e-9;

/// Part of an averaging time by which the whole samples in it may miss it and still be named by it: half
/// of that in a deviation, far within its interval.
const NAMED_WITHIN: f64 = 0.01;

/// Whether an averaging time holds a sample, which is the shortest time that can be averaged over.
#[must_use]
pub fn is_sample_or_longer(averaging_time_s: f64, sample_period_s: f64) -> bool {
    averaging_time_s >= sample_period_s * (1.0 - TIME_SLACK)
}

/// Time that blocks of [`samples_in`] samples are labelled with, s: the time asked for where they hold it
/// to a hundredth, else the time that they do hold.
#[must_use]
pub fn block_label_s(averaging_time_s: f64, sample_period_s: f64) -> f64 {
    let block_s = samples_in(averaging_time_s, sample_period_s) as f64 * sample_period_s;
    let is_named = (block_s - averaging_time_s).abs() <= NAMED_WITHIN * averaging_time_s;
    if is_named { averaging_time_s } else { block_s }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_labelled_with_the_time_they_hold() {
        // Half a sample of 100 s at 4 kHz is nothing, of 1.4 s at 1 Hz it is 0.4 s.
        let period_s = 1.0 / 3989.45;
        assert_eq!(
            block_label_s(100.0, period_s).to_bits(),
            100.0_f64.to_bits()
        );
        assert_eq!(block_label_s(1.4, 1.0).to_bits(), 1.0_f64.to_bits());
        assert_eq!(block_label_s(1.6, 1.0).to_bits(), 2.0_f64.to_bits());
        assert!(is_sample_or_longer(0.3, 0.1 * 3.0) && !is_sample_or_longer(1e-6, 2.5e-4));
    }
}
