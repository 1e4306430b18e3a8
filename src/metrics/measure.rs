//! From a record to the table of everything it supports.

use std::collections::BTreeMap;

use super::catalogue::support::{
    NO_TRUTH, SAMPLES_MIN, encoder_lack, repeats_lack, support, truth_lack,
};
use super::estimate::interval;
use super::estimate::value::{ChannelMetrics, Estimate};
use super::key::metric::{Against, Applies, Headline, MetricKey, Needs, Pool, Table};
use super::motion::multi_sine::measure_multi_sine;
use super::motion::steady::{LAGS_MIN, RATIO_BLOCKS, equal_block_means, measure_steady, put_mean};
use super::motion::swing::measure_swing;
use super::noise::autocovariance::LaggedProducts;
use super::noise::level::{measure_mean_ratio, put_noise_gain, put_noise_std, put_ratio_of_means};
use super::noise::spectrum::{log_binned, segment_samples, welch};
use super::pipeline::PIPELINE_ONLY;
use super::record::{FilterFacts, Motion, Record, Settings};
use super::steps::settling::{settling, tail_start};
use super::steps::shape::{OVERSHOOT, RISE_TIME, Step, put_step_shape};
use super::steps::staircase::measure_scale_factor;
use super::trial::frozen_response::put_frozen_response;
use super::trial::readaptation::{READAPTATION_TIME, measure_after_step, onset};
use crate::metrics::catalogue::known_metrics;
use crate::wording::counted;

/// Settling time.
pub static SETTLING_TIME: MetricKey = MetricKey::new(
    "settling_time_s",
    "s",
    Applies::Steps,
    "time after the last step until the rate stays within max(1 % of the step, 5 sigma)",
)
.heading("settling time")
.needs(Needs::Step)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::Steps]);

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

/// Tracking error rms.
pub static TRACKING_ERROR_RMS: MetricKey = MetricKey::new(
    "tracking_error_rms_deg_per_h",
    "deg/h",
    Applies::Moving,
    "root mean square difference from the true rate at the same stamps",
)
.heading("tracking error rms")
.against(Against::Truth)
.pooled(Pool::RootMeanSquare)
.run_column(11)
.of_one_motion()
.tables(&[Table::Swing, Table::MultiSine, Table::Steps])
.headlines(&[Headline::General]);

/// DC gain.
pub static DC_GAIN: MetricKey = MetricKey::of_filters(
    "dc_gain",
    "1",
    Applies::Always,
    "response to a small added rate with the weight sequence of the unperturbed run replayed",
)
.heading("DC gain")
.needs(Needs::Nothing)
.run_column(8)
.tables(&[
    Table::Rest,
    Table::Swing,
    Table::MultiSine,
    Table::Steps,
    Table::Campaign,
])
.headlines(&[Headline::Rest]);

/// DC gain adapted.
pub static DC_GAIN_ADAPTED: MetricKey = MetricKey::of_filters(
    "dc_gain_adapted",
    "1",
    Applies::Always,
    "response to a small added rate present from the first sample, the filter free to adapt",
)
.heading("DC gain adapted")
.needs(Needs::Nothing)
.tables(&[Table::Rest]);

/// Settled gain.
pub static SETTLED_GAIN: MetricKey = MetricKey::of_filters(
    "settled_gain",
    "1",
    Applies::Steps,
    "mean of the channel over that of raw in the last quarter after the last step",
)
.heading("settled gain")
.needs(Needs::SettledStep)
.tables(&[Table::Steps]);

/// Time of divergence.
pub static DIVERGED_AT: MetricKey = MetricKey::new(
    "diverged_at_s",
    "s",
    Applies::Always,
    "time at which the channel failed, from the start of the warm-up; absent if it did not",
)
.heading("diverged at")
.needs(Needs::Nothing)
.closing_tables();

/// Points of the spectrum in the report.
const SPECTRUM_POINTS_MAX: usize = 400;

/// Measures one channel.
///
/// `filter` is `None` for raw, whose `record.channel_deg_per_h` is `record.raw_deg_per_h`. Every
/// metric of the catalogue ends up in the table or, with the reason, among the unavailable ones;
/// `diverged_at_s` and the metrics of pipelines are left to the caller, who saw the failure and
/// knows the hardware. Intervals are 95 %.
///
/// # Panics
/// If the slices of the record differ in length, an empty truth excepted.
#[must_use]
pub fn measure(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
) -> ChannelMetrics {
    let samples = record.channel_deg_per_h.len();
    let truths = record.truth().map_or(samples, <[f64]>::len);
    assert!(
        record.raw_deg_per_h.len() == samples && truths == samples,
        "channel, raw and truth hold {samples}, {} and {truths} samples",
        record.raw_deg_per_h.len()
    );
    let readings = record.encoder_rad.map_or(samples, <[f64]>::len);
    assert!(
        readings == samples,
        "channel and encoder hold {samples} and {readings} samples"
    );
    let mut metrics = ChannelMetrics::default();
    if let Err(reason) = measure_motion(record, settings, filter, &mut metrics) {
        refuse_rest(&reason, &mut metrics);
    }
    if let Some(facts) = filter {
        put_dc_gains(facts, &mut metrics);
        put_rate_gains(facts, &mut metrics);
        put_frozen_response(facts, record.sample_period_s, &mut metrics);
    }
    metrics.keep_finite();
    explain_missing(record, settings, filter.is_some(), &mut metrics);
    metrics
}

