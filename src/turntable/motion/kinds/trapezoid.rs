//! Trapezoids of rate: accelerate, hold, decelerate, rest.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::{MotionChecks, SAMPLES_PER_RAMP_MIN};
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::units::deg_per_s_to_rad_per_s;
use crate::wording::number;

table! {
    /// Trapezoids of rate, the first of which begins with the record; the table rests before and after.
    pub struct TrapezoidConfig {
        /// Rate at the top; not 0.
        rate_deg_per_s: f64, example 10.0, in -2000.0..=2000.0, "deg/s";
        /// Acceleration of both ramps; a ramp must span at least 8 output samples.
        acceleration_deg_per_s2: f64, example 100.0, in 1e-6..=1e6, "deg/s^2";
        /// Time at the top.
        hold_s: f64, example 2.0, in 0.0..=1e6, "s";
        /// Time at rest after each. Source of the default: none.
        rest_s: f64 = 0.0, in 0.0..=1e6, "s";
        /// How often it is repeated; all of them must fit into the duration.
        cycles: u32 = 1, in 1..=1_000_000;
        /// Each is followed by one the other way.
        both_senses: bool = false;
    }
}

impl TrapezoidConfig {
    /// Number of trapezoids, those of both senses.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.cycles * if self.both_senses { 2 } else { 1 }
    }

    /// Time from the start of the first to the end of the last, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        let count = f64::from(self.count());
        let ramp_s = self.rate_deg_per_s.abs() / self.acceleration_deg_per_s2;
        count * (2.0 * ramp_s + self.hold_s) + (count - 1.0) * self.rest_s
    }
}

impl Motion for TrapezoidConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::General
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        deg_per_s_to_rad_per_s(self.rate_deg_per_s).abs()
    }

    fn extremes(&self, _: Surroundings) -> CommandExtremes {
        CommandExtremes {
            jump_rad_per_s: 0.0,
            acceleration_rad_per_s2: deg_per_s_to_rad_per_s(self.acceleration_deg_per_s2),
        }
    }

    /// Refuses ramps of a few samples and trapezoids that the record cuts off.
    fn check(&self, checks: &mut MotionChecks) {
        let rate = self.rate_deg_per_s.abs();
        let acceleration = self.acceleration_deg_per_s2;
        if rate <= 0.0 {
            let message = "turntable.trapezoid.rate_deg_per_s = 0.0 deg/s is no motion: allowed \
                           [-2000, 2000] deg/s without 0; use [turntable.static]";
            checks.complain("turntable.trapezoid.rate_deg_per_s", message.to_owned());
            return;
        }
        let acceleration_max = rate / (SAMPLES_PER_RAMP_MIN * checks.sample_period_s);
        if acceleration > acceleration_max {
            let message = format!(
                "turntable.trapezoid.acceleration_deg_per_s2 = {acceleration:?} deg/s^2 is too \
                 steep: allowed up to {acceleration_max:.6} deg/s^2, 8 output samples to reach \
                 {rate:?} deg/s"
            );
            checks.complain("turntable.trapezoid.acceleration_deg_per_s2", message);
        }
        let needed_s = self.length_s();
        if checks.is_too_long(needed_s) {
            let message = format!(
                "turntable.trapezoid.cycles = {}: the motion takes {} s, but duration_s = \
                 {:?} s",
                self.cycles,
                number(needed_s),
                checks.duration_s
            );
            checks.complain_or("turntable.trapezoid.cycles", "duration_s", message);
        }
    }

    fn is_idle(&self, key: &str, _: f64) -> bool {
        key == "turntable.trapezoid.rest_s" && self.count() < 2
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Trapezoids::new(self, warm_up_s, sample_period_s))
    }
}

/// Trapezoids in a row, the first of which begins with the record; at rest before and after.
///
/// The rate has no jumps, the acceleration does; a corner lies wherever the times put it, and the
/// sample that holds it is the cubic through the rates and slopes at its ends, which there misses
/// the corner by at most 4/27 of what the rate changes in one sample.
#[derive(Clone, Debug)]
struct Trapezoids {
    /// Rate of the first, rad/s.
    rate: f64,
    /// Length of a ramp, samples.
    ramp: f64,
    /// Length of the top, samples.
    hold: f64,
    /// From the start of one to the start of the next, samples.
    period: f64,
    count: f64,
    /// Whether every other one turns the other way.
    alternates: bool,
    /// Where the first begins, samples.
    first: f64,
}

impl Trapezoids {
    fn new(config: &TrapezoidConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let samples = |time_s: f64| time_s / sample_period_s;
        let ramp = samples(ramp_s(config));
        let hold = samples(config.hold_s);
        Self {
            rate: deg_per_s_to_rad_per_s(config.rate_deg_per_s),
            ramp,
            hold,
            period: 2.0 * ramp + hold + samples(config.rest_s),
            count: f64::from(config.count()),
            alternates: config.both_senses,
            first: first_measured_index(warm_up_s, sample_period_s) as f64,
        }
    }
}

impl Course for Trapezoids {
    fn at(&self, instant: f64) -> Instant {
        let since = instant - self.first;
        let number = (since / self.period).floor();
        if since < 0.0 || number >= self.count {
            return Instant::REST;
        }
        let is_backward = self.alternates && number % 2.0 > 0.5;
        let rate = if is_backward { -self.rate } else { self.rate };
        let within = since - number * self.period;
        let falling = within - self.ramp - self.hold;
        if within < self.ramp {
            Instant {
                rate: rate * (within / self.ramp),
                slope: rate / self.ramp,
            }
        } else if falling < 0.0 {
            Instant { rate, slope: 0.0 }
        } else if falling < self.ramp {
            Instant {
                rate: rate * (1.0 - falling / self.ramp),
                slope: -rate / self.ramp,
            }
        } else {
            Instant::REST
        }
    }
}

/// Length of a ramp, s.
fn ramp_s(config: &TrapezoidConfig) -> f64 {
    config.rate_deg_per_s.abs() / config.acceleration_deg_per_s2
}
