//! Entering a noise fit into a channel's table: coefficients, or the reasons for their absence.

use super::curves::put_fit_curve;
use super::noise_fit::{
    ANGLE_RANDOM_WALK, BIAS_INSTABILITY, NoiseFit, QUANTISATION, RATE_RAMP, RATE_RANDOM_WALK, Term,
};
use super::overlapping::AllanPoint;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::reason::{Unavailable, too_short};
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::metric::{MetricKey, Needs};
use crate::units;

/// Metrics that the fit gives.
pub(crate) const FIT_METRICS: [&MetricKey; 5] = [
    &ANGLE_RANDOM_WALK,
    &BIAS_INSTABILITY,
    &RATE_RANDOM_WALK,
    &RATE_RAMP,
    &QUANTISATION,
];

/// Upper end beyond which an interval says nothing, whatever the unit.
const BOUND_MAX: f64 = 1e6;

/// A bound to three digits, as plain as its size allows.
fn three_digits(value: f64) -> String {
    if (1e-3..1e4).contains(&value) {
        let magnitude = value.log10().floor();
        let decimals = (2.0 - magnitude).max(0.0);
        format!("{value:.*}", round_to_count(decimals))
    } else {
        format!("{value:.2e}")
    }
}

/// Shortest record, s, of which B, K or R can be fitted: the fit must reach 10 s.
pub(crate) const SLOW_NOISE_DURATION_MIN_S: f64 = 90.0;

/// Why a record cannot show B, K or R; nothing if it can, or for another metric.
pub(crate) fn slow_noise_lack(key: &MetricKey, duration_s: f64) -> Option<Unavailable> {
    let is_short = duration_s < SLOW_NOISE_DURATION_MIN_S * (1.0 - 1e-9);
    (key.needs == Needs::SlowNoiseFit && is_short)
        .then(|| too_short(key.name, SLOW_NOISE_DURATION_MIN_S, duration_s))
}

/// Enters a fit and the curve it was made from; of a record too short for slow noise without B, K, R.
pub(crate) fn enter_fit(
    points: &[AllanPoint],
    fit: &NoiseFit,
    duration_s: f64,
    metrics: &mut ChannelMetrics,
) {
    put_noise_fit(fit, metrics);
    for key in FIT_METRICS {
        let Some(reason) = slow_noise_lack(key, duration_s) else {
            continue;
        };
        if let Some(metric) = metrics.get(key) {
            let (high, unit) = (metric.estimate.high, metric.unit);
            let bound = if high.is_finite() {
                format!("; it is {high:.2e} {unit} at most")
            } else {
                String::new()
            };
            metrics.withdraw(key, format!("{reason}{bound}"));
        }
    }
    put_fit_curve(points, Some(fit), metrics);
}

/// Enters the five fitted coefficients or the reasons for their absence.
fn put_noise_fit(fit: &NoiseFit, metrics: &mut ChannelMetrics) {
    type Conversion = fn(f64) -> f64;
    let entries: [(&MetricKey, &Term, Conversion); 5] = [
        (
            &ANGLE_RANDOM_WALK,
            &fit.angle_random_walk_deg_per_h_sqrt_s,
            units::deg_per_h_sqrt_s_to_deg_per_sqrt_h,
        ),
        (
            &BIAS_INSTABILITY,
            &fit.bias_instability_deg_per_h,
            std::convert::identity,
        ),
        (
            &RATE_RANDOM_WALK,
            &fit.rate_random_walk_deg_per_h_per_sqrt_s,
            units::deg_per_h_per_sqrt_s_to_deg_per_h_per_sqrt_h,
        ),
        (
            &RATE_RAMP,
            &fit.rate_ramp_deg_per_h_per_s,
            units::deg_per_h_per_s_to_deg_per_h_per_h,
        ),
        (
            &QUANTISATION,
            &fit.quantisation_arcsec,
            std::convert::identity,
        ),
    ];
    for (key, term, convert) in entries {
        match term {
            Term::Found(estimate) => {
                let estimate = estimate.scaled(convert(1.0));
                let metric = metrics.put(key, estimate);
                metric.fields.insert("tau_min_s", fit.tau_range_s[0]);
                metric.fields.insert("tau_max_s", fit.tau_range_s[1]);
            }
            Term::LeftOut { reason, allowed } => {
                metrics.metrics.remove(key.name);
                let high = convert(allowed.high);
                // A bound of nothing is that of a record that these five terms do not describe.
                let bound = if high > 0.0 && high < BOUND_MAX {
                    format!("; it is {} {} at most (95 %)", three_digits(high), key.unit)
                } else {
                    String::new()
                };
                metrics.miss(key, format!("{reason}{bound}"));
            }
        }
    }
}