fn measure_motion(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), String> {
    let values = record.channel_deg_per_h;
    if values.len() < SAMPLES_MIN {
        return Err(format!(
            "the record holds {}; metrics need {SAMPLES_MIN}",
            counted(values.len(), "sample")
        ));
    }
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        return Err(format!("sample {index} of the record is not finite"));
    }
    let spectrum = welch(
        values,
        record.sample_period_s,
        segment_samples(values.len()),
    );
    metrics.put_spectrum(log_binned(&spectrum, SPECTRUM_POINTS_MAX));
    put_extremes(values, metrics);
    match &settings.motion {
        Motion::MultiSine { .. } | Motion::General | Motion::Steps { .. }
            if record.truth().is_none() =>
        {
            Err(NO_TRUTH.to_owned())
        }
        Motion::Steady => {
            measure_steady(record, settings, filter, metrics);
            Ok(())
        }
        Motion::Swing { frequency_hz } => {
            measure_swing(record, *frequency_hz, false, filter, metrics)
        }
        Motion::SwingFromRest { frequency_hz } => {
            measure_swing(record, *frequency_hz, true, filter, metrics)
        }
        Motion::MultiSine { frequencies_hz } => {
            measure_multi_sine(record, frequencies_hz, filter, metrics)
        }
        Motion::General => {
            measure_tracking(record, metrics);
            if let Some(facts) = filter {
                measure_mean_ratio(record, metrics);
                match onset(record.truth_deg_per_h) {
                    Some(start) => measure_after_step(record, start, facts, metrics),
                    None => {
                        metrics.miss(&READAPTATION_TIME, "the motion does not end at a new rate")
                    }
                }
            }
            Ok(())
        }
        Motion::Steps {
            last_step_index,
            step_deg_per_h,
            staircase,
        } => {
            measure_steps(record, *last_step_index, *step_deg_per_h, filter, metrics);
            measure_scale_factor(record, staircase, metrics);
            Ok(())
        }
    }
}

/// Enters the smallest and the largest sample.
fn put_extremes(values: &[f64], metrics: &mut ChannelMetrics) {
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    metrics.put(&MINIMUM, Estimate::exact(smallest));
    metrics.put(&MAXIMUM, Estimate::exact(largest));
}

/// Rate after a step over the step below which it counts as rest.
const REST_PER_STEP: f64 = 0.05;

/// Metrics of a staircase: settling after the last step, noise and means.
fn measure_steps(
    record: &Record,
    last_step_index: usize,
    step_deg_per_h: f64,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let values = record.channel_deg_per_h;
    match settling(
        values,
        last_step_index,
        step_deg_per_h,
        record.sample_period_s,
    ) {
        Ok(settled) => {
            let metric = metrics.put(&SETTLING_TIME, Estimate::exact(settled.settling_time_s));
            metric
                .fields
                .insert("band_deg_per_h", settled.band_deg_per_h);
            metric.fields.insert("step_deg_per_h", step_deg_per_h);
            let step = Step {
                rate_deg_per_h: values,
                index: last_step_index,
                height_deg_per_h: step_deg_per_h,
                settling: settled,
                sample_period_s: record.sample_period_s,
            };
            put_step_shape(&step, metrics);
        }
        Err(reason) => {
            for key in [&SETTLING_TIME, &OVERSHOOT, &RISE_TIME] {
                metrics.miss(key, reason.clone());
            }
        }
    }
    measure_tracking(record, metrics);
    let start = tail_start(values.len(), last_step_index.min(values.len()));
    if values.len() - start < SAMPLES_MIN {
        return;
    }
    let products = |series: &[f64]| {
        let tail = &series[start..];
        LaggedProducts::new(tail, interval::mean(tail), LAGS_MIN, RATIO_BLOCKS)
    };
    let channel = products(values);
    put_noise_std(
        &channel,
        values.len() - start,
        record.sample_period_s,
        metrics,
    );
    if let Some(facts) = filter {
        let level = interval::mean(&record.raw_deg_per_h[start..]).abs();
        put_noise_gain(&channel, &products(record.raw_deg_per_h), level, metrics);
        measure_mean_ratio(record, metrics);
        let own = equal_block_means(&values[start..], RATIO_BLOCKS);
        let raw = equal_block_means(&record.raw_deg_per_h[start..], RATIO_BLOCKS);
        put_ratio_of_means(&SETTLED_GAIN, &own, &raw, metrics);
        let rate = interval::mean(&record.raw_deg_per_h[start..]).abs();
        if rate < REST_PER_STEP * step_deg_per_h.abs() {
            metrics.miss(
                &READAPTATION_TIME,
                "the last step ends at rest, where lag outweighs gain",
            );
        } else {
            measure_after_step(record, last_step_index, facts, metrics);
        }
    }
}

