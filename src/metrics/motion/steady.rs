//! Metrics of a record at rest or at constant rate.

use super::mean::{MEAN, MEAN_ERROR, mean_spread_of, measure_mean_ratio, put_mean};
use crate::metrics::allan::coefficients::mixed_degrees_of_freedom;
use crate::metrics::allan::curves::{put_allan_curve, put_fit_curve};
use crate::metrics::allan::entry::{FIT_METRICS, enter_fit};
use crate::metrics::allan::noise_fit::{
    ANGLE_RANDOM_WALK, FIT_TAU_PER_RECORD_MAX, FitRange, NoiseFit, fit_noise,
};
use crate::metrics::allan::overlapping::{AllanPoint, overlapping_allan_across};
use crate::metrics::allan::pulses::entry::{enter_lack, enter_pulses};
use crate::metrics::allan::pulses::recognition::PulseWords;
use crate::metrics::allan::variants::{AllanEstimator, AllanVariantPoint, allan_variant_across};
use crate::metrics::estimate::blocks::RATIO_BLOCKS;
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::{
    ChannelMetrics, DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION,
};
use crate::metrics::estimate::value::Estimate;
use crate::metrics::estimate::{blocks, interval};
use crate::metrics::key::metric::MetricKey;
use crate::metrics::noise::autocovariance::{CURVE_LAGS, LaggedProducts};
use crate::metrics::noise::bias_stability;
use crate::metrics::noise::bias_stability::{
    BIAS_STABILITY, BIAS_STABILITY_1S, BIAS_STABILITY_10S, BIAS_STABILITY_100S, BLOCKS_MIN,
    averaging_lack,
};
use crate::metrics::noise::by_weights::NoiseByWeights;
use crate::metrics::noise::level::{put_noise_gain, put_noise_std};
use crate::metrics::noise::line::fit_beside_sine;
use crate::metrics::noise::memory::fit_tau_min_s;
use crate::metrics::noise::pulse_fit::RecordFit;
use crate::metrics::noise::truth_response::without_motion;
use crate::metrics::record::{FilterFacts, Record, Settings, WeightScatter};
use crate::metrics::theory::prediction::lags_needed;
use crate::metrics::trial::dc_gain::{
    ANGLE_RANDOM_WALK_OVER_DC_GAIN, BIAS_STABILITY_OVER_DC_GAIN, DC_GAIN, put_over_dc_gain,
};
use crate::metrics::trial::predicted::measure_predictions;
use crate::metrics::trial::weight_noise::{measure_inside_memory, measure_weight_noise};
use crate::wording::{counted, plain};

/// Lags of the autocovariance, at least; correlation beyond counts as slow noise.
pub(crate) const LAGS_MIN: usize = CURVE_LAGS;

