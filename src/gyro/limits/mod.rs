//! Where the models' assumptions hold: what is refused and what is worth a caution.

mod second_order;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::gyro::controller::Controller;
use crate::gyro::error::{GyroError, slopes_text};
use crate::gyro::limits::second_order::optics;
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::detector::Detector;
use crate::gyro::optics::modulator::Modulator;
use crate::gyro::parts::Parts;
use crate::gyro::vibration::{Tone, VibrationResponse, tones};
use crate::gyro::{Fidelity, GyroConfig, NoiseDraw};
use crate::random::Streams;
use crate::units::{
    deg_per_h_to_rad_per_s, deg_per_sqrt_h_to_rad_per_sqrt_s, rad_per_s_to_deg_per_h,
    rad_per_s_to_deg_per_s,
};

/// Departure of the converter's slope from nominal up to which rounding counts as white noise.
const SLOPE_ERROR_MAX: f64 = 0.05;
/// Phase error above which the sine is worth a caution: it lengthens the settling by
/// `phi^2 / 18` = 1 %.
const PHASE_ERROR_SAID_RAD: f64 = 0.42;
/// Phase step of the ramp converter above which the fringe is not linear over it.
const RAMP_STEP_MAX_RAD: f64 = 0.1;
/// Share of a word's noise power from which the ramp converter's rounding is worth a caution.
const RAMP_POWER_SAID: f64 = 0.05;

/// The hardest motion a run asks of the gyro; magnitudes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionExtremes {
    /// Largest rate on the input axis, Earth rate included, rad/s.
    pub rate_rad_per_s: f64,
    /// Largest sudden change, the first rate (the loop starts from zero) included, rad/s.
    pub jump_rad_per_s: f64,
    /// Largest acceleration apart from jumps, rad/s^2.
    pub acceleration_rad_per_s2: f64,
}

/// Refuses what a model cannot represent, and says what it represents but the budget does not.
///
/// * **Fringe.** A Sagnac phase beyond pi is ambiguous: `|rate| < pi / Ks`. The rate model refuses
///   more; the loop model follows from rest, or locks onto a wrong fringe after a jump.
/// * **Phase error.** A jump J leaves the error `Ks J`, a steady acceleration A the error
///   `Ks A T_L / g`. The loop sees its sine: the restoring slope is lost at pi/2, the fringe at pi.
///   With `d phi / dt = -(g / T_L) sin phi` the angle lost while settling is
///   `(T_L / g) int x / sin x dx`, longer than the linear one by `phi^2 / 18` to first order.
/// * **Converter.** For Gaussian noise of s steps at the input, the mean of the rounded level x
///   has the slope `1 + 2 sum_k (-1)^k exp(-2 pi^2 s^2 k^2) cos(2 pi k x)`. Rounding is white noise
///   of `q^2 / 12` only while that is 1; the limit of 5 % is s = 0.432. The loop's gain, bandwidth
///   and lag go with the slope, the angle random walk against it; without noise the slope is 0
///   within a code, a dead zone. All samples of a half period see the same x, so that the ratio
///   s is that of one sample, for either way of drawing the noise.
/// * **Ramp converter.** A step L of phase is rounded in the integral, so that the mean rate is
///   right while the fringe is linear over L (0.1 rad). What is left is `L^2 / 12` at both ends of
///   an output sample of M half periods: up to `L^2 / (6 M^2)` of a word's mean step, the less the
///   smoother the loop. The rate
///   model leaves it out: refused beyond the word's white noise, said from a twentieth of it.
///
/// * **Vibration** adds its peak rates and accelerations, and its rectified mean is said.
///
/// Ideal converters (0 bits) have no such limits, with or without noise.
///
/// # Errors
/// Any [`GyroError`] of the configuration; for the rate model [`GyroError::RateBeyondFringe`],
/// [`GyroError::PhaseErrorBeyondSlope`], [`GyroError::ConverterTooCoarse`],
/// [`GyroError::RampTooCoarse`] and [`GyroError::RateModelLacks`].
///
/// # Source
/// Derived; the slope from the Fourier series of the rounding error, averaged over the noise.
pub fn cautions(
    config: &GyroConfig,
    fidelity: Fidelity,
    motion: &MotionExtremes,
) -> Result<Vec<String>, GyroError> {
    let parts = Parts::new(config)?;
    // Neither peaks nor the mean depend on the phases drawn.
    let tones = tones(&config.vibration, &Streams::new(0, 0));
    let motion = &shaken(motion, &tones);
    let second_order = optics(&parts, fidelity, motion, &tones)?;
    let rectified = rectification(tones, &parts);
    let Parts {
        coil,
        modulator,
        detector,
        controller,
        ..
    } = parts;
    let found = [
        rectified,
        fringe(config, fidelity, motion, &coil)?,
        phase_error(fidelity, motion, &coil, &controller)?,
        converter(config, fidelity, &detector, &coil)?,
        ramp(config, fidelity, &detector, &modulator, &coil)?,
    ];
    Ok(found.into_iter().flatten().chain(second_order).collect())
}

