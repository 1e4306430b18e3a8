//! Entering what is told of pulses into a channel's table.

use super::answer::PulseAnswer;
use super::recognition::PulseWords;
use crate::metrics::allan::noise_fit::{
    ANGLE_RANDOM_WALK, BIAS_INSTABILITY, FitRange, NoiseFit, QUANTISATION, RATE_RAMP,
    RATE_RANDOM_WALK,
};
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::units;
use crate::wording::{plain, to_digits};

/// Field of a quantisation: angle of a pulse.
const STEP: &str = "step_arcsec";

/// Says how the terms of a fit were found where the words count pulses. The quantisation stands whatever
/// the judgement of the other terms is.
pub(crate) fn enter_pulses(fit: &NoiseFit, metrics: &mut ChannelMetrics) {
    let Some(pulses) = &fit.pulses else {
        return;
    };
    let terms = [
        &ANGLE_RANDOM_WALK,
        &BIAS_INSTABILITY,
        &RATE_RANDOM_WALK,
        &RATE_RAMP,
    ];
    for key in terms {
        if metrics.get(key).is_some() {
            let words = pulses.method.words();
            metrics.pulse_words.insert(key.name.to_owned(), words);
        }
    }
    if pulses.counts {
        put_quantisation(
            fit.quantisation_arcsec.estimate(),
            pulses.step_arcsec(),
            metrics,
        );
        let words = quantisation_words(pulses);
        metrics
            .pulse_words
            .insert(QUANTISATION.name.to_owned(), words);
    }
}

fn quantisation_words(pulses: &PulseAnswer) -> String {
    let step = plain(to_digits(pulses.step_arcsec(), 6));
    let agreement = pulses.agreement;
    let [first, last] = agreement
        .tau_range_s
        .map(|tau_s| plain(to_digits(tau_s, 3)));
    format!(
        "from the step of {step} arcsec, over sqrt(12); between {first} s and {last} s the Allan \
         deviation is {:.3} times that of its sawtooth beside N",
        agreement.ratio
    )
}

/// Says what is known without a fit: the quantisation, and what the angle random walk is at most.
pub(crate) fn enter_lack(pulses: &PulseWords, range: FitRange, metrics: &mut ChannelMetrics) {
    if pulses.carries {
        let step_arcsec = pulses.sawtooth.step_arcsec;
        let quantisation = Estimate::exact(step_arcsec / 12.0_f64.sqrt());
        put_quantisation(quantisation, step_arcsec, metrics);
        let step = plain(to_digits(step_arcsec, 6));
        let words = format!("from the step of {step} arcsec, over sqrt(12)");
        metrics
            .pulse_words
            .insert(QUANTISATION.name.to_owned(), words);
    }
    let most = units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(pulses.walk_at_most(range));
    let reason = metrics.why_unavailable(&ANGLE_RANDOM_WALK);
    if let Some(reason) = reason.filter(|_| most.is_finite()) {
        let reason = format!(
            "{reason}; it is {} {} at most",
            plain(to_digits(most, 2)),
            ANGLE_RANDOM_WALK.unit
        );
        metrics.miss(&ANGLE_RANDOM_WALK, reason.clone());
        metrics
            .pulse_words
            .insert(ANGLE_RANDOM_WALK.name.to_owned(), reason);
    }
}

fn put_quantisation(estimate: Estimate, step_arcsec: f64, metrics: &mut ChannelMetrics) {
    let metric = metrics.put(&QUANTISATION, estimate);
    metric.fields.insert(STEP, step_arcsec);
}
