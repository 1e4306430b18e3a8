//! The configuration of the test signal that is added inside the loop.

use serde::Deserialize;

use super::turntable_config::{MotionConfig, MultiSineConfig};

/// Sines of equivalent rate added to the step of the ramp while the table is at rest.
///
/// To the loop a step `-A` added to each step of its ramp is the Sagnac phase `A` of the rate `A / Ks`,
/// `Ks` the scale factor in seconds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "MultiSineConfig")]
pub struct InjectionConfig {
    /// The sines as the motion that would do the same.
    motion: MotionConfig,
}

impl InjectionConfig {
    /// The sines.
    ///
    /// # Panics
    /// Never: the motion is made of them.
    #[must_use]
    pub fn sines(&self) -> &MultiSineConfig {
        match &self.motion {
            MotionConfig::MultiSine(sines) => sines,
            _ => unreachable!("the motion is made of sines"),
        }
    }

    /// The equivalent motion: several sines.
    #[must_use]
    pub fn equivalent_motion(&self) -> &MotionConfig {
        &self.motion
    }
}

impl From<MultiSineConfig> for InjectionConfig {
    fn from(sines: MultiSineConfig) -> Self {
        Self {
            motion: MotionConfig::MultiSine(sines),
        }
    }
}
