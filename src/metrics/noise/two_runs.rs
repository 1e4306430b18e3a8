//! Noise of an adaptive filter in motion as two runs on other noise show it, and its two parts.

use crate::metrics::estimate::influence::resampled;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::two_runs::DifferenceSums;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, MetricKey};
use crate::metrics::record::{FilterFacts, WeightScatter};
use crate::metrics::theory::learning::NOT_FROM_ONE_RECORD;

/// Fields of the metric: its parts, in the same unit.
const THROUGH_WEIGHTS: &str = "noise_through_weights_deg_per_h";
const WEIGHTS_TIMES_MOTION: &str = "weight_noise_times_motion_deg_per_h";

/// Noise of two runs.
pub static TWO_RUN_NOISE_STD: MetricKey = MetricKey::of_filters(
    "two_run_noise_std_deg_per_h",
    "deg/h",
    Applies::Moving,
    "standard deviation of the difference of two runs of an adaptive filter, same motion, other noise, over sqrt(2); beside it that of its parts: noise through the weights, and weights times motion",
)
.lower_is_better()
.heading("noise of two runs")
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
    let estimate = match facts.weight_scatter(samples, 0.0) {
        WeightScatter::Blocks => deviation_of(&runs.whole),
        _ => Estimate::without_interval(deviation(&runs.whole), NOT_FROM_ONE_RECORD),
    };
    let metric = metrics.put(&TWO_RUN_NOISE_STD, estimate);
    let parts = [
        (THROUGH_WEIGHTS, &runs.through_weights),
        (WEIGHTS_TIMES_MOTION, &runs.of_weights),
    ];
    for (name, sums) in parts {
        metric.fields.insert(name, deviation(sums));
    }
}

fn deviation(blocks: &[DifferenceSums]) -> f64 {
    let whole = blocks.iter();
    let whole = whole.fold(DifferenceSums::default(), |total, own| total.plus(*own));
    whole.deviation()
}

/// Standard deviation with the interval that blocks of time show.
///
/// The second run has the noise of half a record later: a block and that half a record behind it show the
/// same noise, and leave together.
fn deviation_of(blocks: &[DifferenceSums]) -> Estimate {
    let half = blocks.len() / 2;
    let without = |left_out: usize| {
        let kept = blocks.iter().enumerate();
        let kept = kept.filter(|(block, _)| block % half != left_out);
        let kept: Vec<DifferenceSums> = kept.map(|(_, own)| *own).collect();
        deviation(&kept)
    };
    let left_out: Vec<f64> = (0..half).map(without).collect();
    resampled(deviation(blocks), &left_out, None).clamped(0.0, f64::INFINITY)
}
