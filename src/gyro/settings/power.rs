//! Settings of the detected power against temperature.

use crate::declare::{alternatives, table};

alternatives! {
    /// Detected power against the temperature of the case: exactly one law.
    pub enum PowerConfig, one "power law", first by default {
        Quadratic(QuadraticPowerConfig) = "quadratic",
        Exponential(ExponentialPowerConfig) = "exponential",
        /// The same power at every temperature.
        Constant(ConstantPowerConfig) = "constant",
    }
}

table! {
    /// Parabola through (cold, ratio), (reference, 1) and (hot, ratio).
    pub struct QuadraticPowerConfig {
        /// A temperature below the reference. Source of the default: the paper's cold test.
        cold_c: f64 = -40.0, in -100.0..=150.0, "C";
        /// Power there over the power at the reference. Source of the default: derived, it gives the paper's
        /// 0.0065 deg/sqrt(h) at -40 C.
        cold_ratio: f64 = 0.853, in 1e-3..=100.0;
        /// A temperature above the reference. Source of the default: the paper's hot test.
        hot_c: f64 = 60.0, in -100.0..=150.0, "C";
        /// Power there over the power at the reference. Source of the default: derived, it gives the paper's
        /// 0.0064 deg/sqrt(h) at 60 C.
        hot_ratio: f64 = 0.967, in 1e-3..=100.0;
    }
}

table! {
    /// Exponential fall with temperature: `exp(-(T - reference) / fall)`.
    pub struct ExponentialPowerConfig {
        /// Kelvins over which the power falls by e; 40 to 70 for an uncooled source at constant current.
        fall_k: f64, example 55.0, in 1.0..=1e6, "K";
    }
}

table! {
    /// Nothing to set.
    pub struct ConstantPowerConfig {
    }
}
