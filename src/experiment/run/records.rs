//! Lengths of records, stamps of samples.

use crate::gyro;
use crate::scenario::{Resolved, Scenario};
use crate::turntable::first_measured_index;

/// How many samples the warm-up and the measured record hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RecordLength {
    /// Samples before the record.
    pub(crate) warm_up: usize,
    /// Samples of the record.
    pub(crate) measured: usize,
}

impl RecordLength {
    /// `ceil(warm_up_s f)` and `floor(duration_s f)` samples.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the plan bounds both counts and the reader refuses negative times"
    )]
    pub(crate) fn new(scenario: &Scenario, sample_period_s: f64) -> Self {
        let rate_hz = 1.0 / sample_period_s;
        Self {
            warm_up: first_measured_index(scenario.warm_up_s, sample_period_s) as usize,
            measured: (scenario.duration_s * rate_hz).floor() as usize,
        }
    }

    /// Those of a run, simulated or recorded: a log may end in the middle of a sample period.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of samples of a log, which is read; the cast saturates"
    )]
    pub(crate) fn of(resolved: &Resolved) -> Self {
        const SLACK: f64 = 1e-9;
        let period_s = sample_period_s(resolved);
        let length = Self::new(&resolved.scenario, period_s);
        let Some(log) = &resolved.log else {
            return length;
        };
        let asked = resolved.scenario.duration_s / period_s * (1.0 + SLACK);
        let left = log.samples.saturating_sub(length.warm_up);
        Self {
            warm_up: length.warm_up,
            measured: left.min(asked.floor() as usize),
        }
    }

    /// All samples.
    pub(crate) fn total(self) -> usize {
        self.warm_up + self.measured
    }
}

/// Stamp of sample `index`, s from the start of the warm-up.
pub(crate) fn stamp_s(index: u64, sample_period_s: f64) -> f64 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    let ordinal = (index + 1) as f64;
    ordinal * sample_period_s
}

/// A number of samples as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
pub(crate) fn count(samples: usize) -> f64 {
    samples as f64
}

/// Period of the samples of a run, simulated or recorded, s.
pub(crate) fn sample_period_s(resolved: &Resolved) -> f64 {
    match &resolved.log {
        Some(log) => 1.0 / log.sample_rate_hz,
        None => gyro::sample_period_s(&resolved.scenario.gyro),
    }
}
