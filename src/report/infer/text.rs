//! What figures say of the settings behind them, as text.

use std::fmt::Write as _;

use super::InferenceSheet;
use crate::gate::{limits_text, plain};
use crate::inference::{
    Calibration, Confirmation, Confirmed, Explained, Judged, JudgedGate, PrintedConfig, Reading,
    Ridge, Shifted,
};
use crate::metrics::three_digits;

/// Most readings of the text that are not accepted.
const OTHERS_SHOWN: usize = 5;
/// Width of an interval over the prior's from which the figures say nothing.
const UNTOLD: f64 = 0.9;

/// The answer as text.
#[must_use]
pub fn infer_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    let answer = sheet.answer;
    let accepted = answer.accepted().count();
    line(
        &mut text,
        format_args!(
            "{}: {} figures, {} parameters, {} readings",
            sheet.problem.name,
            sheet.problem.published.len(),
            sheet.parameters.len(),
            sheet.readings.len()
        ),
    );
    line(
        &mut text,
        format_args!(
            "accepted {accepted} of {} readings: the fewest that hold {:.3} of the probability",
            sheet.readings.len(),
            answer.accepted_part
        ),
    );
    for (place, judged) in answer.readings.iter().enumerate() {
        if judged.is_accepted || place < accepted + OTHERS_SHOWN {
            text.push_str(&reading_text(sheet, judged));
        }
    }
    let hidden = answer
        .readings
        .len()
        .saturating_sub(accepted + OTHERS_SHOWN);
    if hidden > 0 {
        line(
            &mut text,
            format_args!("  and {hidden} more, in infer.json"),
        );
    }
    text.push('\n');
    text.push_str(&figures_text(sheet));
    text.push_str(&ridges_text(sheet));
    text.push_str(&experiments_text(sheet));
    if let Some(calibration) = sheet.calibration {
        text.push_str(&calibration_text(calibration));
    }
    if let Some(confirmation) = sheet.confirmation {
        text.push_str(&confirmation_text(sheet, confirmation));
    }
    if !sheet.gates.is_empty() {
        line(&mut text, format_args!("\nGates"));
    }
    for gate in sheet.gates {
        let word = if gate.is_accepted() { "PASS" } else { "FAIL" };
        line(&mut text, format_args!("  {word} {}", gate_text(gate)));
    }
    text
}

fn line(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{arguments}");
}

/// Answers of a reading in words.
pub(in crate::report) fn answers(reading: &Reading) -> String {
    let answers = reading.answers.iter();
    let answers: Vec<String> = answers
        .map(|(question, answer)| format!("{question}: {answer}"))
        .collect();
    if answers.is_empty() {
        "as the scenarios say".to_owned()
    } else {
        answers.join("; ")
    }
}

fn reading_text(sheet: &InferenceSheet, judged: &Judged) -> String {
    let mut text = String::new();
    line(
        &mut text,
        format_args!(
            "  {} {:>8}  {}",
            if judged.is_accepted {
                "accepted"
            } else {
                "refused "
            },
            format!("{:.2} %", 100.0 * judged.weight),
            answers(&sheet.readings[judged.reading])
        ),
    );
    if judged.is_accepted {
        for (parameter, range) in sheet.parameters.iter().zip(&judged.parameters) {
            let note = if range.share > UNTOLD {
                ", which is all that was allowed: the figures say nothing of it"
            } else {
                ""
            };
            line(
                &mut text,
                format_args!(
                    "      {} {} [{}, {}]{}{note}",
                    parameter.name,
                    three_digits(range.value),
                    three_digits(range.low),
                    three_digits(range.high),
                    behind(parameter.unit)
                ),
            );
        }
    }
    text
}

fn figures_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    let (explained, told) = sheet.answer.explained();
    line(
        &mut text,
        format_args!(
            "Figures: {explained} of {told} explained together, each forecast from all others (limit of the \
         pull {:.2})",
            sheet.answer.pull_limit
        ),
    );
    let rows = sheet
        .problem
        .published
        .iter()
        .zip(&sheet.answer.figures)
        .zip(sheet.lacks);
    for ((printed, figure), lack) in rows {
        text.push_str(&figure_text(printed, figure, lack.as_deref()));
    }
    text
}

