//! Declaration of a noise source: where it enters the detection chain, and with what density.

use crate::gyro::GyroConfig;
use crate::gyro::thermal::condition::Condition;

/// Declaration of a detector noise source.
#[derive(Clone, Copy, Debug)]
pub struct NoiseSource {
    /// Name in budgets, and of the stream it is drawn from on its own.
    pub name: &'static str,
    /// Scenario key that switches it off, by `false` or 0.
    pub key: &'static str,
    /// Where it enters and with what density; a source that is switched off has density 0.
    pub(in crate::gyro) density: fn(&GyroConfig, &Condition) -> Density,
}

/// One-sided noise density of a source at the place where it enters; 0 where it is switched off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// Phase difference of the two waves, one independent phase per half period.
    Phase {
        /// Density `S1`, rad^2/Hz.
        rad2_per_hz: f64,
    },
    /// Power of the light, relative.
    Intensity {
        /// Density, 1/Hz.
        per_hz: f64,
    },
    /// Photocurrent and dark current, in proportion to their sum.
    OfCurrent {
        /// Density per current, A^2/Hz per A.
        a2_per_hz_per_a: f64,
    },
    /// Input of the amplifier, whatever the light.
    Current {
        /// Density, A^2/Hz.
        a2_per_hz: f64,
    },
    /// Rounding in the converter, white noise of variance `q^2 / 12` per sample.
    Rounding {
        /// Step q, V.
        step_v: f64,
    },
}

impl Density {
    /// Density of the current behind the photodiode, A^2/Hz, at a photocurrent; what enters as
    /// phase or in the converter has none.
    #[must_use]
    pub fn a2_per_hz(&self, photocurrent_a: f64, dark_current_a: f64) -> f64 {
        match *self {
            Self::Intensity { per_hz } => per_hz * photocurrent_a * photocurrent_a,
            Self::OfCurrent { a2_per_hz_per_a } => {
                a2_per_hz_per_a * (photocurrent_a + dark_current_a)
            }
            Self::Current { a2_per_hz } => a2_per_hz,
            Self::Phase { .. } | Self::Rounding { .. } => 0.0,
        }
    }
}

/// A density that a switch turns off.
pub(super) fn when(is_on: bool, density: f64) -> f64 {
    if is_on { density } else { 0.0 }
}
