//! Pooling of independent repeats of one channel.

use super::allan::pool_allan;
use super::curves::pool_curves;
use super::pooling::{MetricValues, Pooling, SCATTER_REPEATS_MIN};
use super::repeatability::put_repeatability;
use crate::metrics::catalogue::{find, repeated_metrics};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::repeat_statistics::RepeatStatistics;
use crate::metrics::estimate::table::{
    ChannelMetrics, DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION,
};
use crate::metrics::estimate::value::{Estimate, Metric};
use crate::metrics::key::metric::Pool;

/// Pools independent repeats of the same channel.
///
/// * Noise coefficients: the Allan variances are averaged, their degrees of freedom added, and the
///   fit is made again.
/// * Standard deviations: root of the mean variance, chi-square interval with the sum of the degrees
///   of freedom. Tracking error and errors of a calibration: root of the mean square, Student's t on the squares.
/// * Everything else: mean, Student's t on the scatter of the repeats from six repeats on; with
///   fewer, the repeats' own intervals combined in quadrature if each has one.
///
/// Repeatabilities: standard deviation of the repeats' values, from six repeats on.
///
/// Each metric gets the field `repeats`, the number of repeats that have it; the values are kept repeat
/// by repeat. Allan
/// deviations and spectra are averaged as powers, other curves as they are. If a repeat failed, the first failed one stands for the channel.
#[must_use]
pub fn aggregate(repeats: &[ChannelMetrics]) -> ChannelMetrics {
    let mut pooling = Pooling::default();
    repeats.iter().for_each(|repeat| pooling.add(repeat));
    pooling.pooled()
}

impl Pooling {
    /// What [`aggregate`] makes of the repeats that were taken in.
    #[must_use]
    pub fn pooled(mut self) -> ChannelMetrics {
        if let Some(failed) = self.failed.take() {
            return failed;
        }
        let mut pooled = ChannelMetrics::default();
        for (name, values) in &self.metrics {
            pooled.metrics.insert(name.clone(), pool(name, values));
        }
        for (name, reason) in &self.unavailable {
            if !pooled.metrics.contains_key(name) {
                pooled.unavailable.insert(name.clone(), reason.clone());
            }
        }
        put_repeatability(&self, &mut pooled);
        pool_curves(&self, &mut pooled);
        pool_allan(&self, &mut pooled);
        for key in repeated_metrics() {
            let Some(mut own) = self.metrics.remove(key.name) else {
                continue;
            };
            let lacking = own.lacking(self.count);
            if let Some(statistics) = RepeatStatistics::of(&own.first, own.values, lacking) {
                pooled.repeats.insert(key.name.to_owned(), statistics);
            }
        }
        pooled
    }
}

/// Whether a metric is pooled by its squares.
fn is_root_mean_square(name: &str) -> bool {
    find(name).is_some_and(|key| matches!(key.pool, Pool::RootMeanSquare))
}

/// Pools one metric over the repeats that have it.
fn pool(name: &str, own: &MetricValues) -> Metric {
    let values = &own.values;
    let count = values.len() as f64;
    let mut pooled = own.first.clone();
    if values.len() > 1 {
        let squares = || -> Vec<f64> { values.iter().map(|value| value * value).collect() };
        pooled.estimate = match own.freedom {
            Some(freedom) => {
                pooled.fields.insert(DEGREES_OF_FREEDOM, freedom);
                interval::deviation(interval::mean(&squares()).sqrt(), freedom)
            }
            None if is_root_mean_square(name) => {
                let squares = squares();
                let square = interval::from_parts(interval::mean(&squares), &squares);
                Estimate::with_interval(
                    square.value.sqrt(),
                    square.low.max(0.0).sqrt(),
                    square.high.sqrt(),
                )
            }
            None => pool_mean(own),
        };
    }
    let mut settle = |field, value: Option<f64>| {
        pooled.fields.remove(field);
        pooled.fields.extend(value.map(|value| (field, value)));
    };
    let expected = own.expected_square.map(|sum| (sum / count).sqrt());
    settle(EXPECTED, expected);
    settle(RAW_CORRELATION, own.raw_correlation.map(|sum| sum / count));
    pooled.fields.insert("repeats", count);
    pooled
}

/// Mean of the repeats with the interval described at [`aggregate`].
fn pool_mean(own: &MetricValues) -> Estimate {
    let (values, half_widths) = (&own.values, &own.half_widths);
    let mean = interval::mean(values);
    if values.len() >= SCATTER_REPEATS_MIN || half_widths.iter().any(|&width| width <= 0.0) {
        return interval::from_parts(mean, values);
    }
    let square: f64 = half_widths.iter().map(|width| width * width).sum();
    Estimate::symmetric(mean, square.sqrt() / values.len() as f64)
}
