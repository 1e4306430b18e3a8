//! `report.html`: one run in one file.

use maud::{Markup, html};

use super::channels::{all_metrics, main_metrics, missing};
use super::document::{by_value, document, facts, filter, maybe, section, wide};
use super::gates::{GateRow, gates_table, unit_word};
use super::pictures::{Shown, capital, pictures};
use super::repeats::repeats;
use super::units::units;
use crate::gate::{Verdict, count_accepted, judge_claim, plain, simulated, three_digits};
use crate::metrics::catalogue::ANGLE_RANDOM_WALK;
use crate::report::budget::{TOTAL, replacement};
use crate::report::record::columns::{heading_of, value_text};
use crate::report::text::verdict::verdict_text;
use crate::report::{RunReport, RunStatus};
use crate::scenario::{AssumedValue, Fidelity};
use crate::signal::GyroFacts;

/// Largest size of a page, bytes.
pub(in crate::report) const PAGE_BYTES_MAX: usize = 2_000_000;
/// What is left free of it for what frames the sections.
const RESERVE_BYTES: usize = 50_000;
/// Most gates that are shown, those that failed first.
const GATES_MAX: usize = 500;

/// What goes with the page of a run.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) struct Beside<'a> {
    /// Names of the files beside it.
    pub(in crate::report) files: &'a [String],
    /// Values that nobody set.
    pub(in crate::report) assumed: &'a [AssumedValue],
}

/// The page of a run with its pictures.
pub(in crate::report) fn run_page(report: &RunReport, shown: &[Shown], beside: &Beside) -> String {
    let before = html! { (maybe(failures(report))) (gates(report)) (channels(report)) };
    let behind = html! {
        (more_metrics(report)) (maybe(report.gyro.map(|gyro| budget(report, gyro)))) (maybe(published(report))) (maybe(over_repeats(report)))
        (assumed(beside.assumed)) (units()) (origin(report, beside.files))
    };
    let head = head(report);
    let used = before.0.len() + behind.0.len() + head.0.len() + RESERVE_BYTES;
    let drawn = drawn(report, shown, PAGE_BYTES_MAX.saturating_sub(used));
    let title = format!("{} \u{2013} fogbench", name(report));
    let foot = html! { p { "Written by fogbench " (report.tool_version) ". The same scenario, seed and version give the same bytes." } };
    document(&title, &head, &html! { (before) (drawn) (behind) }, &foot)
}

/// Name and point.
fn name(report: &RunReport) -> String {
    match &report.sweep {
        Some((index, _)) => format!("{} {index:04}", report.scenario.name),
        None => report.scenario.name.clone(),
    }
}

/// Word and class of how a run ended.
pub(super) fn status_word(status: RunStatus) -> (&'static str, &'static str) {
    match status {
        RunStatus::Pass => ("PASS", "pass"),
        RunStatus::GateFailed => ("GATE FAILED", "fail"),
        RunStatus::ChannelFailed => ("CHANNEL FAILED", "fail"),
        RunStatus::NotRun => ("NOT RUN", "doubt"),
        RunStatus::RunFailed => ("RUN FAILED", "fail"),
    }
}

fn head(report: &RunReport) -> Markup {
    let scenario = report.scenario;
    let (word, class) = status_word(report.status());
    let accepted = count_accepted(report.verdicts);
    let said = match report.verdicts.len() {
        0 => "no gates".to_owned(),
        count => format!("{accepted} of {count} gates accepted"),
    };
    let model = match scenario.fidelity {
        Fidelity::Loop => "loop model",
        Fidelity::Rate => "rate model",
    };
    let record = format!(
        "{} s after {} s of warm-up",
        plain(scenario.duration_s),
        plain(scenario.warm_up_s)
    );
    let mut pairs = vec![("record", record)];
    pairs.extend(report.gyro.into_iter().flat_map(|gyro| {
        [
            ("model", model.to_owned()),
            ("repeats", scenario.repeats.to_string()),
            ("seed", scenario.seed.to_string()),
            ("output rate", format!("{} Hz", plain(gyro.output_rate_hz))),
            (
                "proper frequency",
                format!("{} kHz", plain(gyro.proper_frequency_khz)),
            ),
            (
                "loop bandwidth",
                format!("{} Hz", plain(gyro.loop_bandwidth_hz)),
            ),
            ("loop gain", plain(gyro.loop_gain)),
        ]
    }));
    pairs.extend(report.log.into_iter().flat_map(|log| {
        [
            ("log", log.file.clone()),
            ("column", log.column.clone().unwrap_or_default()),
            ("unit", log.unit.clone()),
            ("samples", log.samples.to_string()),
            ("sample rate", format!("{} Hz", plain(log.sample_rate_hz))),
        ]
    }));
    pairs.retain(|(_, value)| !value.is_empty());
    html! {
        h1 { (name(report)) }
        @if let Some(description) = &scenario.description { p { (capital(description)) } }
        div.verdict { span class={ "pill " (class) } { (word) } span { (said) } }
        (facts(&pairs))
        @if let Some((_, point)) = &report.sweep {
            dl.facts { @for (key, value) in point { div { dt { code { (key) } } dd { (value) } } } }
        }
        nav aria-label="sections" {
            a href="#gates" { "Gates" } a href="#channels" { "Channels" } a href="#pictures" { "Pictures" }
            a href="#metrics" { "All metrics" }
            @if report.gyro.is_some() { a href="#budget" { "Noise budget" } }
            a href="#origin" { "Files and origin" }
        }
    }
}

