//! What the converter hands to the demodulator in one half period.
//!
//! Levels are counted in a unit that makes the rounding a rounding to whole numbers: the
//! converter step q over sqrt(n) for the mean of n samples (so that one rounding has the noise of
//! n, `q^2 / 12 n`, and one normal the same ratio to the step as each of n would have), or the
//! voltage of the nominal mean power for an ideal converter.

use crate::gyro::noise::exact_draw::{DrawUnits, ExactDraw};
use crate::gyro::optics::detector::Detector;
use crate::gyro::optics::modulator::Modulator;
use crate::random::{Stream, Streams};

/// Adding and subtracting `1.5 * 2^52` rounds to the nearest whole number, ties to even.
///
/// `f64::round` is a library call in the default x86-64 build; this is two additions. Valid for
/// magnitudes below `2^51`.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Phase error below which the fringe is a polynomial, rad: the degree is right to 1e-16 there.
const SMALL_PHASE_RAD: f64 = 1.0 / 32.0;

/// Rounds to the nearest whole number, ties to even; `|value| < 2^51`.
#[inline(always)]
pub(super) fn round_whole(value: f64) -> f64 {
    (value + ROUNDER) - ROUNDER
}

/// Half periods that went wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Faults {
    /// Half periods in which the converter was beyond its range.
    pub(super) saturated: u64,
    /// Half periods with a phase error beyond a quarter turn: the loop has lost lock.
    pub(super) unlocked: u64,
}

/// Draws one half period's level; `PLUS` is the half with bias `+phi_m`.
pub(super) trait Sampler: Sized {
    /// Mean level of the half period at phase error `error_codes` (ramp codes, before bias).
    fn sample<const PLUS: bool>(&mut self, error_codes: f64) -> f64;
}

/// A sampler whose light may change in power.
pub(super) trait ScaledSampler: Sampler {
    /// As [`Sampler::sample`], with the light times `power`; the dark current stays.
    fn sample_scaled<const PLUS: bool>(&mut self, error_codes: f64, power: f64) -> f64;
}

/// A sampler whose light changes from half period to half period by the given factors.
pub(super) struct PowerSampler<'a, S> {
    pub(super) sampler: S,
    pub(super) powers: std::slice::Iter<'a, f64>,
}

impl<S: ScaledSampler> Sampler for PowerSampler<'_, S> {
    #[inline(always)]
    fn sample<const PLUS: bool>(&mut self, error_codes: f64) -> f64 {
        let power = self.powers.next().copied().unwrap_or(1.0);
        self.sampler.sample_scaled::<PLUS>(error_codes, power)
    }
}

/// The raised-cosine fringe about its two bias points, in levels against ramp codes.
///
/// `level = offset + swing cos(x +- phi_m)`. For a small phase error x the cosine splits into an
/// even part, common to both halves, and an odd part that changes sign between them.
#[derive(Clone, Copy, Debug)]
struct Fringe {
    even: [f64; 4],
    odd: [f64; 4],
    small_codes: f64,
    offset: f64,
    swing: f64,
    depth_rad: f64,
    rad_per_code: f64,
}

impl Fringe {
    fn new(offset: f64, swing: f64, modulator: &Modulator) -> Self {
        let rad_per_code = modulator.codes_per_rad().recip();
        let (sine, cosine) = modulator.depth_rad.sin_cos();
        let power = |exponent: i32| rad_per_code.powi(exponent);
        let (even, odd) = (swing * cosine, swing * sine);
        Self {
            even: [
                offset + even,
                -even * power(2) / 2.0,
                even * power(4) / 24.0,
                -even * power(6) / 720.0,
            ],
            odd: [
                odd * power(1),
                -odd * power(3) / 6.0,
                odd * power(5) / 120.0,
                -odd * power(7) / 5040.0,
            ],
            small_codes: SMALL_PHASE_RAD / rad_per_code,
            offset,
            swing,
            depth_rad: modulator.depth_rad,
            rad_per_code,
        }
    }

