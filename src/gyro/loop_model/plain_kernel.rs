//! The hot path: ramp, demodulation and integrator of one loop period after another.

use crate::gyro::loop_model::sampler::{Sampler, round_whole};

/// All state of the loop besides the noise streams. Phases are in ramp codes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Registers {
    /// Ramp, `0 <= ramp < codes_per_turn` after every half period.
    pub(super) ramp_codes: f64,
    /// What the ramp converter put out in the half period before.
    pub(super) output_codes: f64,
    /// Step of the ramp per half period, the loop's register r.
    pub(super) step_codes: f64,
    /// Demodulated errors not yet integrated, newest first, in levels.
    pub(super) delayed_levels: [f64; 3],
    /// Resets by 2 pi upwards and downwards.
    pub(super) resets: u64,
}

/// Constants of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LoopConstants {
    /// Register codes per level of pair difference: the loop gain.
    pub(super) gain_codes_per_level: f64,
    /// Ramp codes over 2 pi.
    pub(super) codes_per_turn: f64,
}

impl Registers {
    /// Advances the ramp by one half period and returns the phase error, codes.
    ///
    /// The ramp wraps modulo 2 pi, and with it the remembered output: the reset is an exact
    /// turn, which the cosine does not see, so that the phase error stays small and needs no
    /// range reduction.
    #[inline(always)]
    fn half_period<const ROUND: bool>(&mut self, phase_codes: f64, turn: f64) -> f64 {
        self.ramp_codes += self.step_codes;
        if !(0.0..turn).contains(&self.ramp_codes) {
            self.reset(turn);
        }
        let output = if ROUND {
            round_whole(self.ramp_codes)
        } else {
            self.ramp_codes
        };
        let error = phase_codes - (output - self.output_codes);
        self.output_codes = output;
        error
    }

    /// Puts an error into the pipeline and takes out the one that is due.
    pub(super) fn delay(&mut self, error_levels: f64, latency: usize) -> f64 {
        if latency == 0 {
            return error_levels;
        }
        let due = self.delayed_levels[latency - 1];
        self.delayed_levels.copy_within(0..latency - 1, 1);
        self.delayed_levels[0] = error_levels;
        due
    }

    #[cold]
    #[inline(never)]
    fn reset(&mut self, turn: f64) {
        let turns = (self.ramp_codes / turn).floor();
        self.ramp_codes -= turns * turn;
        self.output_codes -= turns * turn;
        self.resets += 1;
    }
}

/// Runs one loop period per pair of `phases_codes` (Sagnac phase at the start of each half).
///
/// Per period: two half periods with bias +phi_m and -phi_m; error = level(-) - level(+); the
/// error of `LATENCY` periods ago enters the integrator. Returns the sampler and the sum over the
/// periods of the register after its update, codes.
///
/// A latency of one period breaks the chain ramp -> fringe -> register -> ramp in two, so that the
/// processor overlaps two periods.
#[inline]
pub(super) fn advance<S: Sampler, const ROUND: bool, const LATENCY: usize>(
    registers: &mut Registers,
    constants: LoopConstants,
    phases_codes: &[f64],
    mut sampler: S,
) -> (S, f64) {
    let turn = constants.codes_per_turn;
    let mut state = *registers;
    let mut sum = 0.0;
    for pair in phases_codes.chunks_exact(2) {
        let plus_error = state.half_period::<ROUND>(pair[0], turn);
        let plus = sampler.sample::<true>(plus_error);
        let minus_error = state.half_period::<ROUND>(pair[1], turn);
        let minus = sampler.sample::<false>(minus_error);
        let error = minus - plus;
        let due = if LATENCY == 0 {
            error
        } else {
            let due = state.delayed_levels[LATENCY - 1];
            for slot in (1..LATENCY).rev() {
                state.delayed_levels[slot] = state.delayed_levels[slot - 1];
            }
            state.delayed_levels[0] = error;
            due
        };
        state.step_codes += constants.gain_codes_per_level * due;
        sum += state.step_codes;
    }
    *registers = state;
    (sampler, sum)
}
