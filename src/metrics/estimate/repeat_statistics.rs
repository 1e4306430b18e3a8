//! A metric over the independent repeats of a run: every value, and what they have in common.

use super::interval;
use super::table::ChannelMetrics;
use crate::metrics::key::metric::MetricKey;

/// One metric over the repeats.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RepeatStatistics {
    /// Unit of the metric.
    pub unit: &'static str,
    /// Averaging time of the metric, s, where that defines it.
    pub averaging_time_s: Option<f64>,
    /// Values of the repeats, in order.
    pub values: Vec<f64>,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, divisor one less than their number.
    pub standard_deviation: f64,
    /// The smallest.
    pub minimum: f64,
    /// The largest.
    pub maximum: f64,
}

impl RepeatStatistics {
    /// Statistics of one metric; `None` with fewer than two repeats or where one lacks it.
    #[must_use]
    pub fn of(repeats: &[ChannelMetrics], key: &MetricKey) -> Option<Self> {
        let metrics: Option<Vec<_>> = repeats.iter().map(|repeat| repeat.get(key)).collect();
        let metrics = metrics.filter(|metrics| metrics.len() > 1)?;
        let values: Vec<f64> = metrics.iter().map(|metric| metric.estimate.value).collect();
        let mean = interval::mean(&values);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            unit: metrics[0].unit,
            averaging_time_s: metrics[0].fields.get("averaging_time_s").copied(),
            mean,
            standard_deviation: (squares / (values.len() - 1) as f64).sqrt(),
            minimum: values.iter().copied().fold(f64::INFINITY, f64::min),
            maximum: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            values,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::catalogue::MEAN;
    use crate::metrics::{Estimate, Metric};

    fn repeat(value: f64) -> ChannelMetrics {
        let mut channel = ChannelMetrics::default();
        let metric = Metric::new(Estimate::exact(value), "deg/h");
        channel.metrics.insert("mean_deg_per_h".to_owned(), metric);
        channel
    }

    #[test]
    fn known_answer_of_four_repeats() {
        let repeats = [2.0, 4.0, 4.0, 6.0].map(repeat);
        let statistics = RepeatStatistics::of(&repeats, &MEAN).expect("four values");
        assert!((statistics.mean - 4.0).abs() < 1e-15);
        // Squares 4 + 0 + 0 + 4 over three.
        assert!((statistics.standard_deviation - (8.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(statistics.minimum.to_bits(), 2.0_f64.to_bits());
        assert_eq!(statistics.maximum.to_bits(), 6.0_f64.to_bits());
        assert_eq!(statistics.values.len(), 4);
    }

    #[test]
    fn one_repeat_and_a_metric_that_one_repeat_lacks_have_no_statistics() {
        assert!(RepeatStatistics::of(&[repeat(1.0)], &MEAN).is_none());
        let lacking = [repeat(1.0), ChannelMetrics::default()];
        assert!(RepeatStatistics::of(&lacking, &MEAN).is_none());
    }
}
