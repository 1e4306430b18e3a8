//! Metrics of a record of steps.

use super::mean::{measure_mean_ratio, put_ratio_of_means};
use super::steady::LAGS_MIN;
use super::tracking::measure_tracking;
use crate::metrics::estimate::blocks::{RATIO_BLOCKS, equal_block_means};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::noise::level::{put_noise_gain, put_noise_std};
use crate::metrics::record::{FilterFacts, Record, SAMPLES_MIN};
use crate::metrics::steps::settling::{SETTLING_TIME, settling, tail_start};
use crate::metrics::steps::shape::{OVERSHOOT, RISE_TIME, Step, put_step_shape};
use crate::metrics::trial::readaptation::{READAPTATION_TIME, measure_after_step};

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

/// Rate after a step over the step below which it counts as rest.
const REST_PER_STEP: f64 = 0.05;

/// Metrics of a staircase: settling after the last step, noise and means.
pub(crate) fn measure_steps(
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
        (values.len() - start, 1),
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
