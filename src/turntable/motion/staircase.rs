//! Command of rates held one after the other.

use super::course::{Course, Instant};
use super::kind::{CommandExtremes, Surroundings};
use super::samples::step_indices;
use crate::signal::MotionSegment;
use crate::turntable::Stairs;
use crate::turntable::servo::step_response_extremes;
use crate::units::deg_per_s_to_rad_per_s;

/// Command of a staircase. Steps fall between samples.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// rad/s.
    rates: Vec<f64>,
    /// Index of the first sample of each rate but the first.
    changes: Vec<u64>,
}

impl Held {
    /// The command of a staircase that begins with the record.
    pub(super) fn new(stairs: &Stairs, warm_up_s: f64, sample_period_s: f64) -> Self {
        let rates = stairs.rates_deg_per_s.iter();
        assert!(!stairs.rates_deg_per_s.is_empty(), "a staircase has a rate");
        Self {
            rates: rates.copied().map(deg_per_s_to_rad_per_s).collect(),
            changes: step_indices(stairs, warm_up_s, sample_period_s),
        }
    }
}

impl Course for Held {
    /// The first rate; what follows has no value at the instant of a step.
    fn at(&self, _: f64) -> Instant {
        Instant {
            rate: self.rates[0],
            slope: 0.0,
        }
    }

    fn segment(&self, index: u64, start: Instant) -> (MotionSegment, Instant) {
        let steps_taken = self.changes.partition_point(|at| *at <= index);
        (MotionSegment::constant(self.rates[steps_taken]), start)
    }
}

/// Extremes of a staircase whose steps a servo rounds off.
pub(super) fn extremes(
    stairs: &Stairs,
    rate_max: f64,
    surroundings: Surroundings,
) -> CommandExtremes {
    let rates = &stairs.rates_deg_per_s;
    let first = rates.first().map_or(0.0, |rate| rate.abs());
    let rises = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let rise = deg_per_s_to_rad_per_s(rises.fold(0.0, f64::max));
    let first = deg_per_s_to_rad_per_s(first);
    let (jump_rad_per_s, acceleration_rad_per_s2) =
        step_response_extremes(surroundings.servo, first, rise, rate_max);
    CommandExtremes {
        jump_rad_per_s,
        acceleration_rad_per_s2,
    }
}
