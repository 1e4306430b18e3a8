//! JSON that people can read: one record or one curve a line.

use crate::metrics::{Estimate, IntervalKind, Metric};
use serde_json::{Map, Number, Value};
use std::fmt::Write as _;

/// A JSON number; nothing for a value that is not finite, which JSON does not have.
///
/// Such a value has been refused where it arose, or its metric is unavailable with the reason (see
/// `ChannelMetrics::keep_finite`). Should one come here all the same, its key is left out: one
/// number never takes the rest of a result with it, and no `null` passes for a measurement.
pub(crate) fn number(value: f64) -> Option<Value> {
    Number::from_f64(value).map(Value::Number)
}

/// Enters a number under its key, if there is one.
pub(crate) fn put(record: &mut Map<String, Value>, key: &str, value: impl Into<Option<f64>>) {
    if let Some(value) = value.into().and_then(number) {
        record.insert(key.to_owned(), value);
    }
}

/// An object of numbers, in their order.
pub(crate) fn numbers<const N: usize>(pairs: [(&str, f64); N]) -> Map<String, Value> {
    let mut record = Map::new();
    for (key, value) in pairs {
        put(&mut record, key, value);
    }
    record
}

/// An array of numbers; nothing if one of them is not finite, so that places keep their meaning.
pub(crate) fn array<'a>(values: impl IntoIterator<Item = &'a f64>) -> Option<Value> {
    let values: Option<Vec<Value>> = values.into_iter().map(|value| number(*value)).collect();
    values.map(Value::Array)
}

/// Enters an array of numbers under its key, if all of them are numbers.
pub(crate) fn put_array<'a>(
    record: &mut Map<String, Value>,
    key: &str,
    values: impl IntoIterator<Item = &'a f64>,
) {
    if let Some(values) = array(values) {
        record.insert(key.to_owned(), values);
    }
}

/// An object from pairs, in their order.
pub(crate) fn object<const N: usize>(pairs: [(&str, Value); N]) -> Map<String, Value> {
    pairs
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}

/// Pretty text with a final newline: containers of scalars stay on one line.
pub(crate) fn pretty(value: &Value) -> String {
    let mut text = String::new();
    write_value(&mut text, value, 0);
    text.push('\n');
    text
}

/// The same without the newline, of a value that stands `depth` containers deep.
pub(crate) fn pretty_at(value: &Value, depth: usize) -> String {
    let mut text = String::new();
    write_value(&mut text, value, depth);
    text
}

fn is_flat(value: &Value) -> bool {
    let scalar = |value: &Value| !value.is_array() && !value.is_object();
    match value {
        Value::Array(items) => items.iter().all(scalar),
        Value::Object(fields) => fields.values().all(scalar),
        _ => true,
    }
}

fn write_value(text: &mut String, value: &Value, depth: usize) {
    let flat = is_flat(value);
    match value {
        Value::Array(items) => {
            let parts = items.iter().map(|item| (None, item));
            write_container(text, ('[', ']'), parts, flat, depth);
        }
        Value::Object(fields) => {
            let parts = fields.iter().map(|(key, item)| (Some(key.as_str()), item));
            write_container(text, ('{', '}'), parts, flat, depth);
        }
        scalar => {
            // Writing to a String cannot fail.
            let _ = write!(text, "{scalar}");
        }
    }
}

fn write_container<'a>(
    text: &mut String,
    (open, close): (char, char),
    parts: impl Iterator<Item = (Option<&'a str>, &'a Value)>,
    flat: bool,
    depth: usize,
) {
    text.push(open);
    for (index, (key, item)) in parts.enumerate() {
        if index > 0 {
            text.push_str(if flat { ", " } else { "," });
        }
        if !flat {
            new_line(text, depth + 1);
        }
        if let Some(key) = key {
            let _ = write!(text, "{}: ", Value::from(key));
        }
        write_value(text, item, depth + 1);
    }
    if !flat {
        new_line(text, depth);
    }
    text.push(close);
}

fn new_line(text: &mut String, depth: usize) {
    text.push('\n');
    for _ in 0..depth {
        text.push_str("  ");
    }
}

/// Version of the layout of both files.
pub(crate) const SCHEMA: u32 = 1;

/// Who wrote it.
pub(crate) fn tool(version: &str) -> Value {
    object([("name", "fogbench".into()), ("version", version.into())]).into()
}

/// A metric with its interval, unit and fields.
pub(crate) fn estimate(metric: &Metric) -> Map<String, Value> {
    let mut record = interval(&metric.estimate);
    if let Some(word) = interval_word(&metric.estimate) {
        record.insert(INTERVAL.to_owned(), word.into());
    }
    record.insert("unit".to_owned(), metric.unit.into());
    for (field, value) in &metric.fields {
        put(&mut record, field, *value);
    }
    record
}

/// Key of what the ends of an estimate are, where they are no interval.
pub(crate) const INTERVAL: &str = "interval";

/// Key of the metrics of a channel, and of nothing else.
pub(crate) const METRICS: &str = "metrics";

/// Word for a value that no noise moves, or that is a fact of the record.
pub(crate) const EXACT: &str = "exact";

/// What every interval of a summary is that says nothing else.
pub(crate) const INTERVALS: &str = "confidence intervals for the ensemble value: the mean over seeds \
     of records of this length and warm-up, same scenario";

/// What the ends of an estimate are, where they are no interval.
fn interval_word(estimate: &Estimate) -> Option<&'static str> {
    match estimate.interval {
        IntervalKind::Exact => Some(EXACT),
        IntervalKind::Absent(reason) => Some(reason),
        _ => None,
    }
}

/// A value with its interval.
pub(crate) fn interval(estimate: &Estimate) -> Map<String, Value> {
    numbers([
        ("value", estimate.value),
        ("low", estimate.low),
        ("high", estimate.high),
        ("confidence", estimate.confidence),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn containers_of_scalars_stay_on_one_line() {
        let value =
            serde_json::json!({"a": {"b": [1, 2.5], "c": {}}, "d": [{"e": "x\""}], "f": []});
        let text = pretty(&value);
        assert_eq!(
            text,
            "{\n  \"a\": {\n    \"b\": [1, 2.5],\n    \"c\": {}\n  },\n  \"d\": [\n    {\"e\": \"x\\\"\"}\n  ],\n  \"f\": []\n}\n"
        );
        let back: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(back, value);
    }

    #[test]
    fn a_number_that_is_not_finite_leaves_its_key_out() {
        let mut record = numbers([
            ("a", 1.0),
            ("b", f64::NAN),
            ("c", f64::INFINITY),
            ("d", 2.0),
        ]);
        put(&mut record, "e", f64::NEG_INFINITY);
        put_array(&mut record, "f", &[1.0, f64::NAN]);
        put_array(&mut record, "g", &[1.0, 2.0]);
        let text = pretty(&record.into());
        assert_eq!(
            text,
            "{\n  \"a\": 1.0,\n  \"d\": 2.0,\n  \"g\": [1.0, 2.0]\n}\n"
        );
    }
}
