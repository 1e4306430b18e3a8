//! `index.html`: a suite in one file.

use std::collections::{BTreeMap, BTreeSet};

use maud::{Markup, html};

use super::against::comparison_section;
use super::document::{by_value, document, facts, filter, maybe, section, wide};
use super::gates::{GateRow, gates_table};
use super::pictures::{Shown, pictures};
use super::run::{PAGE_BYTES_MAX, status_word};
use crate::comparison::{ComparedTable, Comparison};
use crate::gate::{Verdict, VerdictKind, count_accepted, plain};
use crate::report::json::suite::SuiteReport;
use crate::report::record::columns::value_text;
use crate::report::record::sweep::swept_text;
use crate::report::{FILTERS, RunOutcome, RunStatus, SweepPictures};

/// Most points of a sweep that the page lists.
const POINTS_MAX: usize = 500;
/// Most runs that are no points that the page lists, and most gates.
const RUNS_MAX: usize = 1000;
const GATES_MAX: usize = 300;
/// Bytes that tables may take; pictures take what is left.
const TABLE_BYTES_MAX: usize = 1_500_000;
const RESERVE_BYTES: usize = 50_000;

/// The page of a suite; `files` are the files of its tables, name and text, `drawn` the pictures of its
/// sweeps.
#[must_use]
pub fn suite_page(
    suite: &SuiteReport,
    files: &[(String, String)],
    drawn: &[SweepPictures],
) -> String {
    let (sweeps, alone) = grouped(suite.runs);
    let mut left = TABLE_BYTES_MAX;
    let head = head(suite, &sweeps);
    let gates = failed_gates(suite.runs);
    let runs = runs(&alone, suite.runs.len(), &mut left);
    let swept: Vec<Markup> = sweeps
        .iter()
        .map(|(name, points)| sweep(name, points, &mut left))
        .collect();
    let tables = tables(suite.across);
    let behind = html! { (maybe(assumptions(suite.across))) (origin(suite, files)) };
    let against = suite.against.as_ref().map(comparison_section);
    let against = maybe(against);
    let used = [&head, &against, &gates, &runs, &tables, &behind].into_iter();
    let used = used.chain(&swept).map(|part| part.0.len()).sum::<usize>() + RESERVE_BYTES;
    let mut room = PAGE_BYTES_MAX.saturating_sub(used);
    let sweeps = html! { @for ((name, _), table) in sweeps.iter().zip(&swept) {
        (section(&format!("sweep-{name}"), &format!("Sweep {name}"), &html! {
            (table)
            @for own in drawn.iter().filter(|own| own.sweep == *name) { (sweep_pictures(own, &mut room)) }
        }))
    } };
    let shown = files.iter().filter(|(name, _)| name.ends_with(".svg"));
    let shown: Vec<Shown> = shown
        .map(|(name, svg)| Shown {
            name,
            holds: holds(name),
            svg,
        })
        .collect();
    let drawn = pictures(&shown, &mut room);
    let tables = html! {
        @if !suite.across.tables.is_empty() {
            (section("tables", "Across scenarios", &html! { (tables) (drawn) }))
        }
    };
    let body = html! { (against) (gates) (runs) (sweeps) (tables) (behind) };
    let foot = html! { p { "Written by fogbench " (suite.tool_version) ". The same scenarios, seeds and version give the same bytes." } };
    document("fogbench results", &head, &body, &foot)
}

/// What a picture of a suite shows.
fn holds(name: &str) -> &'static str {
    if name.starts_with("published") {
        "published and simulated figures"
    } else {
        "change with what is assumed"
    }
}

/// Points of a sweep.
type Points<'a> = Vec<&'a RunOutcome>;

