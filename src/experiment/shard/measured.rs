//! What one repeat of a run measured, as bytes and back.

use super::codec::{Coded, coded};
use crate::experiment::run::{Faults, Repeat};
use crate::gyro::LoopFaults;
use crate::metrics::{
    ChannelFailure, ChannelMetrics, Estimate, FitSheet, FitTerm, IntervalKind, Metric,
    OutlierEntry, RepeatStatistics, Unavailable,
};

coded! {
    Repeat { faults, channels }
    Faults { saturated, unlocked, limits }
    LoopFaults { saturated_steps, wrong_fringe_words, fringe_error_deg_per_s }
    ChannelMetrics {
        metrics, unavailable, curves, repeats, curve_labels, noise_fit, pulse_words, outliers, smoothing,
        error,
    }
    ChannelFailure { kind, sample, message }
    Metric { estimate, unit, fields }
    Estimate { value, low, high, confidence, interval }
    RepeatStatistics {
        unit, averaging_time_s, values, lacking, mean, standard_deviation, minimum, maximum,
    }
    FitSheet { is_adequate, numbers, missed_tau_s, terms }
    FitTerm { square, standard_error, unit, is_in_model }
    OutlierEntry { index, time_s, words, size_deg_per_h, size_deviations }
}

impl Coded for Unavailable {
    fn put(&self, out: &mut Vec<u8>) {
        self.as_str().to_owned().put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        String::take(from).map(Self::from)
    }
}

impl Coded for IntervalKind {
    fn put(&self, out: &mut Vec<u8>) {
        match self {
            Self::Confidence => 0_u8.put(out),
            Self::Exact => 1_u8.put(out),
            Self::Absent(reason) => {
                2_u8.put(out);
                reason.put(out);
            }
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match u8::take(from)? {
            0 => Some(Self::Confidence),
            1 => Some(Self::Exact),
            2 => Coded::take(from).map(Self::Absent),
            _ => None,
        }
    }
}
