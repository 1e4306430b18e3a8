//! Metrics of a record of steps.

use super::mean::{
    RatioOfMeans, filter_reach, measure_mean_ratio, paired_ratio, ratio_of_means_lack,
};
use super::steady::LAGS_MIN;
use super::tracking::measure_tracking;
use crate::metrics::estimate::blocks::RATIO_BLOCKS;
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::paired::mean_spread;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::noise::by_weights::NoiseByWeights;
use crate::metrics::noise::level::{put_noise_gain, put_noise_std};
use crate::metrics::noise::truth_response::without_motion;
use crate::metrics::record::{FilterFacts, Record, SAMPLES_MIN, WeightScatter};
use crate::metrics::steps::settling::{SETTLING_TIME, settling, tail_start};
use crate::metrics::steps::shape::{OVERSHOOT, RISE_TIME, Step, put_step_shape};
use crate::metrics::theory::learning::NOT_FROM_ONE_RECORD;
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

/// Samples that a filter reaches back, for each block of a settled part: shorter ones are not
/// independent.
const REACHES_PER_BLOCK: usize = 8;

/// Fewest blocks.
const BLOCKS_MIN: usize = 6;

/// Metrics of a staircase: settling after the last step, noise and means.
pub(crate) fn measure_steps(
    record: &Record,
    last_step_index: usize,
    step_deg_per_h: f64,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let values = record.channel_deg_per_h;
    put_settling(record, last_step_index, step_deg_per_h, filter, metrics);
    let start = tail_start(values.len(), last_step_index.min(values.len()));
    if values.len() - start < SAMPLES_MIN {
        measure_tracking(record, None, filter, metrics);
        return;
    }
    measure_tracking(record, Some(start), filter, metrics);
    let reaches = (values.len() - start) / (REACHES_PER_BLOCK * filter_reach(filter));
    let blocks = reaches.clamp(BLOCKS_MIN, RATIO_BLOCKS);
    let products = |tail: &[f64]| LaggedProducts::new(tail, interval::mean(tail), LAGS_MIN, blocks);
    // The table may shake at its rate.
    let still = without_motion(record, start, filter);
    let (own_tail, raw_tail) = still.as_ref().map_or_else(
        || (&values[start..], &record.raw_deg_per_h[start..]),
        |(own, raw)| (own.as_slice(), raw.as_slice()),
    );
    let (channel, raw) = (products(own_tail), products(raw_tail));
    let part = start as f64 / values.len() as f64;
    let by_weights = filter.map_or_else(NoiseByWeights::none, |facts| {
        NoiseByWeights::new(facts, &raw, values.len(), part)
    });
    put_noise_std(
        &channel,
        &by_weights,
        (values.len() - start, 1),
        record.sample_period_s,
        metrics,
    );
    if let Some(facts) = filter {
        let level = interval::mean(&record.raw_deg_per_h[start..]).abs();
        put_noise_gain(&channel, &raw, &by_weights, level, metrics);
        measure_mean_ratio(record, start..values.len(), facts, metrics);
        put_settled_gain(record, start, facts, metrics);
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

/// Enters what the last step shows: settling, rise and overshoot.
fn put_settling(
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
            // A filter that learns meets the step with the weights of its own record.
            let scatter = filter.map_or(WeightScatter::Blocks, |facts| {
                facts.weight_scatter(values.len(), 0.0)
            });
            let given = |estimate: Estimate| match scatter {
                WeightScatter::Blocks => estimate,
                _ => Estimate::without_interval(estimate.value, NOT_FROM_ONE_RECORD),
            };
            let metric = metrics.put(&SETTLING_TIME, given(settled.settling_time_s));
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
            put_step_shape(&step, given, metrics);
        }
        Err(reason) => {
            for key in [&SETTLING_TIME, &OVERSHOOT, &RISE_TIME] {
                metrics.miss(key, reason.clone());
            }
        }
    }
}

/// Ratio of the means from `start` on, if raw's can be told from zero.
fn put_settled_gain(
    record: &Record,
    start: usize,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    let (own, raw) = (
        &record.channel_deg_per_h[start..],
        &record.raw_deg_per_h[start..],
    );
    let samples = start..record.raw_deg_per_h.len();
    let of = RatioOfMeans {
        ratio: interval::mean(own) / interval::mean(raw),
        raw_deg_per_h: interval::mean(raw),
        samples: samples.len(),
    };
    let drift = record.drift_covariance(&samples, &samples);
    let raw_mean = mean_spread(raw, 1)
        .plus(Spread::known(drift))
        .about(of.raw_deg_per_h);
    if let Some(reason) = ratio_of_means_lack(&raw_mean) {
        return metrics.miss(&SETTLED_GAIN, reason);
    }
    let part = start as f64 / record.raw_deg_per_h.len() as f64;
    let scatter = facts.weight_scatter(record.raw_deg_per_h.len(), part);
    let weights = facts.mean_weights.as_deref();
    let learned = scatter.of(weights, |weights| weights.iter().sum());
    metrics.put(
        &SETTLED_GAIN,
        paired_ratio(record, samples, of, facts, learned),
    );
}
