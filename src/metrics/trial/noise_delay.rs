//! A filter on the noise-delay plane: its bound, the curve of it, and how far above it stands.

use crate::metrics::estimate::influence::{Learned, Spread, resampled, spread};
use crate::metrics::estimate::interval::{self, NORMAL_QUANTILE};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::FilterFacts;
use crate::metrics::theory::bound::{
    LeastNoise, NoiseDelayBound, bound_taps, filter_bound, filter_bound_at, noise_power_gain,
};
use crate::units;

/// Least noise power gain at the delay of the filter.
pub static NOISE_DELAY_BOUND_NOISE_GAIN: MetricKey = MetricKey::of_filters(
    "noise_delay_bound_noise_gain",
    "1",
    Applies::SteadyOrSwing,
    "least noise gain of as many consecutive taps as the filter has, of any first age behind its register, at this delay with unit DC gain; of one without a count as many as its 1 % memory; sparse taps may do better",
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
    "least noise gain of as many consecutive taps with unit DC gain over the delay",
)
.picture("noise-delay.svg");

/// Points of the curve.
const CURVE_POINTS: usize = 41;

impl LeastNoise {
    /// The bound with its interval: the scatter of the autocovariance, and of the delay it is taken at.
    ///
    /// The bound is made of parabolas in the delay: its extremes over the short interval are at the ends
    /// unless the lowest point lies inside, which the value in the middle stands for. The scatter of the
    /// autocovariance adds in quadrature; the two are nearly independent.
    fn over_delay(
        &self,
        delay_samples: &Estimate,
        at: impl Fn(f64) -> Option<Self>,
        left_out: &[f64],
    ) -> Estimate {
        let value = self.noise_gain;
        let ends = [delay_samples.low, delay_samples.high]
            .map(|end| at(end).map_or(value, |least| least.noise_gain));
        let colour = interval::jackknife(value, left_out).high - value;
        let below = (value - ends[0].min(ends[1])).max(0.0).hypot(colour);
        let above = (ends[0].max(ends[1]) - value).max(0.0).hypot(colour);
        Estimate::with_interval(value, (value - below).max(0.0), value + above)
    }
}

/// Enters the noise-delay bound with the delay it holds at, the taps that reach it and the white-noise
/// figure beside it.
fn put_bound(
    bound: Result<(Estimate, LeastNoise), Unavailable>,
    facts: &FilterFacts,
    delay_samples: f64,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let (estimate, least) = match bound {
        Ok(bound) => bound,
        Err(reason) => return metrics.miss(&NOISE_DELAY_BOUND_NOISE_GAIN, reason),
    };
    let fields = &mut metrics.put(&NOISE_DELAY_BOUND_NOISE_GAIN, estimate).fields;
    fields.insert("delay_ms", units::s_to_ms(delay_samples * sample_period_s));
    let taps = bound_taps(&facts.shape);
    fields.insert("taps", taps as f64);
    fields.insert("first_age_samples", least.first_age_samples as f64);
    let white = NoiseDelayBound::white(taps, facts.shape.register_samples);
    if let Some(white) = white.and_then(|white| white.at(delay_samples)) {
        fields.insert("white_noise_gain", white.noise_gain);
    }
}

/// Enters the curve of the bound over delays from one sample before the register to one behind the
/// oldest sample that the filter weighs, for white noise and for the colour of raw's.
///
/// There is no curve of a single tap, which delays by whole samples.
fn put_bound_curve(
    facts: &FilterFacts,
    autocovariance: &[f64],
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let taps = bound_taps(&facts.shape);
    let register = facts.shape.register_samples;
    let (Ok(coloured), Some(white)) = (
        filter_bound(&facts.shape, autocovariance),
        NoiseDelayBound::white(taps, register),
    ) else {
        return;
    };
    if taps < 2 {
        return;
    }
    let first = register as f64 - 1.0;
    let last = (facts.shape.newest_age_samples + taps) as f64;
    let step = (last - first) / (CURVE_POINTS as f64 - 1.0);
    let delays: Vec<f64> = (0..CURVE_POINTS)
        .map(|index| first + step * index as f64)
        .collect();
    let gains = |bound: NoiseDelayBound| -> Vec<f64> {
        let at = delays.iter().filter_map(|&delay| bound.at(delay));
        at.map(|least| least.noise_gain).collect()
    };
    let delays_ms = delays
        .iter()
        .map(|delay| units::s_to_ms(delay * sample_period_s + facts.latency_s));
    let columns = [
        (&DELAY, delays_ms.collect()),
        (&LEAST_NOISE_GAIN, gains(coloured)),
        (&LEAST_WHITE_NOISE_GAIN, gains(white)),
    ];
    metrics.put_curve(&NOISE_DELAY_BOUND, columns);
}

/// Noise of a channel and of raw, from which the noise gain over the bound follows.
pub(crate) struct OverBound<'a> {
    /// Of the channel.
    pub(crate) channel: &'a LaggedProducts,
    /// Of raw.
    pub(crate) raw: &'a LaggedProducts,
    /// The bound, and the same without each block.
    pub(crate) bound: &'a Result<LeastNoise, Unavailable>,
    pub(crate) bounds_without: &'a [Result<LeastNoise, Unavailable>],
}

