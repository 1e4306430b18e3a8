//! What the temperature does to the words of a log, in words and a table.

use crate::gate::{estimate_text, three_digits};
use crate::metrics::catalogue::{STD_LEFT, TEMPERATURE};
use crate::metrics::columns::temperature::{RATE, TEMPERATURE_C};
use crate::metrics::{
    APPLIED, BEFORE, ChannelMetrics, MEAN_LENGTH, Metric, P_VALUE, REFERENCE, TEMPERATURE_METRICS,
};
use crate::report::layout::text::{Grid, wrapped};

/// Digits of a coefficient.
const DIGITS: i32 = 2;

/// A table of the coefficients of every channel in which they were looked for.
pub(crate) fn temperature_text(channels: &[(String, ChannelMetrics)], width: usize) -> String {
    let mut text = String::new();
    for (name, metrics) in channels {
        let Some(left) = metrics.get(&STD_LEFT) else {
            if let Some(reason) = metrics.why_unavailable(&STD_LEFT) {
                let line = format!("no temperature coefficients of {name}: {reason}");
                text.push_str(&wrapped(&line, "  ", width));
            }
            continue;
        };
        text.push_str(&wrapped(&heading(name, metrics, left), "  ", width));
        text.push_str(&table(metrics, width));
        let line = format!(
            "the means scatter by {} deg/h, and by {} without what is significant",
            three_digits(field(left, BEFORE)),
            three_digits(left.estimate.value)
        );
        text.push_str(&wrapped(&line, "  ", width));
    }
    if text.is_empty() {
        text
    } else {
        format!("\n{text}")
    }
}

fn field(metric: &Metric, name: &str) -> f64 {
    metric.fields.get(name).copied().unwrap_or_default()
}

/// What the temperature did, and what it was compared with.
fn heading(name: &str, metrics: &ChannelMetrics, left: &Metric) -> String {
    let curve = metrics.curve(&TEMPERATURE);
    let range = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (low, high)
    };
    let means = format!(
        "{} means of {} s",
        field(left, "count"),
        three_digits(field(left, MEAN_LENGTH))
    );
    let Some(curve) = curve.filter(|curve| !RATE.of(curve).is_empty()) else {
        return format!("temperature of {name}: {means}");
    };
    let (low_c, high_c) = range(TEMPERATURE_C.of(curve));
    let (slowest, fastest) = range(RATE.of(curve));
    format!(
        "temperature of {name}: {low_c:.1} to {high_c:.1} C at {} to {} K/min, {means}",
        three_digits(slowest),
        three_digits(fastest)
    )
}

/// The coefficients with their significance, and why some are missing.
fn table(metrics: &ChannelMetrics, width: usize) -> String {
    let mut grid = Grid::default();
    grid.row(["", "unit", "estimate", "p", "applied"].map(str::to_owned));
    let mut lacking = String::new();
    for key in TEMPERATURE_METRICS
        .into_iter()
        .filter(|key| **key != STD_LEFT)
    {
        let Some(metric) = metrics.get(key) else {
            if let Some(reason) = metrics.why_unavailable(key) {
                let line = format!("no {} ({}): {reason}", key.title(), key.name);
                lacking.push_str(&wrapped(&line, "  ", width));
            }
            continue;
        };
        let at = metric.fields.get(REFERENCE);
        let at = at.map_or_else(String::new, |at| format!(" at {} C", three_digits(*at)));
        let applied = metric.fields.get(APPLIED);
        grid.row([
            format!("{}{at}", key.title()),
            key.unit.to_owned(),
            estimate_text(&metric.estimate, DIGITS),
            three_digits(field(metric, P_VALUE)),
            applied.map_or_else(String::new, |applied| three_digits(*applied)),
        ]);
    }
    format!("{}{lacking}", grid.lines("  "))
}
