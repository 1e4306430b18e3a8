//! How sure the response of a channel to a swing is.

use std::f64::consts::TAU;

use super::mean::{GYRO_REACH, filter_reach, rounding_density};
use crate::metrics::estimate::influence::{Learned, Spread};
use crate::metrics::estimate::paired::{MeanScatter, Values, delayed, ends_about_swing};
use crate::metrics::estimate::value::Estimate;
use crate::metrics::record::{FilterFacts, Record, WeightScatter};
use crate::metrics::sine::fit::{SwingClock, SwingFit};
use crate::metrics::theory::prediction::Prediction;

/// The sine fits of one swing record.
pub(super) struct Fits {
    pub(super) channel: SwingFit,
    pub(super) raw: SwingFit,
    /// The true rate, if it is known.
    pub(super) truth: Option<SwingFit>,
    /// Rate implied by the encoder's angle, if there is an encoder.
    pub(super) encoder: Option<SwingFit>,
}

/// What a delay is taken against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Against {
    /// A motion that is known.
    Truth,
    /// Raw, whose noise is in the channel as well.
    Raw,
}

/// Spreads of the response of a filter to raw, and of raw to the truth.
pub(super) struct Response {
    pub(super) clock: SwingClock,
    is_filter: bool,
    /// Of the logarithm of the amplitude ratio, and of the phase, rad, against raw.
    against_raw: [Spread; 2],
    /// Delay of raw behind the truth, with its interval, where the truth is known.
    raw_behind_truth_s: Option<Estimate>,
    /// What learned weights add to the delay, s, and to the amplitude ratio.
    learned: Option<[Learned; 2]>,
    scatter: WeightScatter,
}

impl Response {
    /// Of the fits of a record.
    pub(super) fn new(
        record: &Record,
        fits: &Fits,
        clock: &SwingClock,
        filter: Option<&FilterFacts>,
    ) -> Self {
        let samples = record.raw_deg_per_h.len();
        let scatter = filter.map_or(WeightScatter::Blocks, |facts| {
            facts.weight_scatter(samples, 0.0)
        });
        // What a gradient sees, the swing, it learns within a block, whatever noise left across it.
        let is_learned = matches!(scatter, WeightScatter::Learned(_));
        let learned = filter.filter(|_| is_learned).and_then(|facts| {
            let weights = facts.mean_weights.as_deref();
            let newest = facts.shape.newest_age_samples;
            let frozen = |weights: &[f64]| Prediction::of_weights(weights.to_vec(), newest);
            let delay = |weights: &[f64]| {
                frozen(weights).delay_s(clock.frequency_hz, clock.sample_period_s)
            };
            let amplitude = |weights: &[f64]| {
                frozen(weights).amplitude(clock.frequency_hz, clock.sample_period_s)
            };
            Some([scatter.of(weights, delay)?, scatter.of(weights, amplitude)?])
        });
        let against_raw = if filter.is_some() {
            paired_scatter(record, fits, clock, filter).map(|part| {
                let count = fits.channel.samples();
                // Weights that are still on their way show in the blocks, not in the ensemble.
                if is_learned {
                    part.ends_over(count)
                } else {
                    part.over(count)
                }
            })
        } else {
            [Spread::known(0.0); 2]
        };
        let raw_behind_truth_s = fits
            .truth
            .as_ref()
            .map(|truth| fits.raw.delay_behind_s(truth));
        Self {
            clock: *clock,
            is_filter: filter.is_some(),
            against_raw,
            raw_behind_truth_s,
            learned,
            scatter,
        }
    }

    /// A delay, s, with the interval of its noise.
    ///
    /// Behind the truth the blocks of the channel show it, but for weights that forget nothing: then
    /// raw's own blocks do, and what the weights have learned comes on top.
    pub(super) fn delay(&self, delay_s: Estimate, against: Against) -> Estimate {
        let angular = TAU * self.clock.frequency_hz;
        let paired = self.against_raw[1].scaled(1.0 / angular);
        let own = match (against, &self.learned, &self.raw_behind_truth_s) {
            (Against::Raw, _, _) => paired,
            (Against::Truth, Some(_), Some(raw)) => Spread::of(raw),
            _ => return self.scatter.unless_unknown(delay_s),
        };
        let by_weights = self.learned.as_ref().map(|[delay, _]| delay.spread());
        let spread = by_weights.map_or(own, |learned| own.plus(learned));
        self.scatter.unless_unknown(spread.about(delay_s.value))
    }

    /// Whether the weights forget nothing and what they have learned is known.
    pub(super) fn is_learned(&self) -> bool {
        self.learned.is_some()
    }

    /// A delay of the channel with what learned weights add to its interval.
    pub(super) fn with_weights(&self, delay_s: Estimate) -> Estimate {
        let spread = match &self.learned {
            Some([delay, _]) => Spread::of(&delay_s).plus(delay.spread()),
            None => return self.scatter.unless_unknown(delay_s),
        };
        spread.about(delay_s.value)
    }

