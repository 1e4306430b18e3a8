//! From a fit of the noise terms to the metrics of a channel.

use super::allan::AllanPoint;
use super::estimate::ChannelMetrics;
use super::noise_fit::NoiseFit;
use super::record::Motion;
use super::support::support;

/// The coefficients of slow noise.
const SLOW_NOISE: [&str; 3] = [
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "rate_ramp_deg_per_h_per_h",
];

/// Enters a fit and the curve it was made from, of overlapping differences.
///
/// Slow noise is left out of records too short for it to show, as [`support`] says of them.
pub(crate) fn enter_fit(points: &[AllanPoint], fit: &NoiseFit, metrics: &mut ChannelMetrics) {
    metrics.put_noise_fit(fit);
    if let Some(first) = points.first() {
        let sample_period_s = first.tau_s / first.averaged_samples as f64;
        let samples = first.count + 2 * first.averaged_samples - 1;
        let duration_s = samples as f64 * sample_period_s;
        for name in SLOW_NOISE {
            let steady = &Motion::Steady;
            if let Err(reason) = support(name, duration_s, sample_period_s, steady, true, 1.0) {
                metrics.metrics.remove(name);
                metrics.miss(name, reason);
            }
        }
    }
    metrics.put_allan_curve(points, Some(fit));
}
