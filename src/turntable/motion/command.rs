//! The command, delivered sample by sample.

use super::course::{Instant, Shape};
use crate::scenario::MotionConfig;
use crate::signal::MotionSegment;

/// Command, delivered sample by sample.
#[derive(Clone, Debug)]
pub(in crate::turntable) struct Profile {
    shape: Shape,
    /// Index of the next sample.
    index: u64,
    /// Where the last segment ended.
    start: Instant,
    /// Steps taken so far.
    steps_taken: usize,
}

impl Profile {
    pub(in crate::turntable) fn new(
        motion: &MotionConfig,
        warm_up_s: f64,
        sample_period_s: f64,
    ) -> Self {
        let shape = Shape::new(motion, warm_up_s, sample_period_s);
        Self {
            start: shape.at(0.0),
            index: 0,
            steps_taken: 0,
            shape,
        }
    }

    /// Commanded rate at the very start, rad/s.
    pub(in crate::turntable) fn initial_rate(&self) -> f64 {
        self.start.rate
    }

    /// Command over the next sample. Steps fall between segments, all else is a cubic through
    /// the rates and slopes at both ends.
    pub(in crate::turntable) fn next_segment(&mut self) -> MotionSegment {
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
