//! Inference: problems read, figures forecast from their scenarios in closed form, answers gathered.

mod bench;
mod forms;
mod geometry;
mod record;

use std::path::Path;

use rayon::prelude::*;

use bench::Bench;

use crate::inference::{Answer, Found, Parameter, Question, Reading, Search};
use crate::random::Streams;
use crate::scenario::{Problem, ScenarioError, load_problem};

/// Points of each accepted reading at which experiments are weighed.
const POINTS_OF_EXPERIMENTS: usize = 64;

/// A problem and what its figures say.
#[derive(Clone, Debug)]
pub struct Inference {
    /// The problem.
    pub problem: Problem,
    /// What is open in numbers.
    pub parameters: Vec<Parameter>,
    /// What is open in words.
    pub readings: Vec<Reading>,
    /// Why a figure has no closed form, by figure.
    pub lacks: Vec<Option<String>>,
    /// What the figures say.
    pub answer: Answer,
}

/// Reads a problem and its scenarios without searching.
///
/// # Errors
/// Every complaint about the problem and its scenarios.
pub fn check_problem(file: &Path) -> Result<(), Vec<ScenarioError>> {
    Bench::new(&load_problem(file)?).map(|_| ())
}

/// Reads a problem, searches every reading and weighs what is found.
///
/// The same on any number of threads: every reading draws from a stream of its own.
///
/// # Errors
/// Every complaint about the problem and its scenarios; a problem that no instrument answers.
pub fn infer(file: &Path) -> Result<Inference, Vec<ScenarioError>> {
    let problem = load_problem(file)?;
    let bench = Bench::new(&problem)?;
    let config = &problem.config;
    let search = Search {
        printed: &bench.printed,
        doubt: config.doubt,
        parameters: bench.parameters.len(),
        points: config.points as usize,
    };
    let found: Vec<Option<Found>> = (0..bench.readings.len())
        .into_par_iter()
        .map(|reading| {
            let streams = Streams::new(config.seed, reading as u64);
            search.run(&streams, &mut bench.forecaster(reading))
        })
        .collect();
    if found.iter().all(Option::is_none) {
        let message = "no values within the ranges of the parameters make a gyro";
        return Err(vec![problem.complaint("parameter", message)]);
    }
    let question = Question {
        parameters: &bench.parameters,
        readings: &bench.readings,
        printed: &bench.printed,
        doubt: config.doubt,
    };
    let mut answer = question.answer(&found);
    answer.experiments = experiments(&bench, &answer, &found);
    let Bench {
        parameters,
        readings,
        lacks,
        ..
    } = bench;
    Ok(Inference {
        parameters,
        readings,
        lacks,
        answer,
        problem,
    })
}

/// What the experiments would tell.
fn experiments(
    bench: &Bench,
    answer: &Answer,
    found: &[Option<Found>],
) -> Vec<crate::inference::Told> {
    let mut outcomes = Vec::new();
    for judged in answer.readings.iter().filter(|judged| judged.is_accepted) {
        let Some(found) = &found[judged.reading] else {
            continue;
        };
        let mut oracle = bench.oracle(judged.reading);
        let stride = (found.points.len() / POINTS_OF_EXPERIMENTS).max(1);
        let points: Vec<_> = found.points.iter().step_by(stride).collect();
        let weight = judged.weight / points.len() as f64;
        outcomes.extend(points.iter().map(|point| (weight, oracle(&point.parts))));
    }
    Question::experiments(&outcomes, bench.experiments())
}
