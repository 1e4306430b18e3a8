//! No motion.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};

table! {
    /// Nothing to set.
    pub struct StaticConfig {
    }
}

impl Motion for StaticConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Rest
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        0.0
    }

    fn extremes(&self, _: Surroundings) -> CommandExtremes {
        CommandExtremes::default()
    }

    fn check(&self, _: &mut MotionChecks) {}

    fn course(&self, _: f64, _: f64) -> Arc<dyn Course> {
        Arc::new(Rest)
    }
}

/// Command of a table at rest.
#[derive(Clone, Copy, Debug)]
struct Rest;

impl Course for Rest {
    fn at(&self, _: f64) -> Instant {
        Instant::REST
    }
}
