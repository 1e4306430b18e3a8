//! `fogbench infer`: which settings make all printed figures at once.

use std::io;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use crate::cli::options::infer::InferOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{
    CalibrateInference, Figures, Inference, Plan, check_problem, estimated_s, infer as search,
};
use crate::report::{InferenceSheet, PAGE, infer_json, infer_page, infer_pictures, infer_text};

/// Searches a problem and prints what its figures say; with a folder, writes it there as well.
pub(in crate::cli) fn infer(options: &InferOptions) -> io::Result<Exit> {
    if options.check {
        return Ok(match check_problem(&options.path) {
            Ok(()) => Exit::Success,
            Err(errors) => {
                complaint::print(&errors);
                Exit::Usage
            }
        });
    }
    let place = Place::new(options.output.as_deref(), "infer", options.force);
    if let Err(exit) = place.check(&[&options.path]) {
        return Ok(exit);
    }
    let began = Instant::now();
    let mut inference = match search(&options.path) {
        Ok(inference) => inference,
        Err(errors) => {
            complaint::print(&errors);
            return Ok(Exit::Usage);
        }
    };
    if let Some(draws) = options.calibrate
        && let Err(exit) = calibrate(&mut inference, options, draws, began.elapsed())
    {
        return Ok(exit);
    }
    if let Some(repeats) = options.confirm
        && let Err(exit) = confirm(&mut inference, repeats, !options.without_loop_model)
    {
        return Ok(exit);
    }
    inference.judge();
    let sheet = sheet(&inference);
    let (text, json) = (infer_text(&sheet), infer_json(&sheet));
    if options.output.is_some()
        && let Err(exit) = fill(&inference, place, &text, &json)
    {
        return Ok(exit);
    }
    output::data(&options.format.of(|| text, || json)?)?;
    Ok(if inference.is_accepted() {
        Exit::Success
    } else {
        Exit::GateFailed
    })
}

/// Judges by levels that hold the truth over so many draws; says beforehand how long that takes.
fn calibrate(
    inference: &mut Inference,
    options: &InferOptions,
    draws: u32,
    searched: Duration,
) -> Result<(), Exit> {
    // A search for the figures of a draw and one with a figure shifted.
    let minutes = searched.as_secs_f64() * 2.0 * f64::from(draws) / 60.0;
    let records = if options.simulated {
        " and the simulation of their records"
    } else {
        ""
    };
    output::talk(&format!(
        "{draws} draws: about {minutes:.1} min of searches{records}"
    ));
    let how = CalibrateInference {
        draws,
        figures: if options.simulated {
            Figures::Simulated
        } else {
            Figures::Drawn
        },
    };
    let count = AtomicU32::new(0);
    let done = || {
        let count = count.fetch_add(1, Ordering::Relaxed) + 1;
        if (count * 10).is_multiple_of(draws.next_multiple_of(10)) {
            output::talk(&format!("{count} of {draws} draws are done"));
        }
    };
    match inference.calibrate(how, &done) {
        Ok(calibration) => {
            inference.judge_by(calibration);
            Ok(())
        }
        Err(error) => {
            complaint::print(&[error.to_string()]);
            Err(Exit::Usage)
        }
    }
}

/// Simulates what was found; says beforehand how long that takes.
fn confirm(inference: &mut Inference, repeats: u32, has_loop_model: bool) -> Result<(), Exit> {
    let candidates = inference.candidates();
    let runs = inference.confirmation_runs(&candidates, repeats, has_loop_model);
    let confirmed = runs.and_then(|runs| {
        let plans: Vec<Plan> = runs.iter().map(|run| run.plan.clone()).collect();
        output::talk(&format!(
            "confirmation: {} settings, {} runs, about {:.1} min of one core",
            candidates.len(),
            runs.len(),
            estimated_s(&plans) / 60.0
        ));
        let (count, all) = (AtomicU32::new(0), runs.len());
        let done = || {
            let count = count.fetch_add(1, Ordering::Relaxed) + 1;
            output::talk(&format!("{count} of {all} runs are done"));
        };
        inference.confirm(candidates, repeats, &runs, &(), &done)
    });
    match confirmed {
        Ok(confirmation) => {
            inference.confirmation = Some(confirmation);
            Ok(())
        }
        Err(error) => {
            complaint::print(&[error.to_string()]);
            Err(Exit::RunFailed)
        }
    }
}

/// What the report shows of an inference.
fn sheet(inference: &Inference) -> InferenceSheet<'_> {
    InferenceSheet {
        problem: &inference.problem.config,
        file: &inference.problem.file,
        parameters: inference.parameters(),
        readings: inference.readings(),
        lacks: inference.lacks(),
        answer: &inference.answer,
        calibration: inference.calibration.as_ref(),
        confirmation: inference.confirmation.as_ref(),
        found: inference.found(),
        gates: &inference.gates,
    }
}

/// Fills the output folder: the answer, its page and pictures, and ready scenarios.
fn fill(inference: &Inference, place: Place, text: &str, json: &str) -> Result<(), Exit> {
    let scenarios = inference.scenarios().map_err(|error| {
        complaint::print(&[error.to_string()]);
        Exit::Usage
    })?;
    let names: Vec<String> = scenarios.iter().map(|(path, _)| path.clone()).collect();
    let sheet = sheet(inference);
    let pictures = infer_pictures(&sheet);
    let page = infer_page(&sheet, &pictures, &names);
    let own = [("infer.txt", text), ("infer.json", json), (PAGE, &page)];
    place.fill_with(&own, &pictures, &scenarios)
}
