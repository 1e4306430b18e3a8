//! The loop with every second-order effect of modulator, ramp and register.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::gyro::ModulationScheme;
use crate::gyro::loop_model::plain_kernel::{LoopConstants, Registers};
use crate::gyro::loop_model::sampler::{Sampler, round_whole};
use crate::gyro::optics::modulation::{BiasState, states};
use crate::gyro::optics::second_order::Optics;
use crate::gyro::parts::Parts;
use crate::random::{Stream, Streams};

/// Range in which the second loop sets the gain of the ramp converter, over the nominal gain: that of
/// a multiplying converter, and far beyond the error of any modulator.
const CORRECTION_MIN: f64 = 0.5;
const CORRECTION_MAX: f64 = 2.0;

/// Configuration and state of the effects; the registers are those of the plain kernel.
///
/// Invariant: with every effect neutral it does the arithmetic of the plain kernel, operation by
/// operation, so that both give the same words to the bit.
#[derive(Clone, Debug)]
pub(super) struct FullLoop {
    optics: Optics,
    states: Vec<BiasState>,
    /// States between the two passes through the modulator; the ramp steps as often.
    delay_states: usize,
    codes_per_rad: f64,
    /// Demodulated levels per radian of phase error.
    levels_per_rad: f64,
    visibility: f64,
    depth_rad: f64,
    /// Gain error added from outside, as a drift of the voltage of pi.
    drift: f64,
    /// Gain of the ramp converter as the second loop has set it.
    correction: f64,
    /// What the modulator applied in the last two states, newest first, codes.
    applied_codes: [f64; 2],
    /// States still to come that see the last reset.
    disturbed_states: usize,
    /// Demodulated error of the last period without reset or jump, levels.
    calm_levels: f64,
    periods_to_jump: u32,
    dither: Stream,
    saturated_steps: u64,
    /// States that a jump took beyond a quarter turn; their period is discarded.
    jumped_states: u64,
}

impl FullLoop {
    /// The effects of a configuration, at the start of a run.
    pub(super) fn new(parts: &Parts, levels_per_rad: f64, streams: &Streams) -> Self {
        let (optics, timing) = (parts.optics, parts.timing);
        let (detector, modulator) = (&parts.detector, &parts.modulator);
        Self {
            optics,
            states: states(optics.scheme, modulator.depth_rad),
            delay_states: timing.states_per_half_period as usize,
            codes_per_rad: modulator.codes_per_rad(),
            levels_per_rad,
            visibility: detector.visibility,
            depth_rad: modulator.depth_rad,
            drift: 0.0,
            correction: 1.0,
            applied_codes: [0.0; 2],
            disturbed_states: 0,
            calm_levels: 0.0,
            periods_to_jump: optics.dither_interval_periods,
            dither: streams.stream("phase_dither"),
            saturated_steps: 0,
            jumped_states: 0,
        }
    }

    /// Takes over a loop that ran in the plain kernel.
    pub(super) fn take_over(&mut self, registers: &Registers) {
        self.applied_codes = [registers.output_codes; 2];
    }

    /// Replaces the scale of the second loop's estimates, as automatic gain control does.
    pub(super) fn set_levels_per_rad(&mut self, levels_per_rad: f64) {
        self.levels_per_rad = levels_per_rad;
    }

    /// Replaces the gain error that comes on top of the configured one.
    pub(super) fn set_drift(&mut self, drift: f64) {
        self.drift = drift;
    }

    /// Applied over commanded phase, less one, as the second loop has left it.
    pub(super) fn gain_error(&self) -> f64 {
        self.gain() - 1.0
    }

    /// Loop periods in which the step was held at its limit.
    pub(super) fn saturated_steps(&self) -> u64 {
        self.saturated_steps
    }

    /// States beyond a quarter turn that are no loss of lock: a jump of the ramp took them there.
    pub(super) fn jumped_states(&self) -> u64 {
        self.jumped_states
    }

    /// Runs the loop periods of `phases_codes`, one Sagnac phase per state; returns the sum of the
    /// register over them, codes.
    pub(super) fn run<S: Sampler>(
        &mut self,
        registers: &mut Registers,
        constants: LoopConstants,
        phases_codes: &[f64],
        (is_rounded, latency): (bool, u32),
        sampler: &mut S,
    ) -> f64 {
        let mut sum = 0.0;
        for phases in phases_codes.chunks_exact(self.states.len()) {
            let (levels, is_kept) = self.demodulate(
                registers,
                constants.codes_per_turn,
                phases,
                is_rounded,
                sampler,
            );
            let error = if is_kept { levels } else { 0.0 };
            let due = registers.delay(error, latency as usize);
            registers.step_codes += constants.gain_codes_per_level * due;
            self.limit_step(registers);
            sum += registers.step_codes;
        }
        sum
    }

    fn gain(&self) -> f64 {
        (1.0 + self.optics.gain_error) * (1.0 + self.drift) * self.correction
    }

