//! `filters.html`: filters of a suite side by side on the motions that its runs try them on.

use maud::{Markup, html};

use super::document::{by_value, document, filter, section, wide};
use crate::comparison::{Beside, BesideFilter, BesideRun};
use crate::gate::{estimate_text, three_digits};
use crate::metrics::catalogue::{NOISE_AT_EQUAL_DELAY, NOISE_GAIN};
use crate::metrics::{AgainstOne, ChannelMetrics, Estimate, Finding, Metric, MetricKey};
use crate::report::record::columns::{DIGITS, headline_metrics, unit_text};

/// Most runs of a set that the page has a column and a table of.
const RUNS_MAX: usize = 12;

/// The page; none where no run tries two filters under twins.
#[must_use]
pub fn filters_page(tool_version: &str, sets: &[Beside]) -> Option<String> {
    if sets.is_empty() {
        return None;
    }
    let head = html! {
        h1 { "Filters side by side" }
        p { "Of the same gyro and the same words: first what a filter asks for, its DC gain, its look-ahead and its \
            memory, then what is left of the noise, then what it costs." }
        nav aria-label="sections" {
            a href="index.html" { "All results" }
            @for (index, set) in sets.iter().enumerate() {
                a href=(format!("#{}", id(index))) { (title(set)) }
            }
            a href="#meaning" { "What the columns mean" }
        }
    };
    let body = html! {
        @for (index, set) in sets.iter().enumerate() { (one_set(index, set)) }
        (meaning())
    };
    let foot = html! { p { "Written by fogbench " (tool_version) ". The same scenarios, seeds and version give the same bytes." } };
    Some(document("filters side by side", &head, &body, &foot))
}

fn id(index: usize) -> String {
    format!("filters-{}", index + 1)
}

fn table_id(index: usize) -> String {
    format!("{}-table", id(index))
}

fn title(set: &Beside) -> String {
    let names: Vec<&str> = set.runs.iter().map(|run| run.folder.as_str()).collect();
    match names[..] {
        [one] => one.to_owned(),
        [first, .., last] => format!("{first} to {last}"),
        [] => String::new(),
    }
}

fn one_set(index: usize, set: &Beside) -> Markup {
    let shown = &set.runs[..set.runs.len().min(RUNS_MAX)];
    let heading = format!("{} filters: {}", set.filters.len(), title(set));
    section(
        &id(index),
        &heading,
        &html! {
            (filter(&table_id(index), "filter"))
            (wide(&heading, &side_by_side(index, set, shown)))
            @if shown.len() < set.runs.len() {
                p { "The first " (shown.len()) " of " (set.runs.len()) " runs." }
            }
            @for run in shown { (one_run(run)) }
        },
    )
}

/// A row for each filter: conditions, noise by run, cost.
fn side_by_side(index: usize, set: &Beside, shown: &[BesideRun]) -> Markup {
    html! {
        table.sortable.beside-table id=(table_id(index)) {
            thead { tr {
                th scope="col" { "filter" }
                th.num scope="col" { "DC gain" span.unit { "least" } }
                th.num scope="col" { "look-ahead" span.unit { "samples" } }
                th.num scope="col" { "memory" span.unit { "to 1 %, s" } }
                @for run in shown {
                    th.num scope="col" { "noise, " (run.folder) span.unit { "over a mean of equal delay" } }
                }
                th.num scope="col" { "operations" span.unit { "a word" } }
            } }
            tbody { @for filter in &set.filters { (row(filter, shown.len())) } }
        }
    }
}

fn row(filter: &BesideFilter, runs: usize) -> Markup {
    html! { tr {
        th scope="row" { (filter.name) }
        (gain_cell(filter.dc_gain))
        (condition(filter.look_ahead_samples.as_ref(), |samples| samples > 0.0))
        (condition(filter.memory_s.as_ref(), |_| false))
        @for noise in filter.noise.iter().take(runs) { (noise_cell(noise.as_ref())) }
        (condition(filter.operations.as_ref(), |_| false))
    } }
}