/// Measures everything a steady record supports.
///
/// Where the true rate varies, as the Earth's on a cross axis that turns or that of an unsteady
/// table, what the channel shows of it is taken out first, its mean excepted.
pub(crate) fn measure_steady(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let tau_min_s = settings.fit_tau_min_s;
    let pulses = PulseWords::recognise(record.raw_deg_per_h, record.sample_period_s, tau_min_s);
    let still = without_motion(record, 0, filter);
    let pulses = match still {
        Some(_) => pulses.map(PulseWords::without_times),
        None => pulses,
    };
    let record = &still.as_ref().map_or(*record, |(channel, raw)| Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: raw,
        ..*record
    });
    let lags = LAGS_MIN.max(filter.map_or(0, |facts| lags_needed(&facts.shape)));
    let blocks = filter.map_or(RATIO_BLOCKS, FilterFacts::blocks);
    let products_of = |words| products_about_mean(words, lags, blocks);
    let (fit, (products, raw)) = rayon::join(
        || measure_allan(record, settings, filter, pulses.as_ref(), metrics),
        || {
            let raw = filter.map(|_| products_of(record.raw_deg_per_h));
            (products_of(record.channel_deg_per_h), raw)
        },
    );
    let means_of = |block: usize| {
        let means = blocks::block_means(record.channel_deg_per_h, block);
        Ok((means, blocks::block_means(record.raw_deg_per_h, block)))
    };
    let times = (record.sample_period_s, settings.bias_averaging_time_s);
    measure_bias(times, means_of, fit.as_ref(), metrics);
    measure_mean(record, fit.as_ref(), filter, metrics);
    let words = record.channel_deg_per_h.iter();
    let samples = words.filter(|word| !word.is_nan()).count();
    let by_weights = match (filter, &raw) {
        (Some(facts), Some(raw)) => NoiseByWeights::new(facts, raw, samples, 0.0),
        _ => NoiseByWeights::none(),
    };
    put_noise_std(
        &products,
        &by_weights,
        (samples, 1),
        record.sample_period_s,
        metrics,
    );
    if let (Some(facts), Some(raw)) = (filter, raw) {
        let level = interval::mean(record.raw_deg_per_h).abs();
        put_noise_gain(&products, &raw, &by_weights, level, metrics);
        measure_mean_ratio(record, 0..samples, facts, metrics);
        measure_weight_noise(record, facts, metrics);
        measure_inside_memory(record, facts, metrics);
        measure_predictions(record, facts, (&products, &raw), metrics);
        for (key, over) in [
            (&ANGLE_RANDOM_WALK, &ANGLE_RANDOM_WALK_OVER_DC_GAIN),
            (&BIAS_STABILITY, &BIAS_STABILITY_OVER_DC_GAIN),
        ] {
            put_over_dc_gain(key, over, facts.dc_gain, metrics);
        }
        let scatter = facts.weight_scatter(samples, 0.0);
        if matches!(
            scatter,
            WeightScatter::Learned(_) | WeightScatter::Runs { .. }
        ) {
            widen_by_gain(&ANGLE_RANDOM_WALK, metrics);
        }
    }
}

/// Adds the scatter of the DC gain, which is in the fitted noise of no single record, to a metric that is
/// proportional to it.
fn widen_by_gain(key: &MetricKey, metrics: &mut ChannelMetrics) {
    let Some(gain) = metrics.get(&DC_GAIN).map(|metric| metric.estimate) else {
        return;
    };
    let relative = Spread::of(&gain).half_width() / gain.value;
    if let Some(metric) = metrics.get_mut(key).filter(|_| relative.is_finite()) {
        metric.estimate = metric
            .estimate
            .widened(relative.abs() * metric.estimate.value);
    }
}

/// Allan curve and noise coefficients.
///
/// The curve `allan` is that of the settings. The noise is fitted to the overlapping Allan deviation,
/// the curve `allan_fit`, whose points take the degrees of freedom of the noise mix that the fit found.
/// Where the raw words count pulses it is that of a record without them.
fn measure_allan(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    pulses: Option<&PulseWords>,
    metrics: &mut ChannelMetrics,
) -> Option<NoiseFit> {
    let words = record.channel_deg_per_h;
    let sample_period_s = record.sample_period_s;
    let points = overlapping_allan_across(words, sample_period_s, &settings.bridges);
    let duration_s = words.len() as f64 * sample_period_s;
    let range = FitRange {
        tau_min_s: filter.map_or(settings.fit_tau_min_s, |facts| {
            fit_tau_min_s(&facts.shape, sample_period_s, settings.fit_tau_min_s)
        }),
        tau_max_s: FIT_TAU_PER_RECORD_MAX * duration_s,
    };
    let varies = words
        .windows(2)
        .any(|two| two[0] < two[1] || two[1] < two[0]);
    let fitted = if !varies {
        Err(NO_CHANGE.into())
    } else if let Some(pulses) = pulses {
        pulses.fit(words, sample_period_s, range, filter.is_none())
    } else {
        let fit = fit_beside_sine(words, sample_period_s, &points, range, None)
            .map_or_else(|| fit_noise(&points, range), Ok);
        fit.map(|fit| RecordFit {
            fit,
            points: points.clone(),
            samples: words.len(),
        })
    };
    let curves = Curves {
        points,
        variant: allan_variant_across(words, sample_period_s, &settings.allan, &settings.bridges),
        estimator: settings.allan.estimator,
        duration_s,
    };
    let fit = enter_allan(curves, fitted, metrics);
    if let (None, Some(pulses)) = (&fit, pulses.filter(|_| filter.is_none())) {
        enter_lack(pulses, range, metrics);
    }
    fit
}

