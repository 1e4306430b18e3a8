//! The command, delivered sample by sample.

use std::sync::Arc;

use super::course::{Course, Instant};
use crate::signal::MotionSegment;

/// Command, delivered sample by sample.
#[derive(Clone, Debug)]
pub(in crate::turntable) struct Command {
    course: Arc<dyn Course>,
    /// Index of the next sample.
    index: u64,
    /// Where the last segment ended.
    start: Instant,
}

impl Command {
    /// The command at the start of its course.
    pub(in crate::turntable) fn new(course: Arc<dyn Course>) -> Self {
        Self {
            start: course.at(0.0),
            index: 0,
            course,
        }
    }

    /// Commanded rate at the very start, rad/s.
    pub(in crate::turntable) fn initial_rate(&self) -> f64 {
        self.start.rate
    }

    /// Command over the next sample.
    pub(in crate::turntable) fn next_segment(&mut self) -> MotionSegment {
        let (segment, end) = self.course.segment(self.index, self.start);
        self.index += 1;
        self.start = end;
        segment
    }
}
