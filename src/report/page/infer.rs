//! `report.html` of an inference.

use maud::{Markup, html};

use super::document::{by_value, document, facts, maybe, section, wide};
use super::gates::unit_word;
use super::pictures::{Shown, capital, pictures};
use super::run::PAGE_BYTES_MAX;
use crate::gate::{plain, three_digits};
use crate::inference::{Confirmation, Confirmed, Explained, Judged, PrintedConfig};
use crate::report::infer::InferenceSheet;
use crate::report::infer::text::{answers, calibration_text, gate_text, repeats_text, ridge_text};
use crate::report::plot::Pictures;
use crate::report::plot::infer::INFER_PICTURES;

/// Most readings that are shown, and of those that are not accepted.
const READINGS_MAX: usize = 200;
const REFUSED_MAX: usize = 8;

/// The page of an inference with its pictures.
///
/// * `scenarios`: names of the ready scenarios beside it.
#[must_use]
pub fn infer_page(sheet: &InferenceSheet, drawn: &Pictures, scenarios: &[String]) -> String {
    let shown: Vec<Shown> = drawn
        .drawn
        .iter()
        .map(|(name, svg)| {
            let known = INFER_PICTURES.iter().find(|(known, _)| known == name);
            let holds = known.map_or("", |(_, holds)| *holds);
            Shown { name, holds, svg }
        })
        .collect();
    let before = html! {
        (maybe(gates(sheet))) (readings(sheet)) (figures(sheet))
    };
    let behind = html! {
        (maybe(ridges(sheet))) (maybe(experiments(sheet)))
        (maybe(sheet.confirmation.map(|own| confirmation(sheet, own))))
        (maybe(sheet.calibration.map(|own| {
            section("calibration", "Calibration", &html! { pre { (calibration_text(own).trim()) } })
        })))
        (origin(sheet, scenarios))
    };
    let mut room = PAGE_BYTES_MAX.saturating_sub(before.0.len() + behind.0.len() + 50_000);
    let drawn = section(
        "pictures",
        "Pictures",
        &html! {
            (pictures(&shown, &mut room))
            @for note in &drawn.notes { p.soft { (note) } }
        },
    );
    let title = format!("{} \u{2013} fogbench infer", sheet.problem.name);
    let foot = html! { p { "Written by fogbench " (env!("CARGO_PKG_VERSION")) ". The same problem, seed and version give the same bytes." } };
    document(
        &title,
        &head(sheet),
        &html! { (before) (drawn) (behind) },
        &foot,
    )
}

fn head(sheet: &InferenceSheet) -> Markup {
    let figures = &sheet.answer.figures;
    let (explained, told) = sheet.answer.explained();
    let class = if explained == told { "pass" } else { "fail" };
    let accepted = sheet.answer.accepted();
    let pairs = [
        ("file", sheet.file.to_owned()),
        ("figures", figures.len().to_string()),
        ("parameters", sheet.parameters.len().to_string()),
        ("readings", sheet.readings.len().to_string()),
        ("seed", sheet.problem.seed.to_string()),
        ("points", sheet.problem.points.to_string()),
        ("limit of a pull", three_digits(sheet.answer.pull_limit)),
    ];
    html! {
        h1 { (sheet.problem.name) }
        @if let Some(description) = &sheet.problem.description { p { (capital(description)) } }
        div.verdict {
            span class={ "pill " (class) } { (explained) " of " (told) " figures explained together" }
            span { (accepted.count()) " of " (sheet.readings.len()) " readings accepted" }
        }
        (facts(&pairs))
        nav aria-label="sections" {
            a href="#readings" { "Readings" } a href="#figures" { "Figures" } a href="#pictures" { "Pictures" }
            @if !sheet.answer.ridges.is_empty() { a href="#ridges" { "Not told apart" } }
            @if !sheet.answer.experiments.is_empty() { a href="#experiments" { "Experiments" } }
            @if sheet.confirmation.is_some() { a href="#confirmation" { "Confirmation" } }
            a href="#origin" { "Files and origin" }
        }
    }
}

fn gates(sheet: &InferenceSheet) -> Option<Markup> {
    (!sheet.gates.is_empty()).then(|| {
        section("gates", "Gates", &html! {
            ul.notes { @for gate in sheet.gates { li {
                @if gate.is_accepted() { span.pill.pass { "PASS" } } @else { span.pill.fail { "FAIL" } }
                " " (gate_text(gate))
            } } }
        })
    })
}

