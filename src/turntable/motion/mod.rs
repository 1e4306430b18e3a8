//! What the table is told to do: the kinds of motion, and what they share.
//!
//! The settings of each kind implement [`Motion`](kind::Motion): class, extremes, checks and command. The list
//! of kinds stands here, and the rest of the bench asks [`MotionConfig`].

mod checks;
mod command;
mod course;
mod kind;
mod kinds;
mod samples;
mod soft_start;
mod staircase;
mod stairs;

pub use checks::MotionChecks;
pub use kind::{CommandExtremes, MotionClass, Surroundings};
pub use kinds::campaign::{CampaignConfig, CampaignGroup, campaign_angles_rad};
pub use kinds::chirp::{ChirpConfig, Progression};
pub use kinds::multi_sine::MultiSineConfig;
pub use kinds::rest::StaticConfig;
pub use kinds::rotation::RotationConfig;
pub use kinds::scale_factor_test::{PreferredSeries, ScaleFactorTestConfig, TEST_RATES_MIN};
pub use kinds::script::{ScriptConfig, ScriptPoints};
pub use kinds::steps::StepsConfig;
pub use kinds::swing::SwingConfig;
pub use kinds::test_signal::{SignalShape, TestSignalConfig};
pub use kinds::trapezoid::TrapezoidConfig;
pub use samples::{dwell_ends, first_measured_index, step_indices};
pub use stairs::Stairs;

pub(in crate::turntable) use command::Command;
pub(in crate::turntable) use kind::Motion;
pub(in crate::turntable) use kinds::campaign::remountings;

use std::sync::Arc;

use course::Course;

use crate::declare::alternatives;

alternatives! {
    /// Commanded motion.
    pub enum MotionConfig, one "motion", first by default, each as Motion {
        /// The table is at rest.
        Static(StaticConfig) = "static",
        Swing(SwingConfig) = "swing",
        MultiSine(MultiSineConfig) = "multi_sine",
        Steps(StepsConfig) = "steps",
        ScaleFactorTest(ScaleFactorTestConfig) = "scale_factor_test",
        Rotation(RotationConfig) = "rotation",
        Trapezoid(TrapezoidConfig) = "trapezoid",
        Chirp(ChirpConfig) = "chirp",
        TestSignal(TestSignalConfig) = "test_signal",
        Script(ScriptConfig) = "script",
        Calibration(CampaignConfig) = "calibration",
    }
}

impl MotionConfig {
    /// No motion.
    #[must_use]
    pub fn rest() -> Self {
        Self::Static(StaticConfig {})
    }

    /// Class by which the motion is measured and shown.
    #[must_use]
    pub fn class(&self) -> MotionClass<'_> {
        self.kind().class()
    }

    /// Whether the table does not move.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        matches!(self.class(), MotionClass::Rest)
    }

    /// The rates that are held one after the other; `None` for other motions.
    #[must_use]
    pub fn stairs(&self) -> Option<Stairs> {
        match self.class() {
            MotionClass::Steps(stairs) => Some(stairs),
            _ => None,
        }
    }

    /// The calibration campaign; `None` for other motions.
    #[must_use]
    pub fn campaign(&self) -> Option<&CampaignConfig> {
        match self.class() {
            MotionClass::Campaign(campaign) => Some(campaign),
            _ => None,
        }
    }

    /// Largest commanded rate in magnitude, without the Earth's, rad/s; of several sines its bound.
    ///
    /// # Panics
    /// If a swing or sweep has not exactly one amplitude or a script not either rates or angles; the
    /// scenario reader refuses both.
    #[must_use]
    pub fn rate_max_rad_per_s(&self) -> f64 {
        self.kind().rate_max_rad_per_s()
    }

    /// Highest frequency of the sines that the command is made of, Hz; 0 where it is made of none.
    #[must_use]
    pub fn frequency_max_hz(&self) -> f64 {
        self.kind().frequency_max_hz()
    }

    /// Largest jump and acceleration of the command.
    ///
    /// # Panics
    /// As [`MotionConfig::rate_max_rad_per_s`].
    #[must_use]
    pub fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        self.kind().extremes(surroundings)
    }

    /// Refuses settings that contradict each other or the record.
    pub fn check(&self, checks: &mut MotionChecks) {
        self.kind().check(checks);
    }

    /// Whether a key of this motion is without effect beside its other settings; `duration_s` is the
    /// length of the record, s.
    #[must_use]
    pub fn is_idle(&self, key: &str, duration_s: f64) -> bool {
        self.kind().is_idle(key, duration_s)
    }

    /// Command of the motion: the record begins after `warm_up_s`, one sample lasts `sample_period_s`.
    pub(in crate::turntable) fn course(
        &self,
        warm_up_s: f64,
        sample_period_s: f64,
    ) -> Arc<dyn Course> {
        self.kind().course(warm_up_s, sample_period_s)
    }
}
