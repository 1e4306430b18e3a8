//! Metrics in the Bencher Metric Format.

use serde_json::{Map, Value};

use crate::metrics::{ChannelMetrics, IntervalKind, Metric, find};

const VALUE: &str = "value";
const LOWER: &str = "lower_value";
const UPPER: &str = "upper_value";

/// Metrics of many runs: a benchmark for each channel, `<folder of the run>/<channel>`, and a measure for
/// each metric, by its key.
///
/// # Source
/// Bencher, "Bencher Metric Format (BMF)".
#[derive(Clone, Debug, Default)]
pub struct BencherMetrics(Map<String, Value>);

impl BencherMetrics {
    /// Adds the channels of a run.
    pub fn add(&mut self, folder: &str, channels: &[(String, ChannelMetrics)]) {
        for (name, channel) in channels {
            let measures = channel.metrics.iter();
            let measures =
                measures.filter_map(|(key, metric)| Some((key.clone(), measure(metric)?)));
            let measures: Map<String, Value> = measures.collect();
            if !measures.is_empty() {
                self.0.insert(format!("{folder}/{name}"), measures.into());
            }
        }
    }

    /// The text of the file.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{:#}\n", Value::Object(self.0.clone()))
    }
}

/// A value with the ends of its interval, where it has one; none where it is no number.
fn measure(metric: &Metric) -> Option<Value> {
    let estimate = &metric.estimate;
    let mut measure = Map::new();
    let number = |number: f64| Value::from(number);
    measure.insert(
        VALUE.to_owned(),
        Some(number(estimate.value)).filter(Value::is_number)?,
    );
    let has_interval = !matches!(
        estimate.interval,
        IntervalKind::Absent(_) | IntervalKind::Exact
    );
    if has_interval && estimate.low.is_finite() && estimate.high.is_finite() {
        measure.insert(LOWER.to_owned(), number(estimate.low));
        measure.insert(UPPER.to_owned(), number(estimate.high));
    }
    Some(measure.into())
}

/// Whether a text is a file that [`BencherMetrics::text`] made: nothing but measures that are metrics.
#[must_use]
pub fn is_bencher_metrics(text: &str) -> bool {
    let Ok(Value::Object(benchmarks)) = serde_json::from_str(text) else {
        return false;
    };
    let is_measure = |(name, measure): (&String, &Value)| {
        let parts = measure.as_object();
        find(name).is_some()
            && parts.is_some_and(|parts| {
                let mut keys = parts.keys();
                keys.all(|key| [VALUE, LOWER, UPPER].contains(&key.as_str()))
            })
    };
    benchmarks.values().all(|benchmark| {
        let measures = benchmark.as_object();
        measures.is_some_and(|measures| measures.iter().all(is_measure))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;

    #[test]
    fn a_measure_has_ends_where_its_metric_has_an_interval() {
        let mut channel = ChannelMetrics::default();
        for (key, estimate) in [
            ("mean_deg_per_h", Estimate::with_interval(1.5, 1.0, 2.0)),
            ("dc_gain", Estimate::exact(0.5)),
            (
                "minimum_deg_per_h",
                Estimate::without_interval(-1.0, "one record"),
            ),
            ("maximum_deg_per_h", Estimate::exact(f64::INFINITY)),
        ] {
            channel
                .metrics
                .insert(key.to_owned(), Metric::new(estimate, "1"));
        }
        let mut metrics = BencherMetrics::default();
        metrics.add("power/0003", &[("raw".to_owned(), channel)]);
        let text = metrics.text();
        let read: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(
            read,
            serde_json::json!({"power/0003/raw": {
                "mean_deg_per_h": {"value": 1.5, "lower_value": 1.0, "upper_value": 2.0},
                "dc_gain": {"value": 0.5},
                "minimum_deg_per_h": {"value": -1.0},
            }})
        );
        assert!(is_bencher_metrics(&text));
        for theirs in [
            "",
            "[]",
            r#"{"a": 1}"#,
            r#"{"a": {"latency": {"value": 1}}}"#,
        ] {
            assert!(!is_bencher_metrics(theirs), "{theirs}");
        }
    }
}
