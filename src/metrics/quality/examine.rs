//! A recorded log examined: its outliers, and what it measures without them.

use super::outliers::{OUTLIERS, Outliers, find_outliers};
use super::smoothing::{SMOOTHING_TIME, Smoothed, find_smoothing};
use crate::metrics::estimate::outlier_sheet::OutlierEntry;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::measure::measure_present;
use crate::metrics::noise::memory::record_fit_tau_min_s;
use crate::metrics::record::{Motion, Record, SAMPLES_MIN, Settings};
use crate::metrics::sine::fit::{SwingClock, fit_swing};

/// Why nothing is examined.
const TOO_SHORT: &str = "the record is too short for it";

/// What the words of a log show of themselves: outliers, and an averaging.
#[derive(Clone, Debug)]
pub struct Examination {
    outliers: Result<Outliers, Unavailable>,
    smoothed: Result<Smoothed, Unavailable>,
}

impl Examination {
    /// Examines the words of a record; of a swing the residuals about the fitted sine. A record that is too
    /// short shows nothing.
    #[must_use]
    pub fn of(record: &Record, settings: &Settings) -> Self {
        let words = record.channel_deg_per_h;
        if words.len() < SAMPLES_MIN {
            return Self {
                outliers: Err(TOO_SHORT.into()),
                smoothed: Err(TOO_SHORT.into()),
            };
        }
        let residuals = about_motion(record, &settings.motion);
        let mut still = residuals.unwrap_or_else(|| words.to_vec());
        let outliers = find_present(&still);
        if let Ok(outliers) = &outliers {
            outliers.leave_out(&mut still);
        }
        Self {
            outliers,
            smoothed: find_smoothing(&still, record.sample_period_s),
        }
    }

    /// Enters what was found into the metrics of the same words, and gives what they measure without the
    /// outliers; nothing where there are none.
    ///
    /// * `first_index`: index in the log of the first word of the record.
    /// * `is_fit_tau_min_given`: whether the shortest averaging time of the fit stands, or follows the words.
    ///
    /// Without outliers means sums leave out what is missing: an Allan variance every difference that touches
    /// it, nothing is put in its place.
    pub fn enter(
        self,
        record: &Record,
        settings: &Settings,
        is_fit_tau_min_given: bool,
        first_index: usize,
        metrics: &mut ChannelMetrics,
    ) -> Option<ChannelMetrics> {
        if metrics.error.is_some() {
            for key in [&OUTLIERS, &SMOOTHING_TIME] {
                metrics.miss(key, TOO_SHORT);
            }
            return None;
        }
        put_smoothing(self.smoothed, metrics);
        let outliers = match self.outliers {
            Ok(outliers) => outliers,
            Err(reason) => {
                metrics.miss(&OUTLIERS, reason);
                return None;
            }
        };
        let place = (first_index, record.first_stamp_s, record.sample_period_s);
        put_outliers(&outliers, place, metrics);
        (!outliers.events.is_empty())
            .then(|| without(&outliers, record, settings, is_fit_tau_min_given))
    }
}

/// What a record measures without its outliers.
fn without(
    outliers: &Outliers,
    record: &Record,
    settings: &Settings,
    is_fit_tau_min_given: bool,
) -> ChannelMetrics {
    let mut rest = record.channel_deg_per_h.to_vec();
    outliers.leave_out(&mut rest);
    let fit_tau_min_s = if is_fit_tau_min_given {
        settings.fit_tau_min_s
    } else {
        record_fit_tau_min_s(&rest, record.sample_period_s)
    };
    let settings = Settings {
        fit_tau_min_s,
        ..settings.clone()
    };
    let rest_record = Record {
        channel_deg_per_h: &rest,
        raw_deg_per_h: &rest,
        ..*record
    };
    measure_present(&rest_record, &settings)
}

/// The outliers of a record of which words may be missing: those on either side of a gap are neighbours.
fn find_present(words: &[f64]) -> Result<Outliers, Unavailable> {
    if words.iter().all(|word| !word.is_nan()) {
        return find_outliers(words);
    }
    let present = words.iter().enumerate().filter(|(_, word)| !word.is_nan());
    let (places, present): (Vec<usize>, Vec<f64>) = present.unzip();
    find_outliers(&present).map(|found| found.moved_to(&places))
}

/// The words about a motion that is known; nothing where they stand for themselves.
fn about_motion(record: &Record, motion: &Motion) -> Option<Vec<f64>> {
    let (Motion::Swing { frequency_hz } | Motion::SwingFromRest { frequency_hz }) = motion else {
        return None;
    };
    let clock = SwingClock {
        frequency_hz: *frequency_hz,
        sample_period_s: record.sample_period_s,
        first_stamp_s: record.first_stamp_s,
    };
    let words = record.channel_deg_per_h;
    let fit = fit_swing(words, &clock).ok()?;
    Some(fit.residuals(words))
}

/// Enters the averaging time of a log that was smoothed.
fn put_smoothing(smoothed: Result<Smoothed, Unavailable>, metrics: &mut ChannelMetrics) {
    match smoothed {
        Ok(found) => {
            metrics.put(&SMOOTHING_TIME, found.averaging_time_s);
            metrics.smoothing = Some(found.like.words());
        }
        Err(reason) => metrics.miss(&SMOOTHING_TIME, reason),
    }
}

/// Enters the outliers and their list.
///
/// * `place`: index in the log of the first word of the record, its stamp, and the sample period, s.
pub(crate) fn put_outliers(
    outliers: &Outliers,
    (first_index, first_stamp_s, sample_period_s): (usize, f64, f64),
    metrics: &mut ChannelMetrics,
) {
    let count = outliers.events.len() as f64;
    let metric = metrics.put(&OUTLIERS, Estimate::exact(count));
    for (field, value) in [
        ("words", outliers.words() as f64),
        ("threshold_deg_per_h", outliers.threshold_deg_per_h),
        ("threshold_deviations", outliers.threshold_deviations),
    ] {
        metric.fields.insert(field, value);
    }
    let entries = outliers.events.iter().map(|event| OutlierEntry {
        index: first_index + event.first,
        time_s: first_stamp_s + event.first as f64 * sample_period_s,
        words: event.words,
        size_deg_per_h: event.size_deg_per_h,
        size_deviations: event.size_deviations,
    });
    metrics.outliers = entries.collect();
}