fn figure_text(printed: &PrintedConfig, figure: &Explained, lack: Option<&str>) -> String {
    let name = format!("{} {}", printed.record, printed.metric);
    let mut text = String::new();
    match (figure.predicted, figure.pull, lack) {
        (Some((value, deviation)), Some(pull), _) => {
            let verdict = if figure.is_explained == Some(true) {
                "explained"
            } else {
                "UNEXPLAINED"
            };
            line(
                &mut text,
                format_args!(
                    "  {verdict:<11}  {name}: printed {} {}, from the others {} +-{}, pull {pull:+.1}",
                    plain(printed.value),
                    printed.unit,
                    three_digits(value),
                    three_digits(deviation)
                ),
            );
        }
        (_, _, lack) => line(
            &mut text,
            format_args!(
                "  not told     {name}: printed {} {}; {}",
                plain(printed.value),
                printed.unit,
                lack.unwrap_or("no reading forecasts it")
            ),
        ),
    }
    text
}

fn ridges_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    if !sheet.answer.ridges.is_empty() {
        line(&mut text, format_args!("\nNot told apart"));
    }
    for ridge in &sheet.answer.ridges {
        line(&mut text, format_args!("  {}", ridge_text(sheet, ridge)));
    }
    text
}

/// A gate in words.
pub(in crate::report) fn gate_text(gate: &JudgedGate) -> String {
    let value = gate
        .value
        .map_or_else(|| "nothing was found".to_owned(), three_digits);
    format!(
        "{}: {value}, wanted {}",
        gate.of.word(),
        limits_text(gate.min, gate.max)
    )
}

/// A unit behind a number; nothing of a bare one.
fn behind(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A ridge in words.
pub(in crate::report) fn ridge_text(sheet: &InferenceSheet, ridge: &Ridge) -> String {
    let [one, other] = ridge
        .parameters
        .map(|parameter| &sheet.parameters[parameter]);
    let end = |end: [f64; 2]| {
        format!(
            "{} {}{} with {} {}{}",
            one.name,
            three_digits(end[0]),
            behind(one.unit),
            other.name,
            three_digits(end[1]),
            behind(other.unit)
        )
    };
    format!(
        "{} and {} trade off along {} to {} (correlation {:+.2}; {})",
        one.name,
        other.name,
        end(sheet.ends(ridge)[0]),
        end(sheet.ends(ridge)[1]),
        ridge.correlation,
        answers(&sheet.readings[ridge.reading])
    )
}

fn experiments_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    if !sheet.answer.experiments.is_empty() {
        line(
            &mut text,
            format_args!("\nExperiments that would tell most"),
        );
    }
    for told in &sheet.answer.experiments {
        let experiment = &sheet.problem.experiments[told.experiment];
        line(
            &mut text,
            format_args!(
                "  {:>5.1} bit  {}: {} between {} and {}, +-{} each",
                told.information_bit,
                experiment.name,
                experiment.metric,
                three_digits(told.outcomes.0),
                three_digits(told.outcomes.1),
                three_digits(told.deviation)
            ),
        );
    }
    text
}

/// How often answers hold the truth.
pub(in crate::report) fn calibration_text(calibration: &Calibration) -> String {
    let mut text = String::new();
    let draws = calibration.outcomes.len();
    line(
        &mut text,
        format_args!(
            "\nCalibration: {draws} settings drawn from the priors, inferred from their own figures"
        ),
    );
    line(
        &mut text,
        format_args!(
            "  true reading accepted in {} by 0.95 of the probability{}",
            calibration.count(|outcome| outcome.is_accepted),
            calibration.levels.accepted.map_or_else(String::new, |level| {
                format!("; readings before it hold {level:.3} or less in 95 %, and 0.95 or that level is taken, whichever is more")
            })
        ),
    );
    line(
        &mut text,
        format_args!(
            "  at most a third of the {} readings accepted in {}, without those that print the same figures",
            calibration.readings,
            calibration.third()
        ),
    );
    put_regions(&mut text, calibration);
    line(
        &mut text,
        format_args!(
            "  no figure called unexplained in {}{}",
            calibration.count(|outcome| !outcome.has_unexplained),
            calibration.levels.pull.map_or_else(String::new, |level| {
                format!(
                    "; the largest pull is {level:.2} or less in 95 %, which is the limit taken"
                )
            })
        ),
    );
    let shifted = |what: Shifted| calibration.count(|outcome| outcome.shifted == what);
    line(
        &mut text,
        format_args!(
            "  a figure shifted by 5 standard deviations: named in {}, within 2 of what others leave open in {}, \
             missed in {}",
            shifted(Shifted::Named),
            shifted(Shifted::Open),
            shifted(Shifted::Missed)
        ),
    );
    text
}

