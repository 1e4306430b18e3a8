//! Time columns: the sample period they imply, and what speaks against equal spacing.

use std::path::Path;
use std::str::FromStr;

use super::column::{Column, Columns};
use super::error::LogError;
use crate::units::{NANO, ms_to_s, us_to_s};

/// A step is a gap when it exceeds the sample period by this part of it.
const STEP_TOLERANCE: f64 = 0.5;
/// A rate that was given may differ from that of the time column by this part.
const RATE_TOLERANCE: f64 = 1e-3;

/// Unit of a time column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// s.
    Seconds,
    /// ms.
    Milliseconds,
    /// us.
    Microseconds,
    /// ns.
    Nanoseconds,
}

impl TimeUnit {
    /// A time in s.
    #[must_use]
    pub fn to_s(self, time: f64) -> f64 {
        match self {
            Self::Seconds => time,
            Self::Milliseconds => ms_to_s(time),
            Self::Microseconds => us_to_s(time),
            Self::Nanoseconds => time * NANO,
        }
    }
}

/// A unit of times that nobody knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected one of s, ms, us, ns")]
pub struct UnknownTimeUnit;

impl FromStr for TimeUnit {
    type Err = UnknownTimeUnit;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "s" => Ok(Self::Seconds),
            "ms" => Ok(Self::Milliseconds),
            "us" => Ok(Self::Microseconds),
            "ns" => Ok(Self::Nanoseconds),
            _ => Err(UnknownTimeUnit),
        }
    }
}

/// What a time column says about the spacing of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Timing {
    /// Sample rate over the whole record, Hz: one less than the stamps over the time between the
    /// first and the last.
    pub sample_rate_hz: f64,
    /// Largest distance of a stamp from equal spacing, s.
    pub jitter_max_s: f64,
}

/// Checks the stamps of a log.
///
/// * `given_rate_hz`: the rate the user named, if any; a gap is then one against it.
///
/// # Errors
/// Stamps that do not ascend, a gap with place and size, two samples in the time of one, a given
/// rate that the column contradicts.
pub(super) fn timing(
    path: &Path,
    columns: &Columns,
    time: &Column,
    unit: TimeUnit,
    given_rate_hz: Option<f64>,
) -> Result<Timing, LogError> {
    let first = time.values.first().copied().unwrap_or_default();
    // From the first stamp on, so that stamps of an absolute clock keep their digits.
    let stamps_s: Vec<f64> = time
        .values
        .iter()
        .map(|stamp| unit.to_s(stamp - first))
        .collect();
    let (Some(&last_s), true) = (stamps_s.last(), stamps_s.len() >= 2) else {
        let message = "the time column holds fewer than two stamps: give --rate-hz";
        return Err(LogError::of_file(path, message));
    };
    let period_s = given_rate_hz.map_or_else(|| median_step(&stamps_s), |rate| 1.0 / rate);
    for (row, pair) in stamps_s.windows(2).enumerate() {
        let step_s = pair[1] - pair[0];
        check_step(step_s, period_s).map_err(|complaint| {
            let message = format!("column {}: {complaint}", shown(time));
            LogError::at(path, columns.place(row + 1), message)
        })?;
    }
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    let steps = (stamps_s.len() - 1) as f64;
    let mean_s = last_s / steps;
    if let Some(rate) = given_rate_hz
        && (mean_s * rate - 1.0).abs() > RATE_TOLERANCE
    {
        let message = format!(
            "--rate-hz {rate} contradicts the time column {}, whose mean rate is {:.6} Hz: leave \
             one of them out",
            shown(time),
            1.0 / mean_s
        );
        return Err(LogError::of_file(path, message));
    }
    let mut ordinal = 0.0;
    let mut jitter_max_s = 0.0_f64;
    for stamp_s in &stamps_s {
        jitter_max_s = jitter_max_s.max((stamp_s - ordinal * mean_s).abs());
        ordinal += 1.0;
    }
    Ok(Timing {
        sample_rate_hz: 1.0 / mean_s,
        jitter_max_s,
    })
}

fn shown(time: &Column) -> &str {
    time.name.as_deref().unwrap_or("time")
}

/// Median of the steps: what gaps do not move.
fn median_step(stamps_s: &[f64]) -> f64 {
    let mut steps: Vec<f64> = stamps_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    *median
}

/// What speaks against equal spacing between two stamps.
#[derive(Debug, thiserror::Error)]
enum StepError {
    #[error(
        "the time goes from one stamp to the next by {step_s:.9} s: stamps must ascend; if they are \
         rounded too coarsely, leave the time column out and give --rate-hz"
    )]
    Descent { step_s: f64 },
    #[error(
        "gap of {step_s:.9} s where samples are {period_s:.9} s apart ({:.0} missing): gaps are not \
         filled, cut the log there",
        (step_s / period_s - 1.0).max(1.0)
    )]
    Gap { step_s: f64, period_s: f64 },
    #[error(
        "the stamp is {step_s:.9} s after the one before where samples are {period_s:.9} s apart: \
         spacing must be equal within half of that"
    )]
    Crowd { step_s: f64, period_s: f64 },
}

fn check_step(step_s: f64, period_s: f64) -> Result<(), StepError> {
    if step_s <= 0.0 {
        return Err(StepError::Descent { step_s });
    }
    if step_s > (1.0 + STEP_TOLERANCE) * period_s {
        return Err(StepError::Gap { step_s, period_s });
    }
    if step_s < (1.0 - STEP_TOLERANCE) * period_s {
        return Err(StepError::Crowd { step_s, period_s });
    }
    Ok(())
}
