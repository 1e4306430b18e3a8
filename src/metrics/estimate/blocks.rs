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

/// Block means of a record while it comes in, so many at most.
#[derive(Clone, Debug)]
pub(crate) struct BlockStream {
    block_samples: usize,
    most: usize,
    sum: f64,
    filled: usize,
    means: Vec<f64>,
}

impl BlockStream {
    /// Of blocks of so many samples.
    pub(crate) fn new(block_samples: usize, most: usize) -> Self {
        Self {
            block_samples: block_samples.max(1),
            most,
            sum: 0.0,
            filled: 0,
            means: Vec::new(),
        }
    }

    /// Takes the next values.
    pub(crate) fn extend(&mut self, mut values: &[f64]) {
        while !values.is_empty() && !self.is_full() {
            let (own, rest) = values.split_at((self.block_samples - self.filled).min(values.len()));
            // One after the other, as the mean of a whole block is summed.
            self.sum = own.iter().fold(self.sum, |sum, value| sum + value);
            self.filled += own.len();
            values = rest;
            if self.filled == self.block_samples {
                self.means.push(self.sum / self.block_samples as f64);
                (self.sum, self.filled) = (0.0, 0);
            }
        }
    }

    /// Whether the means are more than are kept.
    fn is_full(&self) -> bool {
        self.means.len() > self.most
    }

    /// Samples of a block.
    pub(crate) fn block_samples(&self) -> usize {
        self.block_samples
    }

    /// The means of all whole blocks; nothing where they are too many to be kept.
    pub(crate) fn means(&self) -> Option<&[f64]> {
        (!self.is_full()).then_some(self.means.as_slice())
    }
}

/// Means of a whole record in so many to twice as many blocks, while it comes in.
#[derive(Clone, Debug)]
pub(crate) struct CoarseStream {
    blocks: BlockStream,
    least: usize,
}

impl CoarseStream {
    /// Of `least` to twice as many blocks once there are as many samples.
    pub(crate) fn new(least: usize) -> Self {
        Self {
            blocks: BlockStream::new(1, usize::MAX),
            least,
        }
    }

    /// Takes the next values.
    pub(crate) fn extend(&mut self, values: &[f64]) {
        for values in values.chunks(self.least) {
            self.blocks.extend(values);
            while self.blocks.means.len() >= 2 * self.least {
                self.merge();
            }
        }
    }

    /// Makes one block of two; one without a partner is not whole yet.
    fn merge(&mut self) {
        let blocks = &mut self.blocks;
        let whole = blocks.means.len() / 2 * 2;
        for mean in blocks.means.drain(whole..) {
            blocks.sum += mean * blocks.block_samples as f64;
            blocks.filled += blocks.block_samples;
        }
        let pairs = blocks.means.chunks_exact(2);
        blocks.means = pairs.map(|two| 0.5 * (two[0] + two[1])).collect();
        blocks.block_samples *= 2;
    }

    /// The means.
    pub(crate) fn means(&self) -> &[f64] {
        &self.blocks.means
    }
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
    fn a_stream_has_the_means_of_the_whole_record_whatever_the_pieces() {
        let values: Vec<f64> = (0..10_007_u32).map(|k| f64::from(k * k % 101)).collect();
        for piece in [1, 7, 64, 5000] {
            let mut blocks = BlockStream::new(13, 1000);
            let mut few = BlockStream::new(13, 10);
            let mut coarse = CoarseStream::new(16);
            for values in values.chunks(piece) {
                blocks.extend(values);
                few.extend(values);
                coarse.extend(values);
            }
            assert_eq!(blocks.means(), Some(&block_means(&values, 13)[..]));
            assert_eq!(few.means(), None);
            let block = coarse.blocks.block_samples;
            assert!((16..32).contains(&coarse.means().len()), "{piece}");
            for (found, whole) in coarse.means().iter().zip(block_means(&values, block)) {
                assert!((found - whole).abs() < 1e-9, "{piece}: {found} {whole}");
            }
        }
    }

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
