//! Settings of a swing.

use crate::declare::table;

table! {
    /// Swing about the table axis: a sine of rate.
    pub struct SwingConfig,
    one "amplitude" of rate_amplitude_deg_per_s | angle_amplitude_deg
    {
        /// Rate amplitude; give this or angle_amplitude_deg.
        rate_amplitude_deg_per_s: Option<f64>, example 1.0, in 1e-9..=2000.0, "deg/s";
        /// Angle amplitude; the rate amplitude is 2 pi f times this.
        angle_amplitude_deg: Option<f64>, example 1.0, in 1e-9..=360.0, "deg";
        /// Swing frequency; a cycle must span at least 8 output samples.
        frequency_hz: f64, example 5.0, in 1e-6..=1000.0, "Hz";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
        /// The table rests through the warm-up and swings from the start of the record, at once: how long do
        /// filters that learned at rest take? soft_start_s must then be 0.
        from_rest: bool = false;
    }
}
