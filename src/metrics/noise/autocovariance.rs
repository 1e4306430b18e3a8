//! Autocovariance of a record, kept per block of time for the jackknife.

use std::ops::Range;

use super::by_weights::NoiseByWeights;
use crate::metrics::estimate::influence::{Learned, resampled, spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::NORMAL_QUANTILE;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::key::metric::{Applies, MetricKey, Needs};
use crate::simd::{LANES, Lanes, Simd, with_wide_vectors};

/// Lag.
pub static LAG: Column = Column::new("lag_s", "s", "time between the two samples");

/// Autocovariance at a lag.
pub static PRODUCT: Column = Column::new(
    "autocovariance_deg2_per_h2",
    "(deg/h)^2",
    "mean product of the noise of two samples that far apart",
);

/// Autocovariance of the noise.
pub static AUTOCOVARIANCE: CurveKey = CurveKey::new(
    "autocovariance",
    &[&LAG, &PRODUCT],
    "autocovariance of the noise about the signal over the first lags",
)
.csv("autocovariance.csv");

/// Correlation at lag one.
pub static LAG1_CORRELATION: MetricKey = MetricKey::new(
    "lag1_correlation",
    "1",
    Applies::Separable,
    "correlation of neighbouring samples about the signal, autocovariance at lag 1 over lag 0",
)
.needs(Needs::SettledStep);

/// Fewest blocks whose scatter says how sure a variance is.
const FREEDOM_BLOCKS_MIN: usize = 10;

/// Samples per pass over the cache.
const CHUNK: usize = 8192;

/// Largest lag of the curve `autocovariance`, samples.
pub(crate) const CURVE_LAGS: usize = 50;

/// Autocovariance of a record about its mean at lags `0 ..= largest_lag`, in its unit squared.
///
/// The mean lagged product of all pairs, `sum x(k) x(k + l) / (n - l)`: unbiased but for the mean that
/// is taken from the record; 0 at lags without a pair.
#[must_use]
pub fn autocovariance(values: &[f64], largest_lag: usize) -> Vec<f64> {
    LaggedProducts::new(values, interval::mean(values), largest_lag, 1).autocovariance()
}

/// Correlation of neighbours, `R(1)/R(0)`, with its jackknife interval; `None` without noise.
pub(crate) fn lag_one_correlation(
    products: &LaggedProducts,
    learned: Option<&Learned>,
) -> Option<Estimate> {
    let of = |autocovariance: &[f64]| autocovariance[1] / autocovariance[0];
    let whole = products.autocovariance();
    let left_out: Vec<f64> = (0..products.blocks())
        .map(|block| of(&products.autocovariance_without(block)))
        .collect();
    (whole[0] > 0.0).then(|| resampled(of(&whole), &left_out, learned).clamped(-1.0, 1.0))
}

/// Enters the correlation of neighbours and the first lags of the autocovariance of the noise.
pub(crate) fn put_autocovariance(
    products: &LaggedProducts,
    by_weights: &NoiseByWeights,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let learned = by_weights.of(|noise| noise[1] / noise[0]);
    match lag_one_correlation(products, learned.as_ref()) {
        Some(correlation) => {
            metrics.put(&LAG1_CORRELATION, by_weights.unless_unknown(correlation));
        }
        None => metrics.miss(&LAG1_CORRELATION, "the channel has no noise"),
    }
    let mut autocovariance = products.autocovariance();
    autocovariance.truncate(CURVE_LAGS + 1);
    let lags = (0..autocovariance.len()).map(|lag| lag as f64 * sample_period_s);
    let columns = [(&LAG, lags.collect()), (&PRODUCT, autocovariance)];
    metrics.put_curve(&AUTOCOVARIANCE, columns);
}

/// Sums of lagged products, block by block.
///
/// A pair of samples belongs to the block that holds its earlier sample.
#[derive(Clone, Debug)]
pub(crate) struct LaggedProducts {
    /// `sums[block][lag]`.
    sums: Vec<Vec<f64>>,
    /// `counts[block][lag]`.
    counts: Vec<Vec<usize>>,
    /// Sum and number at each lag of those pairs of a block whose later sample the next one holds; none of
    /// a record that came in bit by bit.
    across: Vec<Vec<(f64, usize)>>,
}

impl LaggedProducts {
    /// Products of `values - centre` at lags `0 ..= largest_lag` in `blocks` blocks of equal length;
    /// pairs with a missing value (NaN) are left out.
    pub(crate) fn new(values: &[f64], centre: f64, largest_lag: usize, blocks: usize) -> Self {
        let blocks = blocks.clamp(1, values.len().max(1));
        let mut sums = vec![vec![0.0; largest_lag + 1]; blocks];
        let mut counts = vec![vec![0; largest_lag + 1]; blocks];
        let mut across = Vec::with_capacity(blocks);
        let mut deviations = Vec::with_capacity(CHUNK + largest_lag);
        for block in 0..blocks {
            let block_end = values.len() * (block + 1) / blocks;
            let mut start = values.len() * block / blocks;
            across.push(pairs_across(values, centre, start..block_end, largest_lag));
            while start < block_end {
                let end = (start + CHUNK).min(block_end);
                let reach = (end + largest_lag).min(values.len());
                deviations.clear();
                deviations.extend(values[start..reach].iter().map(|value| value - centre));
                add_products(
                    &deviations,
                    end - start,
                    &mut sums[block],
                    &mut counts[block],
                );
                start = end;
            }
        }
        Self {
            sums,
            counts,
            across,
        }
    }

    /// The same about another centre, `step` above: of blocks with these sums of deviations.
    ///
    /// What the ends of a block have more or less of at a lag is not counted.
    fn moved_by(mut self, step: f64, deviations: &[f64]) -> Self {
        let blocks = self.sums.iter_mut().zip(&self.counts).zip(deviations);
        for ((sums, counts), deviation) in blocks {
            for (sum, count) in sums.iter_mut().zip(counts) {
                let share = *count as f64 / counts[0].max(1) as f64;
                *sum += step * (*count as f64 * step - 2.0 * share * deviation);
            }
        }
        self
    }

    /// Number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.sums.len()
    }

    /// Autocovariance at every lag: mean lagged product of all pairs.
    pub(crate) fn autocovariance(&self) -> Vec<f64> {
        self.mean_products(None)
    }

    /// Autocovariance of the samples of one block alone, as if they were a record.
    pub(crate) fn autocovariance_of(&self, block: usize) -> Vec<f64> {
        let lags = self.sums[block].iter().zip(&self.counts[block]);
        let across = self.across.get(block).into_iter().flatten().copied();
        let across = across.chain(std::iter::repeat((0.0, 0)));
        let within = lags.zip(across);
        within
            .map(|((sum, count), (beyond, pairs))| (sum - beyond) / (count - pairs).max(1) as f64)
            .collect()
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

    /// The same of noise whose power the filter's weights move as well: `learned` is what each
    /// stretch adds to the variance through them.
    pub(crate) fn learned_freedom(&self, learned: &Learned) -> f64 {
        let left_out: Vec<f64> = (0..self.blocks())
            .map(|block| self.autocovariance_without(block)[0])
            .collect();
        let power = self.autocovariance()[0];
        let spread = spread(&left_out, Some(learned));
        let quantiles = NORMAL_QUANTILE / interval::student_quantile(spread.freedom);
        (2.0 * power * power / spread.variance * quantiles * quantiles).max(1.0)
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

/// Sum and number, at lags `0 ..= largest_lag`, of the products about a centre of the pairs whose earlier
/// sample lies in a range and the later behind it; pairs with a missing value (NaN) are left out.
fn pairs_across(
    values: &[f64],
    centre: f64,
    range: Range<usize>,
    largest_lag: usize,
) -> Vec<(f64, usize)> {
    let end = range.end;
    let of_lag = |lag: usize| {
        let first = end.saturating_sub(lag).max(range.start);
        let later = values.get(first + lag..).unwrap_or_default();
        let pairs = values[first..end].iter().zip(later);
        let products = pairs.map(|(one, other)| (one - centre) * (other - centre));
        let present = products.filter(|product| !product.is_nan());
        present.fold((0.0, 0), |(sum, count), product| (sum + product, count + 1))
    };
    (0..=largest_lag).map(of_lag).collect()
}

/// Lags whose products are summed side by side, so that none waits for the addition of another.
const SIDE_BY_SIDE: usize = 4;

/// Sums of the products of the first `own` deviations with those behind them at each lag, and the numbers of
/// these products.
pub(super) fn products_at<'a>(
    deviations: &'a [f64],
    own: usize,
    lags: impl IntoIterator<Item = usize>,
) -> Vec<(f64, usize)> {
    // The last block of a short record may hold fewer samples than the lag.
    let later = |lag: usize| {
        let later = deviations.get(lag..).unwrap_or_default();
        &later[..own.min(later.len())]
    };
    let later: Vec<&'a [f64]> = lags.into_iter().map(later).collect();
    products(&deviations[..own], &later)
}

/// Adds the products of the first `own` deviations at every lag.
fn add_products(deviations: &[f64], own: usize, sums: &mut [f64], counts: &mut [usize]) {
    let found = products_at(deviations, own, 0..sums.len());
    for ((sum, count), (more, pairs)) in sums.iter_mut().zip(counts).zip(found) {
        *sum += more;
        *count += pairs;
    }
}

/// Lagged products of a record while it comes in, in twenty to forty blocks of equal length.
#[derive(Clone, Debug)]
pub(crate) struct LaggedStream {
    centre: f64,
    lags: usize,
    blocks: usize,
    /// Chunks of a block.
    block_chunks: usize,
    /// Chunks of the last block.
    filled: usize,
    products: LaggedProducts,
    /// Sum of the deviations of each block.
    deviations: Vec<f64>,
    /// Deviations whose partners are still to come.
    waiting: Vec<f64>,
}

impl LaggedStream {
    /// Of a record about a value near its mean.
    pub(crate) fn new(centre: f64, largest_lag: usize, blocks: usize) -> Self {
        Self {
            centre,
            lags: largest_lag,
            blocks,
            block_chunks: 1,
            filled: 0,
            products: LaggedProducts {
                sums: Vec::new(),
                counts: Vec::new(),
                across: Vec::new(),
            },
            deviations: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// Takes the next values.
    pub(crate) fn extend(&mut self, values: &[f64]) {
        let centre = self.centre;
        self.waiting
            .extend(values.iter().map(|value| value - centre));
        let mut first = 0;
        while self.waiting.len() - first >= CHUNK + self.lags {
            let waiting = std::mem::take(&mut self.waiting);
            self.add(&waiting[first..first + CHUNK + self.lags], CHUNK);
            self.waiting = waiting;
            first += CHUNK;
        }
        self.waiting.drain(..first);
    }

    fn add(&mut self, deviations: &[f64], own: usize) {
        if self.filled == 0 {
            self.products.sums.push(vec![0.0; self.lags + 1]);
            self.products.counts.push(vec![0; self.lags + 1]);
            self.deviations.push(0.0);
        }
        let LaggedProducts { sums, counts, .. } = &mut self.products;
        let block = sums.len() - 1;
        add_products(deviations, own, &mut sums[block], &mut counts[block]);
        self.deviations[block] += deviations[..own].iter().sum::<f64>();
        self.filled += 1;
        if self.filled == self.block_chunks {
            self.filled = 0;
            if sums.len() == 2 * self.blocks {
                self.merge();
            }
        }
    }

    /// Makes one block of two.
    fn merge(&mut self) {
        let LaggedProducts { sums, counts, .. } = &mut self.products;
        let half = sums.len() / 2;
        for block in 0..half {
            for lag in 0..=self.lags {
                sums[block][lag] = sums[2 * block][lag] + sums[2 * block + 1][lag];
                counts[block][lag] = counts[2 * block][lag] + counts[2 * block + 1][lag];
            }
            self.deviations[block] = self.deviations[2 * block] + self.deviations[2 * block + 1];
        }
        sums.truncate(half);
        counts.truncate(half);
        self.deviations.truncate(half);
        self.block_chunks *= 2;
    }

    /// The products of all that came, about its mean.
    pub(crate) fn finish(mut self, mean: f64) -> LaggedProducts {
        let waiting = std::mem::take(&mut self.waiting);
        let own = waiting.len();
        self.add(&waiting, own);
        self.products.moved_by(mean - self.centre, &self.deviations)
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

/// Sums of the products of a slice with the beginning of each of several, none longer than it, over all pairs
/// without a missing value (NaN), and the numbers of these pairs.
fn products(a: &[f64], others: &[&[f64]]) -> Vec<(f64, usize)> {
    let mut found = Vec::with_capacity(others.len());
    let (whole, rest) = others.as_chunks::<SIDE_BY_SIDE>();
    found.extend(whole.iter().flat_map(|others| products_of(a, *others)));
    found.extend(rest.iter().flat_map(|other| products_of(a, [*other])));
    found
}

fn products_of<const N: usize>(a: &[f64], others: [&[f64]; N]) -> [(f64, usize); N] {
    let sums = with_wide_vectors!(simd => dots(simd, a, others));
    std::array::from_fn(|at| {
        if !sums[at].is_nan() {
            return (sums[at], others[at].len());
        }
        let pairs = a.iter().zip(others[at]).map(|(a, b)| a * b);
        pairs
            .filter(|product| !product.is_nan())
            .fold((0.0, 0), |(sum, count), product| (sum + product, count + 1))
    })
}

/// Dot products of a slice with several, none longer than it, each over its own length in eight interleaved
/// sums.
#[inline(always)]
fn dots<S: Simd, const N: usize>(simd: S, a: &[f64], others: [&[f64]; N]) -> [f64; N] {
    let mut lanes = [Lanes::splat(simd, 0.0); N];
    let a_chunks = a.as_chunks::<LANES>().0;
    let chunks = others.map(|other| other.as_chunks::<LANES>().0);
    let common = chunks.iter().map(|own| own.len()).min().unwrap_or(0);
    let whole = chunks.map(|own| &own[..common]);
    for (index, a) in a_chunks[..common].iter().enumerate() {
        let a = Lanes::of(simd, a);
        for (lanes, other) in lanes.iter_mut().zip(&whole) {
            *lanes = *lanes + a * Lanes::of(simd, &other[index]);
        }
    }
    let mut sums = [0.0; N];
    for (index, sum) in sums.iter_mut().enumerate() {
        let own = chunks[index];
        for (a, b) in a_chunks[common..].iter().zip(&own[common..]) {
            lanes[index] = lanes[index] + Lanes::of(simd, a) * Lanes::of(simd, b);
        }
        let done = own.len() * LANES;
        let rest = a[done..].iter().zip(&others[index][done..]);
        let rest: f64 = rest.map(|(a, b)| a * b).sum();
        *sum = lanes[index].to_array().iter().sum::<f64>() + rest;
    }
    sums
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
    fn a_block_alone_has_the_autocovariance_of_its_samples() {
        let values: Vec<f64> = (0..1003).map(|k| ((k * k) % 101) as f64).collect();
        let products = LaggedProducts::new(&values, 50.0, 7, 20);
        for block in 0..20 {
            let own = &values[values.len() * block / 20..values.len() * (block + 1) / 20];
            let alone = LaggedProducts::new(own, 50.0, 7, 1).autocovariance();
            for (found, wanted) in products.autocovariance_of(block).iter().zip(alone) {
                assert!(
                    (found - wanted).abs() < 1e-9 * 1e4,
                    "{block}: {found} {wanted}"
                );
            }
        }
    }

    #[test]
    fn a_stream_has_the_products_of_the_whole_record() {
        let values: Vec<f64> = (0..123_456_u32)
            .map(|k| f64::from((k * 7919) % 1013) + 1e-4 * f64::from(k))
            .collect();
        let mut stream = LaggedStream::new(500.0, 5, 4);
        for piece in values.chunks(10_007) {
            stream.extend(piece);
        }
        let mean = interval::mean(&values);
        let found = stream.finish(mean);
        assert!((4..=8).contains(&found.blocks()));
        let whole = LaggedProducts::new(&values, mean, 5, 4).autocovariance();
        let variance = whole[0];
        for (lag, (found, whole)) in found.autocovariance().iter().zip(&whole).enumerate() {
            // A lag shares all but the ends of a block with its sums.
            let tolerance = if lag == 0 { 1e-12 } else { 1e-5 };
            assert!(
                (found - whole).abs() < tolerance * variance,
                "{lag}: {found} {whole}"
            );
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
    fn the_correlation_of_neighbours_is_that_of_a_moving_average() {
        // The sum of two neighbours of a full-period generator: correlation 1/2.
        let mut state = 1_u64;
        let mut uniform = || -> f64 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let white: Vec<f64> = (0..20_001).map(|_| uniform()).collect();
        let sums: Vec<f64> = white.windows(2).map(|two| two[0] + two[1]).collect();
        let products = LaggedProducts::new(&sums, interval::mean(&sums), 1, 20);
        let found = lag_one_correlation(&products, None).unwrap();
        // Standard error by Bartlett: sqrt((1 - 3/4 + 1/4) / n) = 0.005.
        assert!(found.low < 0.5 && 0.5 < found.high, "{found:?}");
        assert!(
            (0.01..0.05).contains(&(found.high - found.low)),
            "{found:?}"
        );
        assert!(lag_one_correlation(&LaggedProducts::new(&[1.0; 9], 1.0, 1, 3), None).is_none());
        let twelfth = autocovariance(&white, 2);
        assert!((twelfth[0] * 12.0 - 1.0).abs() < 0.05 && twelfth[2].abs() < 0.003);
    }

    #[test]
    fn correlated_samples_count_for_less() {
        assert!((independent_samples(&[2.0, 0.0], 100) - 100.0).abs() < 1e-12);
        assert!((independent_samples(&[1.0, 0.5], 150) - 100.0).abs() < 1e-12);
    }
}
