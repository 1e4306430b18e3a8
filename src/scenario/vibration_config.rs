//! The configuration of the vibration: names are the keys of the scenario file, units included.

use serde::Deserialize;

use super::turntable_config::StaticConfig;

/// Vibration of the gyro's case, and what it does to the gyro.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct VibrationConfig {
    /// Relative change of the detected power per acceleration, 1/g.
    pub intensity_per_g: f64,
    /// Rate error per acceleration, deg/h/g.
    pub rate_error_deg_per_h_per_g: f64,
    /// How the case vibrates (`[gyro.vibration.off]`, `.sine` or `.random`).
    #[serde(flatten)]
    pub motion: VibrationMotion,
}

/// Vibration of the case: exactly one kind.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VibrationMotion {
    /// None.
    Off(StaticConfig),
    /// One tone.
    Sine(SineVibrationConfig),
    /// A band of flat spectral density.
    Random(RandomVibrationConfig),
}

/// Acceleration `A sin(2 pi f t)` and rate about the input axis `W sin(2 pi f t + phase)`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SineVibrationConfig {
    /// Frequency f, Hz.
    pub frequency_hz: f64,
    /// Acceleration amplitude A, g.
    pub acceleration_g: f64,
    /// Rate amplitude W about the input axis, deg/s.
    pub rate_amplitude_deg_per_s: f64,
    /// Phase by which the rate leads the acceleration, deg.
    pub rate_phase_deg: f64,
}

/// Acceleration and rate of flat one-sided density in a band, as a sum of tones.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomVibrationConfig {
    /// Lower edge of the band, Hz.
    pub from_hz: f64,
    /// Upper edge of the band, Hz.
    pub to_hz: f64,
    /// Density of the acceleration, g^2/Hz.
    pub acceleration_psd_g2_per_hz: f64,
    /// Density of the rate about the input axis, (deg/s)^2/Hz.
    pub rate_psd_deg2_per_s2_per_hz: f64,
    /// Tones that make up the band.
    pub tones: u32,
    /// Whether rate and acceleration are locked in phase, as on a bracket that rocks.
    pub coherent: bool,
    /// Phase by which a coherent rate leads the acceleration, deg.
    pub rate_phase_deg: f64,
}