/// The motion with all tones of the vibration in step.
fn shaken(motion: &MotionExtremes, tones: &[Tone]) -> MotionExtremes {
    let mut shaken = *motion;
    for tone in tones {
        let rate = tone.rate_rad_per_s.norm();
        shaken.rate_rad_per_s += rate;
        shaken.acceleration_rad_per_s2 += TAU * tone.frequency_hz * rate;
    }
    shaken
}

fn rectification(tones: Vec<Tone>, parts: &Parts) -> Option<String> {
    let response = VibrationResponse::new(tones, parts)?;
    let mean = response.mean_rad() / parts.coil.scale_factor_s;
    Some(format!(
        "gyro.vibration: the loop rectifies it into a mean error of {:.4} deg/h, power times \
         residual phase to second order; truth is the rate of the table's axis, without the case's",
        rad_per_s_to_deg_per_h(mean)
    ))
}

fn fringe(
    config: &GyroConfig,
    fidelity: Fidelity,
    motion: &MotionExtremes,
    coil: &Coil,
) -> Result<Option<String>, GyroError> {
    let bias = deg_per_h_to_rad_per_s(config.slow_noise.bias_deg_per_h).abs();
    let rate_deg_per_s = rad_per_s_to_deg_per_s(motion.rate_rad_per_s + bias);
    let limit_deg_per_s = rad_per_s_to_deg_per_s(coil.single_fringe_rate_rad_per_s());
    if rate_deg_per_s < limit_deg_per_s {
        return Ok(None);
    }
    match fidelity {
        Fidelity::Rate => Err(GyroError::RateBeyondFringe {
            rate_deg_per_s,
            limit_deg_per_s,
        }),
        Fidelity::Loop => Ok(Some(format!(
            "up to {rate_deg_per_s:.3} deg/s on the input axis, beyond the single-fringe range of \
             +-{limit_deg_per_s:.3} deg/s: the words are right only if the loop follows from rest"
        ))),
    }
}

fn phase_error(
    fidelity: Fidelity,
    motion: &MotionExtremes,
    coil: &Coil,
    controller: &Controller,
) -> Result<Option<String>, GyroError> {
    let lag_s = controller.loop_period_s / controller.gain;
    // No motion leaves a larger error than a reversal in no time.
    let lag = (motion.acceleration_rad_per_s2 * lag_s).min(2.0 * motion.rate_rad_per_s);
    let error_rad = coil.scale_factor_s * motion.jump_rad_per_s.max(lag);
    let fringe_deg_per_s = 2.0 * rad_per_s_to_deg_per_s(coil.single_fringe_rate_rad_per_s());
    match fidelity {
        Fidelity::Rate if error_rad >= FRAC_PI_2 => Err(GyroError::PhaseErrorBeyondSlope {
            phase_error_rad: error_rad,
        }),
        Fidelity::Rate if error_rad > PHASE_ERROR_SAID_RAD => Ok(Some(format!(
            "the motion drives the phase error to {error_rad:.3} rad: the rate model is linear and \
             loses {:.1} % too little angle while it settles; fidelity = \"loop\" has the sine",
            100.0 * error_rad * error_rad / 18.0
        ))),
        Fidelity::Loop if error_rad >= PI => Ok(Some(format!(
            "the motion drives the phase error to {error_rad:.3} rad, beyond pi: the loop locks \
             onto a wrong fringe, off by a multiple of {fringe_deg_per_s:.3} deg/s"
        ))),
        Fidelity::Loop if error_rad >= FRAC_PI_2 => Ok(Some(format!(
            "the motion drives the phase error to {error_rad:.3} rad, beyond pi/2: the loop pulls \
             the less the further it is off and settles late"
        ))),
        _ => Ok(None),
    }
}