/// Channels that failed, and what is worth saying.
fn failures(report: &RunReport) -> Option<Markup> {
    let failed = || {
        report
            .channels
            .iter()
            .filter_map(|(name, channel)| Some((name, channel.error.as_ref()?)))
    };
    (failed().next().is_some() || !report.notes.is_empty()).then(|| {
        section("notes", "Worth knowing", &html! {
            ul.notes {
                @for (name, failure) in failed() {
                    li { span.pill.fail { "FAILED" } " channel " b { (name) } " at sample " (failure.sample) ": " (failure.message) }
                }
                @for note in report.notes { li { (note) } }
            }
        })
    })
}

fn gates(report: &RunReport) -> Markup {
    let mut verdicts: Vec<&Verdict> = report.verdicts.iter().collect();
    let count = verdicts.len();
    if count > GATES_MAX {
        verdicts.sort_by_key(|verdict| verdict.accepted);
        verdicts.truncate(GATES_MAX);
    }
    let rows = verdicts.into_iter().map(|verdict| GateRow {
        run: None,
        verdict,
        assumption: report.assumption_behind(verdict.metric_name()),
    });
    let rows: Vec<GateRow> = rows.collect();
    section(
        "gates",
        "Gates",
        &html! {
            @if count == 0 { p.soft { "The scenario has no gates." } }
            @else { (gates_table(&rows, "gates")) }
            @if count > GATES_MAX { p { "The first " (GATES_MAX) " of " (count) " gates; all stand in " a href="summary.json" { "summary.json" } "." } }
        },
    )
}

fn channels(report: &RunReport) -> Markup {
    section("channels", "Channels", &main_metrics(report))
}

/// The verdict sentences of the filters beside the pictures.
fn drawn(report: &RunReport, shown: &[Shown], room: usize) -> Markup {
    let measured = report.measured();
    let sentences = measured.channels.iter();
    let sentences: Vec<(&String, String)> = sentences
        .filter_map(|(name, channel)| Some((name, verdict_text(channel)?)))
        .collect();
    let mut room = room.saturating_sub(sentences.iter().map(|(_, text)| text.len() + 100).sum());
    let all = pictures(shown, &mut room);
    section(
        "pictures",
        "What the filters do",
        &html! {
            @if sentences.is_empty() { p.soft { "No filter was judged." } (all) }
            @else {
                div.beside {
                    dl.words tabindex="0" aria-label="verdicts on the filters" {
                        @for (name, text) in &sentences { dt { (name) } dd { (capital(text)) "." } }
                    }
                    div { (all) }
                }
            }
        },
    )
}

fn more_metrics(report: &RunReport) -> Markup {
    section(
        "metrics",
        "All metrics",
        &html! { (all_metrics(report)) @if let Some(missing) = missing(report) { (missing) } },
    )
}

