//! DC gain of a filter, found by replay, and metrics restored by it.

use crate::metrics::estimate::influence::{Learned, Spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::{ChannelMetrics, EXPECTED};
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Table};
use crate::metrics::record::{FilterFacts, Record, WeightScatter};
use crate::metrics::theory::learning::NOT_FROM_ONE_RECORD;

/// DC gain.
pub static DC_GAIN: MetricKey = MetricKey::of_filters(
    "dc_gain",
    "1",
    Applies::Always,
    "response to a small added rate with the weight sequence of the unperturbed run replayed",
)
.synonyms(&["gain"])
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

/// Angle random walk over DC gain.
pub static ANGLE_RANDOM_WALK_OVER_DC_GAIN: MetricKey = MetricKey::of_filters(
    "angle_random_walk_over_dc_gain_deg_per_sqrt_h",
    "deg/sqrt(h)",
    Applies::Steady,
    "angle random walk once the scale factor is restored",
)
.lower_is_better()
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
.lower_is_better()
.heading("bias stability / DC gain")
.slow_noise()
.needs(Needs::ScenarioBlocks)
.tables(&[Table::Rest]);

/// Enters the DC gains found by replay.
///
/// Those of given weights are exact. Weights that adapt scatter from seed to seed: the blocks of the
/// record show it, or what the filter has learned from each stretch of its words. Of weights that noise left
/// somewhere before the motion, and that the motion keeps, the DC gain adapted has no interval: how a twin
/// on other noise would differ is in neither.
pub(crate) fn put_dc_gains(record: &Record, facts: &FilterFacts, metrics: &mut ChannelMetrics) {
    let scatter = facts.weight_scatter(record.raw_deg_per_h.len(), 0.0);
    let estimate = |gain: f64, blocks: &[f64], learned: Option<Learned>| {
        if facts.given().is_some() || facts.dc_gain_is_held() {
            return Estimate::exact(gain);
        }
        let of_blocks = interval::from_parts(gain, blocks);
        match learned {
            Some(learned) if matches!(scatter, WeightScatter::Runs { .. }) => {
                learned.spread().plus(Spread::of(&of_blocks)).about(gain)
            }
            Some(learned) => learned.spread().about(gain),
            None if matches!(scatter, WeightScatter::Blocks) => of_blocks,
            None => Estimate::without_interval(gain, NOT_FROM_ONE_RECORD),
        }
    };
    let sums: Vec<f64> = facts
        .block_weights
        .iter()
        .map(|weights| weights.iter().sum())
        .collect();
    let weights = facts.mean_weights.as_deref();
    let by_weights = scatter.of(weights, |weights| weights.iter().sum());
    let learning = facts.learning.as_ref();
    let adapted = learning.and_then(|known| known.adapted_gain(facts.added_rate_deg_per_h));
    for (key, gain, blocks, learned) in [
        (&DC_GAIN, facts.dc_gain, &sums, by_weights),
        (
            &DC_GAIN_ADAPTED,
            facts.dc_gain_adapted,
            &facts.block_dc_gains_adapted,
            adapted,
        ),
    ] {
        match gain {
            Some(gain) => {
                metrics
                    .put(key, estimate(gain, blocks, learned))
                    .fields
                    .insert("added_rate_deg_per_h", facts.added_rate_deg_per_h);
            }
            None => {
                let hidden = facts.shape.hidden_reason();
                metrics.miss(
                    key,
                    hidden.unwrap_or("it was not determined for this filter"),
                );
            }
        }
    }
}

/// Why nothing can be divided by a DC gain that is not above zero.
pub(crate) fn dc_gain_lack(dc_gain: f64) -> Unavailable {
    if dc_gain.is_finite() {
        format!("the DC gain, {dc_gain}, is not positive").into()
    } else {
        "the DC gain of this filter is not a finite number".into()
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
            fields.insert(DC_GAIN.name, gain);
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
    use crate::metrics::allan::noise_fit::ANGLE_RANDOM_WALK;

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
        assert_eq!(
            dc_gain_lack(-0.5).as_str(),
            "the DC gain, -0.5, is not positive"
        );
    }
}
