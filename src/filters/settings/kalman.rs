//! Settings of a Kalman filter.

use crate::declare::table;
use crate::vocabulary::OutputRegister;

table! {
    /// Kalman filter for a rate that walks slowly, in white noise: a one-pole filter once settled.
    pub struct KalmanFilterConfig {
        /// Standard deviation of the white noise of one word. Source of the default: the noise budget.
        measurement_noise_deg_per_h: f64 = 19.0, in 1e-6..=1e9, "deg/h";
        /// Random walk of the rate that the filter reckons with. Source of the default: assumed; gives
        /// half power at about 100 Hz.
        rate_random_walk_deg_per_h_per_sqrt_s: f64 = 190.0, in 1e-9..=1e9, "deg/h/sqrt(s)";
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}
