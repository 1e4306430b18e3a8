//! What theory predicts of a filter at rest, with the noise that the record shows.

use super::noise_delay::{
    NOISE_DELAY_BOUND_NOISE_GAIN, NOISE_GAIN_OVER_BOUND, put_bound, put_bound_curve, put_over_bound,
};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::{FilterFacts, Record};
use crate::metrics::theory::bound::{NO_DELAY_AT_DC, filter_bound_at};
use crate::metrics::theory::prediction::predict;
use crate::units;

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
    let mean_square = interval::mean(record.raw_deg_per_h).powi(2);
    let ran = facts.mean_delay_at_dc_samples();
    let at = |autocovariance: &[f64]| {
        let second_moment: Vec<f64> = autocovariance
            .iter()
            .map(|value| value + mean_square)
            .collect();
        let prediction = predict(&facts.shape, &second_moment)?;
        let delay_samples = ran.unwrap_or_else(|| prediction.delay_at_dc_samples());
        let bound = filter_bound_at(&facts.shape, delay_samples, autocovariance);
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
        .filter_map(|bound| Some(bound.as_ref().ok()?.noise_gain))
        .collect();
    put_bound(
        bound.map(|least| (interval::jackknife(least.noise_gain, &bounds), least)),
        facts,
        delay_samples,
        record.sample_period_s,
        metrics,
    );
}
