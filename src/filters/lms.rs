//! Least mean squares, plain and normalised.

use super::common::{Complaints, Core, CoreFilter, Fault, Filter, FrontEndConfig, Output, dot};
use super::hardware::{self, PipelineSettings};
use super::kind::{Condition, ExpectedWords, FilterSettings};
use super::words::{FixedWords, HardwareWords, LmsWords, refuse_as_printed};
use crate::declare::table;
use crate::vocabulary::{DesiredSignal, OutputRegister, Pipeline, UpdateSign, WordFormat};

table! {
    /// Least mean squares, normalised or not.
    pub struct LmsFilterConfig {
        /// Number of weights N. Source of the default: the paper.
        taps: u32 = 10, in 1..=64;
        /// Step size mu; without normalisation in (deg/h)^-2. Source of the default: the paper.
        step_size: f64 = 0.8, in 1e-24..=2.0;
        /// Whether the step is divided by the energy of the input. Source of the default: a step of 0.8 is
        /// only stable so.
        normalised: bool = true;
        /// Added to the energy in the normalised form. Source of the default: assumed.
        regularisation_deg2_per_h2: f64 = 1.0, in 0.0..=1e12, "(deg/h)^2";
        /// Run an un-normalised step beyond its stability bound.
        allow_unstable: bool = false;
        /// What the filter aims at. Source of the default: the paper.
        desired: DesiredSignal = "two-sample-mean";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 0, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
        /// Sign before the error term of the weight update.
        update_sign: UpdateSign = "corrected";
        /// Arithmetic: the recursion of the books, or the pipeline of the hardware with its bits and clocks.
        pipeline: Pipeline = "textbook";
        /// Words of the hardware; -ftz flushes subnormal numbers to zero, "fixed" has a table of its own. This
        /// key and those below only matter with pipeline = "fpga". Source of the default: the paper's double
        /// precision.
        number_format: WordFormat = "binary64";
        /// Clock of the hardware. Source of the default: the paper.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
        fixed: Option<LmsWords>;
    }
}

impl FilterSettings for LmsFilterConfig {
    fn conditions() -> &'static [Condition<Self>] {
        const {
            &[
                Condition {
                    key: "regularisation_deg2_per_h2",
                    needs: "normalised = true",
                    acts: |settings| settings.normalised,
                },
                Condition {
                    key: "allow_unstable",
                    needs: "normalised = false",
                    acts: |settings| !settings.normalised,
                },
                Condition::hardware("number_format"),
                Condition::hardware("clock_mhz"),
                Condition::fixed(),
            ]
        }
    }

    fn check(&self, complaints: &mut Complaints) {
        if let Some(PipelineSettings::Fixed(_)) = self.hardware() {
            self.words().check(complaints);
            refuse_as_printed(self.update_sign, complaints);
        }
    }

    fn notes(&self, words: &ExpectedWords) -> Vec<String> {
        match self.hardware() {
            Some(PipelineSettings::Fixed(_)) => self.words().notes(words.peak_deg_per_h),
            _ => Vec::new(),
        }
    }

    /// Refuses an un-normalised step that the expected motion alone makes unstable.
    fn check_on(&self, words: &ExpectedWords, complaints: &mut Complaints) {
        let Some(run) = &words.run else {
            return;
        };
        if self.normalised || self.allow_unstable {
            return;
        }
        let (taps, rate_max) = (self.taps as usize, run.rate_max_deg_per_h);
        let eigenvalue_max = match run.swing_step_rad {
            Some(phase_step_rad) => sine_eigenvalue_max(taps, rate_max, phase_step_rad, 0.0),
            None => constant_eigenvalue_max(taps, rate_max, 0.0),
        };
        let bound = lms_step_bound(eigenvalue_max);
        if self.step_size >= bound {
            let message = format!(
                "= {} is unstable: with {} taps and up to {rate_max:.4} deg/h on the axis the \
                 un-normalised step must stay below {bound:.3e} (deg/h)^-2; use normalised = true, \
                 a smaller step, or allow_unstable = true",
                self.step_size, self.taps
            );
            complaints.key("step_size", &message);
        }
    }

    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        let regularisation_deg2_per_h2 = self.regularisation_deg2_per_h2;
        Some(Box::new(Lms::new(&LmsConfig {
            taps: self.taps as usize,
            step_size: self.step_size,
            normalisation: if self.normalised {
                Normalisation::Energy {
                    regularisation_deg2_per_h2,
                }
            } else {
                Normalisation::None
            },
            update_sign: self.update_sign,
            front_end: FrontEndConfig {
                desired: self.desired,
                input_lag_samples: self.input_lag_samples as usize,
                output_register: self.output_register,
            },
        })))
    }

    fn hardware(&self) -> Option<PipelineSettings> {
        let words = HardwareWords::of(self.number_format, || self.words());
        (self.pipeline == Pipeline::Fpga).then(|| hardware::lms(self, &words))
    }

    fn fixed_words(&self) -> Option<FixedWords> {
        Some(self.words())
    }

    fn hardware_on(&self, words: &HardwareWords) -> Option<PipelineSettings> {
        Some(hardware::lms(self, words))
    }
}

impl LmsFilterConfig {
    /// The words of its table, or those of the reference.
    fn words(&self) -> FixedWords {
        let table = self.fixed.as_ref();
        table.map_or_else(|| LmsWords::reference().resolved(), LmsWords::resolved)
    }
}

