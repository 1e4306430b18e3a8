//! Repeats taken in one after the other: of each only what pooling needs is kept, so that many of them fit in
//! memory.

use std::collections::BTreeMap;

use crate::metrics::allan::curves::DEVIATION;
use crate::metrics::allan::entry::FIT_METRICS;
use crate::metrics::allan::extra_terms::found_sine;
use crate::metrics::allan::noise_fit::{FitRange, Sine};
use crate::metrics::catalogue::known_curves;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::{
    ChannelMetrics, DEGREES_OF_FREEDOM, EXPECTED, RAW_CORRELATION,
};
use crate::metrics::estimate::value::Metric;
use crate::metrics::key::curve::{Column, CurveKey, CurvePool};
use crate::metrics::key::metric::MetricKey;

/// From this many repeats on, Student's t on their scatter gives the interval; below, the intervals
/// of the repeats themselves say more.
pub(super) const SCATTER_REPEATS_MIN: usize = 6;

/// What the sum of no numbers is: sums that grow repeat by repeat have the bits of those over all at once.
const NO_SUM: f64 = -0.0;

/// Independent repeats of the same channel, taken in in their order.
#[derive(Clone, Debug, Default)]
pub struct Pooling {
    pub(super) count: usize,
    pub(super) first: Option<ChannelMetrics>,
    /// The first that failed; what comes behind it no longer counts.
    pub(super) failed: Option<ChannelMetrics>,
    pub(super) metrics: BTreeMap<String, MetricValues>,
    /// The first reason for each metric that a repeat lacks.
    pub(super) unavailable: BTreeMap<String, Unavailable>,
    /// Sums of the columns of curves, by curve and column; none of one that a repeat lacks or has in another
    /// length.
    sums: BTreeMap<(&'static str, &'static str), Option<Vec<f64>>>,
    pub(super) fits: Fits,
}

/// One metric over the repeats that have it.
#[derive(Clone, Debug)]
pub(super) struct MetricValues {
    pub(super) first: Metric,
    pub(super) values: Vec<f64>,
    /// Indices of the repeats that lack it, up to the last that has it.
    lacking: Vec<usize>,
    /// Half widths of the intervals of the first repeats, as far as they count.
    pub(super) half_widths: Vec<f64>,
    /// Sum of the degrees of freedom, if each repeat has them.
    pub(super) freedom: Option<f64>,
    /// Sum of the squares of what is expected, if each repeat expects something.
    pub(super) expected_square: Option<f64>,
    /// Sum of the correlations with raw, if each repeat has one.
    pub(super) raw_correlation: Option<f64>,
}

impl MetricValues {
    fn new(first: Metric) -> Self {
        Self {
            first,
            values: Vec::new(),
            lacking: Vec::new(),
            half_widths: Vec::new(),
            freedom: Some(NO_SUM),
            expected_square: Some(NO_SUM),
            raw_correlation: Some(NO_SUM),
        }
    }

    fn add(&mut self, repeat: usize, metric: &Metric) {
        self.lack_until(repeat);
        let estimate = metric.estimate;
        self.values.push(estimate.value);
        if self.half_widths.len() < SCATTER_REPEATS_MIN {
            self.half_widths.push((estimate.high - estimate.low) / 2.0);
        }
        let field = |name| metric.fields.get(name).copied();
        let plus = |sum: Option<f64>, more: Option<f64>| Some(sum? + more?);
        self.freedom = plus(self.freedom, field(DEGREES_OF_FREEDOM));
        let expected = field(EXPECTED).map(|value| value * value);
        self.expected_square = plus(self.expected_square, expected);
        self.raw_correlation = plus(self.raw_correlation, field(RAW_CORRELATION));
    }

    /// Notes that the repeats up to one lack it that have not been heard of.
    fn lack_until(&mut self, repeat: usize) {
        let heard = self.values.len() + self.lacking.len();
        self.lacking.extend(heard..repeat);
    }

    /// Indices of the repeats of `count` that lack it.
    pub(super) fn lacking(&mut self, count: usize) -> Vec<usize> {
        self.lack_until(count);
        std::mem::take(&mut self.lacking)
    }
}

