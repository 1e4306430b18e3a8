//! Autocovariance of a record, kept per block of time for the jackknife.

use super::interval::{self, NORMAL_QUANTILE};

/// Fewest blocks whose scatter says how sure a variance is.
const FREEDOM_BLOCKS_MIN: usize = 10;

/// Samples per pass over the cache.
const CHUNK: usize = 8192;

/// Sums of lagged products, block by block.
///
/// A pair of samples belongs to the block that holds its earlier sample.
#[derive(Clone, Debug)]
pub(crate) struct LaggedProducts {
    /// `sums[block][lag]`.
    sums: Vec<Vec<f64>>,
    /// `counts[block][lag]`.
    counts: Vec<Vec<usize>>,
}

impl LaggedProducts {
    /// Products of `values - centre` at lags `0 ..= largest_lag` in `blocks` blocks of equal length.
    pub(crate) fn new(values: &[f64], centre: f64, largest_lag: usize, blocks: usize) -> Self {
        let blocks = blocks.clamp(1, values.len().max(1));
        let mut sums = vec![vec![0.0; largest_lag + 1]; blocks];
        let mut counts = vec![vec![0; largest_lag + 1]; blocks];
        let mut deviations = Vec::with_capacity(CHUNK + largest_lag);
        for block in 0..blocks {
            let block_end = values.len() * (block + 1) / blocks;
            let mut start = values.len() * block / blocks;
            while start < block_end {
                let end = (start + CHUNK).min(block_end);
                let reach = (end + largest_lag).min(values.len());
                deviations.clear();
                deviations.extend(values[start..reach].iter().map(|value| value - centre));
                for lag in 0..=largest_lag {
                    // The last block of a short record may hold fewer samples than the lag.
                    let later = deviations.get(lag..).unwrap_or_default();
                    let pairs = (end - start).min(later.len());
                    sums[block][lag] += dot(&deviations[..pairs], &later[..pairs]);
                    counts[block][lag] += pairs;
                }
                start = end;
            }
        }
        Self { sums, counts }
    }

    /// Number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.sums.len()
    }

    /// Autocovariance at every lag: mean lagged product of all pairs.
    pub(crate) fn autocovariance(&self) -> Vec<f64> {
        self.mean_products(None)
    }

    /// Autocovariance without the pairs of one block.
    pub(crate) fn autocovariance_without(&self, block: usize) -> Vec<f64> {
        self.mean_products(Some(block))
    }

    /// Degrees of freedom of the variance from its scatter over the blocks; `None` for fewer than
    /// [`FREEDOM_BLOCKS_MIN`] blocks or ones that do not scatter.
    ///
    /// `2 s^4 / var(s^2)`, where the variance of the mean of n blocks is their sample variance over
    /// n. As that is uncertain itself, the degrees are cut by the square of the normal quantile over
    /// Student's t for n - 1.
    pub(crate) fn variance_freedom(&self) -> Option<f64> {
        let pairs = self.sums.iter().zip(&self.counts);
        let variances: Vec<f64> = pairs
            .filter(|(_, counts)| counts[0] > 0)
            .map(|(sums, counts)| sums[0] / counts[0] as f64)
            .collect();
        let blocks = variances.len() as f64;
        let of_mean = interval::sample_variance(&variances) / blocks;
        let power = interval::mean(&variances);
        let quantiles = NORMAL_QUANTILE / interval::student_quantile(blocks - 1.0);
        let freedom = 2.0 * power * power / of_mean * quantiles * quantiles;
        (variances.len() >= FREEDOM_BLOCKS_MIN && freedom.is_finite()).then_some(freedom.max(1.0))
    }

    fn mean_products(&self, left_out: Option<usize>) -> Vec<f64> {
        (0..self.sums[0].len())
            .map(|lag| {
                let kept = (0..self.blocks()).filter(|&block| Some(block) != left_out);
                let (sum, count) = kept.fold((0.0, 0), |(sum, count), block| {
                    (sum + self.sums[block][lag], count + self.counts[block][lag])
                });
                sum / count.max(1) as f64
            })
            .collect()
    }
}

/// Number of independent samples that say as much about the variance as the record does.
///
/// `n R0^2 / sum R(k)^2` over positive and negative lags: the variance of a Gaussian sample
/// variance is `2 sum R(k)^2 / n` (Bartlett). Lags beyond those given count as uncorrelated.
pub(crate) fn independent_samples(autocovariance: &[f64], count: usize) -> f64 {
    let variance_squared = autocovariance[0] * autocovariance[0];
    let lagged: f64 = autocovariance[1..].iter().map(|value| value * value).sum();
    if variance_squared > 0.0 {
        count as f64 * variance_squared / (variance_squared + 2.0 * lagged)
    } else {
        count as f64
    }
}

/// Dot product in eight interleaved sums, which the compiler turns into vectors.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut lanes = [0.0; LANES];
    let (a_lanes, a_rest) = a.as_chunks::<LANES>();
    let (b_lanes, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a_lanes.iter().zip(b_lanes) {
        for lane in 0..LANES {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_agree_with_the_plain_sum_over_chunk_and_block_borders() {
        let values: Vec<f64> = (0..2 * CHUNK + 100)
            .map(|k| ((k * k) % 101) as f64)
            .collect();
        let covariance = LaggedProducts::new(&values, 50.0, 3, 5).autocovariance();
        for (lag, got) in covariance.into_iter().enumerate() {
            let plain: f64 = (0..values.len() - lag)
                .map(|k| (values[k] - 50.0) * (values[k + lag] - 50.0))
                .sum::<f64>()
                / (values.len() - lag) as f64;
            assert!((got - plain).abs() < 1e-9 * plain.abs().max(1.0));
        }
    }

    #[test]
    fn a_record_shorter_than_its_blocks_and_lags_has_products_where_pairs_exist() {
        for count in 1..60_u8 {
            let values: Vec<f64> = (0..count).map(f64::from).collect();
            let covariance = LaggedProducts::new(&values, 0.0, 24, 20).autocovariance();
            for (lag, got) in covariance.into_iter().enumerate() {
                let pairs: Vec<f64> = (lag..values.len())
                    .map(|later| values[later] * values[later - lag])
                    .collect();
                let plain = pairs.iter().sum::<f64>() / pairs.len().max(1) as f64;
                assert!((got - plain).abs() < 1e-9 * plain.max(1.0), "{count} {lag}");
            }
        }
    }

    #[test]
    fn correlated_samples_count_for_less() {
        assert!((independent_samples(&[2.0, 0.0], 100) - 100.0).abs() < 1e-12);
        assert!((independent_samples(&[1.0, 0.5], 150) - 100.0).abs() < 1e-12);
    }
}
