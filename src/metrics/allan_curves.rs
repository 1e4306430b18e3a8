//! The two Allan curves of a channel, how they are entered and how repeats are pooled.
//!
//! `allan` is the curve of the settings' estimator and averaging times, `allan_fit` the overlapping
//! Allan deviation that the noise terms are fitted to.

use super::catalogue::{ANGLE_RANDOM_WALK, BIAS_STABILITY_OVER_DC_GAIN, DC_GAIN, MEAN};
use std::collections::BTreeMap;

use super::aggregate::{columns, mean_of};
use super::allan::AllanPoint;
use super::allan_variants::{AllanEstimator, AllanVariantPoint};
use super::bias::expected_bias_stability;
use super::catalogue::fitted_metrics;
use super::estimate::ChannelMetrics;
use super::interval;
use super::noise_fit::{FitRange, NoiseFit, fit_pooled_noise};
use super::noise_identification::PowerLaw;
use super::steady::{ANGLE_RANDOM_WALK_OVER_DC_GAIN, put_over_dc_gain};
use super::support::slow_noise_lack;
use super::table::EXPECTED;

/// The curve of the settings.
const CURVE: &str = "allan";
/// The curve that is fitted.
const FIT_CURVE: &str = "allan_fit";

/// Columns of the curve that pooling takes the mean of.
const MEANS: [&str; 2] = ["count", "noise_identified"];

/// Columns both curves have.
fn columns_of(points: &[AllanPoint]) -> BTreeMap<String, Vec<f64>> {
    type Pick = fn(&AllanPoint) -> f64;
    let picks: [(&str, Pick); 6] = [
        ("tau_s", |point| point.tau_s),
        ("deviation_deg_per_h", |point| {
            point.deviation_deg_per_h.value
        }),
        ("low_deg_per_h", |point| point.deviation_deg_per_h.low),
        ("high_deg_per_h", |point| point.deviation_deg_per_h.high),
        ("edf", |point| point.degrees_of_freedom),
        // Differences of one record.
        ("count", |point| point.count as f64),
    ];
    picks
        .into_iter()
        .map(|(name, pick)| (name.to_owned(), points.iter().map(pick).collect()))
        .collect()
}

/// The fitted overlapping Allan deviation at the times of a curve.
fn fitted_column(points: &[AllanPoint], fit: &NoiseFit) -> (String, Vec<f64>) {
    let fitted = points
        .iter()
        .map(|point| fit.deviation_deg_per_h(point.tau_s));
    ("fitted_deg_per_h".to_owned(), fitted.collect())
}

/// Enters the curve of the settings with the noise identified at every averaging time.
///
/// `noise_alpha` is the exponent of the rate's spectrum, the word column `noise` its name, the word
/// `estimator` that of the curve. `noise_identified` is 0 where there are too few averaging times and
/// the noise is that of the last one that has enough. The fitted deviation stands beside the Allan
/// deviations only; that of the others is another function of the same terms.
pub(crate) fn put_curve(
    variants: &[AllanVariantPoint],
    estimator: AllanEstimator,
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let points: Vec<AllanPoint> = variants.iter().map(|variant| variant.point).collect();
    let mut curve = columns_of(&points);
    let alpha = variants.iter().map(|variant| variant.noise.alpha().into());
    curve.insert("noise_alpha".to_owned(), alpha.collect());
    let identified = variants.iter().map(|variant| variant.noise_identified);
    let identified = identified.map(|known| f64::from(u8::from(known)));
    curve.insert("noise_identified".to_owned(), identified.collect());
    let is_allan = matches!(
        estimator,
        AllanEstimator::Overlapping | AllanEstimator::Plain
    );
    curve.extend(
        fit.filter(|_| is_allan)
            .map(|fit| fitted_column(&points, fit)),
    );
    metrics.curves.insert(CURVE.to_owned(), curve);
    let noise = variants.iter().map(|variant| variant.noise.name());
    put_labels(noise.collect(), estimator.name(), metrics);
}

fn put_labels(noise: Vec<&'static str>, estimator: &'static str, metrics: &mut ChannelMetrics) {
    let labels = BTreeMap::from([
        ("estimator".to_owned(), vec![estimator]),
        ("noise".to_owned(), noise),
    ]);
    metrics.curve_labels.insert(CURVE.to_owned(), labels);
}

/// Enters the curve that the noise is fitted to; its column of the fit is absent without one.
pub(crate) fn put_fit_curve(
    points: &[AllanPoint],
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let mut curve = columns_of(points);
    curve.extend(fit.map(|fit| fitted_column(points, fit)));
    metrics.curves.insert(FIT_CURVE.to_owned(), curve);
}

/// Enters a fit and the curve it was made from; of a record too short for slow noise without B, K, R.
pub(crate) fn enter_fit(
    points: &[AllanPoint],
    fit: &NoiseFit,
    duration_s: f64,
    metrics: &mut ChannelMetrics,
) {
    metrics.put_noise_fit(fit);
    for key in fitted_metrics() {
        let Some(reason) = slow_noise_lack(key, duration_s) else {
            continue;
        };
        if let Some(metric) = metrics.get(key) {
            let (high, unit) = (metric.estimate.high, metric.unit);
            let bound = if high.is_finite() {
                format!("; it is {high:.2e} {unit} at most")
            } else {
                String::new()
            };
            metrics.withdraw(key, reason + &bound);
        }
    }
    put_fit_curve(points, Some(fit), metrics);
}