/// What the fits of the repeats say.
#[derive(Clone, Debug, Default)]
pub(super) struct Fits {
    /// Range of the first that has one.
    pub(super) range: Option<FitRange>,
    /// The sine of each repeat that has one.
    pub(super) sines: Vec<Sine>,
    /// Squares of the terms by metric, of the repeats that have both.
    pub(super) squares: BTreeMap<&'static str, Vec<f64>>,
    /// The first words on each metric of a gyro whose words count pulses.
    pub(super) pulse_words: BTreeMap<String, String>,
}

impl Fits {
    fn add(&mut self, repeat: &ChannelMetrics) {
        self.sines.extend(found_sine(repeat));
        for (key, words) in &repeat.pulse_words {
            let entry = self.pulse_words.entry(key.clone());
            entry.or_insert_with(|| words.clone());
        }
        let Some(sheet) = &repeat.noise_fit else {
            return;
        };
        if self.range.is_none() {
            let ends = sheet.number("tau_min_s").zip(sheet.number("tau_max_s"));
            self.range = ends.map(|(tau_min_s, tau_max_s)| FitRange {
                tau_min_s,
                tau_max_s,
            });
        }
        for key in FIT_METRICS {
            let term = sheet.terms.get(key.name);
            if let Some(term) = term.filter(|_| repeat.get(key).is_some()) {
                self.squares.entry(key.name).or_default().push(term.square);
            }
        }
    }
}

impl Pooling {
    /// Takes in the next repeat.
    pub fn add(&mut self, repeat: &ChannelMetrics) {
        if self.failed.is_some() {
            return;
        }
        if repeat.error.is_some() {
            self.failed = Some(repeat.clone());
            return;
        }
        for (name, metric) in &repeat.metrics {
            if !self.metrics.contains_key(name) {
                let values = MetricValues::new(metric.clone());
                self.metrics.insert(name.clone(), values);
            }
            if let Some(values) = self.metrics.get_mut(name) {
                values.add(self.count, metric);
            }
        }
        for (name, reason) in &repeat.unavailable {
            if !self.unavailable.contains_key(name) {
                self.unavailable.insert(name.clone(), reason.clone());
            }
        }
        self.add_curves(repeat);
        self.fits.add(repeat);
        self.count += 1;
        self.first.get_or_insert_with(|| repeat.clone());
    }

    fn add_curves(&mut self, repeat: &ChannelMetrics) {
        for key in known_curves() {
            let curve = repeat.curve(key);
            for column in key.columns {
                let own = curve.and_then(|curve| column.get(curve));
                let at = (key.name, column.name);
                if self.first.is_none() {
                    let none = own.map(|own| vec![NO_SUM; own.len()]);
                    self.sums.insert(at, none);
                }
                let Some(known) = self.sums.get_mut(&at) else {
                    continue;
                };
                match (known.as_mut(), own) {
                    (Some(sums), Some(own)) if sums.len() == own.len() => {
                        let is_square =
                            key.pool == CurvePool::AllanVariance && *column == &DEVIATION;
                        for (sum, value) in sums.iter_mut().zip(own) {
                            *sum += if is_square { value * value } else { *value };
                        }
                    }
                    _ => *known = None,
                }
            }
        }
    }

    /// Mean of a column of a curve over the repeats, point by point, of Allan deviations that of their squares;
    /// none unless all have it in the same length.
    pub(super) fn mean_of(&self, curve: &CurveKey, column: &Column) -> Option<Vec<f64>> {
        let sums = self.sums.get(&(curve.name, column.name))?.as_ref()?;
        let count = self.count as f64;
        Some(sums.iter().map(|sum| sum / count).collect())
    }

    /// A column of a curve in the first repeat; none unless all have it in the same length.
    pub(super) fn first_of(&self, curve: &CurveKey, column: &Column) -> Option<&[f64]> {
        self.sums.get(&(curve.name, column.name))?.as_ref()?;
        column.get(self.first.as_ref()?.curve(curve)?)
    }

    /// Values of a metric that every repeat has.
    pub(super) fn values_of_all(&self, key: &MetricKey) -> Option<&[f64]> {
        let values = &self.metrics.get(key.name)?.values;
        (values.len() == self.count).then_some(values)
    }
}
