//! Settings of the angle encoder.

use crate::declare::table;

table! {
    /// The angle encoder: what a laboratory sees of the axis. Truth is the axis itself, whatever the
    /// encoder shows. The table has an encoder if it has a resolution; the other keys need one.
    pub struct EncoderConfig {
        /// Least step of the encoder, 0 for none.
        resolution_arcsec: Option<f64>, example 0.36, in 0.0..=3600.0, "arcsec";
        /// Age of the angle that a reading shows; at most one tick of a direct-drive servo. Source of the
        /// default: none, it is an ideal encoder; real ones have up to some 100 us.
        latency_us: f64 = 0.0, in 0.0..=10000.0, "us";
        /// Amplitude of the error once per revolution, from an eccentric disc. Source of the default: none,
        /// as above; 0.5 is typical.
        eccentricity_error_arcsec: f64 = 0.0, in 0.0..=3600.0, "arcsec";
        /// Phase of that error at angle 0.
        eccentricity_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
        /// Amplitude of the error once per line, from interpolating between lines. Source of the default:
        /// none, as above; 0.5 is typical.
        interpolation_error_arcsec: f64 = 0.0, in 0.0..=3600.0, "arcsec";
        /// Phase of that error at angle 0.
        interpolation_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
        /// Lines of the disc, with which the interpolation error repeats. Source of the default: a line
        /// every 36 arcsec, typical of optical encoders.
        lines_per_revolution: u32 = 36000, in 1..=10_000_000;
    }
}
