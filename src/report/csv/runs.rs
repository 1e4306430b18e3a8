//! `runs.csv`: every metric of every repeat.

use std::fmt::Write as _;

use crate::metrics::{MetricKey, repeated_metrics};
use crate::report::RunReport;
use crate::report::text::repeats::repeats_of;

/// Every repeat of every channel, one row each; nothing for a single record.
#[must_use]
pub(in crate::report) fn runs_csv(report: &RunReport) -> Option<String> {
    let has = |key: &MetricKey| {
        let mut channels = report.channels.iter();
        channels.any(|(_, metrics)| metrics.repeats.contains_key(key.name))
    };
    let columns: Vec<_> = repeated_metrics()
        .into_iter()
        .filter(|key| has(key))
        .collect();
    if columns.is_empty() {
        return None;
    }
    let mut text = format!(
        "channel,run,{}\n",
        columns
            .iter()
            .map(|key| key.name)
            .collect::<Vec<_>>()
            .join(",")
    );
    for (name, metrics) in report.channels {
        for run in 0..repeats_of(metrics) {
            // Writing to a String cannot fail.
            let _ = write!(text, "{name},{}", run + 1);
            for key in &columns {
                text.push(',');
                let of = metrics.repeats.get(key.name);
                if let Some(value) = of.and_then(|of| of.value_of(run)) {
                    let _ = write!(text, "{value:?}");
                }
            }
            text.push('\n');
        }
    }
    Some(text)
}
