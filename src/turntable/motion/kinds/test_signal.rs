//! Signals that wavelet methods are tried on: blocks, a step, HeaviSine, Doppler.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::declare::table;
use crate::signal::MotionSegment;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::turntable::servo::step_response_extremes;
use crate::units::deg_per_s_to_rad_per_s;
use crate::vocabulary::words;
use crate::wording::number;

table! {
    /// A signal that wavelet methods are tried on, from the start of the record on; the table rests before it
    /// and, but for the step, after it.
    pub struct TestSignalConfig {
        /// Shape of the signal.
        shape: SignalShape, example "heavisine";
        /// Largest rate; of the Doppler signal the largest of its envelope.
        rate_amplitude_deg_per_s: f64, example 1.0, in 1e-9..=2000.0, "deg/s";
        /// Length of the signal; it must fit into the duration, and its shortest part must span 4 output samples.
        length_s: f64, example 20.0, in 1e-6..=1e7, "s";
    }
}

words! {
    /// Shape of a test signal.
    pub enum SignalShape {
        /// Twelve rates held one after the other, the shortest for a fiftieth of the length.
        Blocks = "blocks",
        /// Rest, then from the middle on one rate that is held for ever.
        Step = "step",
        /// Two cycles of a sine with two jumps.
        Heavisine = "heavisine",
        /// A sine whose frequency falls from 420 cycles a length to one.
        Doppler = "doppler",
    }
}

/// Jumps of the blocks: share of the length and height.
const BLOCKS: [(f64, f64); 11] = [
    (0.10, 4.0),
    (0.13, -5.0),
    (0.15, 3.0),
    (0.23, -4.0),
    (0.25, 5.0),
    (0.40, -4.2),
    (0.44, 2.1),
    (0.65, 4.3),
    (0.76, -3.1),
    (0.78, 2.1),
    (0.81, -4.2),
];

/// Share that keeps the frequency of the Doppler signal finite.
const DOPPLER_SHARE: f64 = 0.05;

/// Fewest output samples of the shortest part of a signal.
const SAMPLES_PER_PART_MIN: f64 = 4.0;

impl SignalShape {
    /// Jumps: share of the length and height, before the signal is scaled.
    fn jumps(self) -> &'static [(f64, f64)] {
        match self {
            Self::Blocks => &BLOCKS,
            Self::Step => &[(0.5, 1.0)],
            Self::Heavisine => &[(0.3, -2.0), (0.72, 2.0)],
            Self::Doppler => &[],
        }
    }

    /// Largest magnitude before the signal is scaled.
    fn largest(self) -> f64 {
        match self {
            Self::Blocks => 5.2,
            Self::Step => 1.0,
            Self::Heavisine => 6.0,
            Self::Doppler => 0.5,
        }
    }

    /// What has no jumps, before it is scaled: value and slope by the length at a share of it.
    fn smooth(self, share: f64) -> (f64, f64) {
        if share <= 0.0 || share >= 1.0 {
            return (0.0, 0.0);
        }
        match self {
            Self::Blocks | Self::Step => (0.0, 0.0),
            Self::Heavisine => {
                let (sine, cosine) = (2.0 * TAU * share).sin_cos();
                (4.0 * sine, 8.0 * TAU * cosine)
            }
            Self::Doppler => {
                let envelope = (share * (1.0 - share)).sqrt();
                let cycles = (1.0 + DOPPLER_SHARE) / (share + DOPPLER_SHARE);
                let (sine, cosine) = (TAU * cycles).sin_cos();
                let turning = -TAU * cycles / (share + DOPPLER_SHARE);
                let widening = 0.5 * (1.0 - 2.0 * share) / envelope;
                (
                    envelope * sine,
                    widening * sine + envelope * turning * cosine,
                )
            }
        }
    }

    /// Bound on the slope of that by the length.
    fn steepest(self) -> f64 {
        match self {
            Self::Blocks | Self::Step => 0.0,
            Self::Heavisine => 8.0 * TAU,
            // `sqrt(t) / (t + e)^2` is largest at a third of e, and the envelope widens slower than that turns.
            Self::Doppler => {
                let at = DOPPLER_SHARE / 3.0;
                let turning = TAU * (1.0 + DOPPLER_SHARE) / (at + DOPPLER_SHARE).powi(2);
                2.0 * turning * at.sqrt()
            }
        }
    }

    /// Highest frequency of its sines, cycles a length.
    fn cycles_max(self) -> f64 {
        match self {
            Self::Blocks | Self::Step => 0.0,
            Self::Heavisine => 2.0,
            Self::Doppler => (1.0 + DOPPLER_SHARE) / DOPPLER_SHARE.powi(2),
        }
    }

    /// Parts of a length of which the shortest has one: a block, a half, a cycle.
    fn parts(self) -> f64 {
        match self {
            Self::Blocks => 50.0,
            Self::Step => 2.0,
            Self::Heavisine | Self::Doppler => self.cycles_max(),
        }
    }
}

