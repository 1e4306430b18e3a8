//! Mean of a record, its error, its ratio to that of raw, and the extremes.

use crate::metrics::estimate::blocks::{RATIO_BLOCKS, equal_block_means};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, Headline, MetricKey, Needs, Table};
use crate::metrics::record::Record;
use crate::wording::decimals;

/// Mean.
pub static MEAN: MetricKey = MetricKey::new(
    "mean_deg_per_h",
    "deg/h",
    Applies::Always,
    "mean over the record; in a swing the offset of the sine fit over whole cycles",
)
.synonyms(&["average"])
.heading("mean")
.run_column(1)
.of_one_motion()
.tables(&[Table::Rest, Table::Steps])
.headlines(&[Headline::Rest]);

/// Mean error.
pub static MEAN_ERROR: MetricKey = MetricKey::new(
    "mean_error_deg_per_h",
    "deg/h",
    Applies::Always,
    "the mean minus that of the true rate",
)
.heading("mean error")
.against(Against::Truth)
.run_column(2)
.of_one_motion()
.tables(&[Table::Rest, Table::Steps])
.headlines(&[Headline::Steps, Headline::General]);

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

/// Minimum.
pub static MINIMUM: MetricKey = MetricKey::new(
    "minimum_deg_per_h",
    "deg/h",
    Applies::Always,
    "smallest sample of the record",
)
.needs(Needs::Samples)
.run_column(4);

/// Maximum.
pub static MAXIMUM: MetricKey = MetricKey::new(
    "maximum_deg_per_h",
    "deg/h",
    Applies::Always,
    "largest sample of the record",
)
.needs(Needs::Samples)
.run_column(5);

/// Enters the mean and, where the truth is known, its error against the mean truth.
pub(crate) fn put_mean(
    mean: Estimate,
    truth_deg_per_h: Option<f64>,
    averaging_time_s: f64,
    metrics: &mut ChannelMetrics,
) {
    metrics
        .put(&MEAN, mean)
        .fields
        .insert("averaging_time_s", averaging_time_s);
    let Some(truth_deg_per_h) = truth_deg_per_h else {
        return;
    };
    let error = Estimate::with_interval(
        mean.value - truth_deg_per_h,
        mean.low - truth_deg_per_h,
        mean.high - truth_deg_per_h,
    );
    metrics
        .put(&MEAN_ERROR, error)
        .fields
        .insert("averaging_time_s", averaging_time_s);
}

/// Enters the smallest and the largest sample.
pub(crate) fn put_extremes(values: &[f64], metrics: &mut ChannelMetrics) {
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    metrics.put(&MINIMUM, Estimate::exact(smallest));
    metrics.put(&MAXIMUM, Estimate::exact(largest));
}

/// Ratio of the means, if raw's mean can be told from zero.
pub(crate) fn measure_mean_ratio(record: &Record, metrics: &mut ChannelMetrics) {
    let channel = equal_block_means(record.channel_deg_per_h, RATIO_BLOCKS);
    let raw = equal_block_means(record.raw_deg_per_h, RATIO_BLOCKS);
    put_ratio_of_means(&MEAN_RATIO, &channel, &raw, metrics);
}

/// Why nothing can be divided by raw's mean; nothing if it can be told from zero.
pub(crate) fn ratio_of_means_lack(raw_mean: &Estimate) -> Option<Unavailable> {
    (raw_mean.low <= 0.0 && raw_mean.high >= 0.0).then(|| {
        format!(
            "the raw mean, {} deg/h, cannot be told from zero",
            decimals(raw_mean.value, 4)
        )
        .into()
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
