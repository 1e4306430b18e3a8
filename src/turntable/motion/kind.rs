//! The largest rates a motion is told to reach.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::campaign::campaign_extremes;
use super::chirp::{chirp_frequency_max, chirp_rate_max, chirp_widening_max};
use super::script::script_extremes;
use crate::scenario::{CampaignConfig, MotionConfig, MultiSineConfig, SwingConfig};
use crate::units::{deg_per_s_to_rad_per_s, deg_to_rad};

/// What a trapezoid, chirp or script asks of the table at most; see [`command_extremes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandExtremes {
    /// Largest jump of the rate, the one from rest at the start included, rad/s.
    pub jump_rad_per_s: f64,
    /// Largest acceleration in magnitude, rad/s^2.
    pub acceleration_rad_per_s2: f64,
}

/// Jump and acceleration of a motion whose acceleration is its own; `None` for rest, swing,
/// rotation, campaign and steps, where it depends on the warm-up or the servo.
///
/// # Panics
/// If a chirp has not exactly one amplitude or a script not either rates or angles; the scenario
/// reader refuses both.
#[must_use]
pub fn command_extremes(motion: &MotionConfig) -> Option<CommandExtremes> {
    let (jump_rad_per_s, acceleration_rad_per_s2) = match motion {
        MotionConfig::Static(_)
        | MotionConfig::Swing(_)
        | MotionConfig::MultiSine(_)
        | MotionConfig::Rotation(_)
        | MotionConfig::Calibration(_)
        | MotionConfig::Steps(_)
        | MotionConfig::ScaleFactorTest(_) => return None,
        MotionConfig::Trapezoid(trapezoid) => (
            0.0,
            deg_per_s_to_rad_per_s(trapezoid.acceleration_deg_per_s2),
        ),
        MotionConfig::Chirp(chirp) => {
            let rate = chirp_rate_max(chirp);
            let shortest_s = chirp.soft_start_s.min(chirp.soft_stop_s);
            let is_soft = shortest_s > 0.0;
            // The steepest envelope and the fastest sine need not meet: their sum is a bound.
            let envelope = if is_soft { FRAC_PI_2 / shortest_s } else { 0.0 };
            let turning = TAU * chirp_frequency_max(chirp);
            let jump = if is_soft { 0.0 } else { rate };
            (
                jump,
                rate * (turning + envelope) + chirp_widening_max(chirp),
            )
        }
        MotionConfig::Script(script) => {
            let extremes = script_extremes(&script.points);
            (extremes.first_rate.abs(), extremes.acceleration)
        }
    };
    Some(CommandExtremes {
        jump_rad_per_s,
        acceleration_rad_per_s2,
    })
}

/// Jump and acceleration of a campaign after a warm-up of whole samples, s.
#[must_use]
pub fn campaign_command_extremes(config: &CampaignConfig, warm_up_s: f64) -> CommandExtremes {
    let (jump_rad_per_s, acceleration_rad_per_s2) = campaign_extremes(config, warm_up_s);
    CommandExtremes {
        jump_rad_per_s,
        acceleration_rad_per_s2,
    }
}

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

/// Rate amplitudes of several sines, rad/s.
fn multi_sine_amplitudes_rad_per_s(config: &MultiSineConfig) -> impl Iterator<Item = f64> {
    (0..config.frequencies_hz.len())
        .map(|index| deg_per_s_to_rad_per_s(config.rate_amplitude_deg_per_s(index)))
}

/// Bound of the acceleration of several sines, rad/s^2: they may all peak at once.
#[must_use]
pub fn multi_sine_acceleration_max_rad_per_s2(config: &MultiSineConfig) -> f64 {
    let amplitudes = multi_sine_amplitudes_rad_per_s(config);
    amplitudes
        .zip(&config.frequencies_hz)
        .map(|(amplitude, frequency_hz)| TAU * frequency_hz * amplitude)
        .sum()
}

/// Largest commanded rate in magnitude, without the Earth's, rad/s; of several sines its bound.
#[must_use]
pub fn command_rate_max_rad_per_s(motion: &MotionConfig) -> f64 {
    match motion {
        MotionConfig::Static(_) => 0.0,
        MotionConfig::Swing(swing) => swing_rate_amplitude_rad_per_s(swing).abs(),
        MotionConfig::MultiSine(multi_sine) => multi_sine_amplitudes_rad_per_s(multi_sine).sum(),
        MotionConfig::Rotation(rotation) => deg_per_s_to_rad_per_s(rotation.rate_deg_per_s).abs(),
        MotionConfig::Trapezoid(trapezoid) => {
            deg_per_s_to_rad_per_s(trapezoid.rate_deg_per_s).abs()
        }
        MotionConfig::Chirp(chirp) => chirp_rate_max(chirp),
        MotionConfig::Script(script) => script_extremes(&script.points).rate,
        MotionConfig::ScaleFactorTest(test) => deg_per_s_to_rad_per_s(test.to_deg_per_s),
        MotionConfig::Calibration(campaign) => {
            let rates = campaign.rates_deg_per_s.iter().copied();
            rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
        }
        MotionConfig::Steps(steps) => {
            let rates = steps.rates_deg_per_s.iter().copied();
            rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
        }
    }
}
