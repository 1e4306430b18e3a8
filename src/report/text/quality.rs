//! What is the matter with the words of a log, in words: outliers, smoothing.

use crate::gate::{plain, three_digits};
use crate::metrics::catalogue::{OUTLIERS, SMOOTHING_TIME};
use crate::metrics::{ChannelMetrics, OutlierEntry};
use crate::report::layout::text::wrapped;
use crate::wording::{counted, to_digits};

/// Outliers that are listed, the largest; the JSON has all.
const LISTED_MAX: usize = 8;

/// Lines on outliers and smoothing of every channel in which they were looked for.
pub(crate) fn quality_text(channels: &[(String, ChannelMetrics)], width: usize) -> String {
    let mut text = String::new();
    for (name, metrics) in channels {
        let outliers = line(metrics).map(|line| format!("outliers of {name}: {line}"));
        let smoothing = smoothing_words(metrics).map(|words| format!("{name} {words}"));
        for line in outliers.into_iter().chain(smoothing) {
            text.push_str(&wrapped(&line, "  ", width));
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
    let bursts = if words > found.len() {
        format!(" ({} in all)", counted(words, "word"))
    } else {
        String::new()
    };
    Some(format!(
        "{}{bursts} {beyond}{head}: {}",
        found.len(),
        listed.join(", ")
    ))
}

/// What a log that was smoothed is told; nothing of others.
pub(crate) fn smoothing_words(metrics: &ChannelMetrics) -> Option<String> {
    let like = metrics.smoothing.as_deref()?;
    let time = metrics.get(&SMOOTHING_TIME)?.estimate;
    Some(format!(
        "behaves as if averaged over about {} s ({} s to {} s, as behind {like}); noise inside that time \
         is not the gyro's",
        plain(to_digits(time.value, 2)),
        three_digits(time.low),
        three_digits(time.high)
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
