//! Settings of a staircase of rates.

use crate::declare::table;

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
