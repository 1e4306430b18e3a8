//! A number with its interval.

use std::collections::BTreeMap;

/// Confidence of every interval unless a record says otherwise.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// What the ends of an estimate are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum IntervalKind {
    /// Ends of a confidence interval for the ensemble value: the mean over seeds of records of this
    /// length and warm-up, same scenario. Of a log: for the mean over records of the process that
    /// made it.
    Confidence,
    /// The value itself, which no noise of the gyro moves, or which is a fact of this record.
    Exact,
    /// The value itself, for want of an interval, and why a single record gives none.
    Absent(&'static str),
}

/// A value with the interval that covers its ensemble value with probability `confidence`.
///
/// The ensemble value is the mean over seeds of records of this length and warm-up in the same
/// scenario. Where `interval` says so there is none: `low = high = value`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Two-sided coverage of `[low, high]`.
    pub confidence: f64,
    /// What the ends are.
    pub interval: IntervalKind,
}

impl Estimate {
    /// A value without uncertainty.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
            confidence: CONFIDENCE,
            interval: IntervalKind::Exact,
        }
    }

    /// A value of unknown uncertainty, and why it is unknown.
    #[must_use]
    pub fn without_interval(value: f64, reason: &'static str) -> Self {
        Self {
            interval: IntervalKind::Absent(reason),
            ..Self::exact(value)
        }
    }

    /// A value with a symmetric 95 % interval of the given half width.
    #[must_use]
    pub fn symmetric(value: f64, half_width: f64) -> Self {
        Self::with_interval(value, value - half_width, value + half_width)
    }

    /// A value with a 95 % interval.
    #[must_use]
    pub fn with_interval(value: f64, low: f64, high: f64) -> Self {
        Self {
            value,
            low,
            high,
            confidence: CONFIDENCE,
            interval: IntervalKind::Confidence,
        }
    }

    /// Whether `[low, high]` is an interval.
    #[must_use]
    pub fn has_interval(&self) -> bool {
        self.interval == IntervalKind::Confidence
    }

    /// The estimate with everything moved by `shift`.
    #[must_use]
    pub fn shifted(self, shift: f64) -> Self {
        Self {
            value: self.value + shift,
            low: self.low + shift,
            high: self.high + shift,
            ..self
        }
    }

    /// The estimate with an independent half width added to both sides in quadrature.
    #[must_use]
    pub(crate) fn widened(self, half_width: f64) -> Self {
        Self {
            low: self.value - (self.value - self.low).hypot(half_width),
            high: self.value + (self.high - self.value).hypot(half_width),
            ..self
        }
    }

    /// The estimate with both ends cut to `[least, most]`; the value lies between.
    #[must_use]
    pub(crate) fn clamped(self, least: f64, most: f64) -> Self {
        Self {
            low: self.low.max(least).min(self.value),
            high: self.high.min(most).max(self.value),
            ..self
        }
    }

    /// The estimate in another unit: everything times `factor` (`factor` > 0).
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            low: self.low * factor,
            high: self.high * factor,
            ..self
        }
    }
}

/// One metric of a channel: the estimate, its unit and the fields that define it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
