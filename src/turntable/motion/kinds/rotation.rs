//! Constant rate.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::soft_start::SoftStart;
use crate::units::deg_per_s_to_rad_per_s;

table! {
    /// Constant rotation.
    pub struct RotationConfig {
        /// Constant rate.
        rate_deg_per_s: f64, example 10.0, in -2000.0..=2000.0, "deg/s";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
    }
}

impl Motion for RotationConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Rotation
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        deg_per_s_to_rad_per_s(self.rate_deg_per_s).abs()
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        let soft_start_s = self.soft_start_s.min(surroundings.warm_up_s);
        CommandExtremes::soft(self.rate_max_rad_per_s(), 0.0, soft_start_s)
    }

    fn check(&self, checks: &mut MotionChecks) {
        checks.soft_start("turntable.rotation.soft_start_s", self.soft_start_s);
    }

    fn is_idle(&self, key: &str, _: f64) -> bool {
        key == "turntable.rotation.soft_start_s" && self.rate_deg_per_s.abs() <= 0.0
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Rotation {
            rate: deg_per_s_to_rad_per_s(self.rate_deg_per_s),
            soft_start: SoftStart::new(self.soft_start_s, warm_up_s, sample_period_s),
        })
    }
}

/// Command of a constant rate, ramped.
#[derive(Clone, Copy, Debug)]
struct Rotation {
    /// rad/s.
    rate: f64,
    soft_start: SoftStart,
}

impl Course for Rotation {
    fn at(&self, instant: f64) -> Instant {
        let (ramp, ramp_slope) = self.soft_start.at(instant);
        Instant {
            rate: self.rate * ramp,
            slope: self.rate * ramp_slope,
        }
    }
}