/// How often intervals and regions hold the settings, and how large regions are.
fn put_regions(text: &mut String, calibration: &Calibration) {
    let (inside, all) = calibration.intervals();
    if all > 0 {
        line(
            text,
            format_args!(
                "  {inside} of {all} intervals of 95 % hold their value; {} of {} regions of all parameters hold \
                 the settings",
                calibration.count(|outcome| outcome.is_in_region),
                calibration.outcomes.len()
            ),
        );
    }
    let volumes = calibration.volumes();
    if let Some(median) = volumes.get(volumes.len() / 2) {
        line(
            text,
            format_args!(
                "  volume of the region over that of the information bound: {} at the median, at most 2 in {} of {}",
                three_digits(*median),
                volumes.iter().filter(|volume| **volume <= 2.0).count(),
                volumes.len()
            ),
        );
    }
}

/// Forecasts beside simulated records.
fn confirmation_text(sheet: &InferenceSheet, confirmation: &Confirmation) -> String {
    let mut text = String::new();
    let (agreeing, all) = confirmation.agreeing();
    line(
        &mut text,
        format_args!(
            "\nConfirmation: {} settings simulated, each record {}; {agreeing} of {all} forecasts agree",
            confirmation.candidates.len(),
            repeats_text(confirmation)
        ),
    );
    for candidate in &confirmation.candidates {
        let names = sheet.parameters.iter().zip(&candidate.parts);
        let values: Vec<String> = names
            .map(|(parameter, part)| {
                format!(
                    "{} {} {}",
                    parameter.name,
                    three_digits(parameter.at(*part)),
                    parameter.unit
                )
            })
            .collect();
        line(
            &mut text,
            format_args!("  {}: {}", candidate.name, values.join(", ")),
        );
        for (printed, figure) in sheet.problem.published.iter().zip(&candidate.figures) {
            text.push_str(&confirmed_text(printed, figure, confirmation.repeats));
        }
    }
    text
}

/// How often and by which models records were simulated.
pub(in crate::report) fn repeats_text(confirmation: &Confirmation) -> String {
    let times = match confirmation.repeats {
        1 => "once".to_owned(),
        count => format!("{count} times"),
    };
    let loops = if confirmation.has_loop_model() {
        " and once on the loop model"
    } else {
        ""
    };
    format!("{times} on the rate model{loops}")
}

/// A figure published, predicted and simulated.
fn confirmed_text(printed: &PrintedConfig, figure: &Confirmed, repeats: u32) -> String {
    let mut text = String::new();
    let verdict = match figure.agrees(repeats) {
        Some(true) => "agrees",
        Some(false) => "DISAGREES",
        None => "simulated",
    };
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), three_digits);
    let interval = figure.rate_model.map_or_else(String::new, |own| {
        format!(" [{}, {}]", three_digits(own.low), three_digits(own.high))
    });
    line(
        &mut text,
        format_args!(
            "    {verdict:<9}  {} {}: published {}, predicted {}, simulated {}{interval}, loop {} {}{}",
            printed.record,
            printed.metric,
            plain(printed.value),
            number(figure.predicted.map(|own| own.value)),
            number(figure.rate_model.map(|own| own.value)),
            number(figure.loop_model.map(|own| own.value)),
            printed.unit,
            figure
                .pull(printed.value)
                .map_or_else(String::new, |pull| format!(", pull {pull:+.1}")),
        ),
    );
    text
}
