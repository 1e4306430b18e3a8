//! One white source in the place of all others: the angle random walk of a data sheet.
//!
//! It enters at the input of the amplifier, as great as the slope at hand asks for: a loop, whatever its gain
//! and latency, turns a white current of density S into a walk of `sqrt(S / (2 gate_duty)) / (Ks slope)`.
//! What rounding adds is taken off beforehand, so that the walk of the words is the one asked for.

use std::f64::consts::TAU;

use crate::gyro::GyroConfig;
use crate::gyro::error::GyroError;
use crate::gyro::noise::word_rounding::rate_word_walk;
use crate::gyro::optics::coil::Coil;
use crate::units::{deg_per_sqrt_h_to_rad_per_sqrt_s, rad_per_sqrt_s_to_deg_per_sqrt_h};

/// Name in budgets, and of the stream it is drawn from on its own.
pub(super) const NAME: &str = "equivalent";
/// Largest part of the squared walk that rounding may take: beyond it the noise that is rounded is less than
/// a third of a step, and rounding is far from white.
const ROUNDING_SHARE_MAX: f64 = 0.5;
/// Rounds of the search below: rounding hardly depends on the noise where it is white.
const ROUNDS: usize = 4;

/// Walk that the equivalent source has to make, rad/sqrt(s): the one asked for without what rounding adds.
///
/// * `walk`: asked for, deg/sqrt(h).
/// * `converter_walk_rad_per_sqrt_s`: the walk of the rounding in the converter.
///
/// # Errors
/// [`GyroError::RoundingBeyondWalk`].
pub(in crate::gyro) fn equivalent_walk_rad_per_sqrt_s(
    walk: f64,
    config: &GyroConfig,
    coil: &Coil,
    converter_walk_rad_per_sqrt_s: f64,
) -> Result<f64, GyroError> {
    let converter = rad_per_sqrt_s_to_deg_per_sqrt_h(converter_walk_rad_per_sqrt_s);
    let periods = (
        f64::from(config.output.half_periods_per_sample)
            * coil.half_period_s(config.modulator.half_period_mismatch),
        1.0 / (TAU * config.controller.loop_bandwidth_hz),
    );
    let of_words = |detected: f64| rate_word_walk(detected, &config.output, periods);
    // It grows with the noise that is rounded, of which there is at most the whole walk.
    let words = of_words(walk);
    if converter.hypot(words).powi(2) > ROUNDING_SHARE_MAX * walk * walk {
        return Err(GyroError::RoundingBeyondWalk {
            least_deg_per_sqrt_h: converter.hypot(words) / ROUNDING_SHARE_MAX.sqrt(),
            walk_deg_per_sqrt_h: walk,
            converter_deg_per_sqrt_h: converter,
            words_deg_per_sqrt_h: words,
        });
    }
    let mut detected = walk;
    for _ in 0..ROUNDS {
        detected = (walk * walk - of_words(detected).powi(2)).sqrt();
    }
    let equivalent = (detected * detected - converter * converter).sqrt();
    Ok(deg_per_sqrt_h_to_rad_per_sqrt_s(equivalent))
}
