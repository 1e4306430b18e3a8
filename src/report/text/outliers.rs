//! Outliers of a log in words.

use crate::gate::three_digits;
use crate::metrics::catalogue::OUTLIERS;
use crate::metrics::{ChannelMetrics, OutlierEntry};
use crate::report::layout::text::wrapped;
use crate::wording::counted;

/// Outliers that are listed, the largest; the JSON has all.
const LISTED_MAX: usize = 8;

/// A line on the outliers of every channel in which they were looked for.
pub(crate) fn outliers_text(channels: &[(String, ChannelMetrics)], width: usize) -> String {
    let mut text = String::new();
    for (name, metrics) in channels {
        if let Some(line) = line(metrics) {
            text.push_str(&wrapped(
                &format!("outliers of {name}: {line}"),
                "  ",
                width,
            ));
        }
    }
    if text.is_empty() {
        text
    } else {
        format!("\n{text}")
    }
}

/// What there is to say of a channel; nothing where nobody looked.
fn line(metrics: &ChannelMetrics) -> Option<String> {
    let Some(metric) = metrics.get(&OUTLIERS) else {
        return metrics.why_unavailable(&OUTLIERS).map(str::to_owned);
    };
    let field = |name: &str| three_digits(metric.fields.get(name).copied().unwrap_or_default());
    let beyond = format!(
        "beyond {} deg/h, {} standard deviations",
        field("threshold_deg_per_h"),
        field("threshold_deviations")
    );
    let found = &metrics.outliers;
    if found.is_empty() {
        return Some(format!("none {beyond}"));
    }
    let mut listed: Vec<&OutlierEntry> = found.iter().collect();
    listed.sort_by(|a, b| b.size_deviations.total_cmp(&a.size_deviations));
    listed.truncate(LISTED_MAX);
    listed.sort_by_key(|entry| entry.index);
    let listed: Vec<String> = listed.into_iter().map(entry).collect();
    let head = if listed.len() < found.len() {
        format!("; the largest {}", listed.len())
    } else {
        String::new()
    };
    let words = found.iter().map(|entry| entry.words).sum::<usize>();
    Some(format!(
        "{} of {} {beyond}{head}: {}",
        found.len(),
        counted(words, "word"),
        listed.join(", ")
    ))
}

fn entry(entry: &OutlierEntry) -> String {
    let burst = if entry.words == 1 {
        String::new()
    } else {
        format!(" and {} after it", entry.words - 1)
    };
    let sign = if entry.size_deg_per_h < 0.0 { "" } else { "+" };
    format!(
        "word {}{burst} at {} s ({sign}{} deg/h, {} deviations)",
        entry.index,
        three_decimals(entry.time_s),
        three_digits(entry.size_deg_per_h),
        three_digits(entry.size_deviations)
    )
}

fn three_decimals(time_s: f64) -> String {
    format!("{time_s:.3}")
}
