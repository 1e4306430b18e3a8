//! Law of a noise source: where it enters the detection chain, and with what density.

use crate::gyro::optics::converter::AdcConfig;
use crate::gyro::optics::receiver::DetectorConfig;
use crate::gyro::optics::source::SourceConfig;

/// Law of a detector noise source.
#[derive(Clone, Copy, Debug)]
pub(in crate::gyro) struct NoiseLaw {
    /// Name in budgets, and of the stream it is drawn from on its own.
    pub(in crate::gyro) name: &'static str,
    /// Density of an amount: 1 or 0 of a source that is switched, else what its key says.
    pub(in crate::gyro) density: fn(f64, &WorkingPoint) -> Density,
}

/// Working point of the detection chain: what a density may depend on besides the amount.
#[derive(Clone, Copy, Debug)]
pub(in crate::gyro) struct WorkingPoint<'a> {
    pub(in crate::gyro) source: &'a SourceConfig,
    pub(in crate::gyro) detector: &'a DetectorConfig,
    pub(in crate::gyro) adc: &'a AdcConfig,
    /// Temperature of case and electronics, deg C.
    pub(in crate::gyro) case_c: f64,
    /// Density of the current that stands in the place of all sources, A^2/Hz; 0 where none does.
    pub(in crate::gyro) equivalent_a2_per_hz: f64,
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