    #[inline(always)]
    fn level<const PLUS: bool>(&self, error_codes: f64, faults: &mut Faults) -> f64 {
        let x = error_codes;
        if x.abs() < self.small_codes {
            let square = x * x;
            let fourth = square * square;
            let even = (self.even[0] + self.even[1] * square)
                + (self.even[2] + self.even[3] * square) * fourth;
            let odd = ((self.odd[0] + self.odd[1] * square)
                + (self.odd[2] + self.odd[3] * square) * fourth)
                * x;
            if PLUS { even - odd } else { even + odd }
        } else {
            self.level_far(if PLUS { 1.0 } else { -1.0 }, x, faults)
        }
    }

    /// The fringe anywhere; out of line, so that the near path stays a predicted branch.
    #[cold]
    #[inline(never)]
    fn level_far(&self, sign: f64, error_codes: f64, faults: &mut Faults) -> f64 {
        let error_rad = error_codes * self.rad_per_code;
        if error_rad.abs() > std::f64::consts::FRAC_PI_2 {
            faults.unlocked += 1;
        }
        self.offset + self.swing * (error_rad + sign * self.depth_rad).cos()
    }
}

/// Converter in its own steps: clamps to the codes, counting that in `saturated`, and rounds.
#[inline(always)]
fn convert(level: f64, level_max: f64, saturated: &mut u64) -> f64 {
    // A branch, not a minimum and a maximum: it is predicted and adds no latency to the loop.
    if (0.0..=level_max).contains(&level) {
        round_whole(level)
    } else {
        clamp_level(level, level_max, saturated)
    }
}

#[cold]
#[inline(never)]
fn clamp_level(level: f64, level_max: f64, saturated: &mut u64) -> f64 {
    *saturated += 1;
    round_whole(level.clamp(0.0, level_max))
}

/// One normal and one rounding per half period, for all sources and samples together.
///
/// The normal is drawn where it is used: the processor draws it while it waits for the loop's own
/// chain of operations, which is faster than drawing a block ahead (by a fifth when measured).
#[derive(Clone, Debug)]
pub(super) struct CombinedSampler<const ROUNDED: bool> {
    fringe: Fringe,
    dark: f64,
    noise_levels: f64,
    level_max: f64,
    stream: Stream,
    faults: Faults,
}

impl<const ROUNDED: bool> CombinedSampler<ROUNDED> {
    /// The sampler of a detection chain.
    pub(super) fn new(
        detector: &Detector,
        modulator: &Modulator,
        transit_time_s: f64,
        streams: &Streams,
    ) -> Self {
        let levels_per_a = levels_per_ampere(detector);
        let mean = detector.mean_current_a * levels_per_a;
        let dark = detector.dark_current_a * levels_per_a;
        let variance_a2 = detector.half_period_noise_a2(transit_time_s);
        Self {
            fringe: Fringe::new(mean + dark, mean * detector.visibility, modulator),
            dark,
            noise_levels: variance_a2.sqrt() * levels_per_a,
            level_max: detector.converter_code_max * detector.samples_per_half_period.sqrt(),
            stream: streams.stream("combined"),
            faults: Faults::default(),
        }
    }

    pub(super) fn faults(&self) -> Faults {
        self.faults
    }

    /// The chain of `other`, with the noise and the faults so far of this one.
    pub(super) fn retuned(&self, other: Self) -> Self {
        Self {
            stream: self.stream.clone(),
            faults: self.faults,
            ..other
        }
    }
}

impl<const ROUNDED: bool> Sampler for CombinedSampler<ROUNDED> {
    #[inline(always)]
    fn sample<const PLUS: bool>(&mut self, error_codes: f64) -> f64 {
        let noise = self.noise_levels * self.stream.normal();
        let level = self.fringe.level::<PLUS>(error_codes, &mut self.faults) + noise;
        if ROUNDED {
            convert(level, self.level_max, &mut self.faults.saturated)
        } else {
            level
        }
    }
}

