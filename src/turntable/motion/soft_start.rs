//! Raised-cosine start of a motion.

use std::f64::consts::PI;

/// Longest soft start, s: motion must have its full amplitude when the warm-up ends.
const SOFT_START_MAX_S: f64 = 1.0;

/// Raised-cosine ramp of an amplitude from 0 to 1: `(1 - cos(pi t / t_s)) / 2`.
///
/// Rate and acceleration are continuous at both of its ends, so that it hardly excites the servo.
#[derive(Clone, Copy, Debug)]
pub(super) struct SoftStart {
    /// Length in samples; 0 = none.
    samples: f64,
}

impl SoftStart {
    /// A soft start lies inside the warm-up and lasts at most [`SOFT_START_MAX_S`].
    pub(super) fn new(soft_start_s: f64, warm_up_s: f64, sample_period_s: f64) -> Self {
        Self {
            samples: soft_start_s.min(SOFT_START_MAX_S).min(warm_up_s) / sample_period_s,
        }
    }

    /// A ramp of any length, >= 0 s.
    pub(super) fn of(length_s: f64, sample_period_s: f64) -> Self {
        Self {
            samples: length_s / sample_period_s,
        }
    }

    /// Value and slope per sample at `instant` samples from the start.
    pub(super) fn at(self, instant: f64) -> (f64, f64) {
        if instant >= self.samples {
            return (1.0, 0.0);
        }
        let step = PI / self.samples;
        let phase = step * instant;
        (0.5 * (1.0 - phase.cos()), 0.5 * step * phase.sin())
    }
}
