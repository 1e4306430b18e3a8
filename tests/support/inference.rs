//! Problems of an inference and what is read of its answers.

use serde_json::Value;

/// Printed figures as a problem has them: record, metric, value, unit, step.
pub(crate) fn published(rows: &[(&str, &str, f64, &str, f64)]) -> String {
    let rows = rows.iter().map(|(record, metric, value, unit, step)| {
        format!(
            "[[published]]\nrecord = \"{record}\"\nmetric = \"{metric}\"\nvalue = {value:?}\n\
             unit = \"{unit}\"\nrounding = {step:?}\nsource = \"made up\"\n"
        )
    });
    rows.collect()
}

pub(crate) fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}
