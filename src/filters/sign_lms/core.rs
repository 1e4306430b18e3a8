//! The line enhancer of patent CN101221046: least mean squares behind a delay that parts the signal
//! from its noise, with the sign of the error instead of the error.
//!
//! ```text
//!  x(n) ──┬──────────────────────────────────> d(n) = x(n) ──(+)──> e = d - y
//!         └─> delay ─> x(n-D) .. x(n-D-M+1) ─> w'x = y ───────┘
//! ```

use std::cmp::Ordering;

use crate::filters::common::{Core, CoreFilter, Fault, FrontEndConfig, Output};
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister, SignLmsForm};

/// Settings of a line enhancer, in the unit of its words.
#[derive(Clone, Debug, PartialEq)]
pub struct SignLmsConfig {
    /// Number of weights M, >= 1.
    pub taps: usize,
    /// Decorrelation delay D: age of the newest weighed sample, samples, >= 1.
    pub delay_samples: usize,
    /// How the weights are corrected.
    pub form: SignLmsForm,
    /// Step mu, > 0: in the unit of the words for [`SignLmsForm::Sign`], else without unit.
    pub step: f64,
    /// Regularisation alpha, > 0, in the square of the words' unit.
    pub regularisation: f64,
    /// Weight that every tap starts with.
    pub initial_weight: f64,
    /// Errors beyond this, in the unit of the words, leave the weights alone, for D + M samples
    /// on end at most: so long a change of rate takes to pass through delay and taps. An error that
    /// stays is one of the weights, which then are corrected again.
    pub guard: Option<f64>,
    /// Samples between two fresh sums of the norm, at least `taps`; 0 = never.
    pub norm_recompute_samples: u64,
    /// When the result appears.
    pub output_register: OutputRegister,
}

impl SignLmsConfig {
    /// Delay line, desired signal and register.
    #[must_use]
    pub fn front_end(&self) -> FrontEndConfig {
        FrontEndConfig {
            desired: DesiredSignal::Current,
            input_lag_samples: self.delay_samples,
            output_register: self.output_register,
        }
    }
}

/// A line enhancer behind its delay.
pub type SignLms = CoreFilter<SignLmsCore>;

impl SignLms {
    /// A filter in its initial state: all samples before the first are zero.
    ///
    /// # Panics
    /// As [`SignLmsCore::new`].
    #[must_use]
    pub fn new(config: &SignLmsConfig) -> Self {
        Self::with_core(SignLmsCore::new(config), &config.front_end())
    }
}

/// Weights and the recursive norm.
///
/// In this order, each operation rounded on its own, tap 0 (the newest weighed sample) first:
///
/// ```text
/// S    = (S + x(n-D)^2) - x(n-D-M)^2, at least 0               (35)
/// y    = ((0 + x_0 w_0) + x_1 w_1) + ...                       (25)
/// e    = d - y                                                 (26)
/// g    = mu / (alpha + S), times sgn(e) or e; 0 while the guard holds
/// w_j  = w_j + x_j g                                           (33), (34)
/// ```
///
/// The recursive norm never forgets a rounding: after 1e5 samples at 50 deg/s (S = 5e4 in (deg/s)^2)
/// and as many at rest, an independent simulation in binary64 held 3.044275e-4 for a true
/// 3.04427e-4, in binary32 0.339. Every
/// `norm_recompute_samples` it is therefore replaced by a sum of the newest M squares, which is
/// gathered during the M samples before, one addition in each.
///
/// # Source
/// Patent CN101221046, equations (25)-(36), numbered as there; (29)-(35) are images in its text and
/// were restored from their description. The unity-gain form is derived.
///
/// Checked by `patent_filter`, and by the hardware pipeline, which has the same words.
#[derive(Clone, Debug)]
pub struct SignLmsCore {
    config: SignLmsConfig,
    weights: Vec<f64>,
    norm: RecursiveNorm,
    /// Samples on end that the guard has held the weights.
    held_samples: usize,
}

impl SignLmsCore {
    /// The initial state.
    ///
    /// # Panics
    /// If there are no taps, or the norm is to be summed afresh in less time than it takes; the
    /// scenario reader refuses both.
    #[must_use]
    pub fn new(config: &SignLmsConfig) -> Self {
        assert!(config.taps > 0, "a filter has at least one tap");
        Self {
            weights: vec![config.initial_weight; config.taps],
            norm: RecursiveNorm::new(config.taps, config.norm_recompute_samples),
            config: config.clone(),
            held_samples: 0,
        }
    }

    /// The energy in the taps, `|x|^2`, as the recursion holds it.
    #[must_use]
    pub fn norm(&self) -> f64 {
        self.norm.value
    }

