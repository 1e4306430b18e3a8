//! What the table is told to do: commanded rate as a function of the sample count.

use std::f64::consts::{PI, TAU};

use super::tones::{self, Tone};
use crate::scenario::{MotionConfig, MultiSineConfig, StepsConfig, SwingConfig};
use crate::signal::MotionSegment;
use crate::units::{deg_per_s_to_rad_per_s, deg_to_rad};

/// Longest soft start, s: motion must have its full amplitude when the warm-up ends.
const SOFT_START_MAX_S: f64 = 1.0;

/// Commanded rate at one instant and its slope per sample.
#[derive(Clone, Copy, Debug)]
struct Instant {
    /// rad/s.
    rate: f64,
    /// rad/s per sample.
    slope: f64,
}

/// Raised-cosine ramp of an amplitude from 0 to 1: `(1 - cos(pi t / t_s)) / 2`.
///
/// Rate and acceleration are continuous at both of its ends, so that it hardly excites the servo.
#[derive(Clone, Copy, Debug)]
struct SoftStart {
    /// Length in samples; 0 = none.
    samples: f64,
}

impl SoftStart {
    /// A soft start lies inside the warm-up and lasts at most [`SOFT_START_MAX_S`].
    fn new(soft_start_s: f64, warm_up_s: f64, sample_period_s: f64) -> Self {
        Self {
            samples: soft_start_s.min(SOFT_START_MAX_S).min(warm_up_s) / sample_period_s,
        }
    }

    /// Value and slope per sample at `instant` samples from the start.
    fn at(self, instant: f64) -> (f64, f64) {
        if instant >= self.samples {
            return (1.0, 0.0);
        }
        let step = PI / self.samples;
        let phase = step * instant;
        (0.5 * (1.0 - phase.cos()), 0.5 * step * phase.sin())
    }
}

/// Shape of a command.
#[derive(Clone, Debug)]
enum Shape {
    /// `rate`, ramped.
    Rotation { rate: f64, soft_start: SoftStart },
    /// `amplitude sin(2 pi f t)`, ramped.
    Swing {
        amplitude: f64,
        cycles_per_sample: f64,
        soft_start: SoftStart,
    },
    /// A sum of sines, ramped.
    MultiSine {
        tones: Vec<Tone>,
        soft_start: SoftStart,
    },
    /// Rates, rad/s, and the index of the first sample of each but the first.
    Steps { rates: Vec<f64>, changes: Vec<u64> },
}

impl Shape {
    /// Command at `instant` samples from the start; staircases have no such single value.
    fn at(&self, instant: f64) -> Instant {
        match self {
            Self::Rotation { rate, soft_start } => {
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: rate * ramp,
                    slope: rate * ramp_slope,
                }
            }
            Self::Swing {
                amplitude,
                cycles_per_sample,
                soft_start,
            } => {
                // Whole cycles are dropped before the sine, which keeps full precision for hours.
                let (sine, cosine) = (TAU * (cycles_per_sample * instant).fract()).sin_cos();
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: amplitude * ramp * sine,
                    slope: amplitude
                        * (ramp * TAU * cycles_per_sample * cosine + ramp_slope * sine),
                }
            }
            Self::MultiSine { tones, soft_start } => {
                let (rate, slope) = tones::sum_at(tones, instant);
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: ramp * rate,
                    slope: ramp * slope + ramp_slope * rate,
                }
            }
            Self::Steps { rates, .. } => Instant {
                rate: rates[0],
                slope: 0.0,
            },
        }
    }
}

/// Command, delivered sample by sample.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    shape: Shape,
    /// Index of the next sample.
    index: u64,
    /// Where the last segment ended.
    start: Instant,
    /// Steps taken so far.
    steps_taken: usize,
}

impl Profile {
    pub(super) fn new(motion: &MotionConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let soft_start = |length_s| SoftStart::new(length_s, warm_up_s, sample_period_s);
        let shape = match motion {
            MotionConfig::Static(_) => Shape::Rotation {
                rate: 0.0,
                soft_start: soft_start(0.0),
            },
            MotionConfig::Rotation(rotation) => Shape::Rotation {
                rate: deg_per_s_to_rad_per_s(rotation.rate_deg_per_s),
                soft_start: soft_start(rotation.soft_start_s),
            },
            MotionConfig::Swing(swing) => Shape::Swing {
                amplitude: swing_rate_amplitude_rad_per_s(swing),
                cycles_per_sample: swing.frequency_hz * sample_period_s,
                soft_start: soft_start(swing.soft_start_s),
            },
            MotionConfig::MultiSine(multi_sine) => Shape::MultiSine {
                tones: tones::tones(multi_sine, sample_period_s),
                soft_start: soft_start(multi_sine.soft_start_s),
            },
            MotionConfig::Steps(steps) => {
                assert!(!steps.rates_deg_per_s.is_empty(), "a staircase has a rate");
                let rates = steps.rates_deg_per_s.iter();
                Shape::Steps {
                    rates: rates.copied().map(deg_per_s_to_rad_per_s).collect(),
                    changes: step_indices(steps, warm_up_s, sample_period_s),
                }
            }
        };
        Self {
            start: shape.at(0.0),
            index: 0,
            steps_taken: 0,
            shape,
        }
    }

