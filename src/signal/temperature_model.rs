//! What the temperature does to the words of one gyro, as a log of it shows.

/// Bias and scale factor against the temperature T and its rate, about a reference T0.
///
/// A word is `(1 + k (T - T0)) W + b1 (T - T0) + b2 (T - T0)^2 + s dT/dt` beside what does not depend on the
/// temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TemperatureModel {
    /// Reference T0, deg C.
    pub reference_temperature_c: f64,
    /// Linear coefficient b1 of the bias, deg/h/K.
    pub bias_deg_per_h_per_k: f64,
    /// Quadratic coefficient b2 of the bias, deg/h/K^2.
    pub bias_deg_per_h_per_k2: f64,
    /// Coefficient s of the rate of the temperature, the Shupe effect, deg/h/(K/min).
    pub bias_deg_per_h_per_k_per_min: f64,
    /// Linear coefficient k of the scale factor, ppm/K.
    pub scale_factor_ppm_per_k: f64,
}

impl TemperatureModel {
    /// Bias that the temperature adds to that at the reference, deg/h.
    #[must_use]
    pub fn bias_deg_per_h(&self, temperature_c: f64, rate_k_per_min: f64) -> f64 {
        let warmer_k = temperature_c - self.reference_temperature_c;
        (self.bias_deg_per_h_per_k + self.bias_deg_per_h_per_k2 * warmer_k) * warmer_k
            + self.bias_deg_per_h_per_k_per_min * rate_k_per_min
    }

    /// A word as it would be at the reference and without a change of the temperature, deg/h.
    #[must_use]
    pub fn compensated(&self, word_deg_per_h: f64, temperature_c: f64, rate_k_per_min: f64) -> f64 {
        let warmer_k = temperature_c - self.reference_temperature_c;
        let scale = 1.0 + 1e-6 * self.scale_factor_ppm_per_k * warmer_k;
        (word_deg_per_h - self.bias_deg_per_h(temperature_c, rate_k_per_min)) / scale
    }
}
