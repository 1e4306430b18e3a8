//! Scale factor test: rest, the rates of one sense from small to large, those of the other, rest.

use std::sync::Arc;

use super::checks::MotionChecks;
use super::course::Course;
use super::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use super::staircase::{Held, extremes};
use crate::turntable::{ScaleFactorTestConfig, Stairs, TEST_RATES_MIN};
use crate::units::deg_per_s_to_rad_per_s;

impl Motion for ScaleFactorTestConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Steps(self.into())
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        deg_per_s_to_rad_per_s(self.to_deg_per_s)
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        extremes(&self.into(), self.rate_max_rad_per_s(), surroundings)
    }

    /// Refuses a test of too few rates and one that the record cuts off.
    fn check(&self, checks: &mut MotionChecks) {
        let key = |name: &str| format!("turntable.scale_factor_test.{name}");
        let count = self.rates_deg_per_s().len();
        if count < TEST_RATES_MIN {
            let message = format!(
                "{} = {:?} deg/s leaves {count} rates of each sense up to {:?} deg/s: a scale \
                 factor test needs {TEST_RATES_MIN}; begin lower, take another series, or use \
                 [turntable.steps]",
                key("from_deg_per_s"),
                self.from_deg_per_s,
                self.to_deg_per_s
            );
            checks.complain(&key("from_deg_per_s"), message);
        }
        if let Some(longest_s) = self.dwell_max_s
            && longest_s < self.dwell_s
        {
            let message = format!(
                "{} = {longest_s:?} s is too short: allowed from dwell_s = {:?} s",
                key("dwell_max_s"),
                self.dwell_s
            );
            checks.complain(&key("dwell_max_s"), message);
        }
        let needed_s = Stairs::from(self).length_s();
        if checks.is_too_long(needed_s) {
            let message = format!(
                "{} = {:?} s is too long: the test of {count} rates of each sense takes \
                 {needed_s:.6} s, but duration_s = {:?} s",
                key("dwell_s"),
                self.dwell_s,
                checks.duration_s
            );
            checks.complain(&key("dwell_s"), message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Held::new(&Stairs::from(self), warm_up_s, sample_period_s))
    }
}
