//! The table of one channel: its metrics, its curves, and the reasons for what is missing.

use std::collections::BTreeMap;

use super::fit_sheet::FitSheet;
use super::outlier_sheet::OutlierEntry;
use super::reason::Unavailable;
use super::repeat_statistics::RepeatStatistics;
use super::value::{Estimate, Metric};
use crate::metrics::key::curve::{Column, Curve, CurveKey};
use crate::metrics::key::metric::MetricKey;
use crate::units::s_to_ms;

/// Field of a bias stability: correlation of its means with those of raw.
pub(crate) const RAW_CORRELATION: &str = "raw_correlation";
/// Field of a delay: the same in samples.
const DELAY_SAMPLES: &str = "delay_samples";
/// Field of every metric whose interval is a chi-square one.
pub(crate) const DEGREES_OF_FREEDOM: &str = "degrees_of_freedom";

/// Field of a bias stability: what the fitted noise makes one expect.
pub(crate) const EXPECTED: &str = "expected_deg_per_h";

/// Reason of a metric or curve that came out as no finite number.
const NOT_FINITE: &str = "the record gives no finite number";
/// Width of an interval, as a part of its value, that rounding makes.
const ROUNDING: f64 = 1e-12;

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
#[non_exhaustive]
pub struct ChannelMetrics {
    /// Metrics by key (`angle_random_walk_deg_per_sqrt_h`, ...).
    pub metrics: BTreeMap<String, Metric>,
    /// Metrics the record cannot support, with the reason.
    pub unavailable: BTreeMap<String, Unavailable>,
    /// Curves: name, then column name and values.
    pub curves: BTreeMap<String, Curve>,
    /// Metrics over the repeats by key; empty for a single record.
    pub repeats: BTreeMap<String, RepeatStatistics>,
    /// Columns of words of a curve, by curve and column; a single word holds for all its points.
    pub curve_labels: BTreeMap<String, BTreeMap<String, Vec<&'static str>>>,
    /// Fit of the noise terms and how well they describe the Allan variance; none without a fit.
    pub noise_fit: Option<FitSheet>,
    /// How noise terms were found where the words of the gyro count pulses, by metric; else empty.
    pub pulse_words: BTreeMap<String, String>,
    /// Outliers in the order of time; looked for in the words of logs.
    pub outliers: Vec<OutlierEntry>,
    /// What the smoothing of a log looks like, in words; none where none shows.
    pub smoothing: Option<String>,
    /// Set when the channel failed; its metrics are then empty but for `diverged_at_s`.
    pub error: Option<ChannelFailure>,
}

impl Metric {
    /// Degrees of freedom, for a standard deviation.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> Option<f64> {
        self.fields.get(DEGREES_OF_FREEDOM).copied()
    }
}

impl ChannelMetrics {
    /// Enters a metric under its catalogue unit, and returns it for its defining fields.
    pub(crate) fn put(&mut self, key: &MetricKey, estimate: Estimate) -> &mut Metric {
        self.unavailable.remove(key.name);
        self.metrics.remove(key.name);
        self.metrics
            .entry(key.name.to_owned())
            .or_insert_with(|| Metric::new(estimate, key.unit))
    }

    /// Enters a delay of a metric in ms, and beside it the same in samples.
    pub(crate) fn put_delay(
        &mut self,
        key: &MetricKey,
        delay_s: Estimate,
        sample_period_s: f64,
    ) -> &mut Metric {
        let metric = self.put(key, delay_s.scaled(s_to_ms(1.0)));
        let delay_samples = delay_s.value / sample_period_s;
        metric.fields.insert(DELAY_SAMPLES, delay_samples);
        metric
    }

