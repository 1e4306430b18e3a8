//! Line enhancers from their configuration, and what must be said of them before they run.

use crate::filters::{SignLmsConfig, sign_lms_slew_per_sample, sign_lms_slew_samples};
use crate::scenario::SignLmsFilterConfig;
use crate::units::{deg_per_s_to_deg_per_h, rad_per_s_to_deg_per_h};
use crate::vocabulary::{ConstantUnit, InitialWeights, SignLmsForm};

/// A step above this multiple of the noise of a word makes the output of the sign form noisier than
/// the filter makes it quieter: its excess noise is 0.627 mu' sigma.
const NOISY_STEP_RATIO: f64 = 1.5;

/// What a line enhancer will meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Situation {
    /// Largest rate on the axis, deg/h.
    pub(super) rate_max_deg_per_h: f64,
    /// White noise of a word, deg/h.
    pub(super) noise_std_deg_per_h: f64,
    /// Words per second, Hz.
    pub(super) output_rate_hz: f64,
    /// Before the record, s.
    pub(super) warm_up_s: f64,
    /// The record, s.
    pub(super) duration_s: f64,
}

/// Value of one unit of the constants in deg/h.
pub(super) fn unit_deg_per_h(unit: ConstantUnit) -> f64 {
    match unit {
        ConstantUnit::DegPerH => 1.0,
        ConstantUnit::DegPerS => deg_per_s_to_deg_per_h(1.0),
        ConstantUnit::RadPerS => rad_per_s_to_deg_per_h(1.0),
    }
}

/// The filter on words in deg/h: constants converted from the unit in which they are meant.
pub(super) fn sign_lms(config: &SignLmsFilterConfig) -> SignLmsConfig {
    let unit = unit_deg_per_h(config.unit);
    let taps = config.taps as usize;
    SignLmsConfig {
        taps,
        delay_samples: config.delay_samples as usize,
        form: config.form,
        step: match config.form {
            SignLmsForm::Sign => config.step * unit,
            SignLmsForm::Nlms | SignLmsForm::UnityGain => config.step,
        },
        regularisation: config.regularisation * unit * unit,
        initial_weight: match config.initial_weights {
            InitialWeights::Mean => 1.0 / f64::from(config.taps),
            InitialWeights::Zero => 0.0,
        },
        guard: config.guard_deg_per_h,
        norm_recompute_samples: u64::from(config.norm_recompute_samples),
        output_register: config.output_register,
    }
}

/// The unit of the constants, and warnings of a step that is too small for the record or too large
/// for the noise.
pub(super) fn notes(name: &str, config: &SignLmsFilterConfig, met: Situation) -> Vec<String> {
    let mut notes = vec![unit_note(name, config)];
    if config.form != SignLmsForm::Sign {
        return notes;
    }
    let filter = sign_lms(config);
    let rate = met.rate_max_deg_per_h;
    let needed_s = sign_lms_slew_samples(&filter, rate) / met.output_rate_hz;
    let available_s = met.warm_up_s + met.duration_s;
    if config.initial_weights == InitialWeights::Zero && needed_s > met.warm_up_s {
        let verdict = if needed_s > available_s {
            "the record ends before"
        } else {
            "it is still climbing when the record begins"
        };
        notes.push(format!(
            "filter `{name}`: from zero weights the sign form climbs by at most its step a sample \
             and needs {needed_s:.3} s to reach 99 % of {rate:.3} deg/h; warm-up {:.3} s, warm-up \
             and record {available_s:.3} s: {verdict}; use initial_weights = \"mean\" or a larger \
             step",
            met.warm_up_s
        ));
    }
    let slew = sign_lms_slew_per_sample(&filter, rate);
    let noise = met.noise_std_deg_per_h;
    if slew > NOISY_STEP_RATIO * noise {
        notes.push(format!(
            "filter `{name}`: the step moves the output by {slew:.4} deg/h a sample at \
             {rate:.3} deg/h, above {NOISY_STEP_RATIO} times the noise of a word, {noise:.4} deg/h: \
             the output will be noisier, not quieter"
        ));
    }
    notes
}

/// The constants with the unit in which they are meant, and in that of the words; the delay.
pub(super) fn unit_note(name: &str, config: &SignLmsFilterConfig) -> String {
    let unit = config.unit;
    let filter = sign_lms(config);
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
        "filter `{name}`: step = {step} and regularisation = {:?} ({unit})^2 are {converted}; \
         delay of the converged filter {:.1} samples, the register not counted",
        config.regularisation,
        f64::from(config.delay_samples) + 0.5 * (f64::from(config.taps) - 1.0)
    )
}
