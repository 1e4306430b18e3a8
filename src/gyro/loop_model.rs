//! Gyro model that runs every half modulation period.

use crate::gyro::coil::Coil;
use crate::gyro::condition::{Condition, Schedule};
use crate::gyro::controller::Controller;
use crate::gyro::detector::Detector;
use crate::gyro::error::GyroError;
use crate::gyro::loop_kernel::{LoopConstants, Registers, advance};
use crate::gyro::modulator::Modulator;
use crate::gyro::parts::Parts;
use crate::gyro::rate_word::RateWord;
use crate::gyro::sampler::{
    CombinedSampler, ExactSampler, Faults, PowerSampler, Sampler, ScaledSampler, levels_per_ampere,
};
use crate::gyro::slow_noise::SlowNoise;
use crate::gyro::vibration::Vibration;
use crate::random::Streams;
use crate::scenario::{GyroConfig, NoiseDraw};
use crate::signal::MotionSegment;

/// The closed loop, half period by half period.
///
/// In loop period m, for the two halves h with bias sign `s = +1, -1`:
///
/// ```text
/// u += r, wrapped modulo 2 pi           psi = round(u) to the ramp converter's code
/// D = Ks Omega(t) - (psi - psi_prev) + s phi_m
/// v = mean over n samples of round(R_f G_v (R P0 (1 + V cos D) (1 + rin) + I_dark + i_noise))
/// e_m = (v(-) - v(+)) / (2 R_f G_v R P0 V sin phi_m)      r += g e_(m-d)
/// ```
///
/// The rate word is the mean of r, taken after each update, over the periods of an output sample,
/// divided by Ks. The motion is sampled at the start of each half period. Slow noise is a rate
/// added to the motion, constant over an output sample. The loop starts with r = 0 and locks onto
/// the fringe of zero rate: beyond +-pi/Ks at the start it locks onto a wrong one.
///
/// # Source
/// Lefevre, The Fiber-Optic Gyroscope, 2nd ed., chapter 8 (all-digital closed loop).
#[derive(Clone, Debug)]
pub struct LoopModel {
    coil: Coil,
    controller: Controller,
    constants: LoopConstants,
    registers: Registers,
    detection: Detection,
    is_ramp_rounded: bool,
    codes_per_rad: f64,
    /// Pair difference in levels per radian of phase error, `2 slope`.
    levels_per_rad: f64,
    /// Start of each half period in normalised time of the output sample.
    times: Vec<f64>,
    phases_codes: Vec<f64>,
    /// Vibration and the detected power of each half period over its mean, if it is on.
    vibration: Option<(Vibration, Vec<f64>)>,
    slow_noise: SlowNoise,
    rate_word: RateWord,
    condition: Condition,
    /// Absent where the temperature never changes.
    varying: Option<Box<Varying>>,
}

/// What it takes to follow the temperature.
#[derive(Clone, Debug)]
struct Varying {
    schedule: Schedule,
    config: GyroConfig,
    streams: Streams,
}

/// The samplers a configuration can ask for.
#[derive(Clone, Debug)]
enum Detection {
    Combined(CombinedSampler<true>),
    CombinedIdeal(CombinedSampler<false>),
    Exact(ExactSampler),
}

