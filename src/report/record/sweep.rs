//! Point of a sweep: the keys that it sets, with values that keep their types.

use serde_json::Value;

/// Index of a point and what it sets: keys as the matrix writes them, values in TOML.
pub type PointOfSweep = (usize, Vec<(String, String)>);

/// A value that a sweep sets, out of its TOML: numbers and truth values as such, texts without their
/// quotes. What JSON has no type for keeps its spelling.
pub(in crate::report) fn swept_value(toml: &str) -> Value {
    serde_json::from_str(toml).unwrap_or_else(|_| toml.into())
}

/// The same as a text.
pub(in crate::report) fn swept_text(toml: &str) -> String {
    match swept_value(toml) {
        Value::String(text) => text,
        other => other.to_string(),
    }
}

/// What a point sets, in words: `a = 1, b = "x"`.
pub(in crate::report) fn assignments_text(assignments: &[(String, String)]) -> String {
    let keys = assignments.iter();
    let keys = keys.map(|(key, value)| format!("{key} = {value}"));
    keys.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_types() {
        for (toml, expected) in [
            ("0.87", serde_json::json!(0.87)),
            ("1.0", serde_json::json!(1.0)),
            ("1e-7", serde_json::json!(1e-7)),
            ("20", serde_json::json!(20)),
            ("true", serde_json::json!(true)),
            ("\"fpga\"", serde_json::json!("fpga")),
            ("[1.0, 2.0]", serde_json::json!([1.0, 2.0])),
            ("inf", serde_json::json!("inf")),
        ] {
            assert_eq!(swept_value(toml), expected, "{toml}");
        }
    }
}
