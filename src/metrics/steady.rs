//! Metrics of a record at rest or at constant rate.

use super::allan::overlapping_allan;
use super::allan_curves::{enter_fit, put_curve, put_fit_curve};
use super::allan_variants::allan_variant;
use super::audit::{NO_DELAY_AT_DC, filter_bound, lags_needed, predict};
use super::autocovariance::{CURVE_LAGS, LaggedProducts};
use super::bias;
use super::catalogue::{
    ANGLE_RANDOM_WALK, BIAS_STABILITY, BIAS_STABILITY_1S, BIAS_STABILITY_10S, BIAS_STABILITY_100S,
    NOISE_DELAY_BOUND_NOISE_GAIN, NOISE_GAIN_OVER_BOUND, fitted_metrics,
};
use super::estimate::{ChannelMetrics, Estimate};
use super::interval;
use super::key::{Against, Applies, Headline, MetricKey, Needs, Table};
use super::memory::fit_tau_min_s;
use super::noise_delay::{put_bound, put_bound_curve, put_over_bound};
use super::noise_fit::{
    FIT_TAU_PER_RECORD_MAX, FitRange, NoiseFit, Term, fit_noise, mixed_degrees_of_freedom,
};
use super::noise_level::{measure_mean_ratio, put_noise_gain, put_noise_std};
use super::record::{FilterFacts, Record, Settings};
use super::support::{BLOCKS_MIN, averaging_lack};
use super::table::{DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION};
use super::truth_response::without_motion;
use super::weight_noise::measure_weight_noise;
use crate::units;
use crate::wording::{counted, plain};

/// Angle random walk over DC gain.
pub static ANGLE_RANDOM_WALK_OVER_DC_GAIN: MetricKey = MetricKey::of_filters(
    "angle_random_walk_over_dc_gain_deg_per_sqrt_h",
    "deg/sqrt(h)",
    Applies::Steady,
    "angle random walk once the scale factor is restored",
)
.heading("ARW / DC gain")
.slow_noise()
.needs(Needs::AllanFit)
.tables(&[Table::Rest]);

/// Bias stability over DC gain.
pub static BIAS_STABILITY_OVER_DC_GAIN: MetricKey = MetricKey::of_filters(
    "bias_stability_over_dc_gain_deg_per_h",
    "deg/h",
    Applies::Steady,
    "bias stability once the scale factor is restored",
)
.heading("bias stability / DC gain")
.slow_noise()
.needs(Needs::ScenarioBlocks)
.tables(&[Table::Rest]);

/// Mean.
pub static MEAN: MetricKey = MetricKey::new(
    "mean_deg_per_h",
    "deg/h",
    Applies::Always,
    "mean over the record; in a swing the offset of the sine fit over whole cycles",
)
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

/// DC gain predicted.
pub static DC_GAIN_PREDICTED: MetricKey = MetricKey::of_filters(
    "dc_gain_predicted",
    "1",
    Applies::SteadyOrSwing,
    "sum of the Wiener weights for the second moments of the raw record, mean included",
)
.heading("DC gain predicted")
.tables(&[Table::Rest, Table::Swing, Table::Campaign]);

/// Delay at DC.
pub static DELAY_AT_DC: MetricKey = MetricKey::of_filters(
    "delay_at_dc_ms",
    "ms",
    Applies::Steady,
    "delay at DC of the mean weights, register and latency included",
)
.heading("delay at DC")
.tables(&[Table::Rest]);

/// Blocks of time whose scatter gives the intervals of ratios.
pub(crate) const RATIO_BLOCKS: usize = 20;

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
    let still = without_motion(record, filter);
    let record = &still.as_ref().map_or(*record, |(channel, raw)| Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: raw,
        ..*record
    });
    let fit = measure_allan(record, settings, filter, metrics);
    measure_bias(record, settings, fit.as_ref(), metrics);
    measure_mean(record, fit.as_ref(), metrics);
    let lags = LAGS_MIN.max(filter.map_or(0, |facts| lags_needed(&facts.shape)));
    let products = products_about_mean(record.channel_deg_per_h, lags);
    let samples = record.channel_deg_per_h.len();
    put_noise_std(&products, samples, record.sample_period_s, metrics);
    if let Some(facts) = filter {
        let raw = products_about_mean(record.raw_deg_per_h, lags);
        let level = interval::mean(record.raw_deg_per_h).abs();
        put_noise_gain(&products, &raw, level, metrics);
        measure_mean_ratio(record, metrics);
        measure_weight_noise(record, facts, metrics);
        measure_predictions(record, facts, (&products, &raw), metrics);
        for (key, over) in [
            (&ANGLE_RANDOM_WALK, &ANGLE_RANDOM_WALK_OVER_DC_GAIN),
            (&BIAS_STABILITY, &BIAS_STABILITY_OVER_DC_GAIN),
        ] {
            put_over_dc_gain(key, over, facts.dc_gain, metrics);
        }
    }
}