/// The points of a curve with the mean variance of the repeats and the sum of their degrees of
/// freedom; nothing unless all repeats have the curve with the same number of points.
fn pooled_points(repeats: &[ChannelMetrics], curve: &str) -> Option<Vec<AllanPoint>> {
    let tau = columns(repeats, curve, "tau_s")?;
    let variance = mean_of(&columns(repeats, curve, "deviation_deg_per_h")?, |value| {
        value * value
    });
    let freedom = mean_of(&columns(repeats, curve, "edf")?, std::convert::identity);
    let differences = columns(repeats, curve, "count")?;
    // The shortest averaging time is one sample.
    let sample_period_s = tau[0].first().copied().unwrap_or(1.0);
    let count = repeats.len() as f64;
    let points = tau[0]
        .iter()
        .zip(variance.iter().zip(&freedom))
        .zip(differences[0])
        .map(|((&tau_s, (variance, freedom)), differences)| AllanPoint {
            tau_s,
            averaged_samples: interval::round_to_count(tau_s / sample_period_s),
            deviation_deg_per_h: interval::deviation(variance.sqrt(), freedom * count),
            degrees_of_freedom: freedom * count,
            count: interval::round_to_count(*differences),
        });
    Some(points.collect())
}

/// Pools the Allan curves and fits the noise terms to the result.
pub(crate) fn pool_allan(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let fit = pool_fit(repeats, pooled);
    pool_curve(repeats, fit.as_ref(), pooled);
}

fn pool_fit(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) -> Option<NoiseFit> {
    let points = pooled_points(repeats, FIT_CURVE)?;
    let count = repeats.len() as f64;
    let range = fitted_metrics().find_map(|key| {
        let fields = &pooled.get(key)?.fields;
        Some(FitRange {
            tau_min_s: *fields.get("tau_min_s")?,
            tau_max_s: *fields.get("tau_max_s")?,
        })
    });
    let Some(Ok(fit)) = range.map(|range| fit_pooled_noise(&points, range, count)) else {
        put_fit_curve(&points, None, pooled);
        return None;
    };
    let mean = pooled.get(&MEAN);
    let duration_s = mean.and_then(|mean| mean.fields.get("averaging_time_s").copied());
    enter_fit(&points, &fit, duration_s.unwrap_or(f64::INFINITY), pooled);
    for key in fitted_metrics() {
        if let Some(metric) = pooled.get_mut(key) {
            metric.fields.insert("repeats", count);
        }
    }
    expect_of_fit(&fit, pooled);
    let gain = pooled.get(&DC_GAIN);
    let gain = gain.map(|gain| gain.estimate.value);
    if gain.is_some() && pooled.get(&ANGLE_RANDOM_WALK_OVER_DC_GAIN).is_some() {
        pooled.metrics.remove(ANGLE_RANDOM_WALK_OVER_DC_GAIN.name);
        put_over_dc_gain(
            &ANGLE_RANDOM_WALK,
            &ANGLE_RANDOM_WALK_OVER_DC_GAIN,
            gain,
            pooled,
        );
    }
    Some(fit)
}

/// Replaces the mean of what the repeats' fits expect of the bias stability by what the fit to all of
/// them does: terms that cannot be negative are too large on average in single records.
fn expect_of_fit(fit: &NoiseFit, pooled: &mut ChannelMetrics) {
    let coefficients = fit.coefficients();
    let gain = pooled.get(&DC_GAIN);
    let gain = gain.map_or(1.0, |gain| gain.estimate.value.abs());
    for (name, metric) in &mut pooled.metrics {
        let fields = &mut metric.fields;
        let Some((time_s, count)) = fields
            .get("averaging_time_s")
            .copied()
            .zip(fields.get("count").copied())
        else {
            continue;
        };
        if let Some(expected) = fields.get_mut(EXPECTED) {
            let blocks = interval::round_to_count(count);
            let of_channel = expected_bias_stability(&coefficients, time_s, blocks);
            let is_restored = *name == BIAS_STABILITY_OVER_DC_GAIN.name;
            *expected = if is_restored {
                of_channel / gain
            } else {
                of_channel
            };
        }
    }
}

/// Pools the curve of the settings; the noise is the law nearest to the mean exponent.
fn pool_curve(repeats: &[ChannelMetrics], fit: Option<&NoiseFit>, pooled: &mut ChannelMetrics) {
    let (Some(points), Some(alpha)) = (
        pooled_points(repeats, CURVE),
        columns(repeats, CURVE, "noise_alpha"),
    ) else {
        return;
    };
    let mut curve = columns_of(&points);
    for name in MEANS {
        if let Some(found) = columns(repeats, CURVE, name) {
            curve.insert(name.to_owned(), mean_of(&found, std::convert::identity));
        }
    }
    let laws: Vec<PowerLaw> = mean_of(&alpha, std::convert::identity)
        .into_iter()
        .map(PowerLaw::nearest_of_all)
        .collect();
    let exponents = laws.iter().map(|law| law.alpha().into());
    curve.insert("noise_alpha".to_owned(), exponents.collect());
    let had_fit = columns(repeats, CURVE, "fitted_deg_per_h").is_some();
    curve.extend(
        fit.filter(|_| had_fit)
            .map(|fit| fitted_column(&points, fit)),
    );
    pooled.curves.insert(CURVE.to_owned(), curve);
    let labels = repeats.first().and_then(|one| one.curve_labels.get(CURVE));
    let estimator = labels.and_then(|labels| labels.get("estimator")?.first().copied());
    let names = laws.into_iter().map(PowerLaw::name).collect();
    put_labels(names, estimator.unwrap_or_default(), pooled);
}
