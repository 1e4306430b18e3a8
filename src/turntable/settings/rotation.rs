//! Settings of a constant rotation.

use crate::declare::table;

table! {
    /// Constant rotation.
    pub struct RotationConfig {
        /// Constant rate.
        rate_deg_per_s: f64, example 10.0, in -2000.0..=2000.0, "deg/s";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
    }
}
