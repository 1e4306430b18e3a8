//! What the rounding of the rate words adds to the angle random walk.

use std::f64::consts::PI;

use crate::gyro::rate_word::RateOutputConfig;
use crate::units::{deg_per_h_sqrt_s_to_deg_per_sqrt_h, deg_per_sqrt_h_to_deg_per_h_sqrt_s};

/// Noise of a word in steps below which the series of its rounding is as good as its limit (1e-11).
const SMALL_NOISE_STEPS: f64 = 0.1;
/// Terms of the series above: the next is `exp(-4 pi^2 121 / 100)`.
const ROUNDING_TERMS: u32 = 10;

/// Angle random walk that the rounding of the rate words adds to one that the loop sees, deg/sqrt(h).
///
/// A word of period T behind a loop of time constant `t` scatters by
/// `s^2 = (N^2 / T) (1 - (t / T) (1 - exp(-T / t)))`. Rounded to a step q it has, in the mean over
/// the rates, `q^2 (1/12 - sum exp(-4 pi^2 k^2 s^2 / q^2) / (2 pi^2 k^2))` more: `q^2 / 12` where the
/// noise of a word exceeds a third of the step, and nothing without noise, which moves no word.
/// White from word to word, that is an angle random walk of `q sqrt(T / 12)`. Pulses carry their
/// remainder over and have none.
///
/// * `periods`: of a word, and the time constant of the loop, s.
///
/// # Source
/// Derived: Fourier series of the error of rounding, as in Widrow and Kollar, Quantization Noise,
/// chapter 4.
pub(super) fn rate_word_walk(
    walk_deg_per_sqrt_h: f64,
    config: &RateOutputConfig,
    periods: (f64, f64),
) -> f64 {
    let (word_period_s, loop_time_constant_s) = periods;
    let step = config.word_step_deg_per_h();
    if step <= 0.0 {
        return 0.0;
    }
    let walk = deg_per_sqrt_h_to_deg_per_h_sqrt_s(walk_deg_per_sqrt_h);
    let ratio = loop_time_constant_s / word_period_s;
    let kept = 1.0 + ratio * (-1.0 / ratio).exp_m1();
    let squared = walk * walk * kept / (word_period_s * step * step);
    let added = if squared < SMALL_NOISE_STEPS * SMALL_NOISE_STEPS {
        // Of words near the border between two steps, s / sqrt(pi) in all.
        (squared / PI).sqrt() - squared
    } else {
        let regular = (1..=ROUNDING_TERMS).map(|k| {
            let k_squared = f64::from(k * k);
            (-4.0 * PI * PI * k_squared * squared).exp() / (2.0 * PI * PI * k_squared)
        });
        1.0 / 12.0 - regular.sum::<f64>()
    };
    let variance = step * step * added;
    deg_per_h_sqrt_s_to_deg_per_sqrt_h((variance * word_period_s).sqrt())
}