    /// Commanded rate at the very start, rad/s.
    pub(super) fn initial_rate(&self) -> f64 {
        self.start.rate
    }

    /// Command over the next sample. Steps fall between segments, all else is a cubic through
    /// the rates and slopes at both ends.
    pub(super) fn next_segment(&mut self) -> MotionSegment {
        let index = self.index;
        self.index += 1;
        if let Shape::Steps { rates, changes } = &self.shape {
            while changes.get(self.steps_taken).is_some_and(|at| *at <= index) {
                self.steps_taken += 1;
            }
            return MotionSegment::constant(rates[self.steps_taken]);
        }
        let start = self.start;
        let end = self.shape.at(self.index as f64);
        self.start = end;
        MotionSegment::hermite(start.rate, start.slope, end.rate, end.slope)
    }
}

/// Rate amplitude of a swing, rad/s; `A = 2 pi f theta` where the angle amplitude is given.
///
/// A swing of 1 deg/s at 5 Hz has an angle amplitude of only 114.6 arcsec.
///
/// # Panics
/// If neither or both amplitudes are set; the scenario reader refuses such a swing.
#[must_use]
pub fn swing_rate_amplitude_rad_per_s(swing: &SwingConfig) -> f64 {
    match (swing.rate_amplitude_deg_per_s, swing.angle_amplitude_deg) {
        (Some(rate), None) => deg_per_s_to_rad_per_s(rate),
        (None, Some(angle)) => TAU * swing.frequency_hz * deg_to_rad(angle),
        (rate, angle) => panic!("a swing has one amplitude, not rate {rate:?} and angle {angle:?}"),
    }
}

/// Rate amplitudes of several sines, rad/s.
fn multi_sine_amplitudes_rad_per_s(config: &MultiSineConfig) -> impl Iterator<Item = f64> {
    (0..config.frequencies_hz.len())
        .map(|index| deg_per_s_to_rad_per_s(config.rate_amplitude_deg_per_s(index)))
}

/// Bound of the acceleration of several sines, rad/s^2: they may all peak at once.
#[must_use]
pub fn multi_sine_acceleration_max_rad_per_s2(config: &MultiSineConfig) -> f64 {
    let amplitudes = multi_sine_amplitudes_rad_per_s(config);
    amplitudes
        .zip(&config.frequencies_hz)
        .map(|(amplitude, frequency_hz)| TAU * frequency_hz * amplitude)
        .sum()
}

/// Largest commanded rate in magnitude, without the Earth's, rad/s; of several sines its bound.
#[must_use]
pub fn command_rate_max_rad_per_s(motion: &MotionConfig) -> f64 {
    match motion {
        MotionConfig::Static(_) => 0.0,
        MotionConfig::Swing(swing) => swing_rate_amplitude_rad_per_s(swing).abs(),
        MotionConfig::MultiSine(multi_sine) => multi_sine_amplitudes_rad_per_s(multi_sine).sum(),
        MotionConfig::Rotation(rotation) => deg_per_s_to_rad_per_s(rotation.rate_deg_per_s).abs(),
        MotionConfig::Steps(steps) => {
            let rates = steps.rates_deg_per_s.iter().copied();
            rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
        }
    }
}

/// Index of the first measured sample, `ceil(warm_up_s / T)`; the first dwell begins there.
#[must_use]
pub fn first_measured_index(warm_up_s: f64, sample_period_s: f64) -> u64 {
    whole_samples((warm_up_s / sample_period_s).ceil())
}

/// Indices of the samples at which the commanded rate changes, one fewer than there are rates.
///
/// Entry `j` is the first sample that lies wholly at rate `j + 1`:
/// `ceil(warm_up_s / T) + round((j + 1) dwell_s / T)`, so that no error builds up over the dwells.
/// The step itself is at the start of that sample, which is the stamp of the sample before it.
#[must_use]
pub fn step_indices(steps: &StepsConfig, warm_up_s: f64, sample_period_s: f64) -> Vec<u64> {
    let first = first_measured_index(warm_up_s, sample_period_s);
    let dwell_samples = steps.dwell_s / sample_period_s;
    (1..steps.rates_deg_per_s.len())
        .map(|dwells| first + whole_samples((dwells as f64 * dwell_samples).round()))
        .collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rounded count of samples; the cast saturates"
)]
fn whole_samples(count: f64) -> u64 {
    count as u64
}