/// A gain, marked where the signal is attenuated.
fn gain_cell(gain: Option<Finding>) -> Markup {
    let Some(Finding {
        estimate,
        against_one,
        ..
    }) = gain
    else {
        return none();
    };
    html! {
        td.num data-v=(by_value(estimate.value)) {
            @if against_one == AgainstOne::Below { span.pill.doubt { (short(&estimate)) } }
            @else { (short(&estimate)) }
        }
    }
}

/// A figure, marked where it is a condition that a filter of the next word cannot meet.
fn condition(metric: Option<&Metric>, is_marked: fn(f64) -> bool) -> Markup {
    let Some(Metric { estimate, .. }) = metric else {
        return none();
    };
    html! {
        td.num data-v=(by_value(estimate.value)) {
            @if is_marked(estimate.value) { span.pill.doubt { (short(estimate)) } }
            @else { (short(estimate)) }
        }
    }
}

fn noise_cell(noise: Option<&Estimate>) -> Markup {
    let Some(estimate) = noise else {
        return none();
    };
    html! { td.num data-v=(by_value(estimate.value)) { (short(estimate)) } }
}

fn none() -> Markup {
    html! { td.num.soft data-v="" { "\u{2013}" } }
}

/// A value with its interval, of three digits where it has none.
fn short(estimate: &Estimate) -> String {
    if estimate.has_interval() {
        estimate_text(estimate, DIGITS)
    } else {
        three_digits(estimate.value)
    }
}

/// The figures that matter for the motion of a run, raw first.
fn one_run(run: &BesideRun) -> Markup {
    let keys = [&NOISE_GAIN, &NOISE_AT_EQUAL_DELAY].into_iter();
    let mut keys: Vec<&MetricKey> = keys.collect();
    let more = headline_metrics(&run.motion);
    keys.extend(more.into_iter().filter(|key| **key != NOISE_GAIN));
    let told = |key: &&MetricKey| run.channels.iter().any(|(_, own)| own.get(key).is_some());
    keys.retain(told);
    let unit = |key: &MetricKey| {
        let mut all = run.channels.iter().filter_map(|(_, own)| own.get(key));
        all.next().map(unit_text).unwrap_or_default()
    };
    let table = html! {
        table.sortable.beside-table {
            thead { tr {
                th scope="col" { "channel" }
                @for key in &keys { th.num scope="col" { (key.title()) span.unit { (unit(key)) } } }
            } }
            tbody { @for (name, metrics) in &run.channels { tr {
                th scope="row" { (name) }
                @for key in &keys { (figure(metrics, key)) }
            } } }
        }
    };
    html! {
        h3 { a href=(format!("{}/report.html", run.folder)) { (run.folder) } ", " (run.motion.name()) }
        @if let Some(description) = &run.description { p.soft { (description) } }
        @if keys.is_empty() { p { "No figure of it." } }
        @else { (wide(&run.folder, &table)) }
    }
}

fn figure(metrics: &ChannelMetrics, key: &MetricKey) -> Markup {
    noise_cell(metrics.get(key).map(|metric| &metric.estimate))
}

/// What the columns mean, in words.
fn meaning() -> Markup {
    section(
        "meaning",
        "What the columns mean",
        &html! { dl.words {
            dt { "DC gain" }
            dd { "the least of the gains that the verdict goes by, over the runs of the table; marked where it is below 1: \
                every rate is lowered with the noise" }
            dt { "look-ahead" }
            dd { "samples between an output and the latest word that changes it; marked where there are any: no filter of \
                the next word can do that" }
            dt { "memory" }
            dd { "time until an output has forgotten one word to 1 %; what is read inside it is no noise of the gyro" }
            dt { "noise over a mean of equal delay" }
            dd { (NOISE_AT_EQUAL_DELAY.definition) }
            dt { "operations a word" }
            dd { "multiplications, additions and divisions of the plain equations. Those of a program are not seen; the \
                time that it took, which no two runs share, stands in " code { ".fogbench/programs.log" } "." }
        } },
    )
}
