//! Pooling of independent repeats of one channel.

use std::collections::BTreeSet;

use super::allan::pool_allan;
use super::curves::pool_curves;
use super::repeatability::put_repeatability;
use crate::metrics::catalogue::{find, repeated_metrics};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::repeat_statistics::RepeatStatistics;
use crate::metrics::estimate::table::{
    ChannelMetrics, DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION,
};
use crate::metrics::estimate::value::{Estimate, Metric};
use crate::metrics::key::metric::Pool;

/// From this many repeats on, Student's t on their scatter gives the interval; below, the intervals
/// of the repeats themselves say more.
const SCATTER_REPEATS_MIN: usize = 6;

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
    if let Some(failed) = repeats.iter().find(|repeat| repeat.error.is_some()) {
        return failed.clone();
    }
    let mut pooled = ChannelMetrics::default();
    let names: BTreeSet<&String> = repeats
        .iter()
        .flat_map(|repeat| repeat.metrics.keys())
        .collect();
    for name in names {
        let metrics: Vec<&Metric> = repeats
            .iter()
            .filter_map(|repeat| repeat.metrics.get(name))
            .collect();
        pooled.metrics.insert(name.clone(), pool(name, &metrics));
    }
    for (name, reason) in repeats.iter().flat_map(|repeat| &repeat.unavailable) {
        if !pooled.metrics.contains_key(name) {
            pooled
                .unavailable
                .entry(name.clone())
                .or_insert_with(|| reason.clone());
        }
    }
    put_repeatability(repeats, &mut pooled);
    pool_curves(repeats, &mut pooled);
    pool_allan(repeats, &mut pooled);
    pooled.repeats = repeated_metrics()
        .into_iter()
        .filter_map(|key| Some((key.name.to_owned(), RepeatStatistics::of(repeats, key)?)))
        .collect();
    pooled
}

/// Whether a metric is pooled by its squares.
fn is_root_mean_square(name: &str) -> bool {
    find(name).is_some_and(|key| matches!(key.pool, Pool::RootMeanSquare))
}

/// Pools one metric over the repeats that have it.
fn pool(name: &str, metrics: &[&Metric]) -> Metric {
    let values: Vec<f64> = metrics.iter().map(|metric| metric.estimate.value).collect();
    let freedoms: Option<Vec<f64>> = metrics
        .iter()
        .map(|metric| metric.fields.get(DEGREES_OF_FREEDOM).copied())
        .collect();
    let squares: Vec<f64> = values.iter().map(|value| value * value).collect();
    let mut pooled = metrics[0].clone();
    if metrics.len() > 1 {
        pooled.estimate = match freedoms {
            Some(freedoms) => {
                let freedom = freedoms.iter().sum();
                pooled.fields.insert(DEGREES_OF_FREEDOM, freedom);
                interval::deviation(interval::mean(&squares).sqrt(), freedom)
            }
            None if is_root_mean_square(name) => {
                let square = interval::from_parts(interval::mean(&squares), &squares);
                Estimate::with_interval(
                    square.value.sqrt(),
                    square.low.max(0.0).sqrt(),
                    square.high.sqrt(),
                )
            }
            None => pool_mean(&values, metrics),
        };
    }
    let expected: Option<Vec<f64>> = metrics
        .iter()
        .map(|metric| metric.fields.get(EXPECTED).map(|value| value * value))
        .collect();
    match expected {
        Some(squares) => {
            let square = interval::mean(&squares);
            pooled.fields.insert(EXPECTED, square.sqrt());
        }
        None => {
            pooled.fields.remove(EXPECTED);
        }
    }
    let correlations = metrics
        .iter()
        .map(|metric| metric.fields.get(RAW_CORRELATION));
    match correlations
        .map(Option::<&f64>::copied)
        .collect::<Option<Vec<f64>>>()
    {
        Some(correlations) => {
            let mean = interval::mean(&correlations);
            pooled.fields.insert(RAW_CORRELATION, mean);
        }
        None => {
            pooled.fields.remove(RAW_CORRELATION);
        }
    }
    pooled.fields.insert("repeats", metrics.len() as f64);
    pooled
}

/// Mean of the repeats with the interval described at [`aggregate`].
fn pool_mean(values: &[f64], metrics: &[&Metric]) -> Estimate {
    let mean = interval::mean(values);
    let half_widths: Vec<f64> = metrics
        .iter()
        .map(|metric| (metric.estimate.high - metric.estimate.low) / 2.0)
        .collect();
    if values.len() >= SCATTER_REPEATS_MIN || half_widths.iter().any(|&width| width <= 0.0) {
        return interval::from_parts(mean, values);
    }
    let square: f64 = half_widths.iter().map(|width| width * width).sum();
    Estimate::symmetric(mean, square.sqrt() / values.len() as f64)
}
