//! The optics and the loop as waveforms below the transit time, written apart from the library.
//!
//! Two waves pass the modulator, one at t and one a transit time earlier, so that the detector
//! sees `psi(t) - psi(t - tau)` at every instant and not once per half period. Each state of the
//! clock is cut where either wave meets a new state, and every piece is integrated in steps of at
//! most a fortieth of the transit time; a gap of a thousandth of it is therefore resolved exactly.

/// Steps of a piece, which is no longer than a transit time.
const STEPS: u32 = 40;

/// States the delayed wave may lie behind: tau over a state of just under tau / 2, rounded up.
const HISTORY: usize = 4;

/// What the clock puts on the modulator, state after state, and how it is demodulated.
#[derive(Clone, Debug)]
pub(crate) struct BiasWave {
    /// Phase of each state of a cycle, rad.
    pub(crate) bias_rad: Vec<f64>,
    /// Demodulation sign of each state, for the rate.
    pub(crate) rate_signs: Vec<f64>,
    /// Demodulation sign of each state, for the gain of the modulator.
    pub(crate) gain_signs: Vec<f64>,
    /// States per transit time at the proper frequency: 1 or 2.
    pub(crate) states_per_transit: f64,
    /// Slope of the rate demodulation at unit visibility: `sin phi_m` or `sin a`.
    pub(crate) slope: f64,
}

/// Intensity modulation by the bias wave, relative to a state of full positive bias.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct IntensityModulation {
    /// Transmission of the two arms of the modulator, each of which both waves pass once.
    pub(crate) arms: [f64; 2],
    /// Gain of the detected power.
    pub(crate) detected: f64,
}

/// The interferometer and its clock.
#[derive(Clone, Debug)]
pub(crate) struct WaveformGyro {
    pub(crate) wave: BiasWave,
    /// Relative excess of the clock's state over its proper length.
    pub(crate) mismatch: f64,
    pub(crate) visibility: f64,
    /// Applied phase over commanded phase, less 1.
    pub(crate) modulator_gain_error: f64,
    pub(crate) intensity: IntensityModulation,
    /// Whether the demodulator leaves out what is neither state against its proper predecessor.
    pub(crate) is_gated: bool,
}

/// One state of the clock as it was put on the modulator.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    /// Bias less staircase, commanded, rad: the loop's feedback opposes the Sagnac phase.
    phase_rad: f64,
    /// Bias relative to its largest.
    drive: f64,
}

/// The loop about the interferometer: staircase, demodulators, integrator.
pub(crate) struct WaveformLoop {
    gyro: WaveformGyro,
    states: [State; HISTORY],
    ramp_rad: f64,
    /// Step of the staircase per proper transit time, the register.
    pub(crate) register_rad: f64,
    /// Growth of the Sagnac phase per transit time inside a cycle.
    pub(crate) sagnac_slope_rad: f64,
}

/// Demodulated cycle: the loop's error and that of the modulator's gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demodulated {
    pub(crate) rate: f64,
    pub(crate) gain: f64,
}

impl WaveformLoop {
    pub(crate) fn new(gyro: WaveformGyro) -> Self {
        let mut new = Self {
            gyro,
            states: [State::default(); HISTORY],
            ramp_rad: 0.0,
            register_rad: 0.0,
            sagnac_slope_rad: 0.0,
        };
        // The states of the cycle before the first one, so that it starts in the steady state.
        for state in 0..new.gyro.wave.bias_rad.len() {
            new.put(state);
        }
        new
    }

    /// Runs one cycle of the clock from a Sagnac phase at its start, the register held; powers are demodulated as
    /// the detector sees them.
    pub(crate) fn cycle(&mut self, sagnac_rad: f64) -> Demodulated {
        let states = self.gyro.wave.bias_rad.len();
        let (mut rate, mut gain) = (0.0, 0.0);
        for state in 0..states {
            self.put(state);
            let start = state as f64 * self.state_length();
            let power = self.mean_power(sagnac_rad + self.sagnac_slope_rad * start);
            rate += self.gyro.wave.rate_signs[state] * power;
            gain += self.gyro.wave.gain_signs[state] * power;
        }
        let scale = states as f64 * self.gyro.visibility * self.gyro.wave.slope;
        Demodulated {
            rate: rate / scale,
            gain: gain / (scale * std::f64::consts::PI),
        }
    }

    /// Closes the loop for a number of cycles and returns the mean register over the last half.
    pub(crate) fn settle(&mut self, sagnac_rad: f64, loop_gain: f64, cycles: u32) -> f64 {
        let mut sum = 0.0;
        for cycle in 0..cycles {
            self.register_rad += loop_gain * self.cycle(sagnac_rad).rate;
            if 2 * cycle >= cycles {
                sum += self.register_rad;
            }
        }
        2.0 * sum / f64::from(cycles)
    }

    /// The clock moves on to a state of its cycle.
    fn put(&mut self, state: usize) {
        let wave = &self.gyro.wave;
        self.ramp_rad = (self.ramp_rad + self.register_rad / wave.states_per_transit)
            .rem_euclid(std::f64::consts::TAU);
        let largest = wave
            .bias_rad
            .iter()
            .fold(0.0_f64, |max, b| max.max(b.abs()));
        self.states.rotate_right(1);
        self.states[0] = State {
            phase_rad: wave.bias_rad[state] - self.ramp_rad,
            drive: wave.bias_rad[state] / largest,
        };
    }

    /// Length of a state in transit times.
    fn state_length(&self) -> f64 {
        (1.0 + self.gyro.mismatch) / self.gyro.wave.states_per_transit
    }

    /// Mean power over the newest state, in units of the mean power over a fringe. Time is counted
    /// in transit times from the start of the state.
    fn mean_power(&self, sagnac_rad: f64) -> f64 {
        let per_transit = self.gyro.wave.states_per_transit;
        let length = self.state_length();
        let (mut sum, mut time) = (0.0, 0.0);
        for (behind, before) in self.states.iter().enumerate() {
            // While the delayed wave, a transit time late, met that earlier state.
            let start = (1.0 - behind as f64 * length).max(0.0);
            let end = (1.0 - (behind as f64 - 1.0) * length).min(length);
            let is_proper = (behind as f64 - per_transit).abs() < 0.5;
            if start >= end || (self.gyro.is_gated && !is_proper) {
                continue;
            }
            let step = (end - start) / f64::from(STEPS);
            for index in 0..STEPS {
                let at = start + (f64::from(index) + 0.5) * step;
                sum += step * self.power(sagnac_rad + self.sagnac_slope_rad * at, before);
                time += step;
            }
        }
        sum / time
    }

    /// Power while the delayed wave meets the modulator in state `before`.
    fn power(&self, sagnac_rad: f64, before: &State) -> f64 {
        let now = self.states[0];
        let applied = 1.0 + self.gyro.modulator_gain_error;
        let difference = applied * (now.phase_rad - before.phase_rad);
        let [arm_a, arm_b] = self.gyro.intensity.arms;
        // One wave passes arm A first and arm B a transit time later, the other the reverse.
        let first = (1.0 + arm_a * before.drive) * (1.0 + arm_b * now.drive);
        let second = (1.0 + arm_b * before.drive) * (1.0 + arm_a * now.drive);
        let interference = self.gyro.visibility * (first * second).sqrt();
        let light = 0.5 * (first + second) + interference * (sagnac_rad + difference).cos();
        light * (1.0 + self.gyro.intensity.detected * now.drive)
    }
}
