//! Forgetting factors from temperature steps, and the weights they leave to the groups.

use super::error::CalibrationError;
use crate::vocabulary::ForgettingForm;

/// Least forgetting factor: what a group behind a large temperature step keeps.
///
/// F1 would become negative beyond `c dT = 1`, and factors near zero leave too few groups of weight.
pub const FORGETTING_FACTOR_MIN: f64 = 1e-3;

/// The forgetting factor of each group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Forgetting {
    /// The same factor for every group, in `(0, 1]`; 1 forgets nothing.
    Constant(f64),
    /// From the temperature step to the group.
    Temperature {
        /// Form of the law.
        form: ForgettingForm,
        /// The constant c, 1/K, >= 0.
        constant_per_k: f64,
    },
}

/// Where equation (15) puts the factor; the printed equation is an image that is lost.
///
/// Equation (14) updates the information `P^-1` by `P^-1 <- lambda (P^-1 + a^T a / mu)`. With
/// `lambda = mu = sigma` this is `sigma P^-1 + a^T a`: old groups lose weight by sigma, the new one
/// counts in full, and group i ends with the product of all later factors. The other readings are kept
/// for comparison. R2 gives a group at steady temperature no weight at all; R3 raises the weight of
/// groups taken while the temperature moves, opposite to the stated aim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reading {
    /// R1: `lambda = mu = sigma`; `P^-1 <- sigma P^-1 + a^T a`. Row weight `prod_{l>i} sigma_l`.
    #[default]
    Discount,
    /// R2: `P^-1 <- sigma P^-1 + (1 - sigma) a^T a`: no weight to a group without temperature step.
    Convex,
    /// R3: `lambda = 1`, `mu = sigma`: row weight `1 / sigma_i`, more for groups in motion of T.
    RowWeight,
}

impl Forgetting {
    /// Checks the constants.
    ///
    /// # Errors
    /// [`CalibrationError::BadSetting`] if a constant is out of its range.
    pub fn check(&self) -> Result<(), CalibrationError> {
        let (name, value, sound, expected) = match *self {
            Self::Constant(factor) => (
                "forgetting_factor",
                factor,
                factor > 0.0 && factor <= 1.0,
                "0 < factor <= 1",
            ),
            Self::Temperature { constant_per_k, .. } => (
                "forgetting_constant_per_k",
                constant_per_k,
                constant_per_k >= 0.0 && constant_per_k.is_finite(),
                ">= 0 1/K",
            ),
        };
        if sound {
            return Ok(());
        }
        Err(CalibrationError::BadSetting {
            name,
            value,
            expected,
        })
    }

    /// Factors `sigma_1..sigma_n` for temperatures `T_1..T_n` of one gyro after `T_0`, deg C.
    ///
    /// Held to [`FORGETTING_FACTOR_MIN`] and above.
    #[must_use]
    pub fn factors(&self, initial_temperature_c: f64, temperature_c: &[f64]) -> Vec<f64> {
        let before = std::iter::once(&initial_temperature_c).chain(temperature_c);
        let steps = before
            .zip(temperature_c)
            .map(|(old, new)| (new - old).abs());
        steps.map(|step_k| self.factor(step_k)).collect()
    }

    /// `sigma` for a step of the temperature, K.
    fn factor(&self, step_k: f64) -> f64 {
        let factor = match *self {
            Self::Constant(factor) => factor,
            Self::Temperature {
                form,
                constant_per_k,
            } => {
                let step = constant_per_k * step_k;
                match form {
                    ForgettingForm::Linear => 1.0 - step,
                    ForgettingForm::Exponential => (-step).exp(),
                    ForgettingForm::Rational => 1.0 / (1.0 + step),
                    ForgettingForm::Gaussian => (-step * step).exp(),
                }
            }
        };
        factor.max(FORGETTING_FACTOR_MIN)
    }
}

impl Reading {
    /// `(lambda, w)` of the update `P^-1 <- lambda P^-1 + w a^T a` for a factor sigma.
    #[must_use]
    pub fn update(self, factor: f64) -> (f64, f64) {
        match self {
            Self::Discount => (factor, 1.0),
            Self::Convex => (factor, 1.0 - factor),
            Self::RowWeight => (1.0, 1.0 / factor),
        }
    }

    /// Weights that the groups are left with after the last, `[groups]`.
    #[must_use]
    pub fn weights(self, factors: &[f64]) -> Vec<f64> {
        let mut discount = 1.0;
        let mut weights: Vec<f64> = factors
            .iter()
            .rev()
            .map(|factor| {
                let (lambda, weight) = self.update(*factor);
                let left = discount * weight;
                discount *= lambda;
                left
            })
            .collect();
        weights.reverse();
        weights
    }
}