/// What the step of a least-mean-squares filter is divided by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normalisation {
    /// Nothing: stable for `0 < mu < 2 / lambda_max` only, lambda_max the largest eigenvalue of
    /// the input's correlation matrix, and so dependent on the unit of the words.
    None,
    /// The energy in the taps, `epsilon + L'L`: stable for `0 < mu < 2` in any unit.
    Energy {
        /// epsilon, (deg/h)^2, >= 0; keeps the division away from 0 / 0 when the input is silent.
        regularisation_deg2_per_h2: f64,
    },
}

/// Settings of a least-mean-squares filter.
#[derive(Clone, Debug, PartialEq)]
pub struct LmsConfig {
    /// Number of weights N, >= 1.
    pub taps: usize,
    /// Step size mu: dimensionless when normalised, else (deg/h)^-2.
    pub step_size: f64,
    /// What the step is divided by.
    pub normalisation: Normalisation,
    /// Sign before the error term.
    pub update_sign: UpdateSign,
    /// Front end and output register.
    pub front_end: FrontEndConfig,
}

/// Least mean squares behind the common front end.
pub type Lms = CoreFilter<LmsCore>;

impl Lms {
    /// A filter of zero weights.
    ///
    /// # Panics
    /// As [`LmsCore::new`].
    #[must_use]
    pub fn new(config: &LmsConfig) -> Self {
        Self::with_core(LmsCore::new(config), &config.front_end)
    }
}

/// Weights W: `y = W'L`, then `W = W + mu (d - y) L`, the step divided by `epsilon + L'L` in the
/// normalised form.
///
/// # Source
/// Widrow and Hoff's rule, the paper's equation (9) with the sign that converges; the normalised
/// form is that of Haykin, Adaptive Filter Theory. Checked by
/// `normalised_lms_learns_the_mean_of_two_samples`.
#[derive(Clone, Debug)]
pub struct LmsCore {
    weights: Vec<f64>,
    signed_step_size: f64,
    normalisation: Normalisation,
}

impl LmsCore {
    /// Zero weights.
    ///
    /// # Panics
    /// If there are no taps; the scenario reader refuses that.
    #[must_use]
    pub fn new(config: &LmsConfig) -> Self {
        assert!(config.taps > 0, "a filter has at least one tap");
        Self {
            weights: vec![0.0; config.taps],
            signed_step_size: config.update_sign.factor() * config.step_size,
            normalisation: config.normalisation,
        }
    }
}

impl Core for LmsCore {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let output = Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weights.iter().sum(),
        };
        let correction = self.signed_step_size * (desired - output.value_deg_per_h);
        let step = match self.normalisation {
            Normalisation::None => correction,
            Normalisation::Energy {
                regularisation_deg2_per_h2: epsilon,
            } => {
                let energy = epsilon + dot(regressors, regressors);
                // Silent taps without regularisation: there is nothing to learn from.
                if energy > 0.0 {
                    correction / energy
                } else {
                    0.0
                }
            }
        };
        for (weight, regressor) in self.weights.iter_mut().zip(regressors) {
            *weight += step * regressor;
        }
        Ok(output)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }
}

/// Upper bound `2 / lambda_max` of the step size of un-normalised least mean squares.
///
/// * `eigenvalue_max`: largest eigenvalue of the input's correlation matrix, (deg/h)^2.
///
/// The bound is that of convergence of the mean weights. For a slow sine alone it is sharp: the
/// logarithm of `|1 - mu N A^2 sin^2|`, averaged over a cycle, changes sign at `mu = 4 / (N A^2)`.
///
/// # Source
/// Haykin, Adaptive Filter Theory, stability of the least-mean-squares algorithm; the remark on the
/// sine is derived.
#[must_use]
pub fn lms_step_bound(eigenvalue_max: f64) -> f64 {
    2.0 / eigenvalue_max
}

/// Largest eigenvalue of the correlation matrix of a sine in white noise, seen by `taps` taps.
///
/// `A^2 / 4 (N + |sin(N theta) / sin(theta)|) + s^2` with `theta` the phase step per sample; for a
/// slow swing (`N theta << 1`) that is `N A^2 / 2 + s^2`. Derived: the correlation
/// `A^2 / 2 cos((i - j) theta)` has rank 2.
///
/// * `amplitude`: A, deg/h.
/// * `phase_step_rad`: `2 pi f T`, rad.
/// * `noise_std`: s, deg/h.
///
/// Returns (deg/h)^2.
#[must_use]
pub fn sine_eigenvalue_max(
    taps: usize,
    amplitude: f64,
    phase_step_rad: f64,
    noise_std: f64,
) -> f64 {
    /// Below this `|sin|` the quotient equals N to rounding, or is 0 / 0.
    const SINE_MIN: f64 = 1e-9;
    let count = taps as f64;
    let sine = phase_step_rad.sin();
    let kernel = if sine.abs() < SINE_MIN {
        count
    } else {
        ((count * phase_step_rad).sin() / sine).abs()
    };
    amplitude * amplitude / 4.0 * (count + kernel) + noise_std * noise_std
}

/// Largest eigenvalue of the correlation matrix of a constant in white noise: `N m^2 + s^2`.
///
/// * `mean`: m, deg/h. * `noise_std`: s, deg/h.
///
/// Returns (deg/h)^2.
#[must_use]
pub fn constant_eigenvalue_max(taps: usize, mean: f64, noise_std: f64) -> f64 {
    taps as f64 * mean * mean + noise_std * noise_std
}
