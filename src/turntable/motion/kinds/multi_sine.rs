//! Several sines of rate at once, and their phases.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::{MotionChecks, SAMPLES_PER_CYCLE_MIN};
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::soft_start::SoftStart;
use crate::units::deg_per_s_to_rad_per_s;
use crate::vocabulary::PhaseRule;

table! {
    /// Several sines of rate at once, for a frequency response from one record.
    pub struct MultiSineConfig {
        /// Frequencies, ascending, at most 64; a cycle must span at least 4 output samples, and the record
        /// three cycles of the lowest and one of each difference.
        frequencies_hz: Vec<f64>, example [5.0, 20.0, 80.0, 320.0], in 1e-6..=100_000.0, "Hz";
        /// Rate amplitudes: one for all frequencies, or one for each.
        rate_amplitudes_deg_per_s: Vec<f64>, example [1.0], in 1e-9..=2000.0, "deg/s";
        /// Phases, which decide how high the sum peaks: cosines of phase -pi k (k - 1) / K (if all K
        /// amplitudes are equal) or pi (k - 1)^2 / K, or sines of phase zero. Source of the default:
        /// Schroeder, IEEE Trans. Inf. Theory 16 (1970) 85, which serves unequal amplitudes too.
        phases: PhaseRule = "schroeder";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
    }
}

impl MultiSineConfig {
    /// Rate amplitude of tone `index`, deg/s.
    ///
    /// # Panics
    /// If there is neither one amplitude nor one for each frequency; the reader refuses that.
    #[must_use]
    pub fn rate_amplitude_deg_per_s(&self, index: usize) -> f64 {
        match self.rate_amplitudes_deg_per_s.as_slice() {
            [common] => *common,
            each => each[index],
        }
    }
}

/// Most sines: the fit grows with the square of their number.
const TONES_MAX: usize = 64;

/// Fewest cycles of the lowest sine in the record.
const CYCLES_MIN: f64 = 3.0;

/// Relative slack when frequencies are compared, so that 1 Hz apart is told in 1 s.
const SLACK: f64 = 1e-9;

/// Turns by which a cosine is ahead of a sine.
const COSINE: f64 = 0.25;

impl MultiSineConfig {
    /// Rate amplitudes, rad/s.
    fn amplitudes_rad_per_s(&self) -> impl Iterator<Item = f64> {
        (0..self.frequencies_hz.len())
            .map(|index| deg_per_s_to_rad_per_s(self.rate_amplitude_deg_per_s(index)))
    }

    /// Bound of the acceleration, rad/s^2: the sines may all peak at once.
    #[must_use]
    pub fn acceleration_max_rad_per_s2(&self) -> f64 {
        let amplitudes = self.amplitudes_rad_per_s();
        amplitudes
            .zip(&self.frequencies_hz)
            .map(|(amplitude, frequency_hz)| TAU * frequency_hz * amplitude)
            .sum()
    }

    /// Refuses sines of the table `table` that cannot be sampled, or not be told apart in the record.
    ///
    /// A joint least-squares fit tells two sines apart once the record holds one cycle of their
    /// difference; whole cycles are not asked for.
    pub(crate) fn check_at(&self, table: &str, checks: &mut MotionChecks) {
        checks.soft_start(&format!("{table}.soft_start_s"), self.soft_start_s);
        let frequencies = format!("{table}.frequencies_hz");
        let tones = &self.frequencies_hz;
        let (duration_s, output_rate_hz) = (checks.duration_s, 1.0 / checks.sample_period_s);
        let mut complain = |key: String, text: String| {
            let message = format!("{key} {text}");
            checks.complain(&key, message);
        };
        if tones.len() > TONES_MAX {
            let text = format!("holds {} frequencies: at most {TONES_MAX}", tones.len());
            complain(frequencies.clone(), text);
        }
        let amplitudes = self.rate_amplitudes_deg_per_s.len();
        if amplitudes != 1 && amplitudes != tones.len() {
            let text = format!(
                "holds {amplitudes} amplitudes for {} frequencies: give one for all, or one for each",
                tones.len()
            );
            complain(format!("{table}.rate_amplitudes_deg_per_s"), text);
        }
        let lowest = tones.first().copied().unwrap_or(0.0);
        if lowest * duration_s < CYCLES_MIN * (1.0 - SLACK) {
            let text = format!(
                "= {lowest:?} Hz is too slow: duration_s = {duration_s:?} s must hold {CYCLES_MIN} cycles"
            );
            complain(format!("{frequencies}[0]"), text);
        }
        let frequency_hz_max = output_rate_hz / SAMPLES_PER_CYCLE_MIN;
        for (index, frequency_hz) in tones.iter().enumerate() {
            if *frequency_hz > frequency_hz_max {
                let text = format!(
                    "= {frequency_hz:?} Hz is too fast: allowed up to {frequency_hz_max:.6} Hz, \
                     {SAMPLES_PER_CYCLE_MIN} samples a cycle at the output rate of {output_rate_hz:.6} Hz"
                );
                complain(format!("{frequencies}[{index}]"), text);
            }
        }
        for (index, pair) in tones.windows(2).enumerate() {
            let key = format!("{frequencies}[{}]", index + 1);
            let apart_hz = pair[1] - pair[0];
            if apart_hz <= 0.0 {
                let text = format!("= {:?} Hz does not ascend from {:?} Hz", pair[1], pair[0]);
                complain(key, text);
            } else if apart_hz * duration_s < 1.0 - SLACK {
                let text = format!(
                    "= {:?} Hz cannot be told from {:?} Hz in duration_s = {duration_s:?} s: \
                     it must hold a cycle of the difference",
                    pair[1], pair[0]
                );
                complain(key, text);
            }
        }
    }
}

