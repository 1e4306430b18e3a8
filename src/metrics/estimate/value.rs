//! A number with its interval, and the table of such numbers for one channel.

use std::collections::BTreeMap;

use super::repeat_statistics::RepeatStatistics;

/// Confidence of every interval unless a record says otherwise.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// A value with the interval that covers the truth with probability `confidence`.
///
/// Where no interval can be given, `low = high = value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Two-sided coverage of `[low, high]`.
    pub confidence: f64,
}

impl Estimate {
    /// A value without uncertainty (exact, or of unknown uncertainty).
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
            confidence: CONFIDENCE,
        }
    }

    /// A value with a symmetric 95 % interval of the given half width.
    #[must_use]
    pub fn symmetric(value: f64, half_width: f64) -> Self {
        Self {
            value,
            low: value - half_width,
            high: value + half_width,
            confidence: CONFIDENCE,
        }
    }

    /// A value with a 95 % interval.
    #[must_use]
    pub fn with_interval(value: f64, low: f64, high: f64) -> Self {
        Self {
            value,
            low,
            high,
            confidence: CONFIDENCE,
        }
    }

    /// The estimate in another unit: everything times `factor` (`factor` > 0).
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            low: self.low * factor,
            high: self.high * factor,
            confidence: self.confidence,
        }
    }
}

/// One metric of a channel: the estimate, its unit and the fields that define it.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// Value and interval.
    pub estimate: Estimate,
    /// Unit as printed, e.g. `deg/sqrt(h)`; `1` for a ratio.
    pub unit: &'static str,
    /// Defining fields, e.g. `averaging_time_s`, `frequency_hz`, `count`; printed beside the value.
    pub fields: BTreeMap<&'static str, f64>,
}

impl Metric {
    /// A metric without defining fields.
    #[must_use]
    pub fn new(estimate: Estimate, unit: &'static str) -> Self {
        Self {
            estimate,
            unit,
            fields: BTreeMap::new(),
        }
    }

    /// The metric with one more defining field.
    #[must_use]
    pub fn with(mut self, field: &'static str, value: f64) -> Self {
        self.fields.insert(field, value);
        self
    }
}

/// Why a channel has no numbers: it failed while running.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelFailure {
    /// Kind, e.g. `diverged`.
    pub kind: String,
    /// Index of the sample (warm-up included) at which it failed.
    pub sample: u64,
    /// What happened, for people.
    pub message: String,
}

/// Everything measured on one channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChannelMetrics {
    /// Metrics by key (`angle_random_walk_deg_per_sqrt_h`, ...).
    pub metrics: BTreeMap<String, Metric>,
    /// Metrics the record cannot support, with the reason.
    pub unavailable: BTreeMap<String, String>,
    /// Curves: name, then column name and values.
    pub curves: BTreeMap<String, BTreeMap<String, Vec<f64>>>,
    /// The main metrics over the repeats by key; empty for a single record.
    pub repeats: BTreeMap<String, RepeatStatistics>,
    /// Columns of words of a curve, by curve and column; a single word holds for all its points.
    pub curve_labels: BTreeMap<String, BTreeMap<String, Vec<&'static str>>>,
    /// Set when the channel failed; its metrics are then empty but for `diverged_at_s`.
    pub error: Option<ChannelFailure>,
}
