//! Metrics over the repeats of a run: percentiles and a histogram of each.

use maud::{Markup, html};

use super::document::{by_value, filter, maybe, wide};
use super::gates::unit_word;
use crate::gate::{plain, three_digits};
use crate::metrics::{RepeatStatistics, repeated_metrics};
use crate::report::RunReport;

/// Percentiles that are shown.
const PERCENTS: [f64; 5] = [5.0, 25.0, 50.0, 75.0, 95.0];
/// Most bars of a histogram.
const BARS_MAX: usize = 24;
/// Size of a histogram, user units.
const WIDTH: f64 = 176.0;
const HEIGHT: f64 = 34.0;

/// The table; nothing for a single record.
pub(super) fn repeats(report: &RunReport) -> Option<Markup> {
    let mut rows = Vec::new();
    for key in repeated_metrics() {
        for (name, channel) in report.channels {
            let statistics = channel.repeats.get(key.name);
            rows.extend(statistics.map(|of| (key, name, of)));
        }
    }
    let count = rows.first().map(|(.., of)| of.repeats())?;
    let table = html! {
        table.sortable #repeats-table {
            thead { tr {
                th scope="col" { "metric" }
                th scope="col" { "channel" }
                th scope="col" { "distribution" }
                th.num scope="col" { "mean" }
                th.num scope="col" { "std" }
                @for percent in PERCENTS { th.num scope="col" { (percent) " %" } }
                th scope="col" { "unit" }
            } }
            tbody { @for (key, name, of) in &rows { tr {
                th scope="row" title=(key.definition) { (key.title()) }
                td { (name) }
                td data-v=(by_value(of.standard_deviation)) { (maybe(histogram(of))) }
                td.num data-v=(by_value(of.mean)) { (plain(of.mean)) }
                td.num data-v=(by_value(of.standard_deviation)) { (three_digits(of.standard_deviation)) }
                @for percent in PERCENTS {
                    @let value = of.percentile(percent);
                    td.num data-v=(by_value(value)) { (plain(value)) }
                }
                td { (unit_word(of.unit)) }
            } } }
        }
    };
    Some(html! {
        p { (count) " independent repeats; every value stands in " a href="runs.csv" { "runs.csv" } "." }
        (filter("repeats-table", "metric or channel"))
        (wide("metrics over the repeats", &table))
    })
}

/// Bars of equal width from the smallest value to the largest; nothing where all are equal.
fn histogram(of: &RepeatStatistics) -> Option<Markup> {
    let span = of.maximum - of.minimum;
    if !(span > 0.0 && span.is_finite()) {
        return None;
    }
    let bars = of.values.len().isqrt().clamp(4, BARS_MAX);
    let mut counts = vec![0_usize; bars];
    for value in &of.values {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a part of the span, between 0 and the number of bars"
        )]
        let bar = ((value - of.minimum) / span * bars as f64) as usize;
        counts[bar.min(bars - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1) as f64;
    let width = WIDTH / bars as f64;
    let label = format!("from {} to {}", plain(of.minimum), plain(of.maximum));
    Some(html! {
        svg.histogram viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(label) {
            title { (label) }
            @for (bar, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                @let height = HEIGHT * *count as f64 / most;
                rect x=(format!("{:.1}", bar as f64 * width)) y=(format!("{:.1}", HEIGHT - height))
                    width=(format!("{:.1}", width - 1.0)) height=(format!("{height:.1}")) {}
            }
        }
    })
}
