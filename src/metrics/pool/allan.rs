//! Pooling of the Allan curves over repeats, and the fit to the result.

use super::pooling::{Fits, Pooling};
use crate::metrics::allan::curves::{
    ALLAN, ALLAN_FIT, COUNT, DEVIATION, ESTIMATOR, FITTED, FREEDOM, NOISE_ALPHA, NOISE_IDENTIFIED,
    TAU, columns_of, fitted_column, put_allan_words, put_fit_curve,
};
use crate::metrics::allan::entry::{FIT_METRICS, enter_fit};
use crate::metrics::allan::extra_terms::{pooled_sine, without_sine};
use crate::metrics::allan::noise_fit::{ANGLE_RANDOM_WALK, NoiseFit, Term, fit_pooled_noise};
use crate::metrics::allan::noise_identification::PowerLaw;
use crate::metrics::allan::overlapping::AllanPoint;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::{ChannelMetrics, EXPECTED};
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::motion::mean::MEAN;
use crate::metrics::noise::bias_stability::expected_bias_stability;
use crate::metrics::trial::dc_gain::{
    ANGLE_RANDOM_WALK_OVER_DC_GAIN, BIAS_STABILITY_OVER_DC_GAIN, DC_GAIN, put_over_dc_gain,
};

/// Columns of the curve that pooling takes the mean of.
const MEANS: [&Column; 2] = [&COUNT, &NOISE_IDENTIFIED];

/// The points of a curve with the mean variance of the repeats and the sum of their degrees of
/// freedom; nothing unless all repeats have the curve with the same number of points.
fn pooled_points(repeats: &Pooling, curve: &CurveKey) -> Option<Vec<AllanPoint>> {
    let tau = repeats.first_of(curve, &TAU)?;
    let variance = repeats.mean_of(curve, &DEVIATION)?;
    let freedom = repeats.mean_of(curve, &FREEDOM)?;
    let differences = repeats.first_of(curve, &COUNT)?;
    // The shortest averaging time is one sample.
    let sample_period_s = tau.first().copied().unwrap_or(1.0);
    let count = repeats.count as f64;
    let points = tau
        .iter()
        .zip(variance.iter().zip(&freedom))
        .zip(differences)
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
pub(crate) fn pool_allan(repeats: &Pooling, pooled: &mut ChannelMetrics) {
    let fit = pool_fit(repeats, pooled);
    pool_curve(repeats, fit.as_ref(), pooled);
}

fn pool_fit(repeats: &Pooling, pooled: &mut ChannelMetrics) -> Option<NoiseFit> {
    let fits = &repeats.fits;
    if !fits.pulse_words.is_empty() {
        pool_pulses(fits, pooled);
        return None;
    }
    let points = pooled_points(repeats, &ALLAN_FIT)?;
    let count = repeats.count as f64;
    let sine = pooled_sine(&fits.sines, repeats.count);
    let rest = without_sine(&points, sine);
    let Some(Ok(fit)) = fits
        .range
        .map(|range| fit_pooled_noise(&rest, range, count))
    else {
        put_fit_curve(&points, None, pooled);
        return None;
    };
    let fit = match sine {
        Some(sine) => fit.beside(sine),
        None => fit,
    };
    let mean = pooled.get(&MEAN);
    let duration_s = mean.and_then(|mean| mean.fields.get("averaging_time_s").copied());
    enter_fit(&points, &fit, duration_s.unwrap_or(f64::INFINITY), pooled);
    for key in FIT_METRICS {
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

/// Pools the terms of words that count pulses, each repeat of which was fitted to a curve of its own: the
/// mean of the squares with Student's t on their scatter.
fn pool_pulses(fits: &Fits, pooled: &mut ChannelMetrics) {
    for key in FIT_METRICS {
        let squares = fits.squares.get(key.name).map_or(&[][..], Vec::as_slice);
        if squares.len() < 2 || pooled.get(key).is_none() {
            continue;
        }
        let square = interval::from_parts(interval::mean(squares), squares);
        let term = Term::new(
            square.value,
            0.0,
            [square.low.max(0.0), square.high.max(0.0)],
        );
        if let Some(metric) = pooled.get_mut(key) {
            metric.estimate = term.estimate();
            metric.fields.insert("repeats", squares.len() as f64);
        }
    }
    pooled.pulse_words.clone_from(&fits.pulse_words);
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
fn pool_curve(repeats: &Pooling, fit: Option<&NoiseFit>, pooled: &mut ChannelMetrics) {
    let (Some(points), Some(alpha)) = (
        pooled_points(repeats, &ALLAN),
        repeats.mean_of(&ALLAN, &NOISE_ALPHA),
    ) else {
        return;
    };
    let mut curve = columns_of(&points);
    for column in MEANS {
        curve.extend(repeats.mean_of(&ALLAN, column).map(|mean| (column, mean)));
    }
    let laws = alpha.into_iter().map(PowerLaw::nearest_of_all);
    let laws: Vec<PowerLaw> = laws.collect();
    let exponents = laws.iter().map(|law| law.alpha().into());
    curve.push((&NOISE_ALPHA, exponents.collect()));
    let had_fit = repeats.first_of(&ALLAN, &FITTED).is_some();
    curve.extend(
        fit.filter(|_| had_fit)
            .map(|fit| fitted_column(&points, fit)),
    );
    pooled.put_curve(&ALLAN, curve);
    let words = repeats
        .first
        .as_ref()
        .map(|one| one.words(&ALLAN, &ESTIMATOR));
    let estimator = words.and_then(|words| words.first().copied());
    let names = laws.into_iter().map(PowerLaw::name).collect();
    put_allan_words(names, estimator.unwrap_or_default(), pooled);
}
