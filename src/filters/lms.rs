//! Least mean squares, plain and normalised.

use super::common::lanes::{self, Lanes, Turns};
use super::common::{Complaints, Core, CoreFilter, Fault, Filter, FrontEndConfig, Output};
use super::hardware::{self, PipelineSettings};
use super::kind::{Condition, ExpectedWords, FilterSettings};
use crate::declare::table;
use crate::vocabulary::{DesiredSignal, NumberFormat, OutputRegister, Pipeline, UpdateSign};

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
        /// Words of the hardware; -ftz flushes subnormal numbers to zero. This key and those below only
        /// matter with pipeline = "fpga". Source of the default: the paper's double precision.
        number_format: NumberFormat = "binary64";
        /// Clock of the hardware. Source of the default: the paper.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
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
            ]
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
        (self.pipeline == Pipeline::Fpga).then(|| hardware::lms(self))
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

impl Normalisation {
    /// Step along the regressors. The division by their energy does not wait for the error.
    #[inline(always)]
    fn step(self, signed_step_size: f64, energy: f64, error: f64) -> f64 {
        let Self::Energy {
            regularisation_deg2_per_h2: epsilon,
        } = self
        else {
            return signed_step_size * error;
        };
        let energy = epsilon + energy;
        let gain = signed_step_size / energy;
        if energy > 0.0 && gain.is_finite() {
            gain * error
        } else if energy > 0.0 {
            signed_step_size * error / energy
        } else {
            // Silent taps without regularisation: there is nothing to learn from.
            0.0
        }
    }
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
/// Computed looking ahead: with V the weights before the newest update, M its regressors and s its step,
///
/// ```text
/// y = V'L + s M'L
/// ```
///
/// is the same prediction, in which all but a product and a sum is known before s is. A sample then waits
/// for the one before for a quarter of the time.
///
/// # Source
/// Widrow and Hoff's rule, the paper's equation (9) with the sign that converges; the normalised
/// form is that of Haykin, Adaptive Filter Theory. Checked by
/// `normalised_lms_learns_the_mean_of_two_samples`, and against the equations as they are printed by
/// `looking_ahead_changes_no_word`.
#[derive(Clone, Debug)]
pub struct LmsCore {
    taps: usize,
    /// W, and behind it L of the newest update.
    states: Turns,
    /// Step of the newest update.
    step: f64,
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
        let zeros = vec![Lanes::ZERO; 2 * lanes::blocks(config.taps)];
        Self {
            taps: config.taps,
            states: Turns::new(zeros),
            step: 0.0,
            signed_step_size: config.update_sign.factor() * config.step_size,
            normalisation: config.normalisation,
        }
    }

    /// An update of a filter of that many blocks of lanes: a constant where it is called, so that no loop
    /// is left.
    #[inline(always)]
    fn update_blocks(
        &mut self,
        taps: usize,
        blocks: usize,
        regressors: &[f64],
        desired: f64,
    ) -> Output {
        let regressors = &regressors[..taps];
        let (newest, older) = self.states.newest_and_older();
        let (weights, before) = newest[..2 * blocks].split_at(blocks);
        let (older, now) = older[..2 * blocks].split_at_mut(blocks);
        let [mut ahead, mut common, mut energy, mut weight_sum] = [Lanes::ZERO; 4];
        for (block, now) in now.iter_mut().enumerate() {
            let lanes = lanes::block(regressors, block);
            ahead += older[block] * lanes;
            common += before[block] * lanes;
            energy += lanes * lanes;
            weight_sum += weights[block];
            *now = lanes;
        }
        let output = Output {
            value_deg_per_h: lanes::sum(ahead) + self.step * lanes::sum(common),
            weight_sum: lanes::sum(weight_sum),
        };
        let error = desired - output.value_deg_per_h;
        let energy = lanes::sum(energy);
        self.step = self
            .normalisation
            .step(self.signed_step_size, energy, error);
        let step = Lanes::splat(self.step);
        for ((older, weights), now) in older.iter_mut().zip(weights).zip(now.iter()) {
            *older = *weights + step * *now;
        }
        self.states.turn();
        output
    }
}

impl Core for LmsCore {
    #[inline(always)]
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let taps = self.taps;
        Ok(match (taps, lanes::blocks(taps)) {
            (10, _) => self.update_blocks(10, 3, regressors, desired), // that of the paper
            (_, 1) => self.update_blocks(taps, 1, regressors, desired),
            (_, 2) => self.update_blocks(taps, 2, regressors, desired),
            (_, 3) => self.update_blocks(taps, 3, regressors, desired),
            (_, 4) => self.update_blocks(taps, 4, regressors, desired),
            (_, blocks) => self.update_blocks(taps, blocks, regressors, desired),
        })
    }

    fn reads_blocks(&self) -> bool {
        true
    }

    fn weights(&self) -> &[f64] {
        &lanes::numbers(self.states.newest())[..self.taps]
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