/// Allan curve and noise coefficients.
///
/// The curve `allan` is that of the settings. The noise is fitted to the overlapping Allan deviation,
/// the curve `allan_fit`, whose points take the degrees of freedom of the noise mix that the fit found.
fn measure_allan(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Option<NoiseFit> {
    let points = overlapping_allan(record.channel_deg_per_h, record.sample_period_s);
    let samples = record.channel_deg_per_h.len();
    let range = FitRange {
        tau_min_s: filter.map_or(settings.fit_tau_min_s, |facts| {
            fit_tau_min_s(&facts.shape, record.sample_period_s, settings.fit_tau_min_s)
        }),
        tau_max_s: FIT_TAU_PER_RECORD_MAX * samples as f64 * record.sample_period_s,
    };
    let varies = record
        .channel_deg_per_h
        .windows(2)
        .any(|two| two[0] < two[1] || two[1] < two[0]);
    let constant = || Err("the output does not vary over the record".to_owned());
    let fitted = if varies {
        fit_noise(&points, range)
    } else {
        constant()
    };
    let variant = allan_variant(
        record.channel_deg_per_h,
        record.sample_period_s,
        &settings.allan,
    );
    let estimator = settings.allan.estimator;
    put_curve(&variant, estimator, fitted.as_ref().ok(), metrics);
    match fitted {
        Ok(fit) => {
            let points = mixed_degrees_of_freedom(&points, &fit.coefficients(), samples + 1);
            let duration_s = samples as f64 * record.sample_period_s;
            enter_fit(&points, &fit, duration_s, metrics);
            Some(fit)
        }
        Err(reason) => {
            put_fit_curve(&points, None, metrics);
            for key in fitted_metrics() {
                metrics.miss(key, reason.as_str());
            }
            None
        }
    }
}

/// Bias stability at the fixed averaging times and at the scenario's.
fn measure_bias(
    record: &Record,
    settings: &Settings,
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    for (name, averaging_time_s) in [
        (&BIAS_STABILITY_1S, 1.0),
        (&BIAS_STABILITY_10S, 10.0),
        (&BIAS_STABILITY_100S, 100.0),
        (&BIAS_STABILITY, settings.bias_averaging_time_s),
    ] {
        if let Some(reason) = averaging_lack(averaging_time_s, record.sample_period_s) {
            metrics.miss(name, reason);
            continue;
        }
        let block = bias::samples_in(averaging_time_s, record.sample_period_s);
        let averaging_time_s = bias::block_label_s(averaging_time_s, record.sample_period_s);
        let means = bias::block_means(record.channel_deg_per_h, block);
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
            bias::effective_degrees_of_freedom(&fit.coefficients(), averaging_time_s, means.len())
        });
        let deviation = interval::sample_variance(&means).sqrt();
        let metric = metrics.put(name, interval::deviation(deviation, freedom));
        metric.fields.insert("averaging_time_s", averaging_time_s);
        metric.fields.insert("block_samples", block as f64);
        metric.fields.insert("count", means.len() as f64);
        metric.fields.insert(DEGREES_OF_FREEDOM, freedom);
        let raw_means = bias::block_means(record.raw_deg_per_h, block);
        if let Some(correlation) = bias::correlation(&means, &raw_means) {
            metric.fields.insert(RAW_CORRELATION, correlation);
        }
        if let Some(fit) = fit.filter(|fit| fit.shows_white_noise()) {
            let coefficients = fit.coefficients();
            let expected =
                bias::expected_bias_stability(&coefficients, averaging_time_s, means.len());
            metric.fields.insert(EXPECTED, expected);
        }
    }
}

/// Mean and its error.
///
/// With a fit, the variance of the mean over T is the fitted Allan variance at T (half the mean
/// square difference between the means of two such records in a row): `N^2/T` for white noise, and
/// it does not vanish with T for slow noise. Without one, Student's t on ten block means.
fn measure_mean(record: &Record, fit: Option<&NoiseFit>, metrics: &mut ChannelMetrics) {
    let values = record.channel_deg_per_h;
    let mean = interval::mean(values);
    let duration_s = values.len() as f64 * record.sample_period_s;
    let estimate = match fit {
        Some(fit) if matches!(fit.angle_random_walk_deg_per_h_sqrt_s, Term::Found(_)) => {
            let variance = fit.mean_variance(duration_s);
            Estimate::symmetric(mean, interval::NORMAL_QUANTILE * variance.sqrt())
        }
        _ => interval::from_parts(mean, &equal_block_means(values, 10)),
    };
    put_mean(
        estimate,
        record.truth().map(interval::mean),
        duration_s,
        metrics,
    );
    metrics.mark_exact(&[&MEAN, &MEAN_ERROR]);
}

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

/// Means of `count` blocks of equal length that cover all values.
pub(crate) fn equal_block_means(values: &[f64], count: usize) -> Vec<f64> {
    let blocks = count.min(values.len());
    (0..blocks)
        .map(|block| {
            let start = values.len() * block / blocks;
            let end = values.len() * (block + 1) / blocks;
            interval::mean(&values[start..end])
        })
        .collect()
}

fn products_about_mean(values: &[f64], lags: usize) -> LaggedProducts {
    LaggedProducts::new(values, interval::mean(values), lags, RATIO_BLOCKS)
}