fn readings(sheet: &InferenceSheet) -> Markup {
    let all = &sheet.answer.readings;
    let accepted = sheet.answer.accepted().count();
    let shown = all.len().min(READINGS_MAX).min(accepted + REFUSED_MAX);
    let table = html! {
        table.sortable {
            thead { tr {
                th scope="col" { "verdict" }
                th.num scope="col" { "probability, %" }
                th scope="col" { "reading" }
                @for parameter in sheet.parameters {
                    th.num scope="col" { (parameter.name) span.unit { (parameter.unit) } }
                }
            } }
            tbody { @for (place, judged) in all.iter().take(shown).enumerate() { (reading_row(sheet, place, judged)) } }
        }
    };
    section(
        "readings",
        "Readings",
        &html! {
            p.soft { "Each parameter as median and 95 % interval under the reading. Accepted are the fewest readings that hold "
                (three_digits(sheet.answer.accepted_part)) " of the probability." }
            (wide("readings", &table))
            @if all.len() > shown { p.soft { (all.len() - shown) " more stand in infer.json." } }
        },
    )
}

fn reading_row(sheet: &InferenceSheet, place: usize, judged: &Judged) -> Markup {
    let answers = &sheet.readings[judged.reading].answers;
    html! { tr {
        td {
            @if judged.is_accepted { span.pill.pass { "accepted" } } @else { span.pill.doubt { "refused" } }
        }
        td.num data-v=(by_value(judged.weight)) { (format!("{:.2}", 100.0 * judged.weight)) }
        th scope="row" data-v=(place + 1) {
            "reading " (place + 1)
            @for (question, answer) in answers { span.definition { (question) ": " (answer) } }
            @if answers.is_empty() { span.definition { "as the scenarios say" } }
        }
        @for range in &judged.parameters {
            td.num data-v=(by_value(range.value)) {
                (three_digits(range.value)) " [" (three_digits(range.low)) ", " (three_digits(range.high)) "]"
            }
        }
    } }
}

fn figures(sheet: &InferenceSheet) -> Markup {
    let rows = sheet.problem.published.iter().zip(&sheet.answer.figures);
    let rows = rows.zip(sheet.lacks).enumerate();
    let table = html! {
        table.sortable {
            thead { tr {
                th.num scope="col" { "no." }
                th scope="col" { "verdict" }
                th scope="col" { "figure" }
                th.num scope="col" { "published" }
                th.num scope="col" { "from the others" }
                th.num scope="col" { "pull" }
                th scope="col" { "unit" }
            } }
            tbody { @for (index, ((printed, figure), lack)) in rows {
                (figure_row(index, printed, figure, lack.as_deref()))
            } }
        }
    };
    section("figures", "Figures", &wide("figures", &table))
}

fn figure_row(
    index: usize,
    printed: &PrintedConfig,
    figure: &Explained,
    lack: Option<&str>,
) -> Markup {
    let (word, class) = match figure.is_explained {
        Some(true) => ("explained", "pass"),
        Some(false) => ("UNEXPLAINED", "fail"),
        None => ("not told", "doubt"),
    };
    html! { tr {
        td.num data-v=(index + 1) { (index + 1) }
        td { span class={ "pill " (class) } { (word) } }
        th scope="row" {
            (printed.record) " " code { (printed.metric) }
            span.definition { (printed.source) @if let Some(lack) = lack { "; " (lack) } }
        }
        td.num data-v=(by_value(printed.value)) { (plain(printed.value)) }
        td.num data-v=(figure.predicted.map_or_else(String::new, |own| by_value(own.0))) {
            @if let Some((value, deviation)) = figure.predicted {
                (three_digits(value)) " \u{b1}" (three_digits(deviation))
            }
        }
        td.num data-v=(figure.pull.map_or_else(String::new, by_value)) {
            @if let Some(pull) = figure.pull { (format!("{pull:+.1}")) }
        }
        td { (unit_word(&printed.unit)) }
    } }
}

fn ridges(sheet: &InferenceSheet) -> Option<Markup> {
    (!sheet.answer.ridges.is_empty()).then(|| {
        section("ridges", "Not told apart", &html! {
            ul.notes { @for ridge in &sheet.answer.ridges { li { (capital(&ridge_text(sheet, ridge))) } } }
        })
    })
}

