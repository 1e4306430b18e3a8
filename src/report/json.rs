//! JSON that people can read: one record or one curve a line.

use serde_json::{Map, Number, Value};
use std::fmt::Write as _;

/// A JSON number.
///
/// # Panics
/// If `value` is not finite: such a number must have been turned into an error or a missing
/// metric long before.
pub(crate) fn number(value: f64, what: &str) -> Value {
    let finite = Number::from_f64(value);
    assert!(finite.is_some(), "{what} reached the report as {value}");
    finite.map_or(Value::Null, Value::Number)
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
    #[should_panic(expected = "delay reached the report as NaN")]
    fn a_number_that_is_not_finite_is_refused() {
        let _ = number(f64::NAN, "delay");
    }
}
