//! What figures say of the settings behind them, as text and JSON.

use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use crate::inference::{
    Answer, Explained, Judged, Parameter, PrintedConfig, ProblemConfig, Reading, Ridge,
};
use crate::metrics::three_digits;

/// Most readings of the text that are not accepted.
const OTHERS_SHOWN: usize = 5;
/// Width of an interval over the prior's from which the figures say nothing.
const UNTOLD: f64 = 0.9;

/// An inference to show.
#[derive(Clone, Copy, Debug)]
pub struct InferenceSheet<'a> {
    /// Its problem.
    pub problem: &'a ProblemConfig,
    /// Bare name of the file.
    pub file: &'a str,
    /// Parameters.
    pub parameters: &'a [Parameter],
    /// Readings.
    pub readings: &'a [Reading],
    /// Why a figure has no closed form, by figure.
    pub lacks: &'a [Option<String>],
    /// What the figures say.
    pub answer: &'a Answer,
}

/// The answer as text.
#[must_use]
pub fn infer_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    let answer = sheet.answer;
    let accepted = answer
        .readings
        .iter()
        .filter(|judged| judged.is_accepted)
        .count();
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
            "accepted {accepted} of {} readings: the fewest that hold 95 % of the probability",
            sheet.readings.len()
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
    text
}

fn line(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{arguments}");
}

/// Answers of a reading in words.
fn answers(reading: &Reading) -> String {
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
                    "      {} {} [{}, {}] {}{note}",
                    parameter.name,
                    three_digits(range.value),
                    three_digits(range.low),
                    three_digits(range.high),
                    parameter.unit
                ),
            );
        }
    }
    text
}

fn figures_text(sheet: &InferenceSheet) -> String {
    let mut text = String::new();
    let explained = sheet
        .answer
        .figures
        .iter()
        .filter(|figure| figure.is_explained == Some(true))
        .count();
    let told = sheet
        .answer
        .figures
        .iter()
        .filter(|figure| figure.is_explained.is_some())
        .count();
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
                    printed.value,
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
                printed.value,
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

/// A ridge in words.
fn ridge_text(sheet: &InferenceSheet, ridge: &Ridge) -> String {
    let [one, other] = ridge
        .parameters
        .map(|parameter| &sheet.parameters[parameter]);
    let end = |end: [f64; 2]| {
        format!(
            "{} {} {} with {} {} {}",
            one.name,
            three_digits(end[0]),
            one.unit,
            other.name,
            three_digits(end[1]),
            other.unit
        )
    };
    format!(
        "{} and {} trade off along {} to {} (correlation {:+.2}; {})",
        one.name,
        other.name,
        end(ridge.ends[0]),
        end(ridge.ends[1]),
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

/// The answer as JSON.
#[must_use]
pub fn infer_json(sheet: &InferenceSheet) -> String {
    let answer = sheet.answer;
    let readings: Vec<Value> = answer
        .readings
        .iter()
        .map(|judged| reading_json(sheet, judged))
        .collect();
    let figures: Vec<Value> = sheet
        .problem
        .published
        .iter()
        .zip(&answer.figures)
        .zip(sheet.lacks)
        .map(|((printed, figure), lack)| figure_json(printed, figure, lack.as_deref()))
        .collect();
    let ridges: Vec<Value> = answer
        .ridges
        .iter()
        .map(|ridge| {
            let names = ridge
                .parameters
                .map(|parameter| sheet.parameters[parameter].name.as_str());
            json!({
                "reading": choices(&sheet.readings[ridge.reading]),
                "parameters": names,
                "correlation": ridge.correlation,
                "from": ridge.ends[0],
                "to": ridge.ends[1],
                "words": ridge_text(sheet, ridge),
            })
        })
        .collect();
    let experiments: Vec<Value> = answer
        .experiments
        .iter()
        .map(|told| {
            let experiment = &sheet.problem.experiments[told.experiment];
            json!({
                "name": experiment.name,
                "record": experiment.record,
                "metric": experiment.metric,
                "information_bit": told.information_bit,
                "lowest": told.outcomes.0,
                "highest": told.outcomes.1,
                "standard_deviation": told.deviation,
            })
        })
        .collect();
    let document = json!({
        "schema": 1,
        "problem": sheet.problem.name,
        "file": sheet.file,
        "readings": readings,
        "figures": figures,
        "ridges": ridges,
        "experiments": experiments,
        "pull_limit": answer.pull_limit,
        "forecasts": answer.forecasts,
    });
    format!("{document:#}\n")
}

/// Answers of a reading by question.
fn choices(reading: &Reading) -> Value {
    let answers = reading.answers.iter();
    let pairs = answers.map(|(question, answer)| (question.clone(), json!(answer)));
    Value::Object(pairs.collect::<Map<_, _>>())
}

fn reading_json(sheet: &InferenceSheet, judged: &Judged) -> Value {
    let parameters = sheet
        .parameters
        .iter()
        .zip(&judged.parameters)
        .map(|(parameter, range)| {
            let value = json!({
                "value": range.value,
                "best": range.best,
                "low": range.low,
                "high": range.high,
                "unit": parameter.unit,
                "share_of_prior": range.share,
            });
            (parameter.name.clone(), value)
        });
    json!({
        "accepted": judged.is_accepted,
        "weight": judged.weight,
        "log_evidence": judged.log_evidence,
        "choices": choices(&sheet.readings[judged.reading]),
        "parameters": Value::Object(parameters.collect::<Map<_, _>>()),
    })
}

fn figure_json(printed: &PrintedConfig, figure: &Explained, lack: Option<&str>) -> Value {
    json!({
        "record": printed.record,
        "metric": printed.metric,
        "unit": printed.unit,
        "published": printed.value,
        "predicted": figure.predicted.map(|predicted| predicted.0),
        "standard_deviation": figure.predicted.map(|predicted| predicted.1),
        "best": figure.at_best.map(|best| best.0),
        "scatter": figure.at_best.map(|best| best.1),
        "pull": figure.pull,
        "explained": figure.is_explained,
        "lack": lack,
    })
}