/// Sweeps by name in the order of the suite, and the runs that are no points.
fn grouped(runs: &[RunOutcome]) -> (Vec<(&str, Points<'_>)>, Points<'_>) {
    let mut sweeps: Vec<(&str, Points)> = Vec::new();
    let mut alone = Vec::new();
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    for run in runs {
        if run.sweep.is_none() {
            alone.push(run);
            continue;
        }
        let place = *places.entry(&run.name).or_insert_with(|| {
            sweeps.push((&run.name, Vec::new()));
            sweeps.len() - 1
        });
        sweeps[place].1.push(run);
    }
    (sweeps, alone)
}

fn head(suite: &SuiteReport, sweeps: &[(&str, Points)]) -> Markup {
    let with = |status: RunStatus| {
        suite
            .runs
            .iter()
            .filter(|run| run.status() == status)
            .count()
    };
    let total = suite.runs.len();
    let passed = with(RunStatus::Pass);
    let failed = suite.against.map_or(0, |it| it.judged.failed().count());
    let (word, class) = if passed == total && failed == 0 {
        ("PASS", "pass")
    } else {
        ("FAIL", "fail")
    };
    let gates: usize = suite.runs.iter().map(|run| run.verdicts.len()).sum();
    let accepted: usize = suite
        .runs
        .iter()
        .map(|run| count_accepted(&run.verdicts))
        .sum();
    let mut pairs = vec![("runs", total.to_string()), ("passed", passed.to_string())];
    for (name, status) in [
        ("with a failed gate", RunStatus::GateFailed),
        ("with a failed channel", RunStatus::ChannelFailed),
        ("failed", RunStatus::RunFailed),
        ("not run", RunStatus::NotRun),
    ] {
        if with(status) > 0 {
            pairs.push((name, with(status).to_string()));
        }
    }
    if suite.against.is_some() {
        pairs.push(("figures that fail against the baseline", failed.to_string()));
    }
    pairs.push(("gates accepted", format!("{accepted} of {gates}")));
    html! {
        h1 { "Results of fogbench" }
        div.verdict { span class={ "pill " (class) } { (word) } span { (passed) " of " (total) " runs passed" } }
        (facts(&pairs))
        nav aria-label="sections" {
            @if suite.against.is_some() { a href="#against" { "Against the baseline" } }
            @if gates > 0 { a href="#gates" { "Gates" } }
            a href="#runs" { "Runs" }
            @for (name, _) in sweeps { a href=(format!("#sweep-{name}")) { (name) } }
            @if !suite.across.tables.is_empty() { a href="#tables" { "Across scenarios" } }
            @if !suite.across.beside.is_empty() { a href=(FILTERS.name) { "Filters side by side" } }
            a href="#origin" { "Files" }
        }
    }
}

/// Gates that were not accepted; the others by their number.
fn failed_gates(runs: &[RunOutcome]) -> Markup {
    let all = || {
        runs.iter()
            .flat_map(|run| run.verdicts.iter().map(move |verdict| (run, verdict)))
    };
    let failed: Vec<(&RunOutcome, &Verdict)> =
        all().filter(|(_, verdict)| !verdict.accepted).collect();
    let undecided = all()
        .filter(|(_, it)| it.accepted && it.kind == VerdictKind::Inconclusive)
        .count();
    let rows = failed.iter().take(GATES_MAX).map(|(run, verdict)| GateRow {
        run: Some(link(run)),
        verdict,
        assumption: None,
    });
    let rows: Vec<GateRow> = rows.collect();
    section(
        "gates",
        "Gates that failed",
        &html! {
            @if failed.is_empty() { p { "None of " (all().count()) "." } }
            @else { (gates_table(&rows, "gates that failed")) }
            @if failed.len() > GATES_MAX { p { "The first " (GATES_MAX) " of " (failed.len()) "; all stand in " a href="junit.xml" { "junit.xml" } "." } }
            @if undecided > 0 { p.soft { (undecided) " more were inconclusive, which their scenarios allow." } }
        },
    )
}

/// A run by its name, which leads to its page, or else to its summary.
fn link(run: &RunOutcome) -> Markup {
    let file = if run.has_page {
        "report.html"
    } else {
        "summary.json"
    };
    html! {
        @if run.is_not_run { (run.folder) }
        @else { a href=(format!("{}/{file}", run.folder)) { (run.folder) } }
    }
}

/// Runs that are no points of a sweep.
fn runs(alone: &[&RunOutcome], total: usize, left: &mut usize) -> Markup {
    let mut rows: Vec<&RunOutcome> = alone.to_vec();
    if rows.len() > RUNS_MAX {
        rows.sort_by_key(|run| run.status() == RunStatus::Pass);
        rows.truncate(RUNS_MAX);
    }
    let rows = affordable(rows.into_iter().map(run_row), left);
    let table = html! {
        table.sortable #runs-table {
            thead { tr {
                th scope="col" { "outcome" }
                th scope="col" { "run" }
                th.num scope="col" { "gates" }
                th scope="col" { "figures" }
            } }
            tbody { @for row in &rows { (row) } }
        }
    };
    section(
        "runs",
        "Runs",
        &html! {
            @if alone.is_empty() { p.soft { "All " (total) " runs are points of sweeps." } }
            @else {
                (filter("runs-table", "name, outcome, figure"))
                (wide("runs", &table))
                @if rows.len() < alone.len() {
                    p { (rows.len()) " of " (alone.len()) " runs; all stand in " a href="metrics.csv" { "metrics.csv" } "." }
                }
            }
        },
    )
}

