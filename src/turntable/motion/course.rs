//! Commanded rate as a function of the sample count.

use std::fmt::Debug;

use crate::signal::MotionSegment;

/// Commanded rate at one instant and its slope per sample.
#[derive(Clone, Copy, Debug)]
pub(in crate::turntable) struct Instant {
    /// rad/s.
    pub(in crate::turntable) rate: f64,
    /// rad/s per sample.
    pub(in crate::turntable) slope: f64,
}

impl Instant {
    /// Standing still.
    pub(super) const REST: Self = Self {
        rate: 0.0,
        slope: 0.0,
    };
}

/// Course of a command.
pub(in crate::turntable) trait Course: Debug + Send + Sync {
    /// Command at `instant` samples from the start.
    fn at(&self, instant: f64) -> Instant;

    /// Command over sample `index`, which begins at `start`, and where it ends.
    ///
    /// The cubic through the rates and slopes at both ends.
    fn segment(&self, index: u64, start: Instant) -> (MotionSegment, Instant) {
        let end = self.at((index + 1) as f64);
        let segment = MotionSegment::hermite(start.rate, start.slope, end.rate, end.slope);
        (segment, end)
    }
}
