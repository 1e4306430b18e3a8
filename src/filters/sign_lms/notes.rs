//! What must be said of a line enhancer before it runs.

use super::core::{sign_lms_slew_per_sample, sign_lms_slew_samples};
use super::settings::SignLmsFilterConfig;
use crate::filters::settings::ExpectedWords;
use crate::vocabulary::{InitialWeights, SignLmsForm};

/// A step above this multiple of the noise of a word makes the output of the sign form noisier than
/// the filter makes it quieter: its excess noise is 0.627 mu' sigma.
const NOISY_STEP_RATIO: f64 = 1.5;

/// The unit of the constants, and warnings of a step that is too small for the record or too large
/// for the noise.
pub(super) fn notes(config: &SignLmsFilterConfig, words: &ExpectedWords) -> Vec<String> {
    let mut notes = vec![unit_note(config)];
    let Some(run) = words.run.filter(|_| config.form == SignLmsForm::Sign) else {
        return notes;
    };
    let filter = config.on_words();
    let rate = run.rate_max_deg_per_h;
    let needed_s = sign_lms_slew_samples(&filter, rate) / words.sample_rate_hz;
    let available_s = run.warm_up_s + run.duration_s;
    if config.initial_weights == InitialWeights::Zero && needed_s > run.warm_up_s {
        let verdict = if needed_s > available_s {
            "the record ends before"
        } else {
            "it is still climbing when the record begins"
        };
        notes.push(format!(
            "from zero weights the sign form climbs by at most its step a sample \
             and needs {needed_s:.3} s to reach 99 % of {rate:.3} deg/h; warm-up {:.3} s, warm-up \
             and record {available_s:.3} s: {verdict}; use initial_weights = \"mean\" or a larger \
             step",
            run.warm_up_s
        ));
    }
    let slew = sign_lms_slew_per_sample(&filter, rate);
    let noise = run.noise_std_deg_per_h;
    if slew > NOISY_STEP_RATIO * noise {
        notes.push(format!(
            "the step moves the output by {slew:.4} deg/h a sample at \
             {rate:.3} deg/h, above {NOISY_STEP_RATIO} times the noise of a word, {noise:.4} deg/h: \
             the output will be noisier, not quieter"
        ));
    }
    notes
}

/// The constants with the unit in which they are meant, and in that of the words; the delay.
fn unit_note(config: &SignLmsFilterConfig) -> String {
    let unit = config.unit;
    let filter = config.on_words();
    let (step, converted) = match config.form {
        SignLmsForm::Sign => (
            format!("{:?} {unit}", config.step),
            format!(
                "step {:.4e} deg/h, regularisation {:.4e} (deg/h)^2",
                filter.step, filter.regularisation
            ),
        ),
        SignLmsForm::Nlms | SignLmsForm::UnityGain => (
            format!("{:?}", config.step),
            format!("regularisation {:.4e} (deg/h)^2", filter.regularisation),
        ),
    };
    format!(
        "step = {step} and regularisation = {:?} ({unit})^2 are {converted}; \
         delay of the converged filter {:.1} samples, the register not counted",
        config.regularisation,
        f64::from(config.delay_samples) + 0.5 * (f64::from(config.taps) - 1.0)
    )
}
