//! Frequency response of a filter whose weights are frozen at their mean.

use std::f64::consts::TAU;

use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::CurveKey;
use crate::metrics::record::FilterFacts;
use crate::metrics::sine::tones::{RESPONSE_COLUMNS, ToneResponse, near, put_responses};
use crate::metrics::theory::prediction::Prediction;

/// Frequency response at the mean weights.
pub static FROZEN_RESPONSE: CurveKey = CurveKey::new(
    "frozen_response",
    RESPONSE_COLUMNS,
    "response of a filter to raw with its weights frozen at their mean over the run",
)
.picture("filter-response.svg");

/// Points of the curve, equally spaced by the logarithm of the frequency.
const POINTS: usize = 121;

/// Lowest frequency in cycles per sample; the highest is half a cycle per sample.
const LOWEST: f64 = 2.5e-4;

/// Enters the curve `frozen_response`: gain, phase and phase delay behind raw over the frequency.
///
/// An adaptive filter has the response of the time mean of its weights; the intervals are Student's
/// t on those of blocks of the record, and so tell how far the weights wandered. That of given
/// weights is exact. Register and latency are part of phase and delay. Beyond a zero of the response
/// the phase takes the turn nearest to the delay before.
pub(crate) fn put_frozen_response(
    facts: &FilterFacts,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let Some(whole) = facts.frozen() else {
        return;
    };
    let newest = facts.shape.newest_age_samples;
    let blocks: Vec<Prediction> = facts
        .block_weights
        .iter()
        .map(|weights| Prediction::of_weights(weights.clone(), newest))
        .collect();
    let mut delay_s = whole.delay_at_dc_samples() * sample_period_s + facts.latency_s;
    if !delay_s.is_finite() {
        delay_s = facts.latency_s;
    }
    let spacing = (0.5 / LOWEST).ln() / (POINTS as f64 - 1.0);
    let responses: Vec<ToneResponse> = (0..POINTS)
        .map(|point| {
            let frequency_hz = LOWEST * (spacing * point as f64).exp() / sample_period_s;
            let angular = TAU * frequency_hz;
            let phase_of = |response: &Prediction, target: f64| {
                let delay_s = response.delay_s(frequency_hz, sample_period_s) + facts.latency_s;
                near(-angular * delay_s, target)
            };
            let gain_of = |response: &Prediction| response.amplitude(frequency_hz, sample_period_s);
            let phase = phase_of(&whole, -angular * delay_s);
            delay_s = -phase / angular;
            let phases: Vec<f64> = blocks.iter().map(|own| phase_of(own, phase)).collect();
            let gains: Vec<f64> = blocks.iter().map(gain_of).collect();
            let phase_rad = interval::from_parts(phase, &phases);
            ToneResponse {
                frequency_hz,
                gain: interval::from_parts(gain_of(&whole), &gains),
                phase_rad,
                delay_s: Estimate::with_interval(
                    delay_s,
                    -phase_rad.high / angular,
                    -phase_rad.low / angular,
                ),
            }
        })
        .collect();
    put_responses(&FROZEN_RESPONSE, &responses, metrics);
}
