//! Curves as CSV: one header line, one row per channel and point, words behind the numbers.

use std::fmt::Write as _;

use crate::metrics::{ChannelMetrics, Column, Curve, CurveKey};

/// One curve of every channel that has it, or nothing if none has.
///
/// The column that the others go with stands first, the others by their names, words last.
#[must_use]
pub fn curve_csv(key: &CurveKey, channels: &[(String, ChannelMetrics)]) -> Option<String> {
    let curves: Vec<(&str, &ChannelMetrics, &Curve)> = channels
        .iter()
        .filter_map(|(name, metrics)| Some((name.as_str(), metrics, metrics.curve(key)?)))
        .collect();
    let mut columns = present(key.columns, |column| {
        curves.iter().any(|(.., curve)| column.get(curve).is_some())
    });
    let first = key.columns.first();
    columns.sort_by_key(|column| (Some(column) != first, column.name));
    if columns.is_empty() {
        return None;
    }
    let mut words = present(key.words, |column| {
        let mut channels = curves.iter();
        channels.any(|(_, metrics, _)| !metrics.words(key, column).is_empty())
    });
    words.sort_by_key(|column| column.name);
    let mut text = String::from("channel");
    for column in columns.iter().chain(&words) {
        text.push(',');
        text.push_str(column.name);
    }
    text.push('\n');
    for (name, metrics, curve) in &curves {
        let rows = curve.values().map(Vec::len).max().unwrap_or(0);
        for row in 0..rows {
            text.push_str(name);
            for column in &columns {
                text.push(',');
                if let Some(value) = column.of(curve).get(row) {
                    // Writing to a String cannot fail.
                    let _ = write!(text, "{value:?}");
                }
            }
            for column in &words {
                text.push(',');
                text.push_str(word(metrics.words(key, column), row));
            }
            text.push('\n');
        }
    }
    Some(text)
}

fn present(
    columns: &[&'static Column],
    is_there: impl Fn(&Column) -> bool,
) -> Vec<&'static Column> {
    let found = columns.iter().copied();
    found.filter(|column| is_there(column)).collect()
}

/// The word at a row: one word alone holds for all rows.
fn word(words: &[&'static str], row: usize) -> &'static str {
    match words {
        [one] => one,
        words => words.get(row).copied().unwrap_or_default(),
    }
}
