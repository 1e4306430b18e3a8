//! Which metrics matter for which motion, and how they are headed.

use crate::gate::{estimate_text, plain, three_digits};
use crate::metrics::{ChannelMetrics, Headline, Metric, MetricKey, Table, find, known_metrics};
use crate::scenario::{MotionClass, MotionConfig};

/// Digits of an interval's half width in tables.
pub(crate) const DIGITS: i32 = 2;

/// One column of the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    /// Metric.
    pub(crate) key: &'static MetricKey,
    /// Heading.
    pub(crate) title: String,
}

/// Table of the metrics of a motion.
fn table_of(motion: &MotionConfig) -> Table {
    match motion.class() {
        MotionClass::Rest | MotionClass::Rotation => Table::Rest,
        MotionClass::Swing { .. } => Table::Swing,
        MotionClass::MultiSine { .. } => Table::MultiSine,
        MotionClass::Steps(_) | MotionClass::General => Table::Steps,
        MotionClass::Campaign(_) => Table::Campaign,
    }
}

/// Line of a motion in the suite's table.
fn headline_of(motion: &MotionConfig) -> Headline {
    match motion.class() {
        MotionClass::Rest | MotionClass::Rotation => Headline::Rest,
        MotionClass::Swing { .. } => Headline::Swing,
        MotionClass::MultiSine { .. } => Headline::MultiSine,
        MotionClass::Steps(stairs) if stairs.has_static_zeros => Headline::ScaleFactor,
        MotionClass::Steps(_) => Headline::Steps,
        MotionClass::General | MotionClass::Campaign(_) => Headline::General,
    }
}

/// Heading of a metric whatever the motion; its averaging time stands beside the unit.
pub(crate) fn heading_of(name: &str) -> String {
    find(name).map_or_else(|| name.replace('_', " "), MetricKey::title)
}

/// The columns that at least one channel fills, in the order of the catalogue; what closes every
/// table stands last.
pub(crate) fn columns(motion: &MotionConfig, channels: &[(String, ChannelMetrics)]) -> Vec<Column> {
    let table = table_of(motion);
    let own = known_metrics()
        .iter()
        .filter(|key| key.tables.contains(&table));
    let closing = known_metrics()
        .iter()
        .filter(|key| key.closes_tables && !key.tables.contains(&table));
    let present = |key: &MetricKey| {
        channels
            .iter()
            .any(|(_, metrics)| metrics.get(key).is_some())
    };
    own.chain(closing)
        .filter(|key| present(key))
        .map(|key| Column {
            key,
            title: key.title(),
        })
        .collect()
}

/// Whether the table of this motion has a column for the metric.
pub(crate) fn matters(motion: &MotionConfig, key: &MetricKey) -> bool {
    key.tables.contains(&table_of(motion))
}

/// Unit of a column, with the averaging time where that defines the metric.
pub(crate) fn unit_text(metric: &Metric) -> String {
    let unit = if metric.unit == "1" { "" } else { metric.unit };
    match metric.fields.get("averaging_time_s") {
        Some(time) if unit.is_empty() => format!("{} s", plain(*time)),
        Some(time) => format!("{unit}, {} s", plain(*time)),
        None => unit.to_owned(),
    }
}

/// A metric with its interval and, where the fitted noise makes one expect a value, that beside it.
pub(crate) fn value_text(metric: &Metric) -> String {
    let text = estimate_text(&metric.estimate, DIGITS);
    match metric.fields.get("expected_deg_per_h") {
        Some(expected) => format!("{text}, expected {}", three_digits(*expected)),
        None => text,
    }
}

/// The metrics that stand for a channel in the suite's table, in the order of the catalogue.
pub(crate) fn headline_metrics(motion: &MotionConfig) -> Vec<&'static MetricKey> {
    let line = headline_of(motion);
    let keys = known_metrics().iter();
    keys.filter(|key| key.headlines.contains(&line))
        .copied()
        .collect()
}

/// The few figures of a channel that stand for it in the suite's table: heading, value and unit.
pub(crate) fn headline(motion: &MotionConfig, metrics: &ChannelMetrics) -> Vec<(String, String)> {
    let keys = headline_metrics(motion).into_iter();
    keys.filter_map(|key| {
        let metric = metrics.get(key)?;
        let value = value_text(metric);
        let text = format!("{value} {}", unit_text(metric));
        Some((key.title(), text.trim_end().to_owned()))
    })
    .collect()
}
