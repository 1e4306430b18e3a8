//! Least mean squares, plain and normalised.

use super::core_filter::{Core, CoreFilter, dot};
use super::divergence::Fault;
use super::filter::Output;
use super::front_end::FrontEndConfig;
use crate::vocabulary::UpdateSign;

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
