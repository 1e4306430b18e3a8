//! Point of a sweep: the keys that it sets, with values that keep their types, and its headline figures.

use serde_json::Value;

use crate::metrics::{Estimate, MetricKey};
use crate::report::record::columns::headline_metrics;
use crate::report::record::run::RunReport;

/// Index of a point and what it sets: keys as the matrix writes them, values in TOML.
pub type PointOfSweep = (usize, Vec<(String, String)>);

/// A headline metric of a channel at a point: small enough to keep for every point of a large sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointFigure {
    /// Number of the channel in the run.
    pub(in crate::report) channel: usize,
    pub(in crate::report) key: &'static MetricKey,
    pub(in crate::report) estimate: Estimate,
    /// Averaging time, of a metric that is defined by one, s.
    pub(in crate::report) averaging_time_s: Option<f64>,
}

/// The headline metrics of a point of a sweep; none of a run that is no point.
pub(in crate::report) fn point_figures(report: &RunReport) -> Vec<PointFigure> {
    if report.sweep.is_none() {
        return Vec::new();
    }
    let motion = report.scenario.measured_motion();
    let keys = headline_metrics(&motion);
    let channels = report.channels.iter().enumerate();
    let figures = channels.flat_map(|(channel, (_, metrics))| {
        keys.iter().filter_map(move |key| {
            let metric = metrics.get(key)?;
            Some(PointFigure {
                channel,
                key,
                estimate: metric.estimate,
                averaging_time_s: metric.fields.get("averaging_time_s").copied(),
            })
        })
    });
    figures.collect()
}

/// A value that a sweep sets, out of its TOML: numbers and truth values as such, texts without their
/// quotes. What JSON has no type for keeps its spelling.
#[must_use]
pub fn swept_value(toml: &str) -> Value {
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
#[must_use]
pub fn assignments_text(assignments: &[(String, String)]) -> String {
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
