//! Staircase: each rate is held for the dwell time, the last one for ever.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::Course;
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::staircase::{Held, extremes};
use crate::turntable::motion::stairs::Stairs;
use crate::units::deg_per_s_to_rad_per_s;
use crate::wording::{counted, number};

table! {
    /// Staircase: each rate is held for the dwell time; the last one is held for ever.
    pub struct StepsConfig {
        /// Rates in order; the first is held through the warm-up, the last one for ever.
        rates_deg_per_s: Vec<f64>, example [0.0, 1.0], in -2000.0..=2000.0, "deg/s";
        /// Time at each rate; all of them must fit into the duration.
        dwell_s: f64, example 5.0, in 1e-6..=1e6, "s";
        /// Time at the start of each dwell that the scale factor leaves out. Source of the default:
        /// assumed; a hundred time constants of a loop of 160 Hz, six times the memory of 64 taps.
        settle_s: f64 = 0.1, in 0.0..=1e6, "s";
    }
}

impl From<&StepsConfig> for Stairs {
    fn from(steps: &StepsConfig) -> Self {
        let counts = 1_u32..;
        let rates = steps.rates_deg_per_s.clone();
        Self {
            ends_s: counts
                .take(rates.len())
                .map(|count| f64::from(count) * steps.dwell_s)
                .collect(),
            rates_deg_per_s: rates,
            settle_s: steps.settle_s,
            has_static_zeros: false,
        }
    }
}

impl Motion for StepsConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Steps(self.into())
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        let rates = self.rates_deg_per_s.iter().copied();
        rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        extremes(&self.into(), self.rate_max_rad_per_s(), surroundings)
    }

    /// Refuses dwells that outlast the record, and a settling that leaves nothing of them.
    fn check(&self, checks: &mut MotionChecks) {
        let count = self.rates_deg_per_s.len();
        let count_f64 = u32::try_from(count).map_or(f64::INFINITY, f64::from);
        let needed_s = count_f64 * self.dwell_s;
        if checks.is_too_long(needed_s) {
            let message = format!(
                "turntable.steps.dwell_s = {:?} s is too long: {} take {} s, \
                 but duration_s = {:?} s",
                self.dwell_s,
                counted(count, "rate"),
                number(needed_s),
                checks.duration_s
            );
            checks.complain("turntable.steps.dwell_s", message);
        }
        let settle = "turntable.steps.settle_s";
        // The default is no wish: short dwells merely have no scale factor.
        if self.settle_s >= self.dwell_s && (checks.is_asked_for)(settle) {
            let message = format!(
                "{settle} = {:?} s leaves nothing of turntable.steps.dwell_s = {:?} s",
                self.settle_s, self.dwell_s
            );
            checks.complain(settle, message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Held::new(&Stairs::from(self), warm_up_s, sample_period_s))
    }
}
