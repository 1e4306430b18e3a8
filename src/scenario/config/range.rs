//! A range of a swept key: `{ from = 100, to = 2000, count = 9, spacing = "log" }`.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Values of a swept key between two ends, both of which are among them.
    pub struct RangeConfig {
        /// First value, in the unit of the swept key.
        from: f64, example 100.0, in -1e300..=1e300;
        /// Last value, in the unit of the swept key; it may lie below the first.
        to: f64, example 2000.0, in -1e300..=1e300;
        /// Number of values.
        count: u32, example 9, in 2..=10_000;
        /// Steps from value to value.
        spacing: Spacing = "linear";
    }
}

words! {
    /// Steps of a range.
    pub enum Spacing {
        /// Equal differences.
        Linear = "linear",
        /// Equal ratios: both ends above 0.
        Log = "log",
    }
}