/// As many rows as there is room for.
fn affordable(rows: impl Iterator<Item = Markup>, left: &mut usize) -> Vec<Markup> {
    let mut taken = Vec::new();
    for row in rows {
        if row.0.len() > *left {
            break;
        }
        *left -= row.0.len();
        taken.push(row);
    }
    taken
}

fn outcome_cells(run: &RunOutcome) -> Markup {
    let (word, class) = status_word(run.status());
    html! {
        td { span class={ "pill " (class) } { (word) } }
    }
}

fn gates_cell(run: &RunOutcome) -> Markup {
    let accepted = count_accepted(&run.verdicts);
    html! {
        td.num data-v=(accepted) { @if run.verdicts.is_empty() { "\u{2013}" } @else { (accepted) " of " (run.verdicts.len()) } }
    }
}

fn run_row(run: &RunOutcome) -> Markup {
    html! { tr {
        (outcome_cells(run))
        th scope="row" {
            (link(run))
            @if let Some(description) = &run.description { span.definition { (description) } }
        }
        (gates_cell(run))
        td.figures { (figures(run)) }
    } }
}

/// The figures of every channel, those of the first in sight.
fn figures(run: &RunOutcome) -> Markup {
    let line = |figures: &[(String, String)]| {
        let figures = figures
            .iter()
            .map(|(title, value)| format!("{title} {value}"));
        figures.collect::<Vec<_>>().join(" \u{b7} ")
    };
    html! {
        @if let Some(error) = &run.error { (error) }
        @for channel in &run.channels {
            @if let Some(failure) = &channel.failure { div { b { (channel.name) } " failed: " (failure.message) } }
        }
        @if let Some((first, others)) = run.channels.split_first() {
            @if others.is_empty() { b { (first.name) } " " (line(&first.headline)) }
            @else {
                details {
                    summary { b { (first.name) } " " (line(&first.headline)) }
                    @for channel in others.iter().filter(|channel| channel.failure.is_none()) {
                        div { b { (channel.name) } " " (line(&channel.headline)) }
                    }
                }
            }
        }
    }
}

/// Points of a sweep that the page lists: all, or those that failed, then the extreme ones and the others
/// evenly, in the order of the sweep.
fn chosen<'a>(points: &[&'a RunOutcome]) -> Vec<&'a RunOutcome> {
    if points.len() <= POINTS_MAX {
        return points.to_vec();
    }
    let has_failed = |index: usize| points[index].has_failed();
    let failed: Vec<usize> = (0..points.len())
        .filter(|index| has_failed(*index))
        .take(POINTS_MAX)
        .collect();
    let evenly = (0..POINTS_MAX).map(|step| step * (points.len() - 1) / (POINTS_MAX - 1));
    let mut others = BTreeSet::new();
    for index in extremes(points).into_iter().chain(evenly) {
        if failed.len() + others.len() == POINTS_MAX {
            break;
        }
        if !has_failed(index) {
            others.insert(index);
        }
    }
    failed
        .into_iter()
        .chain(others)
        .map(|index| points[index])
        .collect()
}

/// The points at which a figure of a channel is least or most.
fn extremes(points: &[&RunOutcome]) -> Vec<usize> {
    let mut ends: BTreeMap<(usize, usize), [(f64, usize); 2]> = BTreeMap::new();
    for (index, run) in points.iter().enumerate() {
        for (channel, outcome) in run.channels.iter().enumerate() {
            for (figure, (_, text)) in outcome.headline.iter().enumerate() {
                let number = text
                    .split(' ')
                    .next()
                    .and_then(|word| word.parse::<f64>().ok());
                let Some(value) = number else { continue };
                let [least, most] = ends.entry((channel, figure)).or_insert([(value, index); 2]);
                if value < least.0 {
                    *least = (value, index);
                }
                if value > most.0 {
                    *most = (value, index);
                }
            }
        }
    }
    ends.into_values()
        .flatten()
        .map(|(_, index)| index)
        .collect()
}

