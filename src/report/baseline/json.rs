//! A comparison as JSON.

use serde_json::{Map, Value};

use crate::baseline::{Entry, Interval, Judged, Outcome, Row};
use crate::report::layout::json::{object, pretty, put};

/// Every figure of either side with its outcome, and how many have which.
#[must_use]
pub fn comparison_with_baseline_json(judged: Judged) -> String {
    let Judged {
        comparison,
        fail_on,
    } = judged;
    let counts = Outcome::ALL.map(|outcome| {
        let count = comparison.count(outcome);
        (outcome.as_str().to_owned(), Value::from(count))
    });
    let words: Vec<Value> = fail_on
        .iter()
        .map(|outcome| outcome.as_str().into())
        .collect();
    let rows: Vec<Value> = comparison.rows.iter().map(row).collect();
    let document = object([
        ("schema", 1.into()),
        ("old_version", comparison.old_version.as_str().into()),
        ("new_version", comparison.new_version.as_str().into()),
        ("fail_on", words.into()),
        ("failed", judged.has_failed().into()),
        ("counts", Value::Object(counts.into_iter().collect())),
        ("metrics", rows.into()),
    ]);
    pretty(&document.into())
}

fn row(row: &Row) -> Value {
    let point = row.id.point.iter();
    let point: Map<String, Value> = point
        .map(|(key, value)| (key.clone(), swept(value)))
        .collect();
    let mut record = object([
        ("scenario", row.id.scenario.as_str().into()),
        ("point", point.into()),
        ("channel", row.id.channel.as_str().into()),
        ("metric", row.id.metric.as_str().into()),
        ("outcome", row.outcome.as_str().into()),
        ("basis", row.basis.words().into()),
    ]);
    if !row.reason.is_empty() {
        record.insert("reason".to_owned(), row.reason.as_str().into());
    }
    put(&mut record, "difference", row.difference);
    put(&mut record, "corrected_p", row.p_value);
    for (key, entry) in [("old", &row.old), ("new", &row.new)] {
        if let Some(entry) = entry {
            record.insert(key.to_owned(), figure(entry));
        }
    }
    record.into()
}

/// A swept value, a number where it is one.
fn swept(value: &str) -> Value {
    serde_json::from_str(value).unwrap_or_else(|_| value.into())
}

fn figure(entry: &Entry) -> Value {
    let mut record = object([
        ("unit", entry.unit.as_str().into()),
        ("seed", entry.seed.into()),
        ("digest", entry.conditions.as_str().into()),
    ]);
    put(&mut record, "value", entry.value);
    if let Interval::Confidence { low, high } = entry.interval {
        put(&mut record, "low", low);
        put(&mut record, "high", high);
    }
    record.into()
}
