//! Gyro model that runs every half modulation period.

mod detection;
pub(in crate::gyro) mod faults;
mod full_kernel;
mod plain_kernel;
mod sampler;

use std::f64::consts::{PI, TAU};

use crate::gyro::GyroConfig;
use crate::gyro::controller::Controller;
use crate::gyro::error::GyroError;
use crate::gyro::loop_model::detection::{Detection, Drive, levels_per_rad};
use crate::gyro::loop_model::faults::LoopFaults;
use crate::gyro::loop_model::full_kernel::FullLoop;
use crate::gyro::loop_model::plain_kernel::{LoopConstants, Registers};
use crate::gyro::noise::slow_noise::SlowNoise;
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::modulation::Timing;
use crate::gyro::parts::{Parts, place_in_cubics};
use crate::gyro::rate_word::RateWord;
use crate::gyro::thermal::condition::{Condition, Schedule};
use crate::gyro::vibration::Vibration;
use crate::random::Streams;
use crate::signal::MotionSegment;
use crate::units::rad_per_s_to_deg_per_s;

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
/// Second-order effects of modulator, ramp and register (gain error and its second loop, four-state
/// bias, dead band, spikes, step width) run in a kernel of their own, only if one of them is on.
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
    /// Demodulated levels per radian of phase error, slope times states (`2 slope` for a pair).
    levels_per_rad: f64,
    /// Start of each state (two-state: half period): cubic of the output sample, normalised time there.
    times: Vec<(usize, f64)>,
    /// Cubics of an output sample.
    cubics: usize,
    phases_codes: Vec<f64>,
    /// Vibration and the detected power of each state over its mean, if it is on.
    vibration: Option<(Vibration, Vec<f64>)>,
    slow_noise: SlowNoise,
    rate_word: RateWord,
    /// Half period, s.
    half_period_s: f64,
    timing: Timing,
    /// The second-order effects, and whether they are in the loop.
    full: Box<FullLoop>,
    is_full: bool,
    wrong_fringe_words: u64,
    fringe_error: f64,
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
        let parts = Parts::new(config)?;
        let (half_periods, timing) = (parts.half_periods, parts.timing);
        let states = half_periods * timing.states_per_half_period;
        let sample_period_s = f64::from(half_periods) * parts.half_period_s;
        let levels_per_rad = levels_per_rad(&parts);
        let mut model = Self {
            coil: parts.coil,
            controller: parts.controller,
            constants: LoopConstants {
                gain_codes_per_level: 0.0,
                codes_per_turn: parts.modulator.codes_per_turn,
            },
            registers: Registers::default(),
            detection: Detection::new(config, &parts, streams),
            is_ramp_rounded: parts.modulator.is_quantised,
            codes_per_rad: parts.modulator.codes_per_rad(),
            levels_per_rad,
            times: times(states as usize, 1),
            cubics: 1,
            phases_codes: (0..states).map(|_| 0.0).collect(),
            vibration: Vibration::new(&config.vibration, parts.half_period_s, streams)
                .map(|vibration| (vibration, (0..states).map(|_| 1.0).collect())),
            slow_noise: SlowNoise::new(
                &config.slow_noise,
                sample_period_s,
                simulated_time_s,
                streams,
            ),
            rate_word: RateWord::new(&config.output, &parts.coil, sample_period_s),
            half_period_s: parts.half_period_s,
            timing,
            full: Box::new(FullLoop::new(&parts, levels_per_rad, streams)),
            is_full: parts.optics.is_needed(),
            wrong_fringe_words: 0,
            fringe_error: 0.0,
            condition: parts.condition,
            varying: Schedule::new(config, sample_period_s).map(|schedule| {
                Box::new(Varying {
                    schedule,
                    config: config.clone(),
                    streams: *streams,
                })
            }),
        };
        model.set_loop_gain(parts.controller.gain);
        model.set_modulator_gain_error(parts.condition.modulator_gain_error);
        Ok(model)
    }

    /// Runs the full kernel from here on, even if no effect needs it.
    pub fn use_full_kernel(&mut self) {
        if !self.is_full {
            self.full.take_over(&self.registers);
            self.is_full = true;
        }
    }

    /// Lets the modulator's gain drift: applied phase = (1 + configured error) (1 + drift)
    /// commanded, as a temperature does by way of the voltage of pi.
    pub fn set_modulator_gain_error(&mut self, drift: f64) {
        if drift != 0.0 {
            self.use_full_kernel();
        }
        self.full.set_drift(drift);
    }

    /// Applied over commanded phase, less one, with what the second loop has corrected.
    #[must_use]
    pub fn modulator_gain_error(&self) -> f64 {
        self.full.gain_error()
    }

    /// Limits reached and fringes lost since the start.
    #[must_use]
    pub fn loop_faults(&self) -> LoopFaults {
        let fringe_deg_per_s =
            2.0 * rad_per_s_to_deg_per_s(self.coil.single_fringe_rate_rad_per_s());
        LoopFaults {
            saturated_steps: self.full.saturated_steps(),
            wrong_fringe_words: self.wrong_fringe_words,
            fringe_error_deg_per_s: self.fringe_error * fringe_deg_per_s,
        }
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
        let half_periods =
            self.phases_codes.len() as f64 / f64::from(self.timing.states_per_half_period);
        half_periods * self.half_period_s
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
        self.detection.faults().saturated
    }

    /// Half periods with a phase error beyond a quarter turn, but for those that a dithered ramp
    /// discards.
    #[must_use]
    pub fn unlocked_half_periods(&self) -> u64 {
        let faults = self.detection.faults();
        faults.unlocked.saturating_sub(self.full.jumped_states())
    }

    /// Runs one loop period with the given Sagnac phases (rad), one for each state of the bias wave;
    /// slow noise and vibration are left out.
    ///
    /// Returns the register after its update, rad per half period.
    ///
    /// # Panics
    /// If there are not as many phases as states: 2, or 4 with a four-state scheme.
    pub fn run_period(&mut self, sagnac_phase_rad: impl AsRef<[f64]>) -> f64 {
        let phases = sagnac_phase_rad.as_ref();
        let states = self.timing.states as usize;
        assert_eq!(phases.len(), states, "one phase per state");
        let mut phases_codes = [0.0; 4];
        for (codes, phase) in phases_codes.iter_mut().zip(phases) {
            *codes = phase * self.codes_per_rad;
        }
        self.run(&phases_codes[..states], None);
        self.register_rad()
    }

    /// Rate word of the output sample over which the gyro moves as `segment`, deg/h.
    pub fn next_word(&mut self, segment: &MotionSegment) -> f64 {
        self.next_word_over(std::slice::from_ref(segment))
    }

    /// Rate word of the output sample over which the gyro moves as `segments`, which share it equally,
    /// deg/h.
    pub fn next_word_over(&mut self, segments: &[MotionSegment]) -> f64 {
        if segments.len() != self.cubics {
            self.cubics = segments.len();
            self.times = times(self.times.len(), self.cubics);
        }
        if let Some(condition) = self.next_condition() {
            self.enter(condition);
        }
        let slow_rad_per_s = self.slow_noise.next_rate_rad_per_s() + self.condition.bias_rad_per_s;
        self.fill_phases(segments, slow_rad_per_s);
        let mut phases_codes = std::mem::take(&mut self.phases_codes);
        let mut vibration = self.vibration.take();
        let powers = vibration.as_mut().map(|(vibration, factors)| {
            let codes_per_rate = self.coil.scale_factor_s * self.codes_per_rad;
            vibration.next_half_periods(codes_per_rate, &mut phases_codes, factors);
            factors.as_slice()
        });
        let sum_codes = self.run(&phases_codes, powers);
        self.vibration = vibration;
        self.phases_codes = phases_codes;
        let periods = self.phases_codes.len() as f64 / f64::from(self.timing.states);
        let mean_rad = sum_codes / (periods * self.codes_per_rad);
        self.watch_fringe(segments, mean_rad);
        self.rate_word.deg_per_h(mean_rad)
    }

    /// Runs the kernel in use and returns the sum of the register over the periods, codes.
    fn run(&mut self, phases_codes: &[f64], powers: Option<&[f64]>) -> f64 {
        let drive = Drive {
            constants: self.constants,
            is_rounded: self.is_ramp_rounded,
            latency: self.controller.latency_periods,
            phases_codes,
            powers,
        };
        let full = self.is_full.then_some(self.full.as_mut());
        self.detection.run(&mut self.registers, drive, full)
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
        let parts = Parts::under_way(config, &condition);
        self.detection
            .retune(Detection::new(config, &parts, streams));
        self.levels_per_rad = levels_per_rad(&parts);
        if config.controller.automatic_gain_control {
            self.full.set_levels_per_rad(self.levels_per_rad);
        }
        self.condition = condition;
        self.set_loop_gain(parts.controller.gain);
        self.set_modulator_gain_error(condition.modulator_gain_error);
    }

    /// Counts a word that is nearer to another fringe than to the motion's own.
    fn watch_fringe(&mut self, segments: &[MotionSegment], mean_rad: f64) {
        let turned: f64 = segments
            .iter()
            .map(|segment| segment.angle_at(1.0, 1.0))
            .sum();
        let phase_rad = self.coil.scale_factor_s * turned / segments.len() as f64;
        let error_rad = mean_rad - phase_rad;
        if error_rad.abs() > PI {
            self.wrong_fringe_words += 1;
            self.fringe_error = (error_rad / TAU).round();
        }
    }

    /// Sagnac phase at the start of each state, codes.
    fn fill_phases(&mut self, segments: &[MotionSegment], slow_rad_per_s: f64) {
        let scale = self.coil.scale_factor_s * self.condition.scale_ratio * self.codes_per_rad;
        let mut places = self.times.iter().zip(&mut self.phases_codes).peekable();
        for (cubic, segment) in segments.iter().enumerate() {
            let [c0, c1, c2, c3] = segment
                .rate_rad_per_s
                .map(|coefficient| scale * coefficient);
            let c0 = c0 + scale * slow_rad_per_s;
            while let Some(((_, u), phase)) = places.next_if(|((own, _), _)| *own == cubic) {
                *phase = ((c3 * u + c2) * u + c1) * u + c0;
            }
        }
    }
}

/// Start of each state: cubic of the output sample, and normalised time there.
fn times(states: usize, cubics: usize) -> Vec<(usize, f64)> {
    (0..states)
        .map(|state| place_in_cubics(state, states, cubics))
        .collect()
}
