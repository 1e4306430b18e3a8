//! What the temperature does to one gyro, as a calibration file holds it.

use serde::Serialize;

use crate::declare::table;
use crate::signal::TemperatureModel;

table! {
    /// Bias and scale factor of one gyro against its temperature T and the rate of that, as a log has shown
    /// them: a word is `(1 + k (T - T0)) W + b1 (T - T0) + b2 (T - T0)^2 + s dT/dt` beside what does not
    /// depend on the temperature.
    #[derive(Serialize)]
    pub struct TemperatureParameters {
        /// Temperature T0 that the coefficients are told at.
        reference_temperature_c: f64, example 25.0, in -100.0..=150.0, "C";
        /// Linear coefficient b1 of the bias.
        bias_deg_per_h_per_k: Option<f64>, example 0.05, in -1000.0..=1000.0, "deg/h/K";
        /// Quadratic coefficient b2 of the bias.
        bias_deg_per_h_per_k2: Option<f64>, example -0.004, in -100.0..=100.0, "deg/h/K^2";
        /// Coefficient s of the rate of the temperature, the Shupe effect.
        bias_deg_per_h_per_k_per_min: Option<f64>, example 0.8, in -1e4..=1e4, "deg/h/(K/min)";
        /// Linear coefficient k of the scale factor.
        scale_factor_ppm_per_k: Option<f64>, example 20.0, in -1e4..=1e4, "ppm/K";
        /// Lowest temperature that the coefficients were fitted to.
        lowest_c: Option<f64>, example -10.0, in -100.0..=150.0, "C";
        /// Highest temperature that they were fitted to.
        highest_c: Option<f64>, example 60.0, in -100.0..=150.0, "C";
    }
}

impl TemperatureParameters {
    /// A model, and the lowest and highest temperature that it was fitted to.
    #[must_use]
    pub fn of(model: &TemperatureModel, fitted_c: [Option<f64>; 2]) -> Self {
        let [lowest_c, highest_c] = fitted_c;
        Self {
            reference_temperature_c: model.reference_temperature_c,
            bias_deg_per_h_per_k: Some(model.bias_deg_per_h_per_k),
            bias_deg_per_h_per_k2: Some(model.bias_deg_per_h_per_k2),
            bias_deg_per_h_per_k_per_min: Some(model.bias_deg_per_h_per_k_per_min),
            scale_factor_ppm_per_k: Some(model.scale_factor_ppm_per_k),
            lowest_c,
            highest_c,
        }
    }

    /// The same effect told at another temperature.
    #[must_use]
    pub fn about(&self, reference_temperature_c: f64) -> Self {
        let model = self.model().about(reference_temperature_c);
        Self::of(&model, [self.lowest_c, self.highest_c])
    }

    /// The model that they are.
    #[must_use]
    pub fn model(&self) -> TemperatureModel {
        TemperatureModel {
            reference_temperature_c: self.reference_temperature_c,
            bias_deg_per_h_per_k: self.bias_deg_per_h_per_k.unwrap_or(0.0),
            bias_deg_per_h_per_k2: self.bias_deg_per_h_per_k2.unwrap_or(0.0),
            bias_deg_per_h_per_k_per_min: self.bias_deg_per_h_per_k_per_min.unwrap_or(0.0),
            scale_factor_ppm_per_k: self.scale_factor_ppm_per_k.unwrap_or(0.0),
        }
    }
}
