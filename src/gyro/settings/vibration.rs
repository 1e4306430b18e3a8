//! Settings of the vibration of the gyro's case.

use crate::declare::{alternatives, table};

table! {
    /// Vibration of the gyro's case, and what it does to the gyro.
    pub struct VibrationConfig {
        /// Relative change of the detected power per acceleration: fibre pigtails and connectors that bend.
        /// Source of the default: assumed.
        intensity_per_g: f64 = 0.001, in -1.0..=1.0, "1/g";
        /// Rate error per acceleration: a coil that strains in step with the acceleration. Source of the
        /// default: none.
        rate_error_deg_per_h_per_g: f64 = 0.0, in -1e6..=1e6, "deg/h/g";
        #[serde(flatten)]
        motion: VibrationMotion;
    }
}

alternatives! {
    /// Vibration of the case: exactly one kind.
    pub enum VibrationMotion, one "vibration", first by default {
        /// The case does not vibrate. Otherwise one tone (sine) or a band (random) of acceleration and of
        /// rate about the input axis, relative to the table, whose rate alone stays truth.
        Off(NoVibrationConfig) = "off",
        Sine(SineVibrationConfig) = "sine",
        Random(RandomVibrationConfig) = "random",
    }
}

table! {
    /// Nothing to set.
    pub struct NoVibrationConfig {}
}

table! {
    /// Acceleration `A sin(2 pi f t)` and rate about the input axis `W sin(2 pi f t + phase)`.
    pub struct SineVibrationConfig {
        /// Frequency; below half the rate of the half modulation periods, 1 / (2 tau).
        frequency_hz: f64, example 300.0, in 1e-6..=100000.0, "Hz";
        /// Amplitude A of the acceleration A sin(2 pi f t). Source of the default: assumed.
        acceleration_g: f64 = 1.0, in 0.0..=1000.0, "g";
        /// Amplitude of the rate about the input axis. Source of the default: none.
        rate_amplitude_deg_per_s: f64 = 0.0, in 0.0..=2000.0, "deg/s";
        /// Phase by which the rate leads the acceleration. Source of the default: none.
        rate_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
    }
}

table! {
    /// Acceleration and rate of flat one-sided density in a band, as a sum of tones.
    pub struct RandomVibrationConfig {
        /// Lower edge of the band.
        from_hz: f64, example 20.0, in 1e-6..=100000.0, "Hz";
        /// Upper edge of the band; below half the rate of the half modulation periods.
        to_hz: f64, example 2000.0, in 1e-6..=100000.0, "Hz";
        /// One-sided density of the acceleration. Source of the default: assumed.
        acceleration_psd_g2_per_hz: f64 = 0.01, in 0.0..=1e6, "g^2/Hz";
        /// One-sided density of the rate about the input axis. Source of the default: none.
        rate_psd_deg2_per_s2_per_hz: f64 = 0.0, in 0.0..=1e6, "(deg/s)^2/Hz";
        /// Tones that make up the band, one in each of as many equal parts, random in phase. Source of the
        /// default: assumed, 31 Hz apart from 20 to 2000 Hz.
        tones: u32 = 64, in 1..=1024;
        /// Whether rate and acceleration are locked in phase, as on a bracket that rocks.
        coherent: bool = false;
        /// Phase by which a coherent rate leads the acceleration. Source of the default: none.
        rate_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
    }
}
