//! Inference: problems read, figures forecast from their scenarios in closed form, answers gathered.

mod bench;
mod calibrate;
mod confirm;
mod forms;
mod geometry;
mod interpolated;
mod logged;
mod measurand;
mod record;
mod response;
mod simulated;
mod surface;

use std::path::Path;

use rayon::prelude::*;

use bench::Bench;
use interpolated::surfaces;
use logged::with_logs;
use simulated::check_runs;

use crate::inference::{
    Answer, Calibration, Confirmation, Found, JudgedGate, Levels, Parameter, Printed, Question,
    Reading, Search,
};
use crate::random::Streams;
use crate::scenario::{Problem, ScenarioError, load_problem};

pub use calibrate::{CalibrateInference, Figures};
pub use confirm::ConfirmationRun;
pub use simulated::SimulationError;

/// Points of each accepted reading at which experiments are weighed.
const POINTS_OF_EXPERIMENTS: usize = 64;

/// A problem and what its figures say.
#[derive(Clone, Debug)]
pub struct Inference {
    /// The problem.
    pub problem: Problem,
    /// What the figures say.
    pub answer: Answer,
    /// How often answers hold the truth; none if that was not asked.
    pub calibration: Option<Calibration>,
    /// Forecasts beside simulated records; none if that was not asked.
    pub confirmation: Option<Confirmation>,
    /// Gates, as they were judged last.
    pub gates: Vec<JudgedGate>,
    bench: Bench,
    found: Vec<Option<Found>>,
}

/// Reads a problem and its scenarios without searching.
///
/// # Errors
/// Every complaint about the problem and its scenarios.
pub fn check_problem(file: &Path) -> Result<(), Vec<ScenarioError>> {
    let problem = with_logs(load_problem(file)?)?;
    check_runs(&problem, &Bench::new(&problem)?)
}

/// Reads a problem, searches every reading and weighs what is found.
///
/// The same on any number of threads: every reading draws from a stream of its own.
///
/// # Errors
/// Every complaint about the problem and its scenarios; a problem that no instrument answers.
pub fn infer(file: &Path) -> Result<Inference, Vec<ScenarioError>> {
    let problem = with_logs(load_problem(file)?)?;
    let mut bench = Bench::new(&problem)?;
    check_runs(&problem, &bench)?;
    bench.surfaces = surfaces(&problem, &bench);
    let found = search(&problem, &bench, &bench.printed, problem.config.seed);
    if found.iter().all(Option::is_none) {
        let message = "no values within the ranges of the parameters make a gyro";
        return Err(vec![problem.complaint("parameter", message)]);
    }
    let question = question(&problem, &bench, &bench.printed, Levels::default());
    let mut answer = question.answer(&found);
    answer.experiments = experiments(&bench, &answer, &found);
    Ok(Inference {
        problem,
        answer,
        calibration: None,
        confirmation: None,
        gates: Vec::new(),
        bench,
        found,
    })
}

impl Inference {
    /// What is open in numbers.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.bench.parameters
    }

    /// What is open in words.
    #[must_use]
    pub fn readings(&self) -> &[Reading] {
        &self.bench.readings
    }

    /// Why a figure has no closed form, by figure.
    #[must_use]
    pub fn lacks(&self) -> &[Option<String>] {
        &self.bench.lacks
    }

    /// What the search has left of every reading; none of one that no gyro answers.
    #[must_use]
    pub fn found(&self) -> &[Option<Found>] {
        &self.found
    }

    /// Judges the gates of the problem by what is found so far.
    pub fn judge(&mut self) {
        let gates = self.problem.config.gates.iter();
        let confirmation = self.confirmation.as_ref();
        self.gates = gates
            .map(|gate| JudgedGate::of(gate, &self.answer, confirmation))
            .collect();
    }

    /// Whether every gate is accepted.
    #[must_use]
    pub fn is_accepted(&self) -> bool {
        self.gates.iter().all(JudgedGate::is_accepted)
    }

    /// Answers anew by the levels of a calibration.
    pub fn judge_by(&mut self, calibration: Calibration) {
        let bench = &self.bench;
        let question = question(&self.problem, bench, &bench.printed, calibration.levels);
        self.answer = question.answer(&self.found);
        self.answer.experiments = experiments(bench, &self.answer, &self.found);
        self.calibration = Some(calibration);
    }
}

/// Searches every reading for what makes some figures.
fn search(problem: &Problem, bench: &Bench, printed: &[Printed], seed: u64) -> Vec<Option<Found>> {
    let search = Search {
        printed,
        doubt: problem.config.doubt,
        parameters: bench.parameters.len(),
        points: problem.config.points as usize,
    };
    (0..bench.readings.len())
        .into_par_iter()
        .map(|reading| {
            let streams = Streams::new(seed, reading as u64);
            search.run(&streams, &mut bench.forecaster(reading))
        })
        .collect()
}

/// What is asked of the readings.
fn question<'a>(
    problem: &Problem,
    bench: &'a Bench,
    printed: &'a [Printed],
    levels: Levels,
) -> Question<'a> {
    Question {
        parameters: &bench.parameters,
        readings: &bench.readings,
        printed,
        doubt: problem.config.doubt,
        levels,
    }
}

/// What the experiments would tell.
fn experiments(
    bench: &Bench,
    answer: &Answer,
    found: &[Option<Found>],
) -> Vec<crate::inference::Told> {
    let mut outcomes = Vec::new();
    for judged in answer.accepted() {
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
