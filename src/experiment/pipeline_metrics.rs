//! What a hardware pipeline adds to its channel's table, and what must be said of it.

use super::channel_filter::{FinishedFilter, FinishedPipeline};
use super::run::stamp_s;
use crate::filters::hardware::FixedSummary;
use crate::fpga::fixed::SignalName;
use crate::metrics::catalogue::{
    ANGLE_RANDOM_WALK, ANGLE_RANDOM_WALK_OVER_BINARY64, ASYMMETRY_MAX, CLOCKS_PER_SAMPLE,
    CONDITION_NUMBER, DC_GAIN, DC_GAIN_MINUS_BINARY64, DELAY_MINUS_BINARY64, DELAY_VS_RAW,
    INDEFINITE_AT, LATENCY, PREDICTED_FAILURE, ROUNDING_ERROR_OVER_SIGNAL, SAMPLE_PERIOD,
    SAMPLE_RATE_MAX, SMALLEST_PIVOT,
};
use crate::metrics::{Applies, ChannelMetrics, Estimate, FIXED_POINT_ONLY, MetricKey, OVERFLOWS};
use crate::scenario::Scenario;
use crate::units::{ms_to_s, s_to_us, us_to_s};
use crate::vocabulary::OutputRegister;
use crate::wording::counted;

/// Metrics of the matrix of recursive least squares.
pub(super) static MATRIX_METRICS: [&MetricKey; 3] =
    [&ASYMMETRY_MAX, &SMALLEST_PIVOT, &CONDITION_NUMBER];

/// Why a filter on fixed-point words has no count of a signal's.
const NO_SIGNAL: &str = "the filter has no such signal";

/// Why a channel can never have a metric of hardware pipelines; nothing for other metrics.
pub(super) fn lacks(scenario: &Scenario, channel: &str, key: &MetricKey) -> Option<&'static str> {
    if ![Applies::Pipeline, Applies::FixedPoint].contains(&key.applies) {
        return None;
    }
    let filter = scenario.filter_of(channel)?;
    let Some(settings) = filter.kind.settings().hardware() else {
        return Some("only a filter with pipeline = \"fpga\" has it");
    };
    if key.applies == Applies::FixedPoint && !settings.is_fixed() {
        return Some(FIXED_POINT_ONLY);
    }
    let mut overflows = OVERFLOWS.into_iter().zip(SignalName::ALL);
    if let Some((_, signal)) = overflows.find(|(overflow, _)| *overflow == key)
        && !settings.has_signal(signal)
    {
        return Some(NO_SIGNAL);
    }
    if MATRIX_METRICS.contains(&key) && !settings.has_matrix() {
        return Some("a least-mean-squares filter has no matrix");
    }
    if *key == PREDICTED_FAILURE && settings.failure_samples().is_none() {
        return Some("only update_order = \"gain-first\" below a forgetting factor of 1 has it");
    }
    None
}

/// How long after their sample's stamp the outputs of a filter appear, s.
///
/// A register that holds the result until the next stamp hides the latency altogether: the plan has
/// made sure that the result is there by then.
pub(super) fn latency_s(pipeline: Option<&FinishedPipeline>) -> f64 {
    match pipeline {
        Some(pipeline) if pipeline.settings.output_register() == OutputRegister::Immediate => {
            us_to_s(pipeline.timing.latency_us)
        }
        _ => 0.0,
    }
}

