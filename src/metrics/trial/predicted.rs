//! What theory predicts of a filter at rest, with the noise that the record shows.

use super::noise_delay::{NOISE_DELAY_BOUND_NOISE_GAIN, NOISE_GAIN_OVER_BOUND, OverBound};
use crate::metrics::estimate::influence::{Spread, spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::{FilterFacts, Record, WeightScatter};
use crate::metrics::theory::bound::{NO_DELAY_AT_DC, filter_bound_at, noise_power_gain};
use crate::metrics::theory::prediction::{Prediction, predict, prediction_lack};

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
.lower_is_better()
.heading("delay at DC")
.tables(&[Table::Rest]);

/// Wiener prediction of the DC gain; the delay of the mean weights and the noise-delay bound there.
///
/// Without mean weights the bound is taken at the predicted delay. It holds for fixed weights; ones
/// that keep adapting to the noise itself can go below.
pub(crate) fn measure_predictions(
    record: &Record,
    facts: &FilterFacts,
    (channel, raw): (&LaggedProducts, &LaggedProducts),
    metrics: &mut ChannelMetrics,
) {
    let mean = interval::mean(record.raw_deg_per_h);
    let ran = facts.mean_delay_at_dc_samples();
    let at = |autocovariance: &[f64], mean: f64| {
        let second_moment: Vec<f64> = autocovariance
            .iter()
            .map(|value| value + mean * mean)
            .collect();
        let prediction = predict(&facts.shape, &second_moment)?;
        let delay_samples = ran.unwrap_or_else(|| prediction.delay_at_dc_samples());
        let bound = filter_bound_at(&facts.shape, delay_samples, autocovariance);
        Some((prediction.dc_gain(), delay_samples, bound))
    };
    let means = means_without_blocks(record.raw_deg_per_h, raw.blocks());
    let parts: Vec<_> = means
        .into_iter()
        .enumerate()
        .filter_map(|(block, mean)| at(&raw.autocovariance_without(block), mean))
        .collect();
    let Some((dc_gain, delay_samples, bound)) = at(&raw.autocovariance(), mean) else {
        metrics.miss(&DC_GAIN_PREDICTED, prediction_lack(&facts.shape));
        for name in [
            &NOISE_DELAY_BOUND_NOISE_GAIN,
            &NOISE_GAIN_OVER_BOUND,
            &DELAY_AT_DC,
        ] {
            metrics.miss(name, prediction_lack(&facts.shape));
        }
        return;
    };
    let gains: Vec<f64> = parts.iter().map(|part| part.0).collect();
    let drift = record.drift_variance().sqrt();
    let by_drift = at(&raw.autocovariance(), mean + drift).map_or(0.0, |moved| moved.0 - dc_gain);
    let spread = spread(&gains, None).plus(Spread::known(by_drift * by_drift));
    metrics.put(&DC_GAIN_PREDICTED, spread.about(dc_gain));
    let delay = if delay_samples.is_finite() {
        let left_out: Vec<f64> = parts.iter().map(|part| part.1).collect();
        put_delay_at_dc(record, facts, (delay_samples, &left_out), metrics)
    } else {
        metrics.miss(&DELAY_AT_DC, NO_DELAY_AT_DC);
        Estimate::exact(delay_samples)
    };
    let without: Vec<_> = parts.into_iter().map(|part| part.2).collect();
    let of = OverBound {
        channel,
        raw,
        bound: &bound,
        bounds_without: &without,
    };
    measure_bound(record, facts, &of, &delay, metrics);
}

/// The noise-delay bound at the delay at DC, and the noise gain over it.
///
/// * `delay`: delay at DC, samples.
fn measure_bound(
    record: &Record,
    facts: &FilterFacts,
    of: &OverBound,
    delay: &Estimate,
    metrics: &mut ChannelMetrics,
) {
    let newest = facts.shape.newest_age_samples;
    let autocovariance = of.raw.autocovariance();
    let scatter = facts.weight_scatter(record.raw_deg_per_h.len(), 0.0);
    let over = scatter.of(facts.mean_weights.as_deref(), |weights| {
        let delay = Prediction::of_weights(weights.to_vec(), newest).delay_at_dc_samples();
        let least = filter_bound_at(&facts.shape, delay, &autocovariance);
        let least = least.map_or(f64::NAN, |least| least.noise_gain);
        noise_power_gain(weights, &autocovariance) / least
    });
    of.put_at(delay, facts, over.as_ref(), record.sample_period_s, metrics);
}

/// Mean of the values with each of `blocks` blocks of equal length left out.
fn means_without_blocks(values: &[f64], blocks: usize) -> Vec<f64> {
    let total: f64 = values.iter().sum();
    let border = |block: usize| values.len() * block / blocks;
    (0..blocks)
        .map(|block| {
            let own = &values[border(block)..border(block + 1)];
            (total - own.iter().sum::<f64>()) / (values.len() - own.len()) as f64
        })
        .collect()
}

/// Enters the delay at DC, and returns it in samples without the latency: of given weights exact, of ones that learn by their blocks or by what they
/// have learned, of a prediction by the blocks left out.
fn put_delay_at_dc(
    record: &Record,
    facts: &FilterFacts,
    (delay_samples, left_out): (f64, &[f64]),
    metrics: &mut ChannelMetrics,
) -> Estimate {
    let newest = facts.shape.newest_age_samples;
    let delay =
        |weights: &[f64]| Prediction::of_weights(weights.to_vec(), newest).delay_at_dc_samples();
    let scatter = facts.weight_scatter(record.raw_deg_per_h.len(), 0.0);
    let of_blocks = || {
        let blocks = facts.block_weights.iter();
        let blocks: Vec<f64> = blocks.map(|block| delay(block)).collect();
        interval::from_parts(delay_samples, &blocks)
    };
    let samples = match scatter.of(facts.mean_weights.as_deref(), delay) {
        Some(learned) if matches!(scatter, WeightScatter::Runs { .. }) => {
            let blocks = Spread::of(&of_blocks());
            learned.spread().plus(blocks).about(delay_samples)
        }
        Some(learned) => learned.spread().about(delay_samples),
        None if facts.block_weights.is_empty() => interval::jackknife(delay_samples, left_out),
        None => scatter.unless_unknown(of_blocks()),
    };
    let delay_s = samples
        .scaled(record.sample_period_s)
        .shifted(facts.latency_s);
    metrics.put_delay(&DELAY_AT_DC, delay_s, record.sample_period_s);
    samples
}
