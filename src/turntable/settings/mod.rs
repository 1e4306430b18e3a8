//! Settings of the rate table: the tables of keys below `turntable`, one file a motion.
//!
//! Invariant: declarations, and what follows from them alone.

mod campaign;
mod chirp;
mod encoder;
mod multi_sine;
mod rest;
mod rotation;
mod scale_factor_test;
mod script;
mod servo;
mod site;
mod steps;
mod swing;
mod trapezoid;

pub use campaign::{CampaignConfig, CampaignGroup};
pub use chirp::{ChirpConfig, Progression};
pub use encoder::EncoderConfig;
pub use multi_sine::MultiSineConfig;
pub use rest::StaticConfig;
pub use rotation::RotationConfig;
pub use scale_factor_test::{PreferredSeries, ScaleFactorTestConfig};
pub use script::{ScriptConfig, ScriptPoints};
pub use servo::{DirectDriveServoConfig, SecondOrderServoConfig, ServoConfig};
pub use site::{AxisConfig, MountingConfig, SiteConfig};
pub use steps::StepsConfig;
pub use swing::SwingConfig;
pub use trapezoid::TrapezoidConfig;

use crate::declare::{alternatives, table};

table! {
    /// Rate table: one motion, one servo, one site, the errors of axis and mounting.
    pub struct TurntableConfig {
        #[serde(flatten)]
        motion: MotionConfig;
        servo: ServoConfig;
        encoder: EncoderConfig;
        site: SiteConfig;
        axis: AxisConfig;
        mounting: MountingConfig;
    }
}

alternatives! {
    /// Commanded motion.
    pub enum MotionConfig, one "motion", first by default {
        /// The table is at rest.
        Static(StaticConfig) = "static",
        Swing(SwingConfig) = "swing",
        MultiSine(MultiSineConfig) = "multi_sine",
        Steps(StepsConfig) = "steps",
        ScaleFactorTest(ScaleFactorTestConfig) = "scale_factor_test",
        Rotation(RotationConfig) = "rotation",
        Trapezoid(TrapezoidConfig) = "trapezoid",
        Chirp(ChirpConfig) = "chirp",
        Script(ScriptConfig) = "script",
        Calibration(CampaignConfig) = "calibration",
    }
}
