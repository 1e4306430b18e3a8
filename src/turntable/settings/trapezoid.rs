//! Settings of trapezoids of rate.

use crate::declare::table;

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
