//! Phase modulator: square-wave bias and the ramp converter.

use crate::gyro::ModulatorConfig;
use crate::units::deg_to_rad;

/// The modulator as the loop uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modulator {
    /// Bias modulation depth `phi_m`, rad.
    pub depth_rad: f64,
    /// Ramp codes over 2 pi; 1 for an ideal converter, whose "code" is a turn, not rounded.
    pub codes_per_turn: f64,
    /// Whether the ramp is rounded to whole codes.
    pub is_quantised: bool,
}

impl Modulator {
    /// The modulator of a configuration; 0 bits mean an ideal converter.
    #[must_use]
    pub fn new(config: &ModulatorConfig) -> Self {
        Self {
            depth_rad: deg_to_rad(config.depth_deg),
            codes_per_turn: 2.0_f64.powi(config.dac_bits.cast_signed()),
            is_quantised: config.dac_bits > 0,
        }
    }

    /// Ramp codes per radian of phase.
    #[must_use]
    pub fn codes_per_rad(&self) -> f64 {
        self.codes_per_turn / std::f64::consts::TAU
    }
}

/// Modulation depth of least angle random walk, rad.
///
/// `cos(phi) = -(1 + beta) + sqrt(beta^2 + 2 beta)`. At unit visibility `beta = B / (A + 2 C)`
/// compares the power-independent current noise `B` with shot noise `A = 2 e R P0` and intensity
/// noise `C = RIN (R P0)^2`; for any visibility see
/// [`power_independent_ratio`](crate::gyro::power_independent_ratio). `beta -> 0` gives pi,
/// `beta -> infinity` pi/2.
///
/// # Source
/// Derived: zero of the derivative of `(a + b cos + c cos^2) / sin^2`, which is the root of
/// `b cos^2 + 2 (a + c) cos + b` inside the unit circle, `1 + beta = (a + c) / b`. Checked by known
/// answer K15 against a grid search of the budget.
#[must_use]
pub fn optimum_depth_rad(power_independent_ratio: f64) -> f64 {
    // The root as a quotient: the difference of two large numbers would lose its digits.
    let sum = 1.0 + power_independent_ratio;
    (-1.0 / (sum + (sum * sum - 1.0).sqrt())).acos()
}
