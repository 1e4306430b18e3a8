//! A comparison with earlier results: a page of its own, and a section of the page of a suite.

use std::collections::{BTreeMap, BTreeSet};

use maud::{Markup, html};

use super::document::{by_value, document, facts, filter, section, wide};
use super::gates::{Scale, WIDTH, pixels_text, unit_word};
use super::pictures::figure_of_page;
use super::run::PAGE_BYTES_MAX;
use crate::baseline::{Entry, Id, Interval, Judged, Limits, Outcome, Point, Row, Side};
use crate::report::baseline::rows::{ComparedSides, change, counts, figure, grounds, unit};
use crate::report::plot::against::{Overlaid, picture};

/// Figures that a page lists; what says nothing comes last.
const ROWS_MAX: usize = 1000;
/// Figures that a page of a suite lists, and pictures that it shows.
const NOTABLE_MAX: usize = 300;
const PICTURES_MAX: usize = 20;
/// Bytes that the pictures of a section may take.
const SECTION_BYTES_MAX: usize = 250_000;
/// Mark of a page of its own, by which it is known.
const TITLE: &str = "fogbench comparison";

/// Height of the picture of two figures, user units.
const HEIGHT: f64 = 30.0;

/// The page of a comparison.
#[must_use]
pub fn comparison_page(compared: &ComparedSides) -> String {
    let Judged {
        comparison,
        fail_on,
    } = compared.judged;
    let (word, class) = if compared.judged.has_failed() {
        ("FAIL", "fail")
    } else {
        ("PASS", "pass")
    };
    let head = html! {
        h1 { "Compared with earlier results" }
        div.verdict { span class={ "pill " (class) } { (word) } span { (counts(comparison)) } }
        (facts(&[
            ("earlier results by fogbench", comparison.old_version.clone()),
            ("later by", comparison.new_version.clone()),
            ("fails on", fail_on.iter().map(|outcome| outcome.as_str()).collect::<Vec<_>>().join(", ")),
        ]))
    };
    let figures = section(
        "figures",
        "Figures",
        &figures(compared, ROWS_MAX, "figures-table"),
    );
    let room = PAGE_BYTES_MAX.saturating_sub(figures.0.len() + head.0.len() + 50_000);
    let curves = overlaid(compared, room);
    let body = html! {
        (figures)
        @if !curves.0.is_empty() { (section("curves", "Allan deviations", &curves)) }
    };
    let foot = html! { p { "The same two results give the same bytes." } };
    document(TITLE, &head, &body, &foot)
}

/// Whether a text is such a page.
#[must_use]
pub fn is_comparison_page(text: &str) -> bool {
    text.contains(&format!("<title>{TITLE}</title>"))
}

/// The section of a suite's page.
pub(super) fn comparison_section(compared: &ComparedSides) -> Markup {
    let body = html! {
        p { (counts(compared.judged.comparison)) }
        (figures(compared, NOTABLE_MAX, "against-table"))
        (overlaid(compared, SECTION_BYTES_MAX))
    };
    section("against", "Against the baseline", &body)
}

/// The figures as a table, the worst first.
fn figures(compared: &ComparedSides, most: usize, id: &str) -> Markup {
    let mut rows: Vec<&Row> = compared.judged.comparison.rows.iter().collect();
    rows.sort_by_key(|row| std::cmp::Reverse(row.outcome));
    let total = rows.len();
    rows.truncate(most);
    let table = html! {
        table.sortable id=(id) {
            thead { tr {
                th scope="col" { "outcome" }
                th scope="col" { "figure" }
                th.num scope="col" { "was" }
                th.num scope="col" { "is" }
                th.num scope="col" { "change" }
                th scope="col" { "before / now" }
            } }
            tbody { @for row in &rows { (figure_row(row, compared)) } }
        }
    };
    html! {
        @if rows.is_empty() { p.soft { "No figure stands on either side." } }
        @else {
            (filter(id, "outcome, run, metric"))
            p.soft.small { "Bars: before above, now below, what a gate accepts behind them." }
            (wide("figures compared", &table))
            @if rows.len() < total { p { "The first " (rows.len()) " of " (total) " figures, the worst first; " code { "compare --format json" } " lists all." } }
        }
    }
}

fn figure_row(row: &Row, compared: &ComparedSides) -> Markup {
    let value = |entry: &Option<Entry>| {
        let value = entry.as_ref().map(|entry| by_value(entry.value));
        value.unwrap_or_default()
    };
    let relative = row
        .difference
        .zip(row.old.as_ref())
        .filter(|(_, old)| old.value != 0.0);
    let relative = relative.map(|(difference, old)| by_value(difference / old.value.abs()));
    let unit_of = |entry: &Option<Entry>| {
        html! { @if entry.is_some() { " " span.unit { (unit_word(unit(row))) } } }
    };
    html! { tr {
        td data-v=(severity(row.outcome)) { span class={ "pill " (class(row.outcome)) } { (row.outcome.as_str()) } }
        th scope="row" {
            div { (row.id.run_text()) } code { (row.id.channel) "." (row.id.metric) }
            span.definition { (grounds(row)) }
        }
        td.num data-v=(value(&row.old)) { (figure(row.old.as_ref())) (unit_of(&row.old)) }
        td.num data-v=(value(&row.new)) { (figure(row.new.as_ref())) (unit_of(&row.new)) }
        td.num data-v=(relative.unwrap_or_default()) { (change(row).unwrap_or_default()) }
        td data-v="" { (bars(row, compared)) }
    } }
}