/// The closed form by source, and what the record says.
fn budget(report: &RunReport, gyro: &GyroFacts) -> Markup {
    let terms = &gyro.angle_random_walk_budget_deg_per_sqrt_h;
    let total = terms
        .iter()
        .find(|(source, _)| *source == TOTAL)
        .map_or(0.0, |(_, walk)| *walk);
    let share = |walk: f64| {
        if total > 0.0 {
            100.0 * (walk / total).powi(2)
        } else {
            0.0
        }
    };
    let simulated = report
        .channels
        .iter()
        .filter(|(name, _)| report.scenario.is_raw(name));
    let simulated =
        simulated.filter_map(|(name, channel)| Some((name, channel.get(&ANGLE_RANDOM_WALK)?)));
    let table = html! {
        table.sortable {
            thead { tr {
                th scope="col" { "source" }
                th.num scope="col" { "angle random walk" span.unit { "deg/sqrt(h)" } }
                th.num scope="col" { "share of the power" span.unit { "%" } }
                th scope="col" { span.soft { "drawn" } }
            } }
            tbody { @for (source, walk) in terms { tr {
                th scope="row" { (source) }
                td.num data-v=(by_value(*walk)) { (three_digits(*walk)) }
                td.num data-v=(by_value(share(*walk))) { (format!("{:.1}", share(*walk))) }
                td.share-cell { @if *source != TOTAL { span.share style=(format!("width:{:.1}%", share(*walk))) {} } }
            } } }
        }
    };
    section(
        "budget",
        "Noise budget",
        &html! {
            p { "White noise of the gyro in closed form, by source"
                @for (index, (name, metric)) in simulated.enumerate() {
                    @if index == 0 { "; the record gives " } @else { ", " }
                    b { (value_text(metric)) } " for " (name)
                }
                "." }
            (wide("noise budget", &table))
            @if let Some(said) = replacement(&gyro.replaced_noise_sources) { p { (said) "." } }
        },
    )
}

/// Published figures beside the simulated ones.
fn published(report: &RunReport) -> Option<Markup> {
    let figures = &report.scenario.published;
    (!figures.is_empty()).then(|| {
        let table = html! {
            table.sortable {
                thead { tr {
                    th scope="col" { "figure" }
                    th.num scope="col" { "published" }
                    th.num scope="col" { "simulated" }
                    th.num scope="col" { "difference" }
                    th scope="col" { "unit" }
                    th scope="col" { "source" }
                } }
                tbody { @for figure in figures { tr {
                    @let metric = simulated(figure, report.channels);
                    @let key = figure.metric.rsplit_once('.').map_or("", |(_, key)| key);
                    th scope="row" { code { (figure.metric) @if let Some(of) = &figure.relative_to { " / " (of) } } span.definition { (heading_of(key)) } }
                    td.num data-v=(by_value(figure.value)) { (figure.value) }
                    @match metric {
                        Some(metric) => {
                            td.num data-v=(by_value(metric.estimate.value)) { (value_text(&metric)) }
                            td.num { @if metric.unit == figure.unit || (metric.unit == "1" && figure.unit.is_empty()) {
                                (format!("{}{}", if metric.estimate.value < figure.value { "" } else { "+" }, three_digits(metric.estimate.value - figure.value)))
                            } @else { "other unit" } }
                        }
                        None => { td.num.soft data-v="" { "not measured" } td {} }
                    }
                    td { (unit_word(&figure.unit)) }
                    td {
                        (figure.source)
                        @if let Some(verdict) = judge_claim(figure, report.channels) {
                            span.definition { (verdict.kind.as_str()) ": " (verdict.reason) }
                        }
                    }
                } } }
            }
        };
        section("published", "Published beside simulated", &wide("published figures", &table))
    })
}

fn over_repeats(report: &RunReport) -> Option<Markup> {
    repeats(report).map(|body| section("repeats", "Repeats", &body))
}

/// Values that nobody set.
fn assumed(values: &[AssumedValue]) -> Markup {
    let table = html! {
        table.sortable #assumed-table {
            thead { tr {
                th scope="col" { "key" }
                th scope="col" { "value" }
                th scope="col" { "unit" }
                th scope="col" { "meaning" }
            } }
            tbody { @for value in values { tr {
                th scope="row" { code { (value.key) } }
                td { (value.value) " " span.pill.doubt { "assumed" } }
                td { (value.unit) }
                td.small.soft { (value.meaning) }
            } } }
        }
    };
    section(
        "assumed",
        "Assumed values",
        &html! {
            @if values.is_empty() { p.soft { "Every value was set." } }
            @else {
                p { "The scenario does not set these " (values.len()) " values; they are the program's defaults, and a \
                    result may rest on them." }
                details {
                    summary { "Show them" }
                    (filter("assumed-table", "gyro.noise"))
                    (wide("assumed values", &table))
                }
            }
        },
    )
}

fn origin(report: &RunReport, files: &[String]) -> Markup {
    let pairs = [
        ("scenario", report.scenario.name.clone()),
        ("file", report.file.to_owned()),
        ("seed", report.scenario.seed.to_string()),
        ("version", format!("fogbench {}", report.tool_version)),
        ("digest of the resolved scenario", report.digest.to_owned()),
    ];
    section(
        "origin",
        "Files and origin",
        &html! {
            (facts(&pairs))
            p { "The command " code { "fogbench run manifest.toml" } " repeats this run to the byte; the manifest holds the digests of \
                inputs and files." }
            h3 { "Beside this page" }
            ul.files { @for file in files { li { a href=(file) { (file) } } } }
        },
    )
}
