//! Keys of a line enhancer, their checks, and the filters they stand for.

use serde::Deserialize;

use super::core::{SignLms, SignLmsConfig};
use super::notes;
use crate::filters::common::{Complaints, Filter};
use crate::filters::hardware::{self, PipelineSettings};
use crate::filters::kind::{ExpectedWords, FilterSettings};
use crate::units::{deg_per_s_to_deg_per_h, rad_per_s_to_deg_per_h};
use crate::vocabulary::{
    ConstantUnit, InitialWeights, NumberFormat, OutputRegister, Pipeline, SignLmsForm,
};

/// Step at and beyond which the normalised forms are unstable in any input.
const NORMALISED_STEP_BOUND: f64 = 2.0;

/// Line enhancer of patent CN101221046.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SignLmsFilterConfig {
    /// Number of weights M.
    pub taps: u32,
    /// Age of the newest weighed sample, samples.
    pub delay_samples: u32,
    /// How the weights are corrected.
    pub form: SignLmsForm,
    /// Step mu: in `unit` in the sign form, else without unit.
    pub step: f64,
    /// Regularisation alpha, in the square of `unit`.
    pub regularisation: f64,
    /// Unit of the words in which step and regularisation are meant.
    pub unit: ConstantUnit,
    /// Weights at the start.
    pub initial_weights: InitialWeights,
    /// Errors beyond this leave the weights alone for at most a delay and a filter length, deg/h.
    pub guard_deg_per_h: Option<f64>,
    /// Samples between two fresh sums of the norm; 0 = never.
    pub norm_recompute_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Arithmetic.
    pub pipeline: Pipeline,
    /// Words of the hardware.
    pub number_format: NumberFormat,
    /// Clock of the hardware, MHz.
    pub clock_mhz: f64,
}

impl SignLmsFilterConfig {
    /// The filter on words in deg/h: constants converted from the unit in which they are meant.
    #[must_use]
    pub fn on_words(&self) -> SignLmsConfig {
        let unit = unit_deg_per_h(self.unit);
        let taps = self.taps as usize;
        SignLmsConfig {
            taps,
            delay_samples: self.delay_samples as usize,
            form: self.form,
            step: match self.form {
                SignLmsForm::Sign => self.step * unit,
                SignLmsForm::Nlms | SignLmsForm::UnityGain => self.step,
            },
            regularisation: self.regularisation * unit * unit,
            initial_weight: match self.initial_weights {
                InitialWeights::Mean => 1.0 / f64::from(self.taps),
                InitialWeights::Zero => 0.0,
            },
            guard: self.guard_deg_per_h,
            norm_recompute_samples: u64::from(self.norm_recompute_samples),
            output_register: self.output_register,
        }
    }
}

impl FilterSettings for SignLmsFilterConfig {
    fn check(&self, complaints: &mut Complaints) {
        if self.form != SignLmsForm::Sign && self.step >= NORMALISED_STEP_BOUND {
            complaints.key("step", &format!(
                "= {:?} is unstable: the step of the normalised forms has no unit and must be in \
                 (0, {NORMALISED_STEP_BOUND})",
                self.step
            ),
        );
        }
        let recompute = self.norm_recompute_samples;
        if recompute != 0 && recompute < self.taps {
            complaints.key(
                "norm_recompute_samples",
                &format!(
                    "= {recompute} is too short: a fresh sum takes taps = {} samples; allowed 0 or \
                 {} and more",
                    self.taps, self.taps
                ),
            );
        }
        if self.form == SignLmsForm::UnityGain {
            if self.pipeline == Pipeline::Fpga {
                complaints.key(
                    "pipeline",
                    "= \"fpga\" has no form \"unity-gain\": use form = \"sign\" or \"nlms\", or \
                 pipeline = \"textbook\"",
                );
            }
            if self.initial_weights == InitialWeights::Zero {
                complaints.key("initial_weights", "= \"zero\" has the sum 0, which form = \"unity-gain\" would hold for ever: use \
                 \"mean\"");
            }
        }
    }

    fn notes(&self, words: &ExpectedWords) -> Vec<String> {
        notes::notes(self, words)
    }

    fn build(&self, _sample_period_s: f64) -> Box<dyn Filter> {
        Box::new(SignLms::new(&self.on_words()))
    }

    fn hardware(&self) -> Option<PipelineSettings> {
        (self.pipeline == Pipeline::Fpga).then(|| hardware::sign_lms(self))
    }
}

/// Value of one unit of the constants in deg/h.
fn unit_deg_per_h(unit: ConstantUnit) -> f64 {
    match unit {
        ConstantUnit::DegPerH => 1.0,
        ConstantUnit::DegPerS => deg_per_s_to_deg_per_h(1.0),
        ConstantUnit::RadPerS => rad_per_s_to_deg_per_h(1.0),
    }
}
