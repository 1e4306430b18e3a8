//! Several sines of rate at once, and their phases.

use std::f64::consts::TAU;

use crate::scenario::{MultiSineConfig, PhaseRule};
use crate::units::deg_per_s_to_rad_per_s;

/// Turns by which a cosine is ahead of a sine.
const COSINE: f64 = 0.25;

/// One sine of rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tone {
    /// Amplitude, rad/s.
    pub(super) amplitude: f64,
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
pub(super) fn tones(config: &MultiSineConfig, sample_period_s: f64) -> Vec<Tone> {
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
pub(super) fn sum_at(tones: &[Tone], instant: f64) -> (f64, f64) {
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
            soft_start_s: 0.0,
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
            soft_start_s: 0.0,
        };
        for (tone, k) in tones(&config, 1e-3).iter().zip(1_i32..) {
            let expected = COSINE - f64::from(k * (k - 1)) / 20.0;
            assert!((tone.phase_turns - expected).abs() < 1e-12);
        }
    }
}
