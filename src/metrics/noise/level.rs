//! Noise about the signal, and what a filter leaves of noise and mean.

use super::autocovariance::{LaggedProducts, independent_samples, put_autocovariance};
use super::by_weights::NoiseByWeights;
use crate::metrics::estimate::influence::resampled;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::{ChannelMetrics, DEGREES_OF_FREEDOM};
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, OfBlocks, Pool, Table};

/// Standard deviation of the noise.
pub static NOISE_STD: MetricKey = MetricKey::new(
    "noise_std_deg_per_h",
    "deg/h",
    Applies::Separable,
    "standard deviation of the samples about the signal: mean, fitted sine, or settled rate; over n less what is fitted",
)
.lower_is_better()
.of_blocks(OfBlocks::Deviation)
.synonyms(&["std", "noise", "noise_rms", "standard_deviation"])
.heading("noise std")
.pooled(Pool::RootMeanSquare)
.needs(Needs::SettledStep)
.run_column(3)
.tables(&[Table::Rest, Table::Swing, Table::MultiSine, Table::Steps])
.headlines(&[Headline::Swing, Headline::MultiSine, Headline::Steps]);

/// Noise power gain.
pub static NOISE_GAIN: MetricKey = MetricKey::of_filters(
    "noise_gain",
    "1",
    Applies::Separable,
    "variance about the signal over that of raw",
)
.lower_is_better()
.synonyms(&["noise_power_gain", "noise_reduction"])
.heading("noise power gain")
.needs(Needs::SettledStep)
.tables(&[Table::Rest, Table::Swing, Table::MultiSine, Table::Steps]);

/// Standard deviation about a signal of `fitted` parameters.
///
/// The sum of squares over `count - fitted`: the mean alone takes one, a sine with its offset three.
///
/// The degrees of freedom are those that the scatter of the variance from block to block shows:
/// noise whose strength changes, as behind weights that follow a swing, has fewer than its
/// autocovariance tells. Of few blocks the latter is taken. The correlation of neighbours and the
/// curve of the autocovariance go with it.
pub(crate) fn put_noise_std(
    products: &LaggedProducts,
    by_weights: &NoiseByWeights,
    (count, fitted): (usize, usize),
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    put_autocovariance(products, by_weights, sample_period_s, metrics);
    let autocovariance = products.autocovariance();
    let of_lags = (independent_samples(&autocovariance, count) - 1.0).max(1.0);
    let freedom = match by_weights.of(|noise| noise[0]) {
        Some(learned) => products.learned_freedom(&learned),
        None => products.variance_freedom().unwrap_or(of_lags),
    };
    let unbiased = count as f64 / count.saturating_sub(fitted).max(1) as f64;
    let deviation = interval::sample_deviation((autocovariance[0] * unbiased).sqrt(), freedom);
    let metric = metrics.put(&NOISE_STD, by_weights.unless_unknown(deviation));
    metric.fields.insert("count", count as f64);
    if metric.estimate.has_interval() {
        metric.fields.insert(DEGREES_OF_FREEDOM, freedom);
    }
}

/// Ratio of the variances about the signal; blocks leave numerator and denominator together.
///
/// `raw_level_deg_per_h` is the size of raw's samples: scatter below 1e-12 of it is rounding.
pub(crate) fn put_noise_gain(
    channel: &LaggedProducts,
    raw: &LaggedProducts,
    by_weights: &NoiseByWeights,
    raw_level_deg_per_h: f64,
    metrics: &mut ChannelMetrics,
) {
    let raw_variance = raw.autocovariance()[0];
    if raw_variance.sqrt() <= 1e-12 * raw_level_deg_per_h || raw_variance <= 0.0 {
        metrics.miss(&NOISE_GAIN, "the raw channel has no noise");
        return;
    }
    let left_out: Vec<f64> = (0..raw.blocks())
        .map(|block| {
            channel.autocovariance_without(block)[0] / raw.autocovariance_without(block)[0]
        })
        .collect();
    let value = channel.autocovariance()[0] / raw_variance;
    let learned = by_weights.of(|noise| noise[0] / by_weights.raw_power());
    // A power is never negative.
    let gain = resampled(value, &left_out, learned.as_ref()).clamped(0.0, f64::INFINITY);
    metrics.put(&NOISE_GAIN, by_weights.unless_unknown(gain));
}