    /// What learned weights add to the mean square difference from the truth: through the response
    /// to the swing, as their delay and amplitude differ.
    pub(super) fn tracking_by_weights(
        &self,
        fits: &Fits,
        filter: Option<&FilterFacts>,
    ) -> Option<Learned> {
        let (facts, truth) = (filter?, fits.truth.as_ref()?);
        // As for the response itself: what a gradient sees it learns within a block.
        self.learned.as_ref()?;
        let clock = self.clock;
        let newest = facts.shape.newest_age_samples;
        let raw = &fits.raw.whole;
        let behind_truth = raw.phase_rad - truth.whole.phase_rad;
        let square = |weights: &[f64]| {
            let frozen = Prediction::of_weights(weights.to_vec(), newest);
            let amplitude =
                raw.amplitude * frozen.amplitude(clock.frequency_hz, clock.sample_period_s);
            let delay_s = frozen.delay_s(clock.frequency_hz, clock.sample_period_s);
            let phase = behind_truth - TAU * clock.frequency_hz * delay_s;
            let own = truth.whole.amplitude;
            0.5 * (amplitude * amplitude + own * own - 2.0 * amplitude * own * phase.cos())
        };
        self.scatter.of(facts.mean_weights.as_deref(), square)
    }

    /// What learned weights add to a function of the filter frozen at weights, and of these.
    pub(super) fn by_weights(
        &self,
        facts: &FilterFacts,
        of: impl Fn(&Prediction, &[f64]) -> f64,
    ) -> Option<Learned> {
        let newest = facts.shape.newest_age_samples;
        self.scatter.of(facts.mean_weights.as_deref(), |weights| {
            of(&Prediction::of_weights(weights.to_vec(), newest), weights)
        })
    }

    /// The amplitude ratio with the interval of its noise: of raw to the truth by its blocks.
    pub(super) fn amplitude(&self, ratio: Estimate) -> Estimate {
        if !self.is_filter {
            return ratio;
        }
        let own = self.against_raw[0].scaled(ratio.value);
        let by_weights = self
            .learned
            .as_ref()
            .map(|[_, amplitude]| amplitude.spread());
        let spread = by_weights.map_or(own, |learned| own.plus(learned));
        self.scatter.unless_unknown(spread.about(ratio.value))
    }
}

/// Scatter of the logarithm of a channel's response to raw at the swing's frequency: of its real part,
/// the amplitude, and of its imaginary part, the phase.
///
/// With `C = 2 mean(x exp(-i w t))` the response is `H = C_y / C_x`, and noise n moves it by
/// `d ln H = 2 mean((n_y - H n_x) exp(-i w t)) / C_y`. What the filter makes of raw's noise at the
/// swing's frequency cancels but for the ends. Source: derived.
fn paired_scatter(
    record: &Record,
    fits: &Fits,
    clock: &SwingClock,
    filter: Option<&FilterFacts>,
) -> [MeanScatter; 2] {
    let own = fits.channel.residuals(record.channel_deg_per_h);
    let raw = fits.raw.residuals(record.raw_deg_per_h);
    let (channel, reference) = (&fits.channel.whole, &fits.raw.whole);
    let gain = channel.amplitude / reference.amplitude;
    let turned = channel.phase_rad - reference.phase_rad;
    let scale = 2.0 / channel.amplitude;
    let phases = 0..own.len();
    let swing: Vec<(f64, f64)> = phases
        .map(|index| (clock.phase_rad(index) + channel.phase_rad).sin_cos())
        .collect();
    // With the input turned by `turned`, and then by what a delay leaves of that.
    let parts = |input: &mut dyn Iterator<Item = f64>, turned: f64| -> [Vec<f64>; 2] {
        let (sine, cosine) = turned.sin_cos();
        let (mut real, mut imaginary) = (Vec::new(), Vec::new());
        for ((own, raw), (s, c)) in own.iter().zip(input).zip(&swing) {
            let (re, im) = (own - gain * cosine * raw, -gain * sine * raw);
            real.push(scale * (re * c + im * s));
            imaginary.push(scale * (im * c - re * s));
        }
        [real, imaginary]
    };
    let reach = filter_reach(filter);
    let cycle = 1.0 / (clock.frequency_hz * clock.sample_period_s);
    let angular = TAU * clock.frequency_hz * clock.sample_period_s;
    if let Some(facts) = filter.filter(|facts| facts.given().is_some()) {
        // The response of given weights is what the fits show but for the ends.
        let density = rounding_density((&own, &raw), facts).scaled(scale / 2.0_f64.sqrt());
        if let Some(response) = facts.response() {
            let phases = [0, own.len()].map(|at| clock.phase_rad(at) + channel.phase_rad);
            let ends = ends_about_swing(&response, (&raw, GYRO_REACH), angular, phases);
            return ends.map(|ends| MeanScatter::known(density, ends.scaled(scale)));
        }
        return parts(&mut raw.iter().copied(), turned)
            .map(|part| MeanScatter::of_known_density(&part[..], density, reach, Some(cycle)));
    }
    let delay = filter.map_or(0.0, FilterFacts::delay_at_dc_samples);
    let plain = parts(&mut raw.iter().copied(), turned);
    let aligned = parts(&mut delayed(&raw, delay).each(), turned + angular * delay);
    let first = reach.min(own.len() / 2);
    [0, 1].map(|part| {
        MeanScatter::of_paired(
            &plain[part][..],
            &aligned[part][first..],
            reach,
            Some(cycle),
        )
    })
}