    /// Whether the guard holds the weights in this sample.
    fn is_held(&mut self, error: f64) -> bool {
        // Not "greater than": an error that is not a number counts as beyond the guard.
        let is_beyond = self.config.guard.is_some_and(|guard| {
            let ordering = error.abs().partial_cmp(&guard);
            !ordering.is_some_and(Ordering::is_le)
        });
        let is_held = is_beyond && self.held_samples < self.config.delay_samples + self.config.taps;
        self.held_samples = match (is_beyond, is_held) {
            (false, _) => 0,
            (true, true) => self.held_samples + 1,
            (true, false) => self.held_samples,
        };
        is_held
    }

    /// What the taps are multiplied by before they are added to the weights.
    fn gain(&mut self, error: f64) -> f64 {
        if self.is_held(error) {
            return 0.0;
        }
        let step = self.config.step / (self.config.regularisation + self.norm.value);
        match self.config.form {
            SignLmsForm::Sign if error > 0.0 => step,
            SignLmsForm::Sign if error < 0.0 => -step,
            SignLmsForm::Sign => 0.0,
            SignLmsForm::Nlms | SignLmsForm::UnityGain => error * step,
        }
    }
}

impl Core for SignLmsCore {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let (taps, leaving) = regressors.split_at(self.config.taps);
        self.norm.slide(taps[0], leaving[0]);
        let mut value = 0.0;
        for (tap, weight) in taps.iter().zip(&self.weights) {
            value += tap * weight;
        }
        let output = Output {
            value_deg_per_h: value,
            weight_sum: self.weights.iter().sum(),
        };
        let gain = self.gain(desired - value);
        let mean = match self.config.form {
            SignLmsForm::UnityGain => taps.iter().sum::<f64>() / taps.len() as f64,
            SignLmsForm::Sign | SignLmsForm::Nlms => 0.0,
        };
        for (weight, tap) in self.weights.iter_mut().zip(taps) {
            *weight += (tap - mean) * gain;
        }
        Ok(output)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The taps and the sample that has just left them.
    fn regressors(&self) -> usize {
        self.config.taps + 1
    }

    fn rule(&self, desired: DesiredSignal) -> WeightRule {
        WeightRule::Adaptive {
            desired_weights: desired.weights().to_vec(),
            is_dc_gain_one: self.config.form == SignLmsForm::UnityGain,
            forgetting_factor: None,
        }
    }
}

/// Sum of squares of a window that slides by one sample at a time.
#[derive(Clone, Debug)]
struct RecursiveNorm {
    value: f64,
    /// Sum that replaces it when it is complete.
    fresh: f64,
    taps: u64,
    interval: u64,
    /// Samples since the last replacement.
    age: u64,
}

impl RecursiveNorm {
    fn new(taps: usize, interval: u64) -> Self {
        let taps = taps as u64;
        assert!(
            interval == 0 || interval >= taps,
            "a fresh sum takes as many samples as there are taps"
        );
        Self {
            value: 0.0,
            fresh: 0.0,
            taps,
            interval,
            age: 0,
        }
    }

    fn slide(&mut self, entering: f64, leaving: f64) {
        let square = entering * entering;
        self.value = (self.value + square) - leaving * leaving;
        if self.value < 0.0 {
            self.value = 0.0;
        }
        if self.interval == 0 {
            return;
        }
        if self.age + self.taps >= self.interval {
            let is_first = self.age + self.taps == self.interval;
            self.fresh = if is_first { 0.0 } else { self.fresh } + square;
        }
        self.age += 1;
        if self.age == self.interval {
            self.value = self.fresh;
            self.age = 0;
        }
    }
}

/// Samples until a filter that starts from zero weights has reached 99 % of a constant rate, sign
/// form: `0.99 s / mu' + 1 + D` with `mu' = mu S / (alpha + S)` and `S = M s^2`.
///
/// The sign of the error, all that the update sees, moves the output by mu' per sample.
///
/// * `rate`: s, and with it mu (`config.step`) and alpha, in the unit of the words.
///
/// # Source
/// Derived; `patent_slew_law_of_the_sign_form` measures it.
#[must_use]
pub fn sign_lms_slew_samples(config: &SignLmsConfig, rate: f64) -> f64 {
    let rate = rate.abs();
    let fraction = 0.99;
    fraction * rate / sign_lms_slew_per_sample(config, rate) + 1.0 + config.delay_samples as f64
}

/// Largest change of the output per sample at a constant rate, sign form: `mu S / (alpha + S)`.
///
/// * `rate`: as above. Returns the unit of the words.
#[must_use]
pub fn sign_lms_slew_per_sample(config: &SignLmsConfig, rate: f64) -> f64 {
    let energy = config.taps as f64 * rate * rate;
    config.step * energy / (config.regularisation + energy)
}
