//! Where the second-order effects end what a model holds, and what they do that is worth saying.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::gyro::Fidelity;
use crate::gyro::error::GyroError;
use crate::gyro::limits::MotionExtremes;
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::optics::coil::Coil;
use crate::gyro::parts::Parts;
use crate::gyro::vibration::Tone;
use crate::units::{
    deg_per_sqrt_h_to_rad_per_sqrt_s, rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s,
};

/// Noise of the register, steps, from which a cut-off step is a bias of half a bit (to 1 %).
const STEP_NOISE_MIN_LSB: f64 = 0.43;
/// Share of the dead band that vibration may take off it unsaid.
const NARROWING_MAX: f64 = 0.01;
/// Share of discarded loop periods from which the fall of the loop gain is worth a caution.
const BLANKED_SHARE_SAID: f64 = 0.1;

/// Refuses what the rate model leaves out of the second-order effects, and says what they do.
///
/// # Errors
/// [`GyroError::RateModelLacks`].
pub(in crate::gyro) fn optics(
    parts: &Parts,
    fidelity: Fidelity,
    motion: &MotionExtremes,
    tones: &[Tone],
) -> Result<Vec<String>, GyroError> {
    if !parts.optics.is_needed() {
        return Ok(Vec::new());
    }
    if fidelity == Fidelity::Rate {
        step_noise(parts)?;
        dither(parts)?;
        shaken_ramp(parts, tones)?;
    }
    let found = [
        step_limit(parts, fidelity, motion)?,
        dead_band(parts),
        blanking(parts, motion),
    ];
    Ok(found.into_iter().flatten().collect())
}

/// The register's noise must carry it across the bits of the step.
fn step_noise(parts: &Parts) -> Result<(), GyroError> {
    let lsb_rad = parts.optics.step_lsb_rad;
    let budget = NoiseBudget::new(&parts.detector, &parts.coil).detection_deg_per_sqrt_h();
    let walk = deg_per_sqrt_h_to_rad_per_sqrt_s(budget) * parts.coil.scale_factor_s;
    let error_rad = walk / parts.controller.loop_period_s.sqrt();
    // r[m+1] = (1 - g) r[m] + g e[m]; a latency only adds to it.
    let gain = parts.controller.gain;
    let noise_rad = error_rad * (gain / (2.0 - gain)).sqrt();
    if noise_rad >= STEP_NOISE_MIN_LSB * lsb_rad {
        return Ok(());
    }
    Err(GyroError::RateModelLacks {
        key: "gyro.controller.step_bits",
        reason: format!(
            "one bit of the ramp's step is {lsb_rad:.3e} rad and the register's noise {noise_rad:.3e} \
             rad, below the {STEP_NOISE_MIN_LSB} of a bit from which cutting off is a bias of half a \
             bit and not a dead zone"
        ),
    })
}

/// Dithered coupling is white noise only if the ramp forgets within a word where it was.
fn dither(parts: &Parts) -> Result<(), GyroError> {
    let optics = &parts.optics;
    if optics.coupling_rad <= 0.0 || optics.dither_rad <= 0.0 {
        return Ok(());
    }
    let half_periods = optics.dither_interval_periods * parts.timing.half_periods;
    if optics.dither_rad >= FRAC_PI_2 && half_periods <= parts.half_periods {
        return Ok(());
    }
    Err(GyroError::RateModelLacks {
        key: "gyro.modulator.dither_deg",
        reason: "it takes dithered cross-coupling for white noise, which takes jumps of at least \
                 90 deg rms and one in every output sample"
            .to_string(),
    })
}

/// Vibration swings the ramp, which narrows the dead band as dither does in a ring laser.
///
/// A swing of s rad leaves `J0(s) = 1 - s^2 / 4` of the coupling, tone by tone.
fn shaken_ramp(parts: &Parts, tones: &[Tone]) -> Result<(), GyroError> {
    if parts.optics.coupling_rad <= 0.0 || parts.optics.dither_rad > 0.0 {
        return Ok(());
    }
    let swing_rad = |tone: &Tone| {
        let phase_rad = tone.rate_rad_per_s.norm() * parts.coil.scale_factor_s;
        phase_rad / (TAU * tone.frequency_hz * parts.half_period_s)
    };
    let narrowing: f64 = tones
        .iter()
        .map(|tone| 0.25 * swing_rad(tone).powi(2))
        .sum();
    if narrowing <= NARROWING_MAX {
        return Ok(());
    }
    Err(GyroError::RateModelLacks {
        key: "gyro.modulator.cross_coupling_urad",
        reason: format!(
            "gyro.vibration swings the ramp by {:.2} rad rms, which narrows the dead band",
            (2.0 * narrowing).sqrt()
        ),
    })
}

fn step_limit(
    parts: &Parts,
    fidelity: Fidelity,
    motion: &MotionExtremes,
) -> Result<Option<String>, GyroError> {
    let limit = parts.optics.step_limit_rad / parts.coil.scale_factor_s;
    if motion.rate_rad_per_s < limit {
        return Ok(None);
    }
    let reason = format!(
        "gyro.controller.step_limit_deg: the step is held at {:.3} deg/s, but the motion reaches {:.3} \
         deg/s",
        rad_per_s_to_deg_per_s(limit),
        rad_per_s_to_deg_per_s(motion.rate_rad_per_s)
    );
    match fidelity {
        Fidelity::Rate => Err(GyroError::RateModelLacks {
            key: "gyro.controller.step_limit_deg",
            reason,
        }),
        Fidelity::Loop => Ok(Some(reason)),
    }
}

fn dead_band(parts: &Parts) -> Option<String> {
    let optics = &parts.optics;
    if optics.coupling_rad <= 0.0 || optics.dither_rad > 0.0 {
        return None;
    }
    Some(format!(
        "gyro.modulator.cross_coupling_urad: a dead band of +-{:.4} deg/h, in which the rate word is \
         zero but for noise",
        rad_per_s_to_deg_per_h(optics.coupling_rad / parts.coil.scale_factor_s)
    ))
}

fn blanking(parts: &Parts, motion: &MotionExtremes) -> Option<String> {
    if !parts.optics.is_reset_blanked {
        return None;
    }
    let share = blanked_share(
        &parts.coil,
        parts.timing.half_periods,
        motion.rate_rad_per_s,
    );
    (share > BLANKED_SHARE_SAID).then(|| {
        format!(
            "gyro.modulator.reset_sample = \"blanked\" discards {:.0} % of the loop periods at the \
             largest rate, and the loop gain falls with it; the rate model leaves that out",
            100.0 * share.min(1.0)
        )
    })
}

/// Resets per loop period at a rate.
fn blanked_share(coil: &Coil, half_periods: u32, rate_rad_per_s: f64) -> f64 {
    coil.scale_factor_s * rate_rad_per_s * f64::from(half_periods) / TAU
}
