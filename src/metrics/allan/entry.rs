//! Entering a noise fit into a channel's table: coefficients, or the reasons for their absence.

use super::curves::put_fit_curve;
use super::extra_terms::{add_to_sheet, put_extra_terms};
use super::noise_fit::{
    ANGLE_RANDOM_WALK, BIAS_INSTABILITY, NoiseFit, QUANTISATION, RATE_RAMP, RATE_RANDOM_WALK, Term,
};
use super::overlapping::AllanPoint;
use crate::metrics::estimate::fit_sheet::{FitSheet, FitTerm};
use crate::metrics::estimate::reason::{Unavailable, too_short};
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::metric::{MetricKey, Needs};
use crate::units;
use crate::wording::{plain, to_digits};

/// Metrics that the fit gives.
pub(crate) const FIT_METRICS: [&MetricKey; 5] = [
    &ANGLE_RANDOM_WALK,
    &BIAS_INSTABILITY,
    &RATE_RANDOM_WALK,
    &RATE_RAMP,
    &QUANTISATION,
];

/// Shortest record, s, of which B, K or R can be fitted: the fit must reach 10 s.
pub(crate) const SLOW_NOISE_DURATION_MIN_S: f64 = 90.0;

/// Why a record cannot show B, K or R; nothing if it can, or for another metric.
pub(crate) fn slow_noise_lack(key: &MetricKey, duration_s: f64) -> Option<Unavailable> {
    let is_short = duration_s < SLOW_NOISE_DURATION_MIN_S * (1.0 - 1e-9);
    (key.needs == Needs::SlowNoiseFit && is_short)
        .then(|| too_short(key.name, SLOW_NOISE_DURATION_MIN_S, duration_s))
}

/// Enters a fit and the curve it was made from; of a record too short for slow noise without B, K, R.
///
/// Where the terms do not describe the curve, none stands: the sheet of the fit has the squares, for
/// whoever wants to look further.
pub(crate) fn enter_fit(
    points: &[AllanPoint],
    fit: &NoiseFit,
    duration_s: f64,
    metrics: &mut ChannelMetrics,
) {
    let refusal = inadequacy(fit);
    for (key, term, unit) in terms(fit) {
        metrics.metrics.remove(key.name);
        let estimate = term.estimate().scaled(unit);
        if let Some(refusal) = &refusal {
            metrics.miss(key, refusal.clone());
        } else if let Some(lack) = slow_noise_lack(key, duration_s) {
            let bound = if term.is_bounded() && estimate.high > 0.0 {
                let most = plain(to_digits(estimate.high, 2));
                format!("; it is {most} {} at most", key.unit)
            } else {
                String::new()
            };
            metrics.miss(key, format!("{lack}{bound}"));
        } else if term.is_bounded() {
            let metric = metrics.put(key, estimate);
            metric.fields.insert("tau_min_s", fit.tau_range_s[0]);
            metric.fields.insert("tau_max_s", fit.tau_range_s[1]);
        } else {
            metrics.miss(key, unbounded(key, fit));
        }
    }
    put_extra_terms(fit, metrics);
    metrics.noise_fit = Some(sheet(fit));
    put_fit_curve(points, Some(fit), metrics);
}

/// The terms that are metrics, each with the factor that takes it from deg/h and s to its unit.
fn terms(fit: &NoiseFit) -> [(&'static MetricKey, Term, f64); 5] {
    [
        (
            &ANGLE_RANDOM_WALK,
            fit.angle_random_walk_deg_per_h_sqrt_s,
            units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(1.0),
        ),
        (&BIAS_INSTABILITY, fit.bias_instability_deg_per_h, 1.0),
        (
            &RATE_RANDOM_WALK,
            fit.rate_random_walk_deg_per_h_per_sqrt_s,
            units::deg_per_h_per_sqrt_s_to_deg_per_h_per_sqrt_h(1.0),
        ),
        (
            &RATE_RAMP,
            fit.rate_ramp_deg_per_h_per_s,
            units::deg_per_h_per_s_to_deg_per_h_per_h(1.0),
        ),
        (&QUANTISATION, fit.quantisation_arcsec, 1.0),
    ]
}

/// Why no term of a fit stands; nothing where they do.
fn inadequacy(fit: &NoiseFit) -> Option<String> {
    let goodness = &fit.goodness;
    if goodness.is_adequate() {
        return None;
    }
    let missed = match &goodness.missed_tau_s[..] {
        [] => String::new(),
        [one] => format!(", outside the fit's 99 % band at {} s", plain(*one)),
        [first, .., last] => format!(
            ", outside the fit's 99 % band at {} averaging times from {} s to {} s",
            goodness.missed_tau_s.len(),
            plain(*first),
            plain(*last)
        ),
    };
    Some(format!(
        "the Allan variance between {:.2} s and {:.2} s is not described by the noise terms (p = \
         {:.4}): it lies {:.0} % off the best fit's deviation at {} s{missed}",
        fit.tau_range_s[0],
        fit.tau_range_s[1],
        goodness.p_value,
        100.0 * goodness.largest_misfit,
        plain(goodness.largest_misfit_tau_s),
    ))
}

/// Why a term has no upper limit.
fn unbounded(key: &MetricKey, fit: &NoiseFit) -> String {
    if *key == QUANTISATION {
        return "not bounded: the 1/tau^2 part of the Allan variance is negative, as behind a loop or \
                a filter, which hides a quantisation below it"
            .to_owned();
    }
    format!(
        "not bounded by the Allan variance between {:.2} s and {:.2} s",
        fit.tau_range_s[0], fit.tau_range_s[1]
    )
}

/// The fit as results hold it.
fn sheet(fit: &NoiseFit) -> FitSheet {
    let goodness = &fit.goodness;
    let in_model = |key: &MetricKey| *key != RATE_RAMP || fit.has_ramp;
    let record = |(key, term, unit): (&MetricKey, Term, f64)| {
        let term = FitTerm {
            square: term.square * unit * unit,
            standard_error: term.standard_error * unit * unit,
            unit: format!("({})^2", key.unit),
            is_in_model: in_model(key),
        };
        (key.name.to_owned(), term)
    };
    let numbers = [
        ("chi_squared", goodness.chi_squared),
        ("degrees_of_freedom", goodness.degrees_of_freedom),
        ("p_value", goodness.p_value),
        ("p_value_beyond_2_percent", goodness.p_value_beyond_harmless),
        ("curves", f64::from(goodness.curves)),
        ("largest_misfit", goodness.largest_misfit),
        ("largest_misfit_tau_s", goodness.largest_misfit_tau_s),
        ("tau_min_s", fit.tau_range_s[0]),
        ("tau_max_s", fit.tau_range_s[1]),
    ];
    let mut sheet = FitSheet {
        is_adequate: goodness.is_adequate(),
        numbers: numbers
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect(),
        missed_tau_s: goodness.missed_tau_s.clone(),
        terms: terms(fit).into_iter().map(record).collect(),
    };
    add_to_sheet(fit, &mut sheet);
    sheet
}
