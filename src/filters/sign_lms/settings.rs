//! Keys of a line enhancer, their checks, and the filters they stand for.

use super::core::{SignLms, SignLmsConfig};
use super::notes;
use crate::declare::table;
use crate::filters::common::{Complaints, Filter};
use crate::filters::hardware::{self, PipelineSettings};
use crate::filters::kind::{Condition, ExpectedWords, FilterSettings};
use crate::filters::words::{FixedWords, HardwareWords, SignLmsWords};
use crate::units::{deg_per_s_to_deg_per_h, rad_per_s_to_deg_per_h};
use crate::vocabulary::{
    ConstantUnit, InitialWeights, OutputRegister, Pipeline, SignLmsForm, WordFormat,
};

/// Step at and beyond which the normalised forms are unstable in any input.
const NORMALISED_STEP_BOUND: f64 = 2.0;

table! {
    /// Line enhancer of patent CN101221046: weights on delayed samples, moved by the sign of the error.
    /// Step and regularisation mean something only together with the unit of the words (`unit`).
    pub struct SignLmsFilterConfig {
        /// Number of weights M. Source of the default: the patent.
        taps: u32 = 20, in 1..=64;
        /// Age of the newest weighed sample, at which the noise is no longer that of the newest. Source of
        /// the default: the patent.
        delay_samples: u32 = 15, in 1..=64;
        /// What the weights are corrected by: the sign of the error (equation 34), the error (33), or the
        /// error with the sum of the weights left alone. Source of the default: the patent.
        form: SignLmsForm = "sign";
        /// Step mu: in the unit below in the sign form, whose output moves by at most this per sample; else
        /// without unit and below 2. Source of the default: the patent, which states no unit.
        step: f64 = 0.005, in 1e-24..=1e9;
        /// Regularisation alpha, in the square of the unit below. Source of the default: the patent, which
        /// states no unit.
        regularisation: f64 = 0.0001, in 1e-24..=1e12;
        /// Unit of the words in which step and regularisation are meant. Source of the default: derived; the
        /// patent prints rates in deg/s, in which a step of 0.005 makes the output of a fine gyro noisier.
        unit: ConstantUnit = "deg/h";
        /// Weights at the start: 1/M in every tap (DC gain 1) or zero. Source of the default: derived; the
        /// patent does not say, and from zero the sign form climbs to a rate by one step a sample.
        initial_weights: InitialWeights = "mean";
        /// Errors beyond this leave the weights alone, for delay_samples + taps samples on end at most, so
        /// that a change of rate, which shows as an error until it has passed the delay, does not spoil
        /// them. Ten standard deviations of the noise of a word are a good value, which only the gyro can
        /// tell: no guard without the key.
        guard_deg_per_h: Option<f64>, example 190.0, in 1e-6..=1e9, "deg/h";
        /// Samples between two fresh sums of the recursive norm, at least the number of weights; 0 = never,
        /// as in the patent. Source of the default: derived; the recursion keeps every rounding, in binary32
        /// more than the norm itself once the table has come to rest.
        norm_recompute_samples: u32 = 1000, in 0..=1_000_000;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
        /// Arithmetic: the recursion of the books, or the pipeline of the hardware with its bits and clocks
        /// (not for form = "unity-gain").
        pipeline: Pipeline = "textbook";
        /// Words of the hardware; -ftz flushes subnormal numbers to zero, "fixed" has a table of its own. This
        /// key and those below only matter with pipeline = "fpga". Source of the default: that of the other
        /// filters.
        number_format: WordFormat = "binary64";
        /// Clock of the hardware. Source of the default: that of the other filters.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
        fixed: Option<SignLmsWords>;
    }
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

impl SignLmsFilterConfig {
    /// The words of its table, or those of the reference.
    fn words(&self) -> FixedWords {
        let table = self.fixed.as_ref();
        table.map_or_else(
            || SignLmsWords::reference().resolved(),
            SignLmsWords::resolved,
        )
    }
}

impl FilterSettings for SignLmsFilterConfig {
    fn conditions() -> &'static [Condition<Self>] {
        const {
            &[
                Condition::hardware("number_format"),
                Condition::hardware("clock_mhz"),
                Condition {
                    key: "norm_recompute_samples",
                    needs: "the recursive norm of fixed-point words is exact; another number_format",
                    acts: |settings| {
                        !matches!(settings.hardware(), Some(PipelineSettings::Fixed(_)))
                    },
                },
                Condition::fixed(),
            ]
        }
    }

    fn check(&self, complaints: &mut Complaints) {
        if self.form != SignLmsForm::Sign && self.step >= NORMALISED_STEP_BOUND {
            complaints.key("step", &format!(
                "= {:?} is unstable: the step of the normalised forms has no unit and must be in \
                 (0, {NORMALISED_STEP_BOUND})",
                self.step
            ),
        );
        }
        if let Some(PipelineSettings::Fixed(_)) = self.hardware() {
            self.words().check(complaints);
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
        let mut notes = notes::notes(self, words);
        if let Some(PipelineSettings::Fixed(_)) = self.hardware() {
            notes.extend(self.words().notes(words.peak_deg_per_h));
        }
        notes
    }

    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        Some(Box::new(SignLms::new(&self.on_words())))
    }

    fn hardware(&self) -> Option<PipelineSettings> {
        let words = HardwareWords::of(self.number_format, || self.words());
        (self.pipeline == Pipeline::Fpga).then(|| hardware::sign_lms(self, &words))
    }

    fn fixed_words(&self) -> Option<FixedWords> {
        (self.form != SignLmsForm::UnityGain).then(|| self.words())
    }

    fn hardware_on(&self, words: &HardwareWords) -> Option<PipelineSettings> {
        (self.form != SignLmsForm::UnityGain).then(|| hardware::sign_lms(self, words))
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