/// The table of a sweep: a column for each key, then the figures.
fn sweep(name: &str, points: &[&RunOutcome], left: &mut usize) -> Markup {
    let set = points.iter().filter_map(|run| run.sweep.as_ref());
    let keys: Vec<&String> = set
        .clone()
        .take(1)
        .flat_map(|(_, set)| set.iter().map(|(key, _)| key))
        .collect();
    let rows = affordable(chosen(points).into_iter().map(point_row), left);
    let id = format!("points-{name}");
    let passed = points
        .iter()
        .filter(|run| run.status() == RunStatus::Pass)
        .count();
    let table = html! {
        table.sortable id=(id) {
            thead { tr {
                th scope="col" { "point" }
                @for key in &keys { th.num scope="col" { code { (key) } } }
                th scope="col" { "outcome" }
                th.num scope="col" { "gates" }
                th scope="col" { "figures" }
            } }
            tbody { @for row in &rows { (row) } }
        }
    };
    let heading = format!("Sweep {name}");
    html! {
        p { (passed) " of " (points.len()) " points passed."
            @if rows.len() < points.len() {
                " The table has " (rows.len()) " of them, those that failed first, then the extreme ones; all stand in "
                a href="metrics.csv" { "metrics.csv" } "."
            } }
        (filter(&id, "value, outcome, figure"))
        (wide(&heading, &table))
    }
}

/// The pictures of a sweep, which lie in its folder.
fn sweep_pictures(own: &SweepPictures, room: &mut usize) -> Markup {
    let places = own.drawn.iter();
    let places: Vec<String> = places
        .map(|[name, ..]| format!("{}/{name}", own.sweep))
        .collect();
    let shown = places.iter().zip(&own.drawn);
    let shown: Vec<Shown> = shown
        .map(|(name, [_, holds, svg])| Shown { name, holds, svg })
        .collect();
    html! {
        @if !shown.is_empty() { h3 { "Over what is swept" } }
        (pictures(&shown, room))
        @for note in &own.notes { p.soft { (note) } }
    }
}

fn point_row(run: &RunOutcome) -> Markup {
    let set = run.sweep.iter().flat_map(|(_, set)| set);
    let values = set.map(|(_, toml)| swept_text(toml));
    html! { tr {
        th scope="row" { (link(run)) }
        @for value in values { td.num data-v=(value) { (value) } }
        (outcome_cells(run))
        (gates_cell(run))
        td.figures { (figures(run)) }
    } }
}

/// Tables over several scenarios.
fn tables(across: &Comparison) -> Markup {
    html! { @for table in &across.tables { (compared(table)) } }
}

fn compared(table: &ComparedTable) -> Markup {
    let rows = html! {
        table.sortable {
            thead { tr {
                th scope="col" { "row" }
                @for column in &table.columns { th.num scope="col" { (column.text()) } }
            } }
            tbody { @for row in &table.rows { tr {
                th scope="row" { (row.label) }
                @for cell in &row.cells {
                    @match cell {
                        Some(cell) => td.num data-v=(by_value(cell.simulated.estimate.value)) {
                            (value_text(&cell.simulated))
                            @if let Some((published, source)) = &cell.published {
                                span.definition title=(source) { "published " (plain(*published)) }
                            }
                        },
                        None => td.num.soft data-v="" { "\u{2013}" },
                    }
                }
            } } }
        }
    };
    html! {
        h3 { (table.name) ": " (table.title) }
        (wide(&table.name, &rows))
        @if !table.lacking.is_empty() { ul.notes.soft { @for lack in &table.lacking { li { (lack) } } } }
    }
}

/// What a publication leaves open.
fn assumptions(across: &Comparison) -> Option<Markup> {
    (!across.assumptions.is_empty()).then(|| {
        section("assumptions", "What the publication leaves open", &html! {
            dl.words { @for assumed in &across.assumptions {
                dt { code { (assumed.key) } @if !assumed.values.is_empty() { " = " (assumed.values.join(" or ")) } " " span.pill.doubt { "assumed" } }
                dd { (assumed.statement) div.soft { (assumed.silence) } div.soft { (assumed.alternatives) } }
            } }
        })
    })
}

fn origin(suite: &SuiteReport, tables: &[(String, String)]) -> Markup {
    let pairs = [("version", format!("fogbench {}", suite.tool_version))];
    let names = ["summary.json", "metrics.csv", "junit.xml"].into_iter();
    let beside = (!suite.across.beside.is_empty()).then_some(FILTERS.name);
    let names = names.chain(beside);
    let names = names.chain(tables.iter().map(|(name, _)| name.as_str()));
    section(
        "origin",
        "Files and origin",
        &html! {
            (facts(&pairs))
            p { "Each run's page and " code { "manifest.toml" } " name its scenario, seed and digests." }
            ul.files { @for name in names { li { a href=(name) { (name) } } } }
            @if !suite.stale.is_empty() {
                p { "Folders that hold results of earlier scenarios: " (suite.stale.join(", ")) "." }
            }
        },
    )
}
