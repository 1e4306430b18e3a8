//! Settings of a scale factor test.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Scale factor test: rest, the rates of one sense from small to large, those of the other, rest.
    pub struct ScaleFactorTestConfig {
        /// Preferred numbers that the rates are taken from: five or ten a decade. Source of the default:
        /// GB 321 as the Chinese method takes it.
        preferred_series: PreferredSeries = "R5";
        /// Smallest rate; the rates of each sense are the members of the series from here on, at least 11.
        from_deg_per_s: f64, example 1.0, in 1e-4..=2000.0, "deg/s";
        /// Largest rate, a member of the series or not.
        to_deg_per_s: f64, example 100.0, in 1e-4..=2000.0, "deg/s";
        /// Time measured at each rate; all of them, with static_s and settle_s, must fit into the duration.
        dwell_s: f64, example 0.1, in 1e-6..=1e6, "s";
        /// Longest time to which a dwell is stretched so that the table turns whole turns.
        dwell_max_s: Option<f64>, example 4.0, in 1e-6..=1e6, "s";
        /// Time measured at rest before and after the rates, the zero that is subtracted.
        static_s: f64, example 0.5, in 1e-6..=1e6, "s";
        /// Time left out before each measurement. Source of the default: as of turntable.steps.
        settle_s: f64 = 0.1, in 0.0..=1e6, "s";
    }
}

words! {
    /// Series of preferred numbers.
    pub enum PreferredSeries {
        /// Five a decade.
        R5 = "R5",
        /// Ten a decade.
        R10 = "R10",
    }
}