impl Motion for MultiSineConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::MultiSine {
            frequencies_hz: &self.frequencies_hz,
        }
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        self.amplitudes_rad_per_s().sum()
    }

    fn frequency_max_hz(&self) -> f64 {
        self.frequencies_hz.iter().copied().fold(0.0, f64::max)
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        let soft_start_s = self.soft_start_s.min(surroundings.warm_up_s);
        CommandExtremes::soft(
            self.rate_max_rad_per_s(),
            self.acceleration_max_rad_per_s2(),
            soft_start_s,
        )
    }

    fn check(&self, checks: &mut MotionChecks) {
        self.check_at("turntable.multi_sine", checks);
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(MultiSine {
            tones: tones(self, sample_period_s),
            soft_start: SoftStart::new(self.soft_start_s, warm_up_s, sample_period_s),
        })
    }
}

/// Command of a sum of sines, ramped.
#[derive(Clone, Debug)]
struct MultiSine {
    tones: Vec<Tone>,
    soft_start: SoftStart,
}

impl Course for MultiSine {
    fn at(&self, instant: f64) -> Instant {
        let (rate, slope) = sum_at(&self.tones, instant);
        let (ramp, ramp_slope) = self.soft_start.at(instant);
        Instant {
            rate: ramp * rate,
            slope: ramp * slope + ramp_slope * rate,
        }
    }
}

/// One sine of rate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tone {
    /// Amplitude, rad/s.
    amplitude: f64,
    /// Cycles per output sample.
    cycles_per_sample: f64,
    /// Phase at the start, turns.
    phase_turns: f64,
}

/// The sines of a configuration.
///
/// With the shares `p` of the power, Schroeder's phase of tone k is
/// `-2 pi sum_(j<k) (k - j) p_j`: the frequency of a chirp that has swept the power below it by
/// then. For equal powers it is `-pi k (k - 1) / K`. Newman's is `pi (k - 1)^2 / K`. Both are phases
/// of cosines and made for equally spaced frequencies; elsewhere they still beat equal phases.
///
/// # Source
/// Schroeder, IEEE Trans. Inf. Theory 16 (1970) 85; Boyd, IEEE Trans. Circuits Syst. 33 (1986) 1018.
fn tones(config: &MultiSineConfig, sample_period_s: f64) -> Vec<Tone> {
    let count = config.frequencies_hz.len();
    let amplitude = |index: usize| config.rate_amplitude_deg_per_s(index);
    let power: f64 = (0..count).map(|index| amplitude(index).powi(2)).sum();
    // Power below the tone, and the sum of it over the tones below.
    let (mut below, mut swept) = (0.0, 0.0);
    let mut made = Vec::with_capacity(count);
    for (index, frequency_hz) in config.frequencies_hz.iter().enumerate() {
        swept += below;
        below += amplitude(index).powi(2) / power;
        let phase_turns = match config.phases {
            PhaseRule::Schroeder => COSINE - swept,
            PhaseRule::Newman => COSINE + 0.5 * (index * index) as f64 / count as f64,
            PhaseRule::Zero => 0.0,
        };
        made.push(Tone {
            amplitude: deg_per_s_to_rad_per_s(amplitude(index)),
            cycles_per_sample: frequency_hz * sample_period_s,
            phase_turns,
        });
    }
    made
}

/// Rate (rad/s) and slope (rad/s per sample) of the sum at `instant` samples from the start.
fn sum_at(tones: &[Tone], instant: f64) -> (f64, f64) {
    tones.iter().fold((0.0, 0.0), |(rate, slope), tone| {
        // Whole cycles are dropped before the sine, which keeps full precision for hours.
        let turns = (tone.cycles_per_sample * instant).fract() + tone.phase_turns;
        let (sine, cosine) = (TAU * turns).sin_cos();
        (
            rate + tone.amplitude * sine,
            slope + tone.amplitude * TAU * tone.cycles_per_sample * cosine,
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crest_factor(phases: PhaseRule) -> f64 {
        let config = MultiSineConfig {
            frequencies_hz: (1..=32).map(f64::from).collect(),
            rate_amplitudes_deg_per_s: vec![1.0],
            phases,
            ..MultiSineConfig::reference()
        };
        let tones = tones(&config, 1.0 / 4096.0);
        let rates = (0..4096_i32).map(|k| sum_at(&tones, f64::from(k)).0);
        let peak = rates.fold(0.0_f64, |max, rate| max.max(rate.abs()));
        let mean_square: f64 = tones.iter().map(|tone| tone.amplitude.powi(2) / 2.0).sum();
        peak / mean_square.sqrt()
    }

    #[test]
    fn phases_by_formula_keep_the_peak_of_32_tones_low() {
        // Boyd 1986: both rules stay near 1.7 for equally spaced cosines. Cosines in phase reach
        // sqrt(2 K) = 8, sines three quarters of that.
        assert!(crest_factor(PhaseRule::Schroeder) < 1.8);
        assert!(crest_factor(PhaseRule::Newman) < 1.8);
        assert!(crest_factor(PhaseRule::Zero) > 5.0);
    }

    #[test]
    fn schroeder_phases_of_equal_tones_are_the_closed_form() {
        let config = MultiSineConfig {
            frequencies_hz: (1..=10).map(f64::from).collect(),
            rate_amplitudes_deg_per_s: vec![2.0],
            phases: PhaseRule::Schroeder,
            ..MultiSineConfig::reference()
        };
        for (tone, k) in tones(&config, 1e-3).iter().zip(1_i32..) {
            let expected = COSINE - f64::from(k * (k - 1)) / 20.0;
            assert!((tone.phase_turns - expected).abs() < 1e-12);
        }
    }
}
