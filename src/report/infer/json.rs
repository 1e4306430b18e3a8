//! What figures say of the settings behind them, as JSON.

use serde_json::{Map, Value, json};

use super::InferenceSheet;
use super::text::ridge_text;
use crate::inference::{
    Calibration, Confirmation, Confirmed, Explained, Judged, JudgedGate, PrintedConfig, Reading,
    Shifted, Simulated,
};

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
                "from": sheet.ends(ridge)[0],
                "to": sheet.ends(ridge)[1],
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
        "accepted_part": answer.accepted_part,
        "forecasts": answer.forecasts,
        "calibration": sheet.calibration.map(calibration_json),
        "gates": sheet.gates.iter().map(gate_json).collect::<Vec<_>>(),
        "confirmation": sheet.confirmation.map(|own| confirmation_json(sheet, own)),
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

fn calibration_json(calibration: &Calibration) -> Value {
    let (inside, all) = calibration.intervals();
    let shifted = |what: Shifted| calibration.count(|outcome| outcome.shifted == what);
    json!({
        "draws": calibration.outcomes.len(),
        "true_reading_accepted": calibration.count(|outcome| outcome.is_accepted),
        "at_most_a_third_accepted": calibration.third(),
        "intervals": all,
        "intervals_that_hold": inside,
        "regions_that_hold": calibration.count(|outcome| outcome.is_in_region),
        "volumes_over_bound": calibration.volumes(),
        "without_unexplained": calibration.count(|outcome| !outcome.has_unexplained),
        "shifted_named": shifted(Shifted::Named),
        "shifted_open": shifted(Shifted::Open),
        "shifted_missed": shifted(Shifted::Missed),
        "accepted_level": calibration.levels.accepted,
        "pull_level": calibration.levels.pull,
    })
}

fn confirmation_json(sheet: &InferenceSheet, confirmation: &Confirmation) -> Value {
    let candidates = confirmation.candidates.iter().map(|candidate| {
        let values = sheet.parameters.iter().zip(&candidate.parts);
        let values = values.map(|(own, part)| (own.name.clone(), json!(own.at(*part))));
        let figures = sheet.problem.published.iter().zip(&candidate.figures);
        let figures =
            figures.map(|(printed, own)| confirmed_json(printed, own, confirmation.repeats));
        json!({
            "name": candidate.name,
            "choices": choices(&sheet.readings[candidate.reading]),
            "parameters": Value::Object(values.collect::<Map<_, _>>()),
            "figures": figures.collect::<Vec<_>>(),
        })
    });
    json!({
        "repeats": confirmation.repeats,
        "candidates": candidates.collect::<Vec<_>>(),
    })
}

fn confirmed_json(printed: &PrintedConfig, figure: &Confirmed, repeats: u32) -> Value {
    let simulated = |own: Option<Simulated>| {
        own.map(|own| json!({"value": own.value, "low": own.low, "high": own.high}))
    };
    json!({
        "record": printed.record,
        "metric": printed.metric,
        "unit": printed.unit,
        "published": printed.value,
        "predicted": figure.predicted.map(|own| own.value),
        "standard_deviation": figure.predicted.map(|own| own.deviation),
        "rate_model": simulated(figure.rate_model),
        "loop_model": simulated(figure.loop_model),
        "pull": figure.pull(printed.value),
        "agrees": figure.agrees(repeats),
    })
}

fn gate_json(gate: &JudgedGate) -> Value {
    json!({
        "of": gate.of.word(),
        "value": gate.value,
        "min": gate.min,
        "max": gate.max,
        "accepted": gate.is_accepted(),
    })
}
