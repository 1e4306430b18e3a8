//! Pooling of independent repeats of one channel.

use std::collections::{BTreeMap, BTreeSet};

use crate::metrics::allan::curves::pool_allan;
use crate::metrics::catalogue::support::repeats_lack;
use crate::metrics::catalogue::{find, known_metrics, repeated_metrics};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::repeat_statistics::RepeatStatistics;
use crate::metrics::estimate::table::{
    DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION, TWO_SIDED_PSD,
};
use crate::metrics::estimate::value::{ChannelMetrics, Estimate, Metric};
use crate::metrics::key::metric::{Applies, MetricKey, Pool, Table};
use crate::metrics::motion::steady::MEAN;
use crate::metrics::steps::scale_factor::scale_factor_repeatability;
use crate::metrics::steps::staircase::SCALE_FACTOR_ERROR;
use crate::units::ratio_to_ppm;

/// Bias repeatability.
pub static BIAS_REPEATABILITY: MetricKey = MetricKey::new(
    "bias_repeatability_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of the means of six repeats or more, each a start of its own",
)
.heading("bias repeatability")
.pooled(Pool::ScatterOf(&MEAN))
.by_choice()
.tables(&[Table::Rest]);

/// Scale factor repeatability.
pub static SCALE_FACTOR_REPEATABILITY: MetricKey = MetricKey::new(
    "scale_factor_repeatability_ppm",
    "ppm",
    Applies::Steps,
    "standard deviation of the scale factors of six repeats or more over their mean",
)
.heading("scale factor repeatability")
.pooled(Pool::RelativeScatterOf(&SCALE_FACTOR_ERROR))
.of_turned_axis()
.by_choice()
.tables(&[Table::Steps]);

/// From this many repeats on, Student's t on their scatter gives the interval; below, the intervals
/// of the repeats themselves say more.
const SCATTER_REPEATS_MIN: usize = 6;

/// Curves of points that have intervals of their own.
const POINT_CURVES: [&str; 8] = [
    "autocovariance",
    "response",
    "scale_factor",
    "frequency_response",
    "frequency_response_vs_raw",
    "frozen_response",
    "noise_delay_bound",
    "rate_gain",
];

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
/// Each metric gets the field `repeats`, the number of repeats that have it; the values of the main
/// ones ([`repeated_metrics`]) are kept repeat by repeat. Allan
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
    pool_spectra(repeats, &mut pooled);
    pool_points(repeats, &mut pooled);
    pool_allan(repeats, &mut pooled);
    pooled.repeats = repeated_metrics()
        .into_iter()
        .filter_map(|key| Some((key.name.to_owned(), RepeatStatistics::of(repeats, key)?)))
        .collect();
    pooled
}

/// Enters the scatter of scale factor and bias over the repeats, where a single record would have
/// them but for their number.
///
/// Source: IEEE Std 952, repeatability; the interval is the chi-square one of a standard deviation.
fn put_repeatability(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    for key in known_metrics() {
        let (Pool::ScatterOf(source) | Pool::RelativeScatterOf(source)) = key.pool else {
            continue;
        };
        let single = repeats_lack(key, 1);
        if pooled.why_unavailable(key) != single.as_deref() {
            continue;
        }
        if let Some(reason) = repeats_lack(key, repeats.len()) {
            pooled.miss(key, reason);
            continue;
        }
        let values: Option<Vec<f64>> = repeats
            .iter()
            .map(|repeat| Some(repeat.get(source)?.estimate.value))
            .collect();
        let Some(values) = values else {
            pooled.miss(key, format!("not every repeat has a {}", source.name));
            continue;
        };
        let factors: Vec<f64> = values
            .iter()
            .map(|ppm| 1.0 + ppm / ratio_to_ppm(1.0))
            .collect();
        let is_relative = matches!(key.pool, Pool::RelativeScatterOf(_));
        let scatter = match scale_factor_repeatability(&factors) {
            Some(ratio) if is_relative => ratio_to_ppm(ratio),
            _ => interval::sample_variance(&values).sqrt(),
        };
        let freedom = values.len() as f64 - 1.0;
        let fields = &mut pooled
            .put(key, interval::deviation(scatter, freedom))
            .fields;
        fields.insert(DEGREES_OF_FREEDOM, freedom);
        fields.insert("repeats", values.len() as f64);
    }
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

/// Column of a curve in every repeat; `None` unless all have it in the same length.
pub(crate) fn columns<'a>(
    repeats: &'a [ChannelMetrics],
    curve: &str,
    column: &str,
) -> Option<Vec<&'a Vec<f64>>> {
    let found: Option<Vec<&Vec<f64>>> = repeats
        .iter()
        .map(|repeat| repeat.curves.get(curve)?.get(column))
        .collect();
    found.filter(|all| !all.is_empty() && all.iter().all(|one| one.len() == all[0].len()))
}

/// Mean over the repeats of `transform(value)`, entry by entry.
pub(crate) fn mean_of(columns: &[&Vec<f64>], transform: fn(f64) -> f64) -> Vec<f64> {
    (0..columns[0].len())
        .map(|index| {
            let sum: f64 = columns.iter().map(|column| transform(column[index])).sum();
            sum / columns.len() as f64
        })
        .collect()
}

fn pool_spectra(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let frequency = columns(repeats, "psd", "frequency_hz");
    let density = columns(repeats, "psd", "psd_deg2_per_h2_per_hz");
    if let (Some(frequency), Some(density)) = (frequency, density) {
        let curve = BTreeMap::from([
            ("frequency_hz".to_owned(), frequency[0].clone()),
            (
                "psd_deg2_per_h2_per_hz".to_owned(),
                mean_of(&density, std::convert::identity),
            ),
            (
                TWO_SIDED_PSD.to_owned(),
                mean_of(&density, |value| value / 2.0),
            ),
        ]);
        pooled.curves.insert("psd".to_owned(), curve);
    }
}

/// Averages the curves whose points have intervals of their own, which shrink with the root of the
/// number of repeats.
fn pool_points(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let shrink = 1.0 / (repeats.len() as f64).sqrt();
    for name in POINT_CURVES {
        let Some(first) = repeats.first().and_then(|repeat| repeat.curves.get(name)) else {
            continue;
        };
        let mean = |column: &str| {
            let found = columns(repeats, name, column)?;
            Some(mean_of(&found, std::convert::identity))
        };
        let pool = |column: &String| {
            let own = mean(column)?;
            let middle = ["_low", "_high"]
                .iter()
                .find(|end| column.contains(*end))
                .and_then(|end| mean(&column.replace(end, "")));
            let values = match middle {
                Some(middle) => own
                    .iter()
                    .zip(&middle)
                    .map(|(end, middle)| middle + shrink * (end - middle))
                    .collect(),
                None => own,
            };
            Some((column.clone(), values))
        };
        let curve: Option<BTreeMap<String, Vec<f64>>> = first.keys().map(pool).collect();
        if let Some(curve) = curve {
            pooled.curves.insert(name.to_owned(), curve);
        }
    }
}