/// Mean and tracking error over the whole record of a motion that is known but not modelled.
///
/// The mean's interval comes from twenty blocks of the differences from the truth, so that the
/// motion itself does not widen it; the tracking error, which a few transients make, has none.
fn measure_tracking(record: &Record, metrics: &mut ChannelMetrics) {
    let values = record.channel_deg_per_h;
    let errors: Vec<f64> = values
        .iter()
        .zip(record.truth_deg_per_h)
        .map(|(rate, truth)| rate - truth)
        .collect();
    let error = interval::from_parts(
        interval::mean(&errors),
        &equal_block_means(&errors, RATIO_BLOCKS),
    );
    let truth = interval::mean(record.truth_deg_per_h);
    let mean = Estimate::with_interval(error.value + truth, error.low + truth, error.high + truth);
    put_mean(
        mean,
        Some(truth),
        values.len() as f64 * record.sample_period_s,
        metrics,
    );
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    metrics.put(&TRACKING_ERROR_RMS, Estimate::exact(square.sqrt()));
}

/// Enters the DC gains found by replay, which are exact up to rounding.
fn put_dc_gains(facts: &FilterFacts, metrics: &mut ChannelMetrics) {
    for (key, gain) in [
        (&DC_GAIN, facts.dc_gain),
        (&DC_GAIN_ADAPTED, facts.dc_gain_adapted),
    ] {
        match gain {
            Some(gain) => {
                metrics
                    .put(key, Estimate::exact(gain))
                    .fields
                    .insert("added_rate_deg_per_h", facts.added_rate_deg_per_h);
            }
            None => metrics.miss(key, "it was not determined for this filter"),
        }
    }
}

/// Enters the curve `rate_gain`: Student's t on the blocks.
fn put_rate_gains(facts: &FilterFacts, metrics: &mut ChannelMetrics) {
    let mut curve: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for rate in &facts.rate_gains {
        let pooled = |blocks: &[f64]| interval::from_parts(interval::mean(blocks), blocks);
        let gain = pooled(&rate.block_gains);
        let ratio = pooled(&rate.block_mean_ratios);
        for (column, value) in [
            ("rate_deg_per_s", rate.rate_deg_per_s),
            ("gain", gain.value),
            ("gain_low", gain.low),
            ("gain_high", gain.high),
            ("mean_ratio", ratio.value),
            ("mean_ratio_low", ratio.low),
            ("mean_ratio_high", ratio.high),
        ] {
            curve.entry(column.to_owned()).or_default().push(value);
        }
    }
    if !curve.is_empty() {
        metrics.curves.insert("rate_gain".to_owned(), curve);
    }
}

/// Gives one reason to everything that is still missing.
fn refuse_rest(reason: &str, metrics: &mut ChannelMetrics) {
    for known in known_metrics() {
        let is_own = **known == DIVERGED_AT || known.applies == Applies::Pipeline;
        if !is_own && metrics.get(known).is_none() {
            metrics.miss(known, reason);
        }
    }
}

/// Gives a reason to every metric of the catalogue that has neither a value nor a reason yet.
fn explain_missing(
    record: &Record,
    settings: &Settings,
    is_filter: bool,
    metrics: &mut ChannelMetrics,
) {
    let duration_s = record.channel_deg_per_h.len() as f64 * record.sample_period_s;
    for known in known_metrics() {
        if **known == DIVERGED_AT
            || known.applies == Applies::Calibration
            || metrics.get(known).is_some()
            || metrics.why_unavailable(known).is_some()
        {
            continue;
        }
        let reason = support(
            known.name,
            duration_s,
            record.sample_period_s,
            &settings.motion,
            is_filter,
            settings.bias_averaging_time_s,
        )
        .err()
        .or_else(|| truth_lack(known, record.truth().is_some(), is_filter).map(str::to_owned))
        .or_else(|| repeats_lack(known, 1))
        .or_else(|| encoder_lack(known, record.encoder_rad.is_some()).map(str::to_owned))
        .unwrap_or_else(|| match known.applies {
            Applies::Pipeline => PIPELINE_ONLY.to_owned(),
            _ => "the record is too short for it".to_owned(),
        });
        metrics.miss(known, reason);
    }
}