fn experiments(sheet: &InferenceSheet) -> Option<Markup> {
    let told = &sheet.answer.experiments;
    let table = html! {
        table.sortable {
            thead { tr {
                th.num scope="col" { "information, bit" }
                th scope="col" { "experiment" }
                th scope="col" { "figure" }
                th.num scope="col" { "least" }
                th.num scope="col" { "greatest" }
                th.num scope="col" { "scatter" }
            } }
            tbody { @for own in told { tr {
                @let experiment = &sheet.problem.experiments[own.experiment];
                td.num data-v=(by_value(own.information_bit)) { (format!("{:.1}", own.information_bit)) }
                th scope="row" { (experiment.name) }
                td { (experiment.record) " " code { (experiment.metric) } }
                td.num data-v=(by_value(own.outcomes.0)) { (three_digits(own.outcomes.0)) }
                td.num data-v=(by_value(own.outcomes.1)) { (three_digits(own.outcomes.1)) }
                td.num data-v=(by_value(own.deviation)) { (three_digits(own.deviation)) }
            } } }
        }
    };
    (!told.is_empty()).then(|| {
        section(
            "experiments",
            "Experiments that would tell most",
            &wide("experiments", &table),
        )
    })
}

fn confirmation(sheet: &InferenceSheet, confirmation: &Confirmation) -> Markup {
    let (agreeing, all) = confirmation.agreeing();
    section(
        "confirmation",
        "Confirmation",
        &html! {
            p { (agreeing) " of " (all) " forecasts agree with simulated records: each "
                (repeats_text(confirmation)) "." }
            @for candidate in &confirmation.candidates {
                h3 { (candidate.name) }
                p.soft { @for (parameter, part) in sheet.parameters.iter().zip(&candidate.parts) {
                    (parameter.name) " " (three_digits(parameter.at(*part))) " " (parameter.unit) "; "
                } (answers(&sheet.readings[candidate.reading])) }
                @let table = html! {
                    table.sortable {
                        thead { tr {
                            th scope="col" { "verdict" }
                            th scope="col" { "figure" }
                            th.num scope="col" { "published" }
                            th.num scope="col" { "predicted" }
                            th.num scope="col" { "rate model" }
                            th.num scope="col" { "loop model" }
                            th.num scope="col" { "pull" }
                        } }
                        tbody { @for (printed, figure) in sheet.problem.published.iter().zip(&candidate.figures) {
                            (confirmed_row(printed, figure, confirmation.repeats))
                        } }
                    }
                };
                (wide(&candidate.name, &table))
            }
        },
    )
}

fn confirmed_row(printed: &PrintedConfig, figure: &Confirmed, repeats: u32) -> Markup {
    let (word, class) = match figure.agrees(repeats) {
        Some(true) => ("agrees", "pass"),
        Some(false) => ("DISAGREES", "fail"),
        None => ("simulated", "doubt"),
    };
    let number = |value: Option<f64>| value.map_or_else(String::new, three_digits);
    html! { tr {
        td { span class={ "pill " (class) } { (word) } }
        th scope="row" { (printed.record) " " code { (printed.metric) } }
        td.num { (plain(printed.value)) }
        td.num { (number(figure.predicted.map(|own| own.value))) }
        td.num {
            (number(figure.rate_model.map(|own| own.value)))
            @if let Some(own) = figure.rate_model { " [" (three_digits(own.low)) ", " (three_digits(own.high)) "]" }
        }
        td.num { (number(figure.loop_model.map(|own| own.value))) }
        td.num { @if let Some(pull) = figure.pull(printed.value) { (format!("{pull:+.1}")) } }
    } }
}

fn origin(sheet: &InferenceSheet, scenarios: &[String]) -> Markup {
    let pairs = [
        ("problem", sheet.file.to_owned()),
        ("version", format!("fogbench {}", env!("CARGO_PKG_VERSION"))),
        ("forecasts made", sheet.answer.forecasts.to_string()),
    ];
    section(
        "origin",
        "Files and origin",
        &html! {
            (facts(&pairs))
            ul.files { @for name in ["infer.json", "infer.txt"] { li { a href=(name) { (name) } } } }
            @if !scenarios.is_empty() {
                p { "Ready scenarios, for " code { "fogbench run" } ":" }
                ul.files { @for name in scenarios { li { a href=(name) { (name) } } } }
            }
        },
    )
}