    /// One loop period: its demodulated error and whether the integrator may have it.
    fn demodulate<S: Sampler>(
        &mut self,
        registers: &mut Registers,
        turn: f64,
        phases: &[f64],
        is_rounded: bool,
        sampler: &mut S,
    ) -> (f64, bool) {
        let has_jumped = self.jump(registers, turn);
        let gain = self.gain();
        let (mut rate_levels, mut gain_levels) = (0.0, 0.0);
        let (mut has_reset, mut is_disturbed) = (false, false);
        for (index, &phase) in phases.iter().enumerate() {
            let state = self.states[index];
            if index.is_multiple_of(self.delay_states) {
                has_reset |= self.advance_ramp(registers, turn);
            }
            is_disturbed |= self.disturbed_states > 0;
            self.disturbed_states = self.disturbed_states.saturating_sub(1);
            let error = self.error_codes(registers, phase, gain, state, is_rounded);
            if has_jumped && (error / self.codes_per_rad).abs() > FRAC_PI_2 {
                self.jumped_states += 1;
            }
            let level = if state.is_plus {
                sampler.sample::<true>(error)
            } else {
                sampler.sample::<false>(error)
            };
            rate_levels += if state.is_plus { -level } else { level };
            gain_levels += state.gain_sign * level;
        }
        let is_kept = !(has_jumped || is_disturbed && self.optics.is_reset_blanked);
        if self.optics.scheme != ModulationScheme::TwoState {
            if is_kept {
                self.correct(gain_levels / (PI * self.levels_per_rad));
            }
        } else if !has_jumped && has_reset {
            let jump = (rate_levels - self.calm_levels) * registers.step_codes.signum();
            self.correct(jump / (PI * self.levels_per_rad));
        } else if !has_jumped {
            self.calm_levels = rate_levels;
        }
        (rate_levels, is_kept)
    }

    /// Second loop: takes its share of an estimated gain error off the ramp converter.
    ///
    /// Out of lock the estimates mean nothing; the range of the converter holds what they do.
    fn correct(&mut self, estimate: f64) {
        let wanted = self.correction * (1.0 - self.optics.second_loop_gain * estimate);
        self.correction = wanted.clamp(CORRECTION_MIN, CORRECTION_MAX);
    }

    /// Advances the ramp by one half period; whether it was reset.
    fn advance_ramp(&mut self, registers: &mut Registers, turn: f64) -> bool {
        let lsb = self.optics.step_lsb_rad * self.codes_per_rad;
        let step = if lsb > 0.0 {
            (registers.step_codes / lsb).floor() * lsb
        } else {
            registers.step_codes
        };
        registers.ramp_codes += step;
        if (0.0..turn).contains(&registers.ramp_codes) {
            return false;
        }
        self.wrap(registers, turn);
        registers.resets += 1;
        self.disturbed_states = self.delay_states;
        true
    }

    /// Brings the ramp back into its turn; a whole turn of applied phase does not show.
    fn wrap(&mut self, registers: &mut Registers, turn: f64) {
        let turns = (registers.ramp_codes / turn).floor();
        registers.ramp_codes -= turns * turn;
        for applied in &mut self.applied_codes {
            *applied -= turns * turn;
        }
    }

    /// A random jump of the ramp if one is due; the period that sees it is discarded.
    fn jump(&mut self, registers: &mut Registers, turn: f64) -> bool {
        if self.optics.dither_rad <= 0.0 {
            return false;
        }
        self.periods_to_jump -= 1;
        if self.periods_to_jump > 0 {
            return false;
        }
        self.periods_to_jump = self.optics.dither_interval_periods;
        registers.ramp_codes += self.optics.dither_rad * self.codes_per_rad * self.dither.normal();
        self.wrap(registers, turn);
        true
    }

    /// Phase error of a state against its nominal bias point, codes.
    fn error_codes(
        &mut self,
        registers: &mut Registers,
        phase_codes: f64,
        gain: f64,
        state: BiasState,
        is_rounded: bool,
    ) -> f64 {
        let output = if is_rounded {
            round_whole(registers.ramp_codes)
        } else {
            registers.ramp_codes
        };
        registers.output_codes = output;
        let applied = gain * output;
        let mut error = phase_codes - (applied - self.applied_codes[self.delay_states - 1]);
        let twice = applied - self.applied_codes[1];
        self.applied_codes = [applied, self.applied_codes[0]];
        if self.optics.coupling_rad > 0.0 {
            let ramp_rad = applied / self.codes_per_rad + self.optics.coupling_phase_rad;
            error += self.optics.coupling_rad * self.codes_per_rad * ramp_rad.sin();
        }
        error += (gain - 1.0) * state.phase_rad * self.codes_per_rad;
        if self.optics.gap_share > 0.0 {
            let steps = if self.optics.mismatch > 0.0 {
                0.0
            } else {
                twice
            };
            error = self.with_spike(error, phase_codes - steps, state.is_plus);
        }
        error
    }

    /// The phase error that gives the mean power of plateau and spike.
    ///
    /// Mean powers of a two-state half period, `(1 - w) cos D + w (cos D' + m s (1 + V cos D') / V)`
    /// with D' the phase in the spike, are a cosine again: so converter, saturation and shot noise
    /// see the power that is there. Left alone where the loop is out of lock.
    fn with_spike(&self, error_codes: f64, spike_codes: f64, is_plus: bool) -> f64 {
        let error_rad = error_codes / self.codes_per_rad;
        if error_rad.abs() > FRAC_PI_2 {
            return error_codes;
        }
        let sign = if is_plus { 1.0 } else { -1.0 };
        let plateau = (error_rad + sign * self.depth_rad).cos();
        let spike = (spike_codes / self.codes_per_rad).cos();
        let intensity = sign * self.optics.intensity_modulation;
        let modulated = spike + intensity * (self.visibility.recip() + spike);
        let share = self.optics.gap_share;
        let mean = ((1.0 - share) * plateau + share * modulated).clamp(-1.0, 1.0);
        sign * (mean.acos() - self.depth_rad) * self.codes_per_rad
    }

    fn limit_step(&mut self, registers: &mut Registers) {
        let limit = self.optics.step_limit_rad * self.codes_per_rad;
        if registers.step_codes.abs() > limit {
            registers.step_codes = registers.step_codes.clamp(-limit, limit);
            self.saturated_steps += 1;
        }
    }
}
