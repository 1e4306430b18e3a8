//! Noise about the signal, and what a filter leaves of noise and mean.

use super::autocovariance::{LaggedProducts, independent_samples, put_autocovariance};
use super::estimate::{ChannelMetrics, Estimate};
use super::interval;
use super::key::{Applies, Headline, MetricKey, Needs, Table};
use super::record::Record;
use super::steady::{RATIO_BLOCKS, equal_block_means};
use super::table::DEGREES_OF_FREEDOM;
use crate::wording::decimals;

/// Mean over that of raw.
pub static MEAN_RATIO: MetricKey = MetricKey::of_filters(
    "mean_ratio",
    "1",
    Applies::Always,
    "mean of the channel over the mean of raw",
)
.heading("mean / raw mean")
.of_one_motion()
.tables(&[Table::Rest, Table::Steps]);

/// Standard deviation of the noise.
pub static NOISE_STD: MetricKey = MetricKey::new(
    "noise_std_deg_per_h",
    "deg/h",
    Applies::Separable,
    "standard deviation of the samples about the signal: mean, fitted sine, or settled rate",
)
.heading("noise std")
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
.heading("noise power gain")
.needs(Needs::SettledStep)
.tables(&[Table::Rest, Table::Swing, Table::MultiSine, Table::Steps]);

/// Standard deviation about the signal.
///
/// The degrees of freedom are those that the scatter of the variance from block to block shows:
/// noise whose strength changes, as behind weights that follow a swing, has fewer than its
/// autocovariance tells. Of few blocks the latter is taken. The correlation of neighbours and the
/// curve of the autocovariance go with it.
pub(crate) fn put_noise_std(
    products: &LaggedProducts,
    count: usize,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    put_autocovariance(products, sample_period_s, metrics);
    let autocovariance = products.autocovariance();
    let of_lags = (independent_samples(&autocovariance, count) - 1.0).max(1.0);
    let freedom = products.variance_freedom().unwrap_or(of_lags);
    let metric = metrics.put(
        &NOISE_STD,
        interval::deviation(autocovariance[0].sqrt(), freedom),
    );
    metric.fields.insert("count", count as f64);
    metric.fields.insert(DEGREES_OF_FREEDOM, freedom);
}

/// Ratio of the variances about the signal; blocks leave numerator and denominator together.
///
/// `raw_level_deg_per_h` is the size of raw's samples: scatter below 1e-12 of it is rounding.
pub(crate) fn put_noise_gain(
    channel: &LaggedProducts,
    raw: &LaggedProducts,
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
    let gain = interval::jackknife(value, &left_out);
    // A power is never negative.
    let gain = Estimate::with_interval(gain.value, gain.low.max(0.0), gain.high);
    metrics.put(&NOISE_GAIN, gain);
}

/// Ratio of the means, if raw's mean can be told from zero.
pub(crate) fn measure_mean_ratio(record: &Record, metrics: &mut ChannelMetrics) {
    let channel = equal_block_means(record.channel_deg_per_h, RATIO_BLOCKS);
    let raw = equal_block_means(record.raw_deg_per_h, RATIO_BLOCKS);
    put_ratio_of_means(&MEAN_RATIO, &channel, &raw, metrics);
}

/// Why nothing can be divided by raw's mean; nothing if it can be told from zero.
pub(crate) fn ratio_of_means_lack(raw_mean: &Estimate) -> Option<String> {
    (raw_mean.low <= 0.0 && raw_mean.high >= 0.0).then(|| {
        format!(
            "the raw mean, {} deg/h, cannot be told from zero",
            decimals(raw_mean.value, 4)
        )
    })
}

/// Enters the ratio of the means of equally long blocks.
pub(crate) fn put_ratio_of_means(
    key: &MetricKey,
    channel: &[f64],
    raw: &[f64],
    metrics: &mut ChannelMetrics,
) {
    let raw_mean = interval::from_parts(interval::mean(raw), raw);
    if let Some(reason) = ratio_of_means_lack(&raw_mean) {
        return metrics.miss(key, reason);
    }
    let (channel_sum, raw_sum): (f64, f64) = (channel.iter().sum(), raw.iter().sum());
    let left_out: Vec<f64> = channel
        .iter()
        .zip(raw)
        .map(|(own, other)| (channel_sum - own) / (raw_sum - other))
        .collect();
    metrics.put(key, interval::jackknife(channel_sum / raw_sum, &left_out));
}
