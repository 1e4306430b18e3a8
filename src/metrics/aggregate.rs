//! Pooling of independent repeats of one channel.

use std::collections::{BTreeMap, BTreeSet};

use super::allan::AllanPoint;
use super::estimate::{ChannelMetrics, Estimate, Metric};
use super::interval;
use super::noise_fit::{FitRange, fit_noise};
use super::repeat_statistics::{REPEATED_METRICS, RepeatStatistics};
use super::steady::{WALK_OVER_DC_GAIN, enter_fit, put_over_dc_gain};
use super::table::{DEGREES_OF_FREEDOM, EXPECTED};

/// From this many repeats on, Student's t on their scatter gives the interval; below, the intervals
/// of the repeats themselves say more.
const SCATTER_REPEATS_MIN: usize = 6;

/// The metrics that a fit to the pooled Allan variance replaces.
const FITTED: [&str; 5] = [
    "angle_random_walk_deg_per_sqrt_h",
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "rate_ramp_deg_per_h_per_h",
    "quantisation_arcsec",
];

/// Root mean squares, which are pooled as squares.
const ROOT_MEAN_SQUARES: [&str; 4] = [
    "tracking_error_rms_deg_per_h",
    "bias_error_rms_deg_per_h",
    "scale_factor_error_rms_ppm",
    "misalignment_error_rms_arcsec",
];

/// Curves of points that have intervals of their own.
const POINT_CURVES: [&str; 5] = [
    "response",
    "frequency_response",
    "frequency_response_vs_raw",
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
/// Each metric gets the field `repeats`, the number of repeats that have it; the values of the main
/// ones ([`REPEATED_METRICS`]) are kept repeat by repeat. Allan
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
    pool_spectra(repeats, &mut pooled);
    pool_points(repeats, &mut pooled);
    pool_allan(repeats, &mut pooled);
    let named = REPEATED_METRICS.into_iter();
    pooled.repeats = named
        .filter_map(|name| Some((name.to_owned(), RepeatStatistics::of(repeats, name)?)))
        .collect();
    pooled
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
            None if ROOT_MEAN_SQUARES.contains(&name) => {
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
fn columns<'a>(
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
fn mean_of(columns: &[&Vec<f64>], transform: fn(f64) -> f64) -> Vec<f64> {
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

/// Pools the Allan curves and fits the noise terms to the result.
fn pool_allan(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let tau = columns(repeats, "allan", "tau_s");
    let deviation = columns(repeats, "allan", "deviation_deg_per_h");
    let freedom = columns(repeats, "allan", "edf");
    let (Some(tau), Some(deviation), Some(freedom)) = (tau, deviation, freedom) else {
        return;
    };
    let count = repeats.len() as f64;
    let variance = mean_of(&deviation, |value| value * value);
    let freedom = mean_of(&freedom, std::convert::identity);
    let points: Vec<AllanPoint> = tau[0]
        .iter()
        .zip(variance.iter().zip(&freedom))
        .map(|(&tau_s, (variance, freedom))| AllanPoint {
            tau_s,
            averaged_samples: 0,
            deviation_deg_per_h: interval::deviation(variance.sqrt(), freedom * count),
            degrees_of_freedom: freedom * count,
            count: 0,
        })
        .collect();
    let range = FITTED.iter().find_map(|&name| {
        let fields = &pooled.metrics.get(name)?.fields;
        Some(FitRange {
            tau_min_s: *fields.get("tau_min_s")?,
            tau_max_s: *fields.get("tau_max_s")?,
        })
    });
    let Some(Ok(fit)) = range.map(|range| fit_noise(&points, range)) else {
        pooled.put_allan_curve(&points, None);
        return;
    };
    enter_fit(&points, &fit, pooled);
    for name in FITTED {
        if let Some(metric) = pooled.metrics.get_mut(name) {
            metric.fields.insert("repeats", count);
        }
    }
    let gain = pooled
        .metrics
        .get("dc_gain")
        .map(|gain| gain.estimate.value);
    if gain.is_some() && pooled.metrics.contains_key(WALK_OVER_DC_GAIN) {
        pooled.metrics.remove(WALK_OVER_DC_GAIN);
        put_over_dc_gain(FITTED[0], WALK_OVER_DC_GAIN, gain, pooled);
    }
}
