//! What the table is told to do: one file a kind of motion.
//!
//! The settings of each kind implement [`Motion`](kind::Motion): class, extremes, checks and command. The list
//! of kinds stands here, and the rest of the bench asks [`MotionConfig`].

mod campaign;
mod checks;
mod chirp;
mod command;
mod course;
mod kind;
mod multi_sine;
mod rest;
mod rotation;
mod samples;
mod scale_factor_test;
mod script;
mod soft_start;
mod staircase;
mod steps;
mod swing;
mod trapezoid;

pub use campaign::campaign_angles_rad;
pub(in crate::turntable) use campaign::remountings;
pub use checks::MotionChecks;
pub(in crate::turntable) use command::Command;
pub(in crate::turntable) use kind::Motion;
pub use kind::{CommandExtremes, MotionClass, Surroundings};
pub use samples::{dwell_ends, first_measured_index, step_indices};

use crate::turntable::{CampaignConfig, MotionConfig, Stairs, StaticConfig};

impl MotionConfig {
    /// The motion whatever its kind.
    pub(in crate::turntable) fn kind(&self) -> &dyn Motion {
        match self {
            Self::Static(kind) => kind,
            Self::Swing(kind) => kind,
            Self::MultiSine(kind) => kind,
            Self::Steps(kind) => kind,
            Self::ScaleFactorTest(kind) => kind,
            Self::Rotation(kind) => kind,
            Self::Trapezoid(kind) => kind,
            Self::Chirp(kind) => kind,
            Self::Script(kind) => kind,
            Self::Calibration(kind) => kind,
        }
    }

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
}
