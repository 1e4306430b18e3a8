//! The sampler a configuration asks for, and the kernel that runs on it.

use crate::gyro::loop_model::full_kernel::FullLoop;
use crate::gyro::loop_model::plain_kernel::{LoopConstants, Registers, advance};
use crate::gyro::loop_model::sampler::{
    CombinedSampler, ExactSampler, Faults, PowerSampler, Sampler, ScaledSampler, levels_per_ampere,
};
use crate::gyro::optics::detector::Detector;
use crate::gyro::optics::modulation::Timing;
use crate::gyro::optics::modulator::Modulator;
use crate::gyro::parts::Parts;
use crate::gyro::{GyroConfig, NoiseDraw};
use crate::random::Streams;

/// The samplers a configuration can ask for.
#[derive(Clone, Debug)]
pub(super) enum Detection {
    Combined(CombinedSampler<true>),
    CombinedIdeal(CombinedSampler<false>),
    Exact(ExactSampler),
}

/// What the kernels need besides the sampler and the registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive<'a> {
    pub(super) constants: LoopConstants,
    /// Whether the ramp is rounded to codes.
    pub(super) is_rounded: bool,
    /// Latency of the loop in periods.
    pub(super) latency: u32,
    /// Sagnac phase at the start of each state, codes.
    pub(super) phases_codes: &'a [f64],
    /// Power of the light in each state over the mean; none means 1.
    pub(super) powers: Option<&'a [f64]>,
}

impl Detection {
    /// The sampler of the states of a configuration's bias wave.
    pub(super) fn new(config: &GyroConfig, parts: &Parts, streams: &Streams) -> Self {
        let detector = &state_detector(&parts.detector, parts.timing);
        let modulator: &Modulator = &parts.modulator;
        let states = parts.timing.states_per_half_period;
        let state_time_s = parts.half_period_s / f64::from(states);
        match (config.noise.draw, config.adc.bits) {
            (NoiseDraw::Exact, _) => Self::Exact(ExactSampler::new(
                detector,
                modulator,
                config.adc.samples_per_half_period / states,
                state_time_s,
                streams,
            )),
            (NoiseDraw::Combined, 0) => Self::CombinedIdeal(CombinedSampler::new(
                detector,
                modulator,
                state_time_s,
                streams,
            )),
            (NoiseDraw::Combined, _) => Self::Combined(CombinedSampler::new(
                detector,
                modulator,
                state_time_s,
                streams,
            )),
        }
    }

    /// Takes over the levels and noise densities of a detection of the same kind.
    pub(super) fn retune(&mut self, other: Self) {
        match (self, other) {
            (Self::Combined(sampler), Self::Combined(other)) => *sampler = sampler.retuned(other),
            (Self::CombinedIdeal(sampler), Self::CombinedIdeal(other)) => {
                *sampler = sampler.retuned(other);
            }
            (Self::Exact(sampler), Self::Exact(other)) => *sampler = sampler.retuned(other),
            (sampler, other) => *sampler = other,
        }
    }

    pub(super) fn faults(&self) -> Faults {
        match self {
            Self::Combined(sampler) => sampler.faults(),
            Self::CombinedIdeal(sampler) => sampler.faults(),
            Self::Exact(sampler) => sampler.faults(),
        }
    }

    /// Runs the loop periods of `drive`, in the full kernel if there is one; returns the sum of the
    /// register over them, codes.
    pub(super) fn run(
        &mut self,
        registers: &mut Registers,
        drive: Drive,
        full: Option<&mut FullLoop>,
    ) -> f64 {
        match self {
            Self::Combined(sampler) => run(sampler, registers, drive, full),
            Self::CombinedIdeal(sampler) => run(sampler, registers, drive, full),
            Self::Exact(sampler) => run(sampler, registers, drive, full),
        }
    }
}

/// Demodulated levels per radian of phase error: slope times states (`2 slope` for a pair).
pub(super) fn levels_per_rad(parts: &Parts) -> f64 {
    f64::from(parts.timing.states)
        * parts.detector.slope_a_per_rad
        * levels_per_ampere(&state_detector(&parts.detector, parts.timing))
}

/// The detection of one state: a half period, or its share of gate and samples.
fn state_detector(detector: &Detector, timing: Timing) -> Detector {
    Detector {
        samples_per_half_period: detector.samples_per_half_period
            / f64::from(timing.states_per_half_period),
        ..*detector
    }
}

/// Runs a local copy of the sampler, with or without power factors.
fn run<S: ScaledSampler + Clone>(
    sampler: &mut S,
    registers: &mut Registers,
    drive: Drive,
    full: Option<&mut FullLoop>,
) -> f64 {
    let copy = sampler.clone();
    let (after, sum) = match drive.powers {
        Some(powers) => {
            let scaled = PowerSampler {
                sampler: copy,
                powers: powers.iter(),
            };
            let (after, sum) = dispatch(scaled, registers, drive, full);
            (after.sampler, sum)
        }
        None => dispatch(copy, registers, drive, full),
    };
    *sampler = after;
    sum
}

/// Picks the kernel, the plain one compiled for (ramp rounded, latency), and runs it.
fn dispatch<S: Sampler>(
    mut sampler: S,
    registers: &mut Registers,
    drive: Drive,
    full: Option<&mut FullLoop>,
) -> (S, f64) {
    let (constants, phases_codes) = (drive.constants, drive.phases_codes);
    if let Some(full) = full {
        let variant = (drive.is_rounded, drive.latency);
        let sum = full.run(registers, constants, phases_codes, variant, &mut sampler);
        return (sampler, sum);
    }
    let kernel = match (drive.is_rounded, drive.latency) {
        (false, 0) => advance::<S, false, 0>,
        (false, 1) => advance::<S, false, 1>,
        (false, 2) => advance::<S, false, 2>,
        (false, _) => advance::<S, false, 3>,
        (true, 0) => advance::<S, true, 0>,
        (true, 1) => advance::<S, true, 1>,
        (true, 2) => advance::<S, true, 2>,
        (true, _) => advance::<S, true, 3>,
    };
    kernel(registers, constants, phases_codes, sampler)
}