impl LoopModel {
    /// The model of a configuration; `simulated_time_s` bounds the flicker's correlation times.
    ///
    /// # Errors
    /// Any [`GyroError`].
    pub fn new(
        config: &GyroConfig,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Result<Self, GyroError> {
        let Parts {
            half_periods,
            coil,
            modulator,
            detector,
            controller,
            condition,
        } = Parts::new(config)?;
        let count = f64::from(half_periods);
        let mut model = Self {
            coil,
            controller,
            constants: LoopConstants {
                gain_codes_per_level: 0.0,
                codes_per_turn: modulator.codes_per_turn,
            },
            registers: Registers::default(),
            detection: detection(config, &detector, &modulator, coil.transit_time_s, streams),
            is_ramp_rounded: modulator.is_quantised,
            codes_per_rad: modulator.codes_per_rad(),
            levels_per_rad: 2.0 * detector.slope_a_per_rad * levels_per_ampere(&detector),
            times: (0..half_periods)
                .map(|half| f64::from(half) / count)
                .collect(),
            phases_codes: (0..half_periods).map(|_| 0.0).collect(),
            vibration: Vibration::new(&config.vibration, &coil, streams)
                .map(|vibration| (vibration, (0..half_periods).map(|_| 1.0).collect())),
            slow_noise: SlowNoise::new(
                &config.slow_noise,
                count * coil.transit_time_s,
                simulated_time_s,
                streams,
            ),
            rate_word: RateWord::new(&config.output, &coil, count * coil.transit_time_s),
            condition,
            varying: Schedule::new(config, count * coil.transit_time_s).map(|schedule| {
                Box::new(Varying {
                    schedule,
                    config: config.clone(),
                    streams: *streams,
                })
            }),
        };
        model.set_loop_gain(controller.gain);
        Ok(model)
    }

    /// Replaces the loop gain at the present power, whatever bandwidth or stability it gives.
    ///
    /// Where the temperature changes, its next update sets the configured gain again.
    pub fn set_loop_gain(&mut self, gain: f64) {
        self.controller.gain = gain;
        self.constants.gain_codes_per_level = gain * self.codes_per_rad / self.levels_per_rad;
    }

    /// The loop's linear model, with the gain now in use.
    #[must_use]
    pub fn controller(&self) -> &Controller {
        &self.controller
    }

    /// Time between rate words, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        self.phases_codes.len() as f64 * self.coil.transit_time_s
    }

    /// Register r: feedback phase step per half period, rad.
    #[must_use]
    pub fn register_rad(&self) -> f64 {
        self.registers.step_codes / self.codes_per_rad
    }

    /// Resets of the ramp by 2 pi since the start.
    #[must_use]
    pub fn reset_count(&self) -> u64 {
        self.registers.resets
    }

    /// Half periods in which the converter was beyond its range.
    #[must_use]
    pub fn saturated_half_periods(&self) -> u64 {
        self.faults().saturated
    }

    /// Half periods with a phase error beyond a quarter turn.
    #[must_use]
    pub fn unlocked_half_periods(&self) -> u64 {
        self.faults().unlocked
    }

    /// Runs one loop period with the given Sagnac phases (rad) in its halves; slow noise and
    /// vibration are left out.
    ///
    /// Returns the register after its update, rad per half period.
    pub fn run_period(&mut self, sagnac_phase_rad: [f64; 2]) -> f64 {
        let phases_codes = sagnac_phase_rad.map(|phase| phase * self.codes_per_rad);
        self.detection.run(
            &mut self.registers,
            self.constants,
            (&phases_codes, None),
            (self.is_ramp_rounded, self.controller.latency_periods),
        );
        self.register_rad()
    }

    /// Rate word of the output sample over which the gyro moves as `segment`, deg/h.
    pub fn next_word(&mut self, segment: &MotionSegment) -> f64 {
        if let Some(condition) = self.next_condition() {
            self.enter(condition);
        }
        let slow_rad_per_s = self.slow_noise.next_rate_rad_per_s() + self.condition.bias_rad_per_s;
        self.fill_phases(segment, slow_rad_per_s);
        let mut powers = None;
        if let Some((vibration, factors)) = &mut self.vibration {
            let codes_per_rate = self.coil.scale_factor_s * self.codes_per_rad;
            vibration.next_half_periods(codes_per_rate, &mut self.phases_codes, factors);
            powers = Some(factors.as_slice());
        }
        let sum_codes = self.detection.run(
            &mut self.registers,
            self.constants,
            (&self.phases_codes, powers),
            (self.is_ramp_rounded, self.controller.latency_periods),
        );
        let periods = 0.5 * self.phases_codes.len() as f64;
        self.rate_word
            .deg_per_h(sum_codes / (periods * self.codes_per_rad))
    }

    fn next_condition(&mut self) -> Option<Condition> {
        self.varying.as_mut()?.schedule.next_change()
    }

    /// Works in another condition from the next output sample on.
    fn enter(&mut self, condition: Condition) {
        let Some(Varying {
            config, streams, ..
        }) = self.varying.as_deref()
        else {
            return;
        };
        let Parts {
            coil,
            modulator,
            detector,
            controller,
            ..
        } = Parts::under_way(config, &condition);
        let fresh = detection(config, &detector, &modulator, coil.transit_time_s, streams);
        self.detection.retune(fresh);
        self.levels_per_rad = 2.0 * detector.slope_a_per_rad * levels_per_ampere(&detector);
        self.condition = condition;
        self.set_loop_gain(controller.gain);
    }