/// The Allan curves of a channel.
pub(crate) struct Curves {
    /// The overlapping Allan deviation that the noise is fitted to.
    pub(crate) points: Vec<AllanPoint>,
    /// The curve of the settings.
    pub(crate) variant: Vec<AllanVariantPoint>,
    /// Its estimator.
    pub(crate) estimator: AllanEstimator,
    /// Length of the record, s.
    pub(crate) duration_s: f64,
}

/// Enters both curves and the noise terms of a fit, or why there is none.
pub(crate) fn enter_allan(
    curves: Curves,
    fitted: Result<RecordFit, Unavailable>,
    metrics: &mut ChannelMetrics,
) -> Option<NoiseFit> {
    let fit = fitted.as_ref().ok().map(|it| &it.fit);
    put_allan_curve(&curves.variant, curves.estimator, fit, metrics);
    match fitted {
        Ok(RecordFit {
            fit,
            points,
            samples,
        }) => {
            let points = mixed_degrees_of_freedom(&points, &fit.coefficients(), samples + 1);
            enter_fit(&points, &fit, curves.duration_s, metrics);
            enter_pulses(&fit, metrics);
            Some(fit)
        }
        Err(reason) => {
            put_fit_curve(&curves.points, None, metrics);
            for key in FIT_METRICS {
                metrics.miss(key, reason.clone());
            }
            None
        }
    }
}

