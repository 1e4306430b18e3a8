//! The estimators side by side, as settings.

use super::design::TemperatureColumns;
use super::error::CalibrationError;
use super::forgetting::{Forgetting, Reading};
use crate::vocabulary::ForgettingForm;

/// Settings of the recursive estimators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecursiveSettings {
    /// How the forgetting factor of each group and gyro comes about.
    pub forgetting: Forgetting,
    /// Reading of the patent's equation (15).
    pub reading: Reading,
    /// xi of `P_0 = xi I`, in the module's units (deg/s and 1): 1e8 is "very large" here, whereas in
    /// rad/s the same number would hold the biases 3283 times tighter.
    pub initial_covariance: f64,
    /// `T_0` of the gyros x, y, z, deg C; none: the temperatures of the first group.
    pub initial_temperature_c: Option<[f64; 3]>,
}

impl RecursiveSettings {
    /// Reading R1, xi = 1e8 and no temperature before the first group.
    #[must_use]
    pub fn new(forgetting: Forgetting) -> Self {
        Self {
            forgetting,
            reading: Reading::Discount,
            initial_covariance: 1e8,
            initial_temperature_c: None,
        }
    }
}

/// How parameters are estimated from group means.
///
/// All of them minimise weighted squares of the residuals; they differ in the weights and in whether
/// the bias may follow the temperature. Where the bias does not drift a batch is best, and forgetting
/// costs up to two thirds more bias error. Where it drifts in proportion to the temperature, a
/// temperature column takes the drift out and forgetting only weakens it. Weights and column together
/// are the choice that is never far from the best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimator {
    /// Least squares over all groups, each of weight 1.
    Batch {
        /// What may depend on temperature.
        temperature: TemperatureColumns,
    },
    /// Recursive least squares with forgetting in square-root information form: the patent's ARLS.
    Recursive(RecursiveSettings),
    /// The patent's equations (14) to (16) to the letter: covariance recursion of all twelve states.
    /// Loses digits where xi is large and the factors small; the loss is reported.
    CovarianceRecursion(RecursiveSettings),
    /// Least squares with the weights that the recursion would leave, and temperature columns.
    Weighted {
        /// How the forgetting factor of each group and gyro comes about.
        forgetting: Forgetting,
        /// Reading of the patent's equation (15).
        reading: Reading,
        /// What may depend on temperature.
        temperature: TemperatureColumns,
    },
}

impl Estimator {
    /// The robust choice where biases drift: weights of F2 with 0.2 1/K and a temperature column.
    #[must_use]
    pub fn recommended() -> Self {
        Self::Weighted {
            forgetting: Forgetting::Temperature {
                form: ForgettingForm::Exponential,
                constant_per_k: 0.2,
            },
            reading: Reading::Discount,
            temperature: TemperatureColumns::BIAS,
        }
    }

    /// The patent's own: recursive, weights of F2 with 1 1/K, no temperature column.
    #[must_use]
    pub fn patent() -> Self {
        Self::Recursive(RecursiveSettings::new(Forgetting::Temperature {
            form: ForgettingForm::Exponential,
            constant_per_k: 1.0,
        }))
    }

    /// What the estimator lets depend on temperature.
    #[must_use]
    pub fn temperature_columns(&self) -> TemperatureColumns {
        match self {
            Self::Batch { temperature } | Self::Weighted { temperature, .. } => *temperature,
            Self::Recursive(_) | Self::CovarianceRecursion(_) => TemperatureColumns::NONE,
        }
    }

    /// Forgetting and the reading of equation (15); a batch forgets nothing.
    pub(super) fn forgetting(&self) -> (Forgetting, Reading) {
        match self {
            Self::Batch { .. } => (Forgetting::Constant(1.0), Reading::Discount),
            Self::Recursive(settings) | Self::CovarianceRecursion(settings) => {
                (settings.forgetting, settings.reading)
            }
            Self::Weighted {
                forgetting,
                reading,
                ..
            } => (*forgetting, *reading),
        }
    }

    /// Settings of the recursion, where there is one.
    pub(super) fn recursion(&self) -> Option<&RecursiveSettings> {
        match self {
            Self::Recursive(settings) | Self::CovarianceRecursion(settings) => Some(settings),
            Self::Batch { .. } | Self::Weighted { .. } => None,
        }
    }

    /// Checks the settings.
    pub(super) fn check(&self) -> Result<(), CalibrationError> {
        self.forgetting().0.check()?;
        let xi = self
            .recursion()
            .map_or(1.0, |settings| settings.initial_covariance);
        if xi > 0.0 && xi.is_finite() {
            return Ok(());
        }
        Err(CalibrationError::BadSetting {
            name: "initial_covariance",
            value: xi,
            expected: "> 0",
        })
    }
}
