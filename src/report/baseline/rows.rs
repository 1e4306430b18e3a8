//! Parts of a row that text and Markdown share.

use crate::baseline::{Comparison, Entry, Interval, Judged, Outcome, Row, Side};
use crate::metrics::{Estimate, estimate_text, plain};
use crate::wording::counted;

/// Significant digits of a half width.
const DIGITS: i32 = 2;

/// A comparison with the sides that it is of.
#[derive(Clone, Copy, Debug)]
pub struct ComparedSides<'a> {
    /// What was judged.
    pub judged: Judged<'a>,
    /// Earlier results.
    pub old: &'a Side,
    /// Later results.
    pub new: &'a Side,
}

/// Rows with an outcome that says something, the worst first.
pub(super) fn notable(comparison: &Comparison) -> Vec<&Row> {
    let is_notable = |row: &&Row| row.outcome != Outcome::Same;
    let mut rows: Vec<&Row> = comparison.rows.iter().filter(is_notable).collect();
    rows.sort_by_key(|row| std::cmp::Reverse(row.outcome));
    rows
}

/// `12 figures: 1 worse, 11 same`.
pub(in crate::report) fn counts(comparison: &Comparison) -> String {
    let counts = Outcome::ALL.map(|outcome| (outcome, comparison.count(outcome)));
    let counts = counts.into_iter().filter(|(_, count)| *count > 0);
    let counts: Vec<String> = counts
        .map(|(outcome, count)| format!("{count} {}", outcome.as_str()))
        .collect();
    let total = counted(comparison.rows.len(), "figure");
    if counts.is_empty() {
        return total;
    }
    format!("{total}: {}", counts.join(", "))
}

/// A figure with its interval, without the unit; `-` where there is none.
pub(in crate::report) fn figure(entry: Option<&Entry>) -> String {
    match entry {
        None => "-".to_owned(),
        Some(entry) => match entry.interval {
            Interval::Confidence { low, high } => {
                let estimate = Estimate::with_interval(entry.value, low, high);
                estimate_text(&estimate, DIGITS)
            }
            Interval::Exact | Interval::Absent => plain(entry.value),
        },
    }
}

/// Unit of a row, empty for a ratio.
pub(in crate::report) fn unit(row: &Row) -> &str {
    let entry = row.new.as_ref().or(row.old.as_ref());
    match entry.map_or("", |entry| entry.unit.as_str()) {
        "1" => "",
        unit => unit,
    }
}

/// `+9.0 %`; none where nothing is compared or the earlier value is zero.
pub(in crate::report) fn change(row: &Row) -> Option<String> {
    let (difference, old) = (row.difference?, row.old.as_ref()?.value);
    (old != 0.0).then(|| format!("{:+.2} %", 100.0 * difference / old.abs()))
}

/// What it was judged by, and how likely that is by chance.
pub(in crate::report) fn grounds(row: &Row) -> String {
    let mut parts = Vec::new();
    if row.old.is_some() && row.new.is_some() {
        parts.push(row.basis.words());
    }
    if let Some(p_value) = row.p_value.filter(|p_value| *p_value < 1.0) {
        parts.push(if p_value < 1e-6 {
            "corrected p below 1e-6".to_owned()
        } else {
            format!("corrected p {p_value:.2e}")
        });
    }
    if !row.reason.is_empty() {
        parts.push(row.reason.clone());
    }
    parts.join("; ")
}

/// A figure in one line: what it was, what it is, by how much it changed and what says so.
pub(in crate::report) fn row_line(row: &Row) -> String {
    let unit = match unit(row) {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let change = change(row).map_or_else(String::new, |change| format!("  {change}"));
    let grounds = match grounds(row).as_str() {
        "" => String::new(),
        grounds => format!("  ({grounds})"),
    };
    let figures = match (&row.old, &row.new) {
        (Some(_), None) => format!("was {}{unit}", figure(row.old.as_ref())),
        (None, _) => format!("{}{unit}", figure(row.new.as_ref())),
        _ => format!(
            "{} -> {}{unit}",
            figure(row.old.as_ref()),
            figure(row.new.as_ref())
        ),
    };
    format!("{}  {figures}{change}{grounds}", row.id)
}