/// Averaging times of bias stability, s, each with its metric: the fixed ones and the scenario's.
pub(crate) fn averaging_times_s(own_s: f64) -> [(&'static MetricKey, f64); 4] {
    [
        (&BIAS_STABILITY_1S, 1.0),
        (&BIAS_STABILITY_10S, 10.0),
        (&BIAS_STABILITY_100S, 100.0),
        (&BIAS_STABILITY, own_s),
    ]
}

/// Bias stability at the fixed averaging times and at the scenario's.
///
/// * `times`: sample period and the scenario's averaging time, s.
/// * `means_of`: means of the channel and of raw over blocks of so many samples.
pub(crate) fn measure_bias(
    (sample_period_s, own_s): (f64, f64),
    means_of: impl Fn(usize) -> Result<(Vec<f64>, Vec<f64>), Unavailable>,
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    for (name, averaging_time_s) in averaging_times_s(own_s) {
        if let Some(reason) = averaging_lack(averaging_time_s, sample_period_s) {
            metrics.miss(name, reason);
            continue;
        }
        let block = blocks::samples_in(averaging_time_s, sample_period_s);
        let averaging_time_s = blocks::block_label_s(averaging_time_s, sample_period_s);
        let (means, raw_means) = match means_of(block) {
            Ok(means) => means,
            Err(reason) => {
                metrics.miss(name, reason);
                continue;
            }
        };
        if means.len() < BLOCKS_MIN {
            let reason = format!(
                "the record holds {} of {} s; a standard deviation with an interval needs \
                 {BLOCKS_MIN}",
                counted(means.len(), "block"),
                plain(averaging_time_s)
            );
            metrics.miss(name, reason);
            continue;
        }
        let freedom = fit.map_or(means.len() as f64 - 1.0, |fit| {
            bias_stability::effective_degrees_of_freedom(
                &fit.coefficients(),
                averaging_time_s,
                means.len(),
            )
        });
        let deviation = interval::sample_variance(&means).sqrt();
        let metric = metrics.put(name, interval::sample_deviation(deviation, freedom));
        metric.fields.insert("averaging_time_s", averaging_time_s);
        metric.fields.insert("block_samples", block as f64);
        metric.fields.insert("count", means.len() as f64);
        metric.fields.insert(DEGREES_OF_FREEDOM, freedom);
        if let Some(correlation) = bias_stability::correlation(&means, &raw_means) {
            metric.fields.insert(RAW_CORRELATION, correlation);
        }
        let expects = |fit: &&NoiseFit| {
            fit.shows_white_noise() && fit.quantisation_is_white_from_s() <= averaging_time_s
        };
        if let Some(fit) = fit.filter(expects) {
            let coefficients = fit.coefficients();
            let expected = bias_stability::expected_bias_stability(
                &coefficients,
                averaging_time_s,
                means.len(),
            );
            metric.fields.insert(EXPECTED, expected);
        }
    }
}

/// Mean and its error.
///
/// Where the slow noise of the gyro is not known, as of a log, the interval is about the process that
/// the fit found: its white noise, and those slow terms that the record tells from nothing.
fn measure_mean(
    record: &Record,
    fit: Option<&NoiseFit>,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let values = record.channel_deg_per_h;
    let mean = interval::mean_of_present(values);
    let duration_s = values.len() as f64 * record.sample_period_s;
    let slow = match (record.drift, fit) {
        (None, Some(fit)) => {
            slow_variance(fit, &blocks::equal_block_means(values, TENTHS), duration_s)
        }
        _ => 0.0,
    };
    let estimate = match mean_spread_of(record, values, filter, true) {
        Ok(spread) => spread.plus(Spread::known(slow)).about(mean),
        Err(reason) => Estimate::without_interval(mean, reason),
    };
    let truth = record.truth().map(|truth| truth.mean());
    enter_mean(
        estimate,
        truth,
        duration_s,
        record.drift_variance() + slow,
        metrics,
    );
}

/// Variance that slow noise gives to the mean of a record, no more than its tenths show.
pub(crate) fn slow_variance(fit: &NoiseFit, tenths: &[f64], duration_s: f64) -> f64 {
    let shown = SLOW_OVER_TENTHS * interval::sample_variance(tenths);
    fit.slow_mean_variance(duration_s).min(shown)
}

/// Enters a mean.
///
/// * `drift`: variance, in its interval, of the input's slow noise.
pub(crate) fn enter_mean(
    mean: Estimate,
    truth_deg_per_h: Option<f64>,
    duration_s: f64,
    drift: f64,
    metrics: &mut ChannelMetrics,
) {
    put_mean(mean, truth_deg_per_h, duration_s, metrics);
    if let Some(metric) = metrics.get_mut(&MEAN).filter(|_| drift > 0.0) {
        metric.fields.insert(SLOW_NOISE, drift.sqrt());
    }
    metrics.mark_exact(&[&MEAN, &MEAN_ERROR]);
}

/// Why nothing is fitted to words that stand still.
pub(crate) const NO_CHANGE: &str = "the output does not vary over the record";

/// Parts of a record of whose means slow noise makes some.
pub(crate) const TENTHS: usize = 10;

/// Most that slow noise adds to the variance of a mean, over the variance of the means of its tenths: a fit
/// to short averaging times may find terms that the record as a whole refutes. A random walk adds
/// `K^2 T/3` and shows `K^2 T/6`, a ramp `R^2 T^2/4` and `R^2 T^2/12`, flicker `1.76 B^2` and `0.81 B^2`;
/// the rest is for the scatter of ten means.
const SLOW_OVER_TENTHS: f64 = 6.0;

/// Field of a mean: standard deviation, in its interval, of the input's slow noise in the mean.
const SLOW_NOISE: &str = "slow_noise_deg_per_h";

fn products_about_mean(values: &[f64], lags: usize, blocks: usize) -> LaggedProducts {
    LaggedProducts::new(values, interval::mean_of_present(values), lags, blocks)
}
