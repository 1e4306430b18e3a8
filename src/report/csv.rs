//! Curves as CSV: one header line, one row per channel and point.

use crate::report::RunReport;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Name of the Allan curve among a channel's curves.
pub(crate) const ALLAN_CURVE: &str = "allan";
/// Name of the spectrum among a channel's curves.
pub(crate) const PSD_CURVE: &str = "psd";

/// The Allan deviation of every channel, or nothing if no channel has one.
#[must_use]
pub fn allan_csv(report: &RunReport) -> Option<String> {
    curve_csv(report, ALLAN_CURVE)
}

/// The one-sided power spectral density of every channel, or nothing if no channel has one.
#[must_use]
pub fn psd_csv(report: &RunReport) -> Option<String> {
    curve_csv(report, PSD_CURVE)
}

/// Columns of an independent variable: they stand first.
fn is_abscissa(column: &str) -> bool {
    column == "averaging_time_s" || column == "tau_s" || column == "frequency_hz"
}

fn curve_csv(report: &RunReport, curve: &str) -> Option<String> {
    let curves = || {
        report
            .channels
            .iter()
            .filter_map(|(name, metrics)| Some((name, metrics.curves.get(curve)?)))
    };
    let columns: BTreeSet<(bool, &str)> = curves()
        .flat_map(|(_, columns)| columns.keys())
        .map(|column| (!is_abscissa(column), column.as_str()))
        .collect();
    if columns.is_empty() {
        return None;
    }
    let mut text = String::from("channel");
    for (_, column) in &columns {
        text.push(',');
        text.push_str(column);
    }
    text.push('\n');
    for (name, table) in curves() {
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
            text.push('\n');
        }
    }
    Some(text)
}
