//! Curves as CSV: one header line, one row per channel and point, words behind the numbers.

use crate::metrics::ChannelMetrics;
use crate::report::RunReport;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Names the Allan curve goes by among a channel's curves, the usual one first.
const ALLAN_CURVES: [&str; 2] = ["allan", "allan_deviation"];
/// Names the spectrum goes by.
const PSD_CURVES: [&str; 2] = ["psd", "spectrum"];

/// A curve: columns by name.
pub(crate) type Curve = BTreeMap<String, Vec<f64>>;

/// The Allan deviation of a channel.
pub(crate) fn allan_curve(metrics: &ChannelMetrics) -> Option<&Curve> {
    ALLAN_CURVES
        .iter()
        .find_map(|name| metrics.curves.get(*name))
}

/// The spectrum of a channel.
pub(crate) fn psd_curve(metrics: &ChannelMetrics) -> Option<&Curve> {
    PSD_CURVES.iter().find_map(|name| metrics.curves.get(*name))
}

/// The independent variable of a curve.
pub(crate) fn abscissa(curve: &Curve) -> Option<&[f64]> {
    column(curve, is_abscissa)
}

/// The dependent variable: the first column with the unit of a rate or of its density that is no
/// end of an interval.
pub(crate) fn ordinate(curve: &Curve) -> Option<&[f64]> {
    column(curve, |name| {
        is_rate(name) && !is_end(name, "low") && !is_end(name, "high")
    })
}

/// The fitted curve over the same points, where a fit was possible.
pub(crate) fn fitted(curve: &Curve) -> Option<&[f64]> {
    column(curve, |name| name.starts_with("fitted"))
}

/// The named end (`low` or `high`) of the dependent variable's interval.
pub(crate) fn interval_end<'a>(curve: &'a Curve, end: &str) -> Option<&'a [f64]> {
    column(curve, |name| is_rate(name) && is_end(name, end))
}

fn column(curve: &Curve, wanted: impl Fn(&str) -> bool) -> Option<&[f64]> {
    let (_, values) = curve.iter().find(|(name, _)| wanted(name))?;
    Some(values)
}

fn is_rate(column: &str) -> bool {
    column.contains("per_h") || column.contains("per_hz")
}

fn is_end(column: &str, end: &str) -> bool {
    column.split('_').any(|word| word == end)
}

/// The autocovariance of a channel's noise.
pub(crate) fn autocovariance_curve(metrics: &ChannelMetrics) -> Option<&Curve> {
    metrics.curves.get("autocovariance")
}

/// Columns of words of a curve.
type Labels = BTreeMap<String, Vec<&'static str>>;

/// The word of a column at a row: one word alone holds for all rows.
fn word(labels: &Labels, column: &str, row: usize) -> &'static str {
    match labels.get(column).map(Vec::as_slice) {
        Some([one]) => one,
        Some(words) => words.get(row).copied().unwrap_or_default(),
        None => "",
    }
}

/// The estimator of an Allan curve, as a scenario names it.
pub(crate) fn allan_estimator(metrics: &ChannelMetrics) -> Option<&'static str> {
    let labels = ALLAN_CURVES
        .iter()
        .find_map(|name| metrics.curve_labels.get(*name))?;
    labels.get("estimator")?.first().copied()
}

/// The Allan deviation of every channel, or nothing if no channel has one.
#[must_use]
pub fn allan_csv(report: &RunReport) -> Option<String> {
    curve_csv(report.channels, ALLAN_CURVES[0], allan_curve)
}

/// The one-sided power spectral density of every channel, or nothing if no channel has one.
#[must_use]
pub fn psd_csv(report: &RunReport) -> Option<String> {
    curve_csv(report.channels, PSD_CURVES[0], psd_curve)
}

/// The autocovariance of every channel's noise, or nothing if no channel has one.
#[must_use]
pub fn autocovariance_csv(report: &RunReport) -> Option<String> {
    curve_csv(report.channels, "autocovariance", autocovariance_curve)
}

/// Columns of an independent variable: they stand first.
fn is_abscissa(column: &str) -> bool {
    ["averaging_time_s", "tau_s", "frequency_hz", "lag_s"].contains(&column)
}

/// One curve of every channel that has it, or nothing if none has.
pub(crate) fn curve_csv(
    channels: &[(String, ChannelMetrics)],
    curve_name: &str,
    curve: fn(&ChannelMetrics) -> Option<&Curve>,
) -> Option<String> {
    let curves = || {
        channels.iter().filter_map(|(name, metrics)| {
            let labels = metrics.curve_labels.get(curve_name);
            Some((name, curve(metrics)?, labels))
        })
    };
    let columns: BTreeSet<(bool, &str)> = curves()
        .flat_map(|(_, columns, _)| columns.keys())
        .map(|column| (!is_abscissa(column), column.as_str()))
        .collect();
    if columns.is_empty() {
        return None;
    }
    let words: BTreeSet<&str> = curves()
        .filter_map(|(.., labels)| labels)
        .flat_map(|labels| labels.keys().map(String::as_str))
        .collect();
    let mut text = String::from("channel");
    let names = columns.iter().map(|(_, column)| column).chain(&words);
    for column in names {
        text.push(',');
        text.push_str(column);
    }
    text.push('\n');
    for (name, table, labels) in curves() {
        let rows = table.values().map(Vec::len).max().unwrap_or(0);
        for row in 0..rows {
            text.push_str(name);
            for (_, column) in &columns {
                text.push(',');
                if let Some(value) = table.get(*column).and_then(|values| values.get(row)) {
                    // Writing to a String cannot fail.
                    let _ = write!(text, "{value:?}");
                }
            }
            for column in &words {
                text.push(',');
                text.push_str(labels.map_or("", |labels| word(labels, column, row)));
            }
            text.push('\n');
        }
    }
    Some(text)
}