impl<const ROUNDED: bool> ScaledSampler for CombinedSampler<ROUNDED> {
    /// The noise stays that of the mean power.
    #[inline(always)]
    fn sample_scaled<const PLUS: bool>(&mut self, error_codes: f64, power: f64) -> f64 {
        let noise = self.noise_levels * self.stream.normal();
        let light = self.fringe.level::<PLUS>(error_codes, &mut self.faults) - self.dark;
        let level = light * power + self.dark + noise;
        if ROUNDED {
            convert(level, self.level_max, &mut self.faults.saturated)
        } else {
            level
        }
    }
}

/// Levels of the returned unit per ampere of photocurrent.
pub(super) fn levels_per_ampere(detector: &Detector) -> f64 {
    if detector.converter_step_v > 0.0 {
        detector.samples_per_half_period.sqrt() * steps_per_ampere(detector)
    } else {
        detector.nominal_current_a.recip()
    }
}

fn steps_per_ampere(detector: &Detector) -> f64 {
    detector.transimpedance_v_per_a / detector.converter_step_v
}

/// Every source and every converter sample drawn on its own.
///
/// Per half period the noise of the phase, before the fringe. Per sample that of the light, of the
/// instantaneous photocurrent and of the amplifier, then rounding to the converter's own step.
#[derive(Clone, Debug)]
pub(super) struct ExactSampler {
    fringe: Fringe,
    dark: f64,
    draw: ExactDraw,
    samples: u32,
    level_max: f64,
    is_rounded: bool,
    mean_scale: f64,
    faults: Faults,
}

impl ExactSampler {
    /// The sampler of a detection chain.
    pub(super) fn new(
        detector: &Detector,
        modulator: &Modulator,
        config_samples: u32,
        transit_time_s: f64,
        streams: &Streams,
    ) -> Self {
        let is_rounded = detector.converter_step_v > 0.0;
        let count = detector.samples_per_half_period;
        let levels_per_a = if is_rounded {
            steps_per_ampere(detector)
        } else {
            detector.nominal_current_a.recip()
        };
        let units = DrawUnits {
            levels_per_a,
            codes_per_rad: modulator.codes_per_rad(),
            state_time_s: transit_time_s,
        };
        let mean = detector.mean_current_a * levels_per_a;
        Self {
            fringe: Fringe::new(mean, mean * detector.visibility, modulator),
            dark: detector.dark_current_a * levels_per_a,
            draw: ExactDraw::new(detector, units, streams),
            samples: config_samples,
            level_max: detector.converter_code_max,
            is_rounded,
            mean_scale: if is_rounded {
                count.sqrt().recip()
            } else {
                count.recip()
            },
            faults: Faults::default(),
        }
    }

    pub(super) fn faults(&self) -> Faults {
        self.faults
    }

    /// The chain of `other`, with the noise and the faults so far of this one.
    pub(super) fn retuned(&self, other: Self) -> Self {
        Self {
            draw: self.draw.retuned(other.draw),
            faults: self.faults,
            ..other
        }
    }

    /// Light of the half period, noise of the phase included.
    #[inline]
    fn light<const PLUS: bool>(&mut self, error_codes: f64) -> f64 {
        let phase_codes = self.draw.phase_codes(error_codes);
        self.fringe.level::<PLUS>(phase_codes, &mut self.faults)
    }

    /// Mean level of the samples of one half period of steady light.
    #[inline]
    fn sample_light(&mut self, light: f64) -> f64 {
        let mut sum = 0.0;
        let mut saturated = 0;
        for _ in 0..self.samples {
            let level = self.draw.sample_level(light, self.dark);
            sum += if self.is_rounded {
                convert(level, self.level_max, &mut saturated)
            } else {
                level
            };
        }
        self.faults.saturated += u64::from(saturated > 0);
        sum * self.mean_scale
    }
}

impl Sampler for ExactSampler {
    #[inline]
    fn sample<const PLUS: bool>(&mut self, error_codes: f64) -> f64 {
        let light = self.light::<PLUS>(error_codes);
        self.sample_light(light)
    }
}

impl ScaledSampler for ExactSampler {
    #[inline]
    fn sample_scaled<const PLUS: bool>(&mut self, error_codes: f64, power: f64) -> f64 {
        let light = self.light::<PLUS>(error_codes);
        self.sample_light(light * power)
    }
}