fn converter(
    config: &GyroConfig,
    fidelity: Fidelity,
    detector: &Detector,
    coil: &Coil,
) -> Result<Option<String>, GyroError> {
    let Some(noise_lsb) = detector.noise_steps(coil.transit_time_s) else {
        return Ok(None);
    };
    let count = detector.samples_per_half_period;
    let step_a = detector.converter_step_v / detector.transimpedance_v_per_a;
    let limit_lsb = noise_limit_lsb();
    if noise_lsb >= limit_lsb {
        return Ok(None);
    }
    let (slope_min, slope_max) = (slope(noise_lsb, 0.0), slope(noise_lsb, 0.5));
    if fidelity == Fidelity::Rate {
        return Err(GyroError::ConverterTooCoarse {
            noise_lsb,
            limit_lsb,
            slope_min,
            slope_max,
        });
    }
    let is_combined = config.noise.draw == NoiseDraw::Combined;
    let rounded_a = if is_combined {
        step_a / count.sqrt()
    } else {
        step_a
    };
    let hidden_rad = 0.5 * rounded_a / detector.slope_a_per_rad;
    let drawn = if is_combined {
        format!(
            "; gyro.noise.draw = \"combined\" rounds the mean of {count} samples once, to {:.3} \
             LSB under {:.3} LSB of noise, elsewhere between two codes than \"exact\" does",
            count.sqrt().recip(),
            noise_lsb / count.sqrt()
        )
    } else {
        String::new()
    };
    let slopes = slopes_text(slope_min, slope_max);
    Ok(Some(format!(
        "gyro.adc: {noise_lsb:.3} LSB of noise per sample, below the {limit_lsb:.3} LSB from which \
         rounding counts as white noise: with the level, the slope of the converter lies between \
         {slopes}, and bandwidth and noise with it; phase \
         errors up to {hidden_rad:.2e} rad ({:.3} deg/h) lie within one code; the noise budget \
         does not hold{drawn}",
        rad_per_s_to_deg_per_h(hidden_rad / coil.scale_factor_s)
    )))
}

fn ramp(
    config: &GyroConfig,
    fidelity: Fidelity,
    detector: &Detector,
    modulator: &Modulator,
    coil: &Coil,
) -> Result<Option<String>, GyroError> {
    if fidelity == Fidelity::Loop || !modulator.is_quantised {
        return Ok(None);
    }
    let step_rad = TAU / modulator.codes_per_turn;
    let half_periods = f64::from(config.output.half_periods_per_sample);
    let period_s = half_periods * coil.transit_time_s;
    let walk = deg_per_sqrt_h_to_rad_per_sqrt_s(
        NoiseBudget::new(detector, coil).detection_deg_per_sqrt_h(),
    );
    let rounding = step_rad / (6.0_f64.sqrt() * half_periods * coil.scale_factor_s);
    let noise = walk / period_s.sqrt();
    let (rounding_deg_per_h, noise_deg_per_h) = (
        rad_per_s_to_deg_per_h(rounding),
        rad_per_s_to_deg_per_h(noise),
    );
    let is_drowned = noise > 0.0 && rounding > noise;
    if step_rad > RAMP_STEP_MAX_RAD || is_drowned {
        return Err(GyroError::RampTooCoarse {
            step_rad,
            rounding_deg_per_h,
            noise_deg_per_h,
        });
    }
    if rounding * rounding <= RAMP_POWER_SAID * noise * noise {
        return Ok(None);
    }
    Ok(Some(format!(
        "gyro.modulator.dac_bits: the rate model leaves out the ramp converter's rounding, up to \
         {rounding_deg_per_h:.3} deg/h rms per word beside {noise_deg_per_h:.3} deg/h of white \
         noise; fidelity = \"loop\" has it"
    )))
}

/// Noise at which the slope departs from nominal by the limit, steps: the first term of its series.
fn noise_limit_lsb() -> f64 {
    (2.0 / SLOPE_ERROR_MAX).ln().sqrt() / (PI * 2.0_f64.sqrt())
}

/// Slope of the mean rounded level at `position` steps from a code, for Gaussian noise.
///
/// The density of the noise summed over the thresholds, which is the Fourier series of
/// [`cautions`] by Poisson's formula, and converges fast where the noise is small.
fn slope(noise_steps: f64, position: f64) -> f64 {
    if noise_steps <= 0.0 {
        return if position < 0.5 { 0.0 } else { f64::INFINITY };
    }
    (-8..8)
        .map(|threshold| {
            let distance = (position - f64::from(threshold) - 0.5) / noise_steps;
            (-0.5 * distance * distance).exp()
        })
        .sum::<f64>()
        / (TAU.sqrt() * noise_steps)
}