/// Enters clocks, times and health.
pub(super) fn enter(
    pipeline: &FinishedPipeline,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let timing = &pipeline.timing;
    for (key, value) in [
        (&CLOCKS_PER_SAMPLE, whole(timing.usage.clocks_per_sample)),
        (&SAMPLE_PERIOD, timing.sample_period_us),
        (&LATENCY, timing.latency_us),
        (&SAMPLE_RATE_MAX, timing.sample_rate_max_khz),
    ] {
        let metric = metrics.put(key, Estimate::exact(value));
        metric
            .fields
            .insert("clock_mhz", pipeline.settings.clock_mhz());
    }
    match &pipeline.health {
        Some(health) => {
            for (key, value) in MATRIX_METRICS.into_iter().zip([
                health.asymmetry_max,
                health.smallest_pivot,
                health.condition_number,
            ]) {
                if value.is_finite() {
                    let metric = metrics.put(key, Estimate::exact(value));
                    metric.fields.insert("count", whole(health.looks));
                } else {
                    metrics.miss(key, "the matrix is not positive definite");
                }
            }
        }
        None => {
            for key in MATRIX_METRICS {
                metrics.miss(key, "the filter has no finite inverse correlation matrix");
            }
        }
    }
    match pipeline.settings.failure_samples() {
        Some(samples) => {
            let metric = metrics.put(
                &PREDICTED_FAILURE,
                Estimate::exact(samples * sample_period_s),
            );
            metric.fields.insert("samples", samples);
        }
        None => metrics.miss(
            &PREDICTED_FAILURE,
            "only the gain-first order is expected to fail",
        ),
    }
}

/// Enters what fixed-point words did to the filter, beside the same filter in binary64.
///
/// * `binary64`: what was measured of that one; none if this filter failed.
pub(super) fn enter_fixed(
    fixed: &FixedSummary,
    binary64: Option<&ChannelMetrics>,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    for (key, count) in OVERFLOWS.into_iter().zip(fixed.overflows) {
        match count {
            Some(count) => drop(metrics.put(key, Estimate::exact(whole(count)))),
            None => metrics.miss(key, NO_SIGNAL),
        }
    }
    match fixed.indefinite_at {
        Some(sample) => {
            let stamp_s = stamp_s(sample, sample_period_s);
            metrics.put(&INDEFINITE_AT, Estimate::exact(stamp_s));
        }
        None => metrics.miss(
            &INDEFINITE_AT,
            "denominators and the diagonal of R stayed above zero",
        ),
    }
    if let Some(ratio) = fixed.error_over_signal {
        metrics.put(&ROUNDING_ERROR_OVER_SIGNAL, Estimate::exact(ratio));
    }
    let Some(binary64) = binary64 else {
        return;
    };
    let pair = |key: &MetricKey| {
        let own = metrics.get(key)?.estimate.value;
        Some((own, binary64.get(key)?.estimate.value))
    };
    let ratio = pair(&ANGLE_RANDOM_WALK).map(|(own, twin)| own / twin);
    let gain = pair(&DC_GAIN).map(|(own, twin)| own - twin);
    let delay = pair(&DELAY_VS_RAW).map(|(own, twin)| s_to_us(ms_to_s(own - twin)));
    for (key, value) in [
        (&ANGLE_RANDOM_WALK_OVER_BINARY64, ratio),
        (&DC_GAIN_MINUS_BINARY64, gain),
        (&DELAY_MINUS_BINARY64, delay),
    ] {
        match value.filter(|value| value.is_finite()) {
            Some(value) => drop(metrics.put(key, Estimate::exact(value))),
            None => metrics.miss(key, "the record does not give it of both"),
        }
    }
}

/// What the reader of a report must know of this filter.
pub(super) fn notes(filter: &FinishedFilter, sample_period_s: f64) -> Vec<String> {
    let Some(pipeline) = &filter.pipeline else {
        return Vec::new();
    };
    let name = &filter.name;
    let mut notes = Vec::new();
    if let Some(samples) = pipeline.settings.failure_samples() {
        let observed = match &filter.words {
            Ok(_) => "it has not failed in this run".to_owned(),
            Err(failure) => format!(
                "it failed after {} ({:.3} s)",
                counted(failure.sample + 1, "sample"),
                whole(failure.sample + 1) * sample_period_s
            ),
        };
        notes.push(format!(
            "filter `{name}`: theory gives the gain-first order ln(0.01/eps)/(1-alpha) = \
             {samples:.0} samples ({:.3} s); {observed}",
            samples * sample_period_s
        ));
    }
    if let Some(warning) = &pipeline.wind_up {
        notes.push(format!("filter `{name}`: {warning}"));
    }
    notes
}

#[expect(
    clippy::cast_precision_loss,
    reason = "clock, sample and look counts are far below 2^53"
)]
fn whole(count: u64) -> f64 {
    count as f64
}