/// Wiener prediction of the DC gain; the delay of the mean weights and the noise-delay bound there.
///
/// Without mean weights the bound is taken at the predicted delay. It holds for fixed weights; ones
/// that keep adapting to the noise itself can go below.
fn measure_predictions(
    record: &Record,
    facts: &FilterFacts,
    (channel, raw): (&LaggedProducts, &LaggedProducts),
    metrics: &mut ChannelMetrics,
) {
    let mean_square = interval::mean(record.raw_deg_per_h).powi(2);
    let ran = facts.mean_delay_at_dc_samples();
    let at = |autocovariance: &[f64]| {
        let second_moment: Vec<f64> = autocovariance
            .iter()
            .map(|value| value + mean_square)
            .collect();
        let prediction = predict(&facts.shape, &second_moment)?;
        let delay_samples = ran.unwrap_or_else(|| prediction.delay_at_dc_samples());
        let bound = filter_bound(&facts.shape, delay_samples, autocovariance);
        Some((prediction.dc_gain(), delay_samples, bound))
    };
    let parts: Vec<_> = (0..raw.blocks())
        .filter_map(|block| at(&raw.autocovariance_without(block)))
        .collect();
    let Some((dc_gain, delay_samples, bound)) = at(&raw.autocovariance()) else {
        metrics.miss(&DC_GAIN_PREDICTED, "the raw channel has no power");
        for name in [
            &NOISE_DELAY_BOUND_NOISE_GAIN,
            &NOISE_GAIN_OVER_BOUND,
            &DELAY_AT_DC,
        ] {
            metrics.miss(name, "the raw channel has no power");
        }
        return;
    };
    let gains: Vec<f64> = parts.iter().map(|part| part.0).collect();
    metrics.put(&DC_GAIN_PREDICTED, interval::jackknife(dc_gain, &gains));
    let delay_ms = |samples: f64| {
        let delay_s = samples * record.sample_period_s + facts.latency_s;
        units::s_to_ms(delay_s)
    };
    if delay_samples.is_finite() {
        let delays_ms: Vec<f64> = parts.iter().map(|part| delay_ms(part.1)).collect();
        let at_dc = interval::jackknife(delay_ms(delay_samples), &delays_ms);
        metrics.put(&DELAY_AT_DC, at_dc);
    } else {
        metrics.miss(&DELAY_AT_DC, NO_DELAY_AT_DC);
    }
    let without: Vec<_> = parts.into_iter().map(|part| part.2).collect();
    put_over_bound(channel, raw, &bound, &without, metrics);
    put_bound_curve(
        facts,
        &raw.autocovariance(),
        record.sample_period_s,
        metrics,
    );
    let bounds: Vec<f64> = without
        .iter()
        .filter_map(|bound| bound.as_ref().ok().copied())
        .collect();
    put_bound(
        bound.map(|bound| interval::jackknife(bound, &bounds)),
        facts,
        delay_samples,
        record.sample_period_s,
        metrics,
    );
}

/// Why nothing can be divided by a DC gain that is not above zero.
pub(crate) fn dc_gain_lack(dc_gain: f64) -> String {
    if dc_gain.is_finite() {
        format!("the DC gain, {dc_gain}, is not positive")
    } else {
        "the DC gain of this filter is not a finite number".to_owned()
    }
}

/// Enters one metric divided by the DC gain: what is left of the improvement once the scale factor
/// is restored.
pub(crate) fn put_over_dc_gain(
    key: &MetricKey,
    over: &MetricKey,
    dc_gain: Option<f64>,
    metrics: &mut ChannelMetrics,
) {
    match (metrics.get(key).cloned(), dc_gain) {
        (Some(metric), Some(gain)) if gain > 1e-6 && gain.is_finite() => {
            let mut fields = metric.fields;
            fields.insert("dc_gain", gain);
            if let Some(expected) = fields.get_mut(EXPECTED) {
                *expected /= gain;
            }
            metrics.put(over, metric.estimate.scaled(1.0 / gain)).fields = fields;
        }
        (Some(_), Some(gain)) => metrics.miss(over, dc_gain_lack(gain)),
        (Some(_), None) => metrics.miss(over, "the DC gain of this filter is not known"),
        (None, _) => metrics.miss(over, format!("the record does not give `{}`", key.name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dc_gain_that_is_no_number_is_called_that() {
        for gain in [f64::NAN, f64::INFINITY] {
            let mut metrics = ChannelMetrics::default();
            metrics.put(&ANGLE_RANDOM_WALK, Estimate::exact(1.0));
            put_over_dc_gain(
                &ANGLE_RANDOM_WALK,
                &ANGLE_RANDOM_WALK_OVER_DC_GAIN,
                Some(gain),
                &mut metrics,
            );
            let reason = metrics.why_unavailable(&ANGLE_RANDOM_WALK_OVER_DC_GAIN);
            let said = "the DC gain of this filter is not a finite number";
            assert_eq!(reason, Some(said));
        }
        assert_eq!(dc_gain_lack(-0.5), "the DC gain, -0.5, is not positive");
    }
}
