//! The largest rates a motion is told to reach.

use std::f64::consts::TAU;

use crate::scenario::{MotionConfig, SwingConfig};
use crate::units::{deg_per_s_to_rad_per_s, deg_to_rad};

/// Rate amplitude of a swing, rad/s; `A = 2 pi f theta` where the angle amplitude is given.
///
/// A swing of 1 deg/s at 5 Hz has an angle amplitude of only 114.6 arcsec.
///
/// # Panics
/// If neither or both amplitudes are set; the scenario reader refuses such a swing.
#[must_use]
pub fn swing_rate_amplitude_rad_per_s(swing: &SwingConfig) -> f64 {
    match (swing.rate_amplitude_deg_per_s, swing.angle_amplitude_deg) {
        (Some(rate), None) => deg_per_s_to_rad_per_s(rate),
        (None, Some(angle)) => TAU * swing.frequency_hz * deg_to_rad(angle),
        (rate, angle) => panic!("a swing has one amplitude, not rate {rate:?} and angle {angle:?}"),
    }
}

/// Largest commanded rate in magnitude, without the Earth's, rad/s.
#[must_use]
pub fn command_rate_max_rad_per_s(motion: &MotionConfig) -> f64 {
    match motion {
        MotionConfig::Static(_) => 0.0,
        MotionConfig::Swing(swing) => swing_rate_amplitude_rad_per_s(swing).abs(),
        MotionConfig::Rotation(rotation) => deg_per_s_to_rad_per_s(rotation.rate_deg_per_s).abs(),
        MotionConfig::Steps(steps) => {
            let rates = steps.rates_deg_per_s.iter().copied();
            rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
        }
    }
}
