//! Metrics by channel: the few that matter for the motion, then all with their definitions.

use std::collections::BTreeSet;

use maud::{Markup, html};

use super::document::{by_value, filter, wide};
use super::gates::unit_word;
use crate::metrics::{ChannelMetrics, Metric, MetricKey, known_metrics};
use crate::report::RunReport;
use crate::report::record::columns::{columns, unit_text, value_text};

/// A channel's cell of a metric.
fn cell(channel: &ChannelMetrics, name: &str) -> Markup {
    match channel.metrics.get(name) {
        Some(metric) => html! {
            td.num data-v=(by_value(metric.estimate.value)) title=(ends(metric)) { (value_text(metric)) }
        },
        None => {
            let reason = channel.unavailable.get(name).map(|reason| reason.as_str());
            let reason = reason.or(channel.error.as_ref().map(|it| it.message.as_str()));
            html! { td.num.soft data-v="" title=[reason] { "\u{2013}" } }
        }
    }
}

/// The ends of an interval in words.
fn ends(metric: &Metric) -> String {
    let estimate = &metric.estimate;
    if estimate.has_interval() {
        let percent = 100.0 * estimate.confidence;
        format!(
            "{} to {}, {percent} % confidence",
            estimate.low, estimate.high
        )
    } else {
        "no interval".to_owned()
    }
}

/// A row for each channel, a column for each metric that matters for the motion.
pub(super) fn main_metrics(report: &RunReport) -> Markup {
    let measured = report.measured();
    let columns = columns(&measured.motion, measured.channels);
    let unit = |key: &MetricKey| {
        let mut found = measured
            .channels
            .iter()
            .filter_map(|(_, channel)| channel.get(key));
        found.next().map(unit_text).unwrap_or_default()
    };
    let table = html! {
        table.sortable #main-metrics {
            thead { tr {
                th scope="col" { "channel" }
                @for column in &columns {
                    th.num scope="col" title=(column.key.definition) { (column.title) " " span.unit { (unit(column.key)) } }
                }
            } }
            tbody { @for (name, channel) in measured.channels { tr {
                th scope="row" { (name) @if channel.error.is_some() { " " span.pill.fail { "FAILED" } } }
                @for column in &columns { (cell(channel, column.key.name)) }
            } } }
        }
    };
    html! {
        (wide("main metrics by channel", &table))
        p.soft.small { "\u{b1}: half width of the 95 % confidence interval for the mean over seeds. A dash says why \
            when pointed at; reasons stand below." }
    }
}

/// A row for each metric with its definition, a column for each channel.
pub(super) fn all_metrics(report: &RunReport) -> Markup {
    let has = |key: &&&MetricKey| {
        let mut channels = report.channels.iter();
        channels.any(|(_, channel)| channel.get(key).is_some())
    };
    let table = html! {
        table.sortable #all-metrics {
            thead { tr {
                th scope="col" { "metric" }
                th scope="col" { "unit" }
                @for (name, _) in report.channels { th.num scope="col" { (name) } }
            } }
            tbody { @for key in known_metrics().iter().filter(has) { tr {
                th scope="row" {
                    (key.title()) " " code.soft { (key.name) }
                    @if let Some(assumption) = report.assumption_behind(key.name) {
                        " " span.pill.doubt title={ "says again what nobody set: " (assumption) } { "assumed" }
                    }
                    span.definition { (key.definition) }
                }
                td { (unit_word(key.unit)) }
                @for (_, channel) in report.channels { (cell(channel, key.name)) }
            } } }
        }
    };
    html! {
        (filter("all-metrics", "noise, delay, \u{2026}"))
        (wide("all metrics by channel", &table))
    }
}

/// Why metrics are missing, each reason once; nothing where none is.
pub(super) fn missing(report: &RunReport) -> Option<Markup> {
    let mut rows: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for (channel, metrics) in report.channels {
        for (name, reason) in &metrics.unavailable {
            let reason = reason.as_str();
            match rows.iter_mut().find(|row| (row.0, row.1) == (name, reason)) {
                Some((.., channels)) => channels.push(channel),
                None => rows.push((name, reason, vec![channel])),
            }
        }
    }
    let names: BTreeSet<&str> = rows.iter().map(|(name, ..)| *name).collect();
    (!rows.is_empty()).then(|| {
        let table = html! {
            table {
                thead { tr { th scope="col" { "metric" } th scope="col" { "channels" } th scope="col" { "reason" } } }
                tbody { @for (name, reason, channels) in &rows { tr {
                    th scope="row" { code { (name) } }
                    td { (channels.join(", ")) }
                    td { (reason) }
                } } }
            }
        };
        html! {
            details {
                summary { (names.len()) " that this record does not give, and why" }
                (wide("missing metrics", &table))
            }
        }
    })
}
