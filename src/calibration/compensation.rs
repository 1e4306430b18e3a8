//! Turning outputs back into rates: the patent's first-order form and the exact inverse.

use nalgebra::{Matrix3, Vector3};

use super::error::CalibrationError;
use super::error_model::{ErrorParameters, matrix};
use super::result::Calibration;
use crate::vocabulary::CompensationForm;

/// Compensation of an assembly's outputs with given parameters.
///
/// With `D = K_G + theta_G` the outputs are `Wm = (I + D) W + B`. The exact form undoes this. The
/// first-order form leaves
///
/// ```text
/// Wm - (D Wm + B) = W + D W + B - D W - D D W - D B - B = W - (D D W + D B)
/// ```
///
/// that is errors of second order: with D of 1e-3 at 100 deg/s some 1e-4 deg/s, or 0.4 deg/h. The
/// inverse of `XA` is worked out once; an output then costs nine multiplications in either form.
///
/// Where the bias follows the temperature, B is `B_G + b (T - T_ref)` for each gyro with its own
/// coefficient and its own reference.
///
/// Units: deg/s and deg C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    parameters: ErrorParameters,
    inverse: Matrix3<f64>,
    temperature_coefficient_deg_per_s_per_k: [f64; 3],
    reference_temperature_c: [f64; 3],
}

impl Compensation {
    /// Compensation with constant biases.
    ///
    /// # Errors
    /// [`CalibrationError::SingularSensitivity`] if `XA` has no inverse.
    pub fn new(parameters: ErrorParameters) -> Result<Self, CalibrationError> {
        let inverse = matrix(parameters.sensitivity())
            .try_inverse()
            .ok_or(CalibrationError::SingularSensitivity)?;
        Ok(Self {
            parameters,
            inverse,
            temperature_coefficient_deg_per_s_per_k: [0.0; 3],
            reference_temperature_c: [0.0; 3],
        })
    }

    /// The same with biases that follow the temperatures of the gyros.
    ///
    /// * `coefficient_deg_per_s_per_k`: of the biases of the gyros x, y, z.
    /// * `reference_temperature_c`: temperatures at which the biases are those of the parameters.
    #[must_use]
    pub fn following_temperature(
        self,
        coefficient_deg_per_s_per_k: [f64; 3],
        reference_temperature_c: [f64; 3],
    ) -> Self {
        Self {
            temperature_coefficient_deg_per_s_per_k: coefficient_deg_per_s_per_k,
            reference_temperature_c,
            ..self
        }
    }

    /// Whether the biases follow the temperatures of the gyros.
    #[must_use]
    pub fn needs_temperature(&self) -> bool {
        let coefficients = self.temperature_coefficient_deg_per_s_per_k;
        coefficients
            .iter()
            .any(|coefficient| coefficient.abs() > 0.0)
    }

    /// Compensation with a calibration's parameters and its temperature coefficient of the bias.
    ///
    /// # Errors
    /// As [`Compensation::new`].
    pub fn of(calibration: &Calibration) -> Result<Self, CalibrationError> {
        let mut compensation = Self::new(calibration.parameters)?;
        if let Some(bias) = calibration.temperature.bias {
            compensation.temperature_coefficient_deg_per_s_per_k = bias.value;
            compensation.reference_temperature_c = calibration.reference_temperature_c;
        }
        Ok(compensation)
    }

    /// Biases at the given temperatures of the gyros, deg/s; none: at the reference temperature.
    #[must_use]
    pub fn bias_deg_per_s(&self, temperature_c: Option<[f64; 3]>) -> [f64; 3] {
        let mut bias = self.parameters.bias_deg_per_s;
        if let Some(temperature_c) = temperature_c {
            for (axis, value) in bias.iter_mut().enumerate() {
                let warmer_k = temperature_c[axis] - self.reference_temperature_c[axis];
                *value += self.temperature_coefficient_deg_per_s_per_k[axis] * warmer_k;
            }
        }
        bias
    }

    /// Rates about the case axes for outputs of the gyros x, y, z, deg/s.
    #[must_use]
    pub fn rates(
        &self,
        form: CompensationForm,
        output_deg_per_s: [f64; 3],
        temperature_c: Option<[f64; 3]>,
    ) -> [f64; 3] {
        let output = Vector3::from(output_deg_per_s);
        let bias = Vector3::from(self.bias_deg_per_s(temperature_c));
        let rates = match form {
            CompensationForm::Exact => self.inverse * (output - bias),
            CompensationForm::FirstOrder => {
                output - (matrix(self.parameters.deviation()) * output + bias)
            }
        };
        rates.into()
    }

    /// What the form leaves of a true rate with perfect parameters, deg/s.
    ///
    /// `-(D D W + D B)` with `D = K_G + theta_G` for the first-order form, nothing for the exact one.
    #[must_use]
    pub fn residual(&self, form: CompensationForm, rate_deg_per_s: [f64; 3]) -> [f64; 3] {
        match form {
            CompensationForm::Exact => [0.0; 3],
            CompensationForm::FirstOrder => {
                let deviation = matrix(self.parameters.deviation());
                let bias = Vector3::from(self.parameters.bias_deg_per_s);
                let error = deviation * Vector3::from(rate_deg_per_s) + bias;
                (-(deviation * error)).into()
            }
        }
    }
}