    /// Sagnac phase at the start of each half period, codes.
    fn fill_phases(&mut self, segment: &MotionSegment, slow_rad_per_s: f64) {
        let scale = self.coil.scale_factor_s * self.condition.scale_ratio * self.codes_per_rad;
        let [c0, c1, c2, c3] = segment
            .rate_rad_per_s
            .map(|coefficient| scale * coefficient);
        let c0 = c0 + scale * slow_rad_per_s;
        for (phase, &u) in self.phases_codes.iter_mut().zip(&self.times) {
            *phase = ((c3 * u + c2) * u + c1) * u + c0;
        }
    }

    fn faults(&self) -> Faults {
        match &self.detection {
            Detection::Combined(sampler) => sampler.faults(),
            Detection::CombinedIdeal(sampler) => sampler.faults(),
            Detection::Exact(sampler) => sampler.faults(),
        }
    }
}

fn detection(
    config: &GyroConfig,
    detector: &Detector,
    modulator: &Modulator,
    transit_time_s: f64,
    streams: &Streams,
) -> Detection {
    match (config.noise.draw, config.adc.bits) {
        (NoiseDraw::Exact, _) => Detection::Exact(ExactSampler::new(
            detector,
            modulator,
            config.adc.samples_per_half_period,
            transit_time_s,
            streams,
        )),
        (NoiseDraw::Combined, 0) => Detection::CombinedIdeal(CombinedSampler::new(
            detector,
            modulator,
            transit_time_s,
            streams,
        )),
        (NoiseDraw::Combined, _) => Detection::Combined(CombinedSampler::new(
            detector,
            modulator,
            transit_time_s,
            streams,
        )),
    }
}

impl Detection {
    /// Takes over the levels and noise densities of a detection of the same kind.
    fn retune(&mut self, other: Self) {
        match (self, other) {
            (Self::Combined(sampler), Self::Combined(other)) => *sampler = sampler.retuned(other),
            (Self::CombinedIdeal(sampler), Self::CombinedIdeal(other)) => {
                *sampler = sampler.retuned(other);
            }
            (Self::Exact(sampler), Self::Exact(other)) => *sampler = sampler.retuned(other),
            (sampler, other) => *sampler = other,
        }
    }

    /// Runs the periods of `(phases_codes, powers)` and returns the sum of the register, codes.
    ///
    /// Powers are those of the light in each half period over the mean; none means 1.
    fn run(
        &mut self,
        registers: &mut Registers,
        constants: LoopConstants,
        inputs: (&[f64], Option<&[f64]>),
        variant: (bool, u32),
    ) -> f64 {
        match self {
            Self::Combined(sampler) => drive(sampler, registers, constants, inputs, variant),
            Self::CombinedIdeal(sampler) => drive(sampler, registers, constants, inputs, variant),
            Self::Exact(sampler) => drive(sampler, registers, constants, inputs, variant),
        }
    }
}

/// Runs a local copy of the sampler, with or without power factors.
fn drive<S: ScaledSampler + Clone>(
    sampler: &mut S,
    registers: &mut Registers,
    constants: LoopConstants,
    (phases_codes, powers): (&[f64], Option<&[f64]>),
    variant: (bool, u32),
) -> f64 {
    let copy = sampler.clone();
    let (after, sum) = if let Some(powers) = powers {
        let scaled = PowerSampler {
            sampler: copy,
            powers: powers.iter(),
        };
        let (after, sum) = dispatch(scaled, registers, constants, phases_codes, variant);
        (after.sampler, sum)
    } else {
        dispatch(copy, registers, constants, phases_codes, variant)
    };
    *sampler = after;
    sum
}

/// Picks the kernel compiled for (ramp rounded, latency) and runs it.
fn dispatch<S: Sampler>(
    sampler: S,
    registers: &mut Registers,
    constants: LoopConstants,
    phases_codes: &[f64],
    variant: (bool, u32),
) -> (S, f64) {
    let kernel = match variant {
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