impl TestSignalConfig {
    /// Rate that stands for 1 before the signal is scaled, rad/s.
    fn scale(&self) -> f64 {
        self.rate_max_rad_per_s() / self.shape.largest()
    }
}

impl Motion for TestSignalConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::General
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        deg_per_s_to_rad_per_s(self.rate_amplitude_deg_per_s)
    }

    fn frequency_max_hz(&self) -> f64 {
        self.shape.cycles_max() / self.length_s
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        let heights = self.shape.jumps().iter().map(|(_, height)| height.abs());
        let rise = self.scale() * heights.fold(0.0, f64::max);
        let rate_max = self.rate_max_rad_per_s();
        let (jump, of_jump) = step_response_extremes(surroundings.servo, 0.0, rise, rate_max);
        CommandExtremes {
            jump_rad_per_s: jump,
            acceleration_rad_per_s2: of_jump + self.scale() * self.shape.steepest() / self.length_s,
        }
    }

    /// Refuses a signal that the record cuts off or that the output samples cannot show.
    fn check(&self, checks: &mut MotionChecks) {
        let key = "turntable.test_signal.length_s";
        let length_s = self.length_s;
        let shortest_s = SAMPLES_PER_PART_MIN * self.shape.parts() * checks.sample_period_s;
        if checks.fits(key, length_s) && length_s < shortest_s {
            let message = format!(
                "{key} = {length_s:?} s is too short for {}: allowed from {} s, \
                 {SAMPLES_PER_PART_MIN} output samples for its shortest part",
                self.shape.word(),
                number(shortest_s)
            );
            checks.complain(key, message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        let first = first_measured_index(warm_up_s, sample_period_s) as f64;
        let length = self.length_s / sample_period_s;
        let jumps = self.shape.jumps().iter();
        Arc::new(TestSignal {
            shape: self.shape,
            scale: self.scale(),
            first,
            length,
            jumps: jumps
                .map(|(share, height)| (first + (share * length).round(), *height))
                .collect(),
        })
    }
}

/// Blocks, step, HeaviSine or Doppler; jumps lie between samples.
///
/// With `t` from 0 to 1 over the length: blocks are the sum of the jumps `h_j` at `t_j`; HeaviSine is
/// `4 sin(4 pi t) - sgn(t - 0.3) - sgn(0.72 - t)`; Doppler is `sqrt(t (1 - t)) sin(2 pi 1.05 / (t + 0.05))`.
/// Each is divided by its largest magnitude, 5.2, 6 and, of the envelope, 0.5.
///
/// # Source
/// D. L. Donoho and I. M. Johnstone, Biometrika 81 (1994) 425, table 1.
#[derive(Clone, Debug)]
struct TestSignal {
    shape: SignalShape,
    /// rad/s.
    scale: f64,
    /// Where the record begins, samples.
    first: f64,
    /// Length, samples.
    length: f64,
    /// Sample that begins with each jump, and its height.
    jumps: Vec<(f64, f64)>,
}

impl TestSignal {
    /// Sum of the jumps up to the start of a sample.
    fn level(&self, index: f64) -> f64 {
        let taken = self.jumps.iter().filter(|(at, _)| *at <= index);
        taken.map(|(_, height)| height).sum()
    }

    /// Rate at an instant over a level.
    fn over(&self, level: f64, instant: f64) -> Instant {
        let (value, slope) = self.shape.smooth((instant - self.first) / self.length);
        Instant {
            rate: self.scale * (level + value),
            slope: self.scale * slope / self.length,
        }
    }
}

impl Course for TestSignal {
    fn at(&self, instant: f64) -> Instant {
        self.over(self.level(instant), instant)
    }

    fn segment(&self, index: u64, _: Instant) -> (MotionSegment, Instant) {
        let level = self.level(index as f64);
        let (start, end) = (
            self.over(level, index as f64),
            self.over(level, (index + 1) as f64),
        );
        let segment = MotionSegment::hermite(start.rate, start.slope, end.rate, end.slope);
        (segment, end)
    }
}