/// Place of an outcome among all, the worst first.
fn severity(outcome: Outcome) -> usize {
    let place = Outcome::ALL.iter().position(|other| *other == outcome);
    place.unwrap_or(Outcome::ALL.len())
}

/// Colour of an outcome.
fn class(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Worse | Outcome::Removed => "fail",
        Outcome::Better => "pass",
        Outcome::Changed | Outcome::Unsure | Outcome::ChangedScenario | Outcome::New => "doubt",
        Outcome::Same => "soft",
    }
}

/// The two figures with their intervals on one scale, before the part that a gate accepts.
fn bars(row: &Row, compared: &ComparedSides) -> Markup {
    let limits = compared.new.limits.get(&row.id);
    let limits = limits.or_else(|| compared.old.limits.get(&row.id));
    let Limits { min, max } = limits.copied().unwrap_or(Limits {
        min: None,
        max: None,
    });
    let drawn = [&row.old, &row.new].map(|entry| entry.as_ref().map(ends));
    let all = drawn.iter().flatten().flatten().copied();
    let all = all.chain([min, max].into_iter().flatten());
    let Some(scale) = Scale::over(all).filter(|scale| !scale.is_point) else {
        return html! {};
    };
    let x = |at: f64| pixels_text(scale.x(at));
    let zone = scale.between(min, max);
    let is_gated = min.is_some() || max.is_some();
    let label = format!(
        "was {}, is {}",
        figure(row.old.as_ref()),
        figure(row.new.as_ref())
    );
    html! {
        svg.bar viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(label) {
            title { (label) }
            @if is_gated { rect.zone x=(pixels_text(zone.0)) y="2" width=(pixels_text((zone.1 - zone.0).max(1.0))) height=(HEIGHT - 4.0) {} }
            @for limit in [min, max].into_iter().flatten() { line.limit x1=(x(limit)) x2=(x(limit)) y1="1" y2=(HEIGHT - 1.0) {} }
            @for (ends, y, class) in [(drawn[0], 10.0, "before"), (drawn[1], 20.0, "now")] {
                @if let Some([low, value, high]) = ends {
                    g class=(class) {
                        line.interval x1=(x(low)) x2=(x(high)) y1=(y) y2=(y) {}
                        circle.value cx=(x(value)) cy=(y) r="3" {}
                    }
                }
            }
        }
    }
}

/// Lower end, value and upper end.
fn ends(entry: &Entry) -> [f64; 3] {
    match entry.interval {
        Interval::Confidence { low, high } => [low, entry.value, high],
        Interval::Exact | Interval::Absent => [entry.value; 3],
    }
}

/// Allan deviations of both sides in one picture for each run that both have curves of: those in which
/// something differs first.
fn overlaid(compared: &ComparedSides, room: usize) -> Markup {
    let differs: BTreeSet<(&str, &Point)> = compared
        .judged
        .comparison
        .rows
        .iter()
        .filter(|row| row.outcome != Outcome::Same)
        .map(|row| (row.id.scenario.as_str(), &row.id.point))
        .collect();
    let mut runs: BTreeMap<(bool, &str, &Point), Vec<&Id>> = BTreeMap::new();
    for id in compared.new.curves.keys() {
        let run = (id.scenario.as_str(), &id.point);
        let key = (!differs.contains(&run), run.0, run.1);
        runs.entry(key).or_default().push(id);
    }
    let both = runs
        .values()
        .filter(|ids| ids.iter().any(|id| compared.old.curves.contains_key(id)));
    let drawn = both.take(PICTURES_MAX).filter_map(|ids| {
        let channels: Vec<Overlaid> = ids
            .iter()
            .map(|id| Overlaid {
                name: &id.channel,
                old: curve(compared.old, id),
                new: curve(compared.new, id),
            })
            .collect();
        let title = ids.first()?.run_text();
        Some((title.clone(), picture(&title, &channels)?.svg()?))
    });
    let mut left = room;
    let mut fits = |svg: &str| {
        let fits = svg.len() <= left;
        left -= if fits { svg.len() } else { 0 };
        fits
    };
    html! {
        @for (title, svg) in drawn {
            @if fits(&svg) { (figure_of_page("Allan deviation, before and now", &title, &svg)) }
        }
    }
}

/// The curve of a channel; empty if there is none.
fn curve<'a>(side: &'a Side, id: &Id) -> &'a [(f64, f64)] {
    side.curves.get(id).map_or(&[], Vec::as_slice)
}