impl OverBound<'_> {
    /// Enters bound, curve of the bound and noise gain over it.
    ///
    /// * `delay_samples`: delay that the bound is taken at.
    /// * `learned`: what weights that forget nothing add to the noise gain over it.
    pub(crate) fn put_at(
        &self,
        delay_samples: &Estimate,
        facts: &FilterFacts,
        learned: Option<&Learned>,
        sample_period_s: f64,
        metrics: &mut ChannelMetrics,
    ) {
        self.put(facts, learned, metrics);
        let autocovariance = self.raw.autocovariance();
        put_bound_curve(facts, &autocovariance, sample_period_s, metrics);
        let without = self.bounds_without.iter().flatten();
        let without: Vec<f64> = without.map(|least| least.noise_gain).collect();
        let at = |delay| filter_bound_at(&facts.shape, delay, &autocovariance).ok();
        let bound = self.bound.clone();
        let bound = bound.map(|least| (least.over_delay(delay_samples, at, &without), least));
        if learned.is_none() {
            widen_over_bound(delay_samples, at, metrics);
        }
        let delay_samples = delay_samples.value;
        put_bound(bound, facts, delay_samples, sample_period_s, metrics);
    }

    /// Enters `noise_gain_over_bound`.
    ///
    /// * `learned`: what weights that forget nothing add to it.
    fn put(&self, facts: &FilterFacts, learned: Option<&Learned>, metrics: &mut ChannelMetrics) {
        let bound = match self.bound {
            Ok(bound) => bound.noise_gain,
            Err(reason) => return metrics.miss(&NOISE_GAIN_OVER_BOUND, reason.clone()),
        };
        let (own, raw) = (self.channel.autocovariance(), self.raw.autocovariance());
        let value = own[0] / raw[0] / bound;
        let given = facts.given().and_then(|_| facts.response());
        let estimate = match given.filter(|response| response.len() <= raw.len()) {
            Some(response) => self.of_given(value, bound, &response),
            None => {
                let left_out = self.without_blocks(|block, raw| {
                    self.channel.autocovariance_without(block)[0] / raw[0]
                });
                resampled(value, &left_out, learned)
            }
        };
        metrics.put(&NOISE_GAIN_OVER_BOUND, estimate);
    }

    /// Noise gain over bound without each block, by the gain that goes with raw's autocovariance.
    fn without_blocks(&self, gain: impl Fn(usize, &[f64]) -> f64) -> Vec<f64> {
        let bounds = self.bounds_without.iter().enumerate();
        bounds
            .filter_map(|(block, bound)| {
                let bound = bound.as_ref().ok()?.noise_gain;
                Some(gain(block, &self.raw.autocovariance_without(block)) / bound)
            })
            .collect()
    }

    /// Of given weights w gain and bound follow from the same autocovariance R of raw.
    ///
    /// A filter near its bound hardly moves with R. What is left is what the channel has beside `w'Rw`: the
    /// words that the ends of a record cut off. A block alone is such a record, and of n blocks the whole has
    /// the ends of one, `1/n^2` of their variance.
    fn of_given(&self, value: f64, bound: f64, response: &[f64]) -> Estimate {
        let of_raw = |raw: &[f64]| noise_power_gain(response, raw);
        let left_out = self.without_blocks(|_, raw| of_raw(raw));
        if left_out.len() < 2 {
            return Estimate::without_interval(value, interval::TOO_FEW_BLOCKS);
        }
        let blocks = self.raw.blocks();
        let power = self.raw.autocovariance()[0];
        let ends: Vec<f64> = (0..blocks)
            .map(|block| {
                let raw = self.raw.autocovariance_of(block);
                let own = self.channel.autocovariance_of(block)[0];
                (own - of_raw(&raw) * raw[0]) / power / bound
            })
            .collect();
        let ends = Spread {
            variance: interval::sample_variance(&ends) / (blocks * blocks) as f64,
            freedom: blocks as f64 - 1.0,
        };
        spread(&left_out, None).plus(ends).about(value)
    }
}

/// Adds what the uncertain delay does to the bound to the interval of the noise gain over it.
///
/// * `bound`: at a delay in samples; nothing where there is none.
///
/// A filter with the delay that its taps have the least noise at stands where the bound does not change
/// with the delay to first order. There the slope at the delay that was found is all noise, and its square
/// holds twice what the curvature does: of `b(t) = c t^2` about the lowest point, with t of the variance
/// `s^2`, the slope gives `(2 c t s)^2`, in the mean `4 c^2 s^4`, and the bound scatters by `2 c^2 s^4`.
fn widen_over_bound(
    delay_samples: &Estimate,
    bound: impl Fn(f64) -> Option<LeastNoise>,
    metrics: &mut ChannelMetrics,
) {
    let Some(metric) = metrics.get_mut(&NOISE_GAIN_OVER_BOUND) else {
        return;
    };
    let error = Spread::of(delay_samples).variance.sqrt();
    let beside = [-error, 0.0, error].map(|off| bound(delay_samples.value + off));
    let [Some(before), Some(at), Some(behind)] = beside.map(|least| least.map(|it| it.noise_gain))
    else {
        return;
    };
    let by_slope = (0.5 * (behind - before)).powi(2);
    let by_curvature = 0.5 * (behind + before - 2.0 * at).powi(2);
    let by_delay = (by_slope - by_curvature).max(by_curvature);
    let Estimate {
        value, low, high, ..
    } = metric.estimate;
    let by_delay = NORMAL_QUANTILE * by_delay.sqrt() / at * value;
    metric.estimate = Estimate::with_interval(
        value,
        (value - by_delay.hypot(value - low)).max(0.0),
        value + by_delay.hypot(high - value),
    );
}
