//! Phase modulator: square-wave bias and the ramp converter.

use crate::declare::table;
use crate::units::deg_to_rad;
use crate::vocabulary::words;

table! {
    /// Phase modulator.
    pub struct ModulatorConfig {
        /// Bias modulation depth; four-state schemes stand at 180 deg plus and minus its complement. Source of
        /// the default: assumed, 2 pi / 3 overmodulation.
        depth_deg: f64 = 120.0, in 1.0..=179.0, "deg", told in Budget;
        /// Bits of the ramp converter over 2 pi; 0 is ideal. Source of the default: assumed.
        dac_bits: u32 = 16, in 0..=32;
        /// Bias wave: two or four states of the transit time, or four of half of it. Source of the default:
        /// assumed. four-state needs gyro.output.half_periods_per_sample to be a multiple of 4. In all of
        /// them the ramp steps once per transit time.
        scheme: ModulationScheme = "two-state";
        /// Applied over commanded phase, less one: error of the voltage of 2 pi. Source of the default: none.
        gain_error_ppm: f64 = 0.0, in -200_000.0..=200_000.0, "ppm";
        /// Whether a loop period with a reset of the ramp is demodulated or discarded. Source of the default:
        /// assumed; discarding turns a gain error into a scale factor error.
        reset_sample: ResetSample = "demodulated";
        /// Amplitude of the error phase that follows the ramp; makes a dead band. Source of the default: none.
        cross_coupling_urad: f64 = 0.0, in 0.0..=100_000.0, "urad";
        /// Phase of that error: it is the sine of ramp plus phase. Source of the default: none.
        cross_coupling_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
        /// Random jumps of the ramp against the dead band, rms; 0 is none. Source of the default: none.
        dither_deg: f64 = 0.0, in 0.0..=720.0, "deg";
        /// Loop periods from jump to jump; the period of a jump is discarded. Source of the default: assumed.
        dither_interval_periods: u32 = 16, in 2..=65536;
        /// Half modulation period over transit time, less one. Source of the default: none.
        half_period_mismatch: f64 = 0.0, in -0.01..=0.01;
        /// Relative intensity modulation that goes with the bias wave. Source of the default: none.
        intensity_modulation: f64 = 0.0, in -0.1..=0.1;
    }
}

words! {
    /// Bias wave of the modulator.
    pub enum ModulationScheme {
        /// Square wave: two states of tau.
        TwoState = "two-state",
        /// Four states of tau, period 4 tau.
        FourState = "four-state",
        /// Four states of tau / 2, period 2 tau.
        FourStateHalf = "four-state-half",
    }

    /// What becomes of the loop period in which the ramp resets by 2 pi.
    pub enum ResetSample {
        /// Demodulated as any other.
        Demodulated = "demodulated",
        /// Discarded.
        Blanked = "blanked",
    }
}

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
