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
    /// Whether the temperature does nothing.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        Self {
            reference_temperature_c: 0.0,
            ..*self
        } == Self::default()
    }

    /// The same effect told at another temperature.
    ///
    /// There the bias that it adds and the change of the scale factor are 0.
    #[must_use]
    pub fn about(&self, reference_temperature_c: f64) -> Self {
        let moved_k = reference_temperature_c - self.reference_temperature_c;
        let scale = 1.0 + 1e-6 * self.scale_factor_ppm_per_k * moved_k;
        Self {
            reference_temperature_c,
            bias_deg_per_h_per_k: self.bias_deg_per_h_per_k
                + 2.0 * self.bias_deg_per_h_per_k2 * moved_k,
            scale_factor_ppm_per_k: self.scale_factor_ppm_per_k / scale,
            ..*self
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_effect_told_at_another_temperature_is_the_same_one() {
        let model = TemperatureModel {
            reference_temperature_c: 25.0,
            bias_deg_per_h_per_k: 0.05,
            bias_deg_per_h_per_k2: -0.004,
            bias_deg_per_h_per_k_per_min: 0.8,
            scale_factor_ppm_per_k: 300.0,
        };
        let moved = model.about(40.0);
        let word = |rate_deg_per_h: f64, temperature_c: f64, rate_k_per_min: f64| {
            let warmer_k = temperature_c - 25.0;
            (1.0 + 300e-6 * warmer_k) * rate_deg_per_h
                + model.bias_deg_per_h(temperature_c, rate_k_per_min)
        };
        // Words as they would be at 40 C, whatever the temperature they were taken at.
        for temperature_c in [-10.0, 25.0, 55.0] {
            let found = moved.compensated(word(36_000.0, temperature_c, 0.5), temperature_c, 0.5);
            let bias = model.bias_deg_per_h(40.0, 0.0);
            let scale = 1.0 + 300e-6 * 15.0;
            assert!((found - (scale * 36_000.0 + bias)).abs() < 0.01, "{found}");
        }
    }
}
