//! A filter on the noise-delay plane: its bound, the curve of it, and how far above it stands.

use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::FilterFacts;
use crate::metrics::theory::bound::{filter_bound, noise_delay_bound};
use crate::units;

/// Least noise power gain at the delay of the filter.
pub static NOISE_DELAY_BOUND_NOISE_GAIN: MetricKey = MetricKey::of_filters(
    "noise_delay_bound_noise_gain",
    "1",
    Applies::SteadyOrSwing,
    "least noise gain any fixed filter of as many taps has at this delay with unit DC gain",
)
.heading("least at this delay")
.tables(&[Table::Rest, Table::Swing]);

/// Noise gain over bound.
pub static NOISE_GAIN_OVER_BOUND: MetricKey = MetricKey::of_filters(
    "noise_gain_over_bound",
    "1",
    Applies::SteadyOrSwing,
    "noise gain over that least one; below 1 the weights adapt or the signal is attenuated",
);

/// Delay.
pub static DELAY: Column = Column::new("delay_ms", "ms", "delay at DC, latency included");

/// Bound for the noise of the record.
pub static LEAST_NOISE_GAIN: Column = Column::new(
    "noise_gain",
    "1",
    "least noise power gain at this delay for the colour of the raw noise",
);

/// Bound for white noise.
pub static LEAST_WHITE_NOISE_GAIN: Column =
    Column::new("white_noise_gain", "1", "the same for white noise");

/// Noise-delay bound.
pub static NOISE_DELAY_BOUND: CurveKey = CurveKey::new(
    "noise_delay_bound",
    &[&DELAY, &LEAST_NOISE_GAIN, &LEAST_WHITE_NOISE_GAIN],
    "least noise gain of any fixed filter of as many taps with unit DC gain over the delay",
)
.picture("noise-delay.svg");

/// Points of the curve.
const CURVE_POINTS: usize = 41;

/// Enters the noise-delay bound with the delay it holds at and the white-noise figure beside it.
pub(crate) fn put_bound(
    bound: Result<Estimate, Unavailable>,
    facts: &FilterFacts,
    delay_samples: f64,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let metric = match bound {
        Ok(bound) => metrics.put(&NOISE_DELAY_BOUND_NOISE_GAIN, bound),
        Err(reason) => return metrics.miss(&NOISE_DELAY_BOUND_NOISE_GAIN, reason),
    };
    metric
        .fields
        .insert("delay_ms", units::s_to_ms(delay_samples * sample_period_s));
    let taps = facts.shape.taps.unwrap_or(0);
    if let Some(white) = noise_delay_bound(taps, facts.shape.newest_age_samples, delay_samples) {
        metric.fields.insert("white_noise_gain", white);
    }
}

/// Enters the curve of the bound over delays from one sample before the newest
/// age to one behind the oldest, for white noise and for the colour of raw's.
///
/// The least of a quadratic form under linear constraints is a quadratic of what these are set to,
/// here of the delay, so that three solutions give the whole curve. There is no curve of a single
/// tap, which has one delay, nor of unlimited ones.
pub(crate) fn put_bound_curve(
    facts: &FilterFacts,
    autocovariance: &[f64],
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let Some(taps) = facts.shape.taps.filter(|taps| *taps > 1) else {
        return;
    };
    let newest = facts.shape.newest_age_samples as f64;
    let half = (taps as f64 - 1.0) / 2.0;
    let at = |delay: f64| filter_bound(&facts.shape, delay, autocovariance);
    let knots = (at(newest), at(newest + half), at(newest + 2.0 * half));
    let (Ok(first), Ok(middle), Ok(last)) = knots else {
        return;
    };
    let (slope, curvature) = (0.5 * (last - first), 0.5 * (first + last) - middle);
    let coloured = |delay: f64| {
        let from_middle = (delay - newest - half) / half;
        middle + (slope + curvature * from_middle) * from_middle
    };
    let step = (taps as f64 + 1.0) / (CURVE_POINTS as f64 - 1.0);
    let delays: Vec<f64> = (0..CURVE_POINTS)
        .map(|index| newest - 1.0 + step * index as f64)
        .collect();
    let white = delays
        .iter()
        .filter_map(|&delay| noise_delay_bound(taps, facts.shape.newest_age_samples, delay));
    let delays_ms = delays
        .iter()
        .map(|delay| units::s_to_ms(delay * sample_period_s + facts.latency_s));
    let coloured = delays.iter().map(|delay| coloured(*delay)).collect();
    let columns = [
        (&DELAY, delays_ms.collect()),
        (&LEAST_NOISE_GAIN, coloured),
        (&LEAST_WHITE_NOISE_GAIN, white.collect()),
    ];
    metrics.put_curve(&NOISE_DELAY_BOUND, columns);
}

/// Enters `noise_gain_over_bound`.
///
/// Blocks leave the noise and the bound together: of fixed weights with unit DC gain the ratio
/// hardly scatters, as both follow from the same autocovariance.
pub(crate) fn put_over_bound(
    channel: &LaggedProducts,
    raw: &LaggedProducts,
    bound: &Result<f64, Unavailable>,
    bounds_without: &[Result<f64, Unavailable>],
    metrics: &mut ChannelMetrics,
) {
    let bound = match bound {
        Ok(bound) => *bound,
        Err(reason) => return metrics.miss(&NOISE_GAIN_OVER_BOUND, reason.clone()),
    };
    let ratio = |channel: &[f64], raw: &[f64], bound: f64| channel[0] / raw[0] / bound;
    let value = ratio(&channel.autocovariance(), &raw.autocovariance(), bound);
    let left_out: Vec<f64> = bounds_without
        .iter()
        .enumerate()
        .filter_map(|(block, bound)| {
            let bound = *bound.as_ref().ok()?;
            let (own, other) = (
                channel.autocovariance_without(block),
                raw.autocovariance_without(block),
            );
            Some(ratio(&own, &other, bound))
        })
        .collect();
    metrics.put(
        &NOISE_GAIN_OVER_BOUND,
        interval::jackknife(value, &left_out),
    );
}
