//! Settings of the temperature of the chamber.

use crate::declare::{alternatives, table};

alternatives! {
    /// Chamber temperature against time, counted from the start of the simulation (the warm-up
    /// included): exactly one course.
    pub enum TemperatureConfig, one "temperature profile", first by default {
        Soak(SoakConfig) = "soak",
        Ramp(TemperatureRampConfig) = "ramp",
        Profile(TemperatureProfileConfig) = "profile",
    }
}

table! {
    /// Constant temperature.
    pub struct SoakConfig {
        /// Temperature of the chamber, constant. Source of the default: the paper's room-temperature test.
        temperature_c: f64 = 25.0, in -100.0..=150.0, "C";
    }
}

table! {
    /// One ramp; constant before and after.
    pub struct TemperatureRampConfig {
        /// Temperature of the chamber before the ramp.
        start_c: f64, example 25.0, in -100.0..=150.0, "C";
        /// Temperature after it.
        end_c: f64, example 60.0, in -100.0..=150.0, "C";
        /// Slope; its sign leads from the start to the end.
        rate_c_per_min: f64, example 1.0, in -1000.0..=1000.0, "K/min";
        /// Time at which the ramp starts. All times of the temperature count from the start of the simulation,
        /// warm-up included. Source of the default: none, at once.
        start_s: f64 = 0.0, in 0.0..=1e7, "s";
    }
}

table! {
    /// Straight lines between points. Here: down to -40 C at 1 K/min, two hours there, up to 60 C, two hours.
    pub struct TemperatureProfileConfig {
        /// Times of the points, increasing; constant before the first and after the last.
        times_s: Vec<f64>, example [0.0, 3900.0, 11100.0, 17100.0, 24300.0], in 0.0..=1e7, "s";
        /// Temperature of the chamber at each time.
        temperatures_c: Vec<f64>, example [25.0, -40.0, -40.0, 60.0, 60.0], in -100.0..=150.0, "C";
    }
}
