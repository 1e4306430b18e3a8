//! A number with its interval.

use std::collections::BTreeMap;

/// Confidence of every interval unless a record says otherwise.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// A value with the interval that covers the truth with probability `confidence`.
///
/// Where no interval can be given, `low = high = value`.
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
