//! Noise of an adaptive filter in motion as two runs on other noise show it, and its two parts.

use crate::metrics::estimate::influence::resampled;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::two_runs::DifferenceSums;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, MetricKey};
use crate::metrics::record::{FilterFacts, WeightScatter};
use crate::metrics::theory::learning::NOT_FROM_ONE_RECORD;

/// Noise of two runs.
pub static TWO_RUN_NOISE_STD: MetricKey = MetricKey::of_filters(
    "two_run_noise_std_deg_per_h",
    "deg/h",
    Applies::Moving,
    "standard deviation of the difference of two runs of an adaptive filter, same motion, other noise, over sqrt(2)",
)
.lower_is_better()
.heading("noise of two runs")
.against(Against::Truth)
.by_choice();

/// Its part through the weights.
pub static NOISE_THROUGH_WEIGHTS: MetricKey = MetricKey::of_filters(
    "noise_through_weights_deg_per_h",
    "deg/h",
    Applies::Moving,
    "part of the noise of two runs: the noise of the words through the weights of each run",
)
.lower_is_better()
.heading("noise through weights")
.against(Against::Truth)
.by_choice();

/// Its part of the weights.
pub static WEIGHT_NOISE_TIMES_MOTION: MetricKey = MetricKey::of_filters(
    "weight_noise_times_motion_deg_per_h",
    "deg/h",
    Applies::Moving,
    "part of the noise of two runs: the difference of their weights times the motion",
)
.lower_is_better()
.heading("weight noise times motion")
.against(Against::Truth)
.by_choice();

/// Enters what two runs show of the noise of a filter.
///
/// Weights that remember more than a tenth of the record differ between two runs by one and the same amount
/// all along, which is one draw: the value then stands without an interval.
pub(crate) fn put_two_runs(facts: &FilterFacts, samples: usize, metrics: &mut ChannelMetrics) {
    let Some(runs) = &facts.two_runs else {
        return;
    };
    let is_in_blocks = matches!(facts.weight_scatter(samples, 0.0), WeightScatter::Blocks);
    for (key, sums) in [
        (&TWO_RUN_NOISE_STD, &runs.whole),
        (&NOISE_THROUGH_WEIGHTS, &runs.through_weights),
        (&WEIGHT_NOISE_TIMES_MOTION, &runs.of_weights),
    ] {
        let estimate = deviation_of(sums);
        let estimate = match is_in_blocks {
            true => estimate,
            false => Estimate::without_interval(estimate.value, NOT_FROM_ONE_RECORD),
        };
        metrics.put(key, estimate);
    }
}

/// Standard deviation with the interval that blocks of time show.
fn deviation_of(blocks: &[DifferenceSums]) -> Estimate {
    let sum_without = |left_out: Option<usize>| {
        let kept = blocks.iter().enumerate();
        let kept = kept.filter(|(block, _)| Some(*block) != left_out);
        kept.fold(DifferenceSums::default(), |total, (_, own)| {
            total.plus(*own)
        })
    };
    let left_out: Vec<f64> = (0..blocks.len())
        .map(|block| sum_without(Some(block)).deviation())
        .collect();
    resampled(sum_without(None).deviation(), &left_out, None).clamped(0.0, f64::INFINITY)
}