    /// Enters a curve, in place of an earlier one.
    pub(crate) fn put_curve(
        &mut self,
        key: &CurveKey,
        columns: impl IntoIterator<Item = (&'static Column, Vec<f64>)>,
    ) {
        let columns = columns.into_iter().map(|(column, values)| {
            debug_assert!(
                key.has(column),
                "{} has no column {}",
                key.name,
                column.name
            );
            (column.name.to_owned(), values)
        });
        self.curves.insert(key.name.to_owned(), columns.collect());
    }

    /// Enters the columns of words of a curve.
    pub(crate) fn put_words(
        &mut self,
        key: &CurveKey,
        columns: impl IntoIterator<Item = (&'static Column, Vec<&'static str>)>,
    ) {
        let columns = columns.into_iter().map(|(column, words)| {
            debug_assert!(
                key.has(column),
                "{} has no column {}",
                key.name,
                column.name
            );
            (column.name.to_owned(), words)
        });
        let columns = columns.collect();
        self.curve_labels.insert(key.name.to_owned(), columns);
    }

    /// A curve of the channel; none if the record does not support it.
    #[must_use]
    pub fn curve(&self, key: &CurveKey) -> Option<&Curve> {
        self.curves.get(key.name)
    }

    /// Words of a column of a curve, empty where there are none.
    #[must_use]
    pub fn words(&self, key: &CurveKey, column: &Column) -> &[&'static str] {
        let labels = self.curve_labels.get(key.name);
        let words = labels.and_then(|labels| labels.get(column.name));
        words.map_or(&[], Vec::as_slice)
    }

    /// Says why a metric is missing.
    pub(crate) fn miss(&mut self, key: &MetricKey, reason: impl Into<Unavailable>) {
        self.unavailable.insert(key.name.to_owned(), reason.into());
    }

    /// Takes a metric out and says why, if it is there.
    pub(crate) fn withdraw(&mut self, key: &MetricKey, reason: impl Into<Unavailable>) {
        if self.metrics.remove(key.name).is_some() {
            self.miss(key, reason);
        }
    }

    /// A metric of the channel; none if the record does not support it.
    #[must_use]
    pub fn get(&self, key: &MetricKey) -> Option<&Metric> {
        self.metrics.get(key.name)
    }

    pub(crate) fn get_mut(&mut self, key: &MetricKey) -> Option<&mut Metric> {
        self.metrics.get_mut(key.name)
    }

    /// Why a metric is missing; none if it is there.
    #[must_use]
    pub fn why_unavailable(&self, key: &MetricKey) -> Option<&str> {
        self.unavailable.get(key.name).map(Unavailable::as_str)
    }

    /// Leaves only finite numbers in the table: the one gate between measuring and reporting.
    ///
    /// A metric whose value or interval came out as no number (a ratio to nothing, a sum beyond
    /// binary64) becomes unavailable with the reason, a curve with such a point is left out whole and
    /// stands among the unavailable ones as `curves.<name>`. A defining field that is no number says
    /// nothing and is dropped from its metric, as are statistics over repeats.
    pub fn keep_finite(&mut self) {
        let is_finite = |estimate: &Estimate| {
            let Estimate {
                value,
                low,
                high,
                confidence,
                ..
            } = *estimate;
            [value, low, high, confidence]
                .iter()
                .all(|it| it.is_finite())
        };
        let mut lost: Vec<(String, Unavailable)> = Vec::new();
        self.metrics.retain(|name, metric| {
            metric.fields.retain(|_, value| value.is_finite());
            let is_kept = is_finite(&metric.estimate);
            if !is_kept {
                lost.push((name.clone(), NOT_FINITE.into()));
            }
            is_kept
        });
        self.curves.retain(|name, columns| {
            let mut columns = columns.iter();
            let broken = columns.find(|(_, values)| !values.iter().all(|it| it.is_finite()));
            if let Some((column, _)) = broken {
                let reason = format!("{NOT_FINITE} for a point of {column}");
                lost.push((format!("curves.{name}"), reason.into()));
            }
            broken.is_none()
        });
        let curves = &self.curves;
        self.curve_labels
            .retain(|name, _| curves.contains_key(name));
        self.repeats.retain(|_, of| {
            let own = [of.mean, of.standard_deviation, of.minimum, of.maximum];
            own.iter().chain(&of.values).all(|it| it.is_finite())
        });
        self.unavailable.extend(lost);
    }

    /// Gives metrics without width the field `exact_to_word`: words that never change determine their
    /// mean exactly, and leave open where within its rounding the rate lies.
    pub(crate) fn mark_exact(&mut self, keys: &[&MetricKey]) {
        for key in keys {
            if let Some(metric) = self.get_mut(key)
                && metric.estimate.high - metric.estimate.low
                    <= ROUNDING * metric.estimate.value.abs()
            {
                metric.fields.insert("exact_to_word", 1.0);
            }
        }
    }
}
