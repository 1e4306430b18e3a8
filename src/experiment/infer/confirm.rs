//! Settings that were found, simulated: forecasts beside records.

use rayon::prelude::*;

use super::Inference;
use super::simulated::{Settings, SimulationError, figures_of};
use crate::experiment::plan::Plan;
use crate::experiment::run::Progress;
use crate::inference::{Candidate, Confirmation, Confirmed, Simulated};

/// Most ridges whose ends are simulated.
const RIDGES_MAX: usize = 4;

/// A record of settings, ready to be run.
pub struct ConfirmationRun {
    candidate: usize,
    record: usize,
    is_loop: bool,
    /// Its plan.
    pub plan: Plan,
}

/// What names a ready scenario, so that all of them can be run at once.
fn name_of(settings: &str, own: &str) -> String {
    let mut name = format!("{settings}-{own}");
    name.truncate(NAME_MAX);
    format!("name=\"{name}\"")
}

/// Gates of a record judge it at its own settings.
const NO_GATES: &str = "gate=[]";
/// Longest name of a scenario.
const NAME_MAX: usize = 64;

impl Inference {
    /// Settings worth a simulation: the most likely ones, and both ends of the ridges of the best reading.
    #[must_use]
    pub fn candidates(&self) -> Vec<Candidate> {
        let Some(best) = self.answer.readings.first() else {
            return Vec::new();
        };
        let candidate = |name: String, parts: &[f64]| Candidate {
            name,
            reading: best.reading,
            parts: parts.to_vec(),
            figures: Vec::new(),
        };
        let mut found = vec![candidate("best".to_owned(), &best.best.parts)];
        let ridges = self.answer.ridges.iter();
        let own = ridges.filter(|ridge| ridge.reading == best.reading);
        for (index, ridge) in own.take(RIDGES_MAX).enumerate() {
            for (end, parts) in ["low", "high"].iter().zip(&ridge.ends) {
                found.push(candidate(format!("ridge-{}-{end}", index + 1), parts));
            }
        }
        found
    }

    /// Plan of a record under some settings.
    ///
    /// # Errors
    /// Complaints about the scenario.
    pub fn plan_of(
        &self,
        candidate: &Candidate,
        record: usize,
        more: &[String],
    ) -> Result<Plan, SimulationError> {
        let settings = Settings {
            reading: candidate.reading,
            values: self.bench.values(&candidate.parts),
        };
        settings.plan(&self.problem, &self.bench, record, more)
    }

    /// Ready scenarios: every record of every candidate, and the experiments at the most likely settings;
    /// each with its path below a folder.
    ///
    /// # Errors
    /// Complaints about a scenario.
    pub fn scenarios(&self) -> Result<Vec<(String, String)>, SimulationError> {
        let config = &self.problem.config;
        let candidates = self.candidates();
        let mut files = Vec::new();
        for candidate in &candidates {
            for (record, row) in config.records.iter().enumerate() {
                let name = name_of(&candidate.name, &row.name);
                let plan = self.plan_of(candidate, record, &[name, NO_GATES.to_owned()])?;
                let path = format!("scenarios/{}/{}.toml", candidate.name, row.name);
                files.push((path, plan.resolved().to_toml()));
            }
        }
        let Some(best) = candidates.first() else {
            return Ok(files);
        };
        for experiment in &config.experiments {
            let record = config
                .records
                .iter()
                .position(|record| record.name == experiment.record);
            let mut more = experiment.set.clone().unwrap_or_default();
            more.push(name_of("experiment", &experiment.name));
            more.push(NO_GATES.to_owned());
            let plan = self.plan_of(best, record.unwrap_or(0), &more)?;
            let path = format!("scenarios/experiments/{}.toml", experiment.name);
            files.push((path, plan.resolved().to_toml()));
        }
        Ok(files)
    }

    /// What a confirmation runs: every record of every candidate, repeated on the rate model and once on
    /// the loop model.
    ///
    /// * `has_loop_model`: whether the loop model is run, which takes most of the time.
    ///
    /// # Errors
    /// Complaints about a scenario.
    pub fn confirmation_runs(
        &self,
        candidates: &[Candidate],
        repeats: u32,
        has_loop_model: bool,
    ) -> Result<Vec<ConfirmationRun>, SimulationError> {
        let models = [
            (
                false,
                vec!["fidelity=\"rate\"".to_owned(), format!("repeats={repeats}")],
            ),
            (
                true,
                vec!["fidelity=\"loop\"".to_owned(), "repeats=1".to_owned()],
            ),
        ];
        let mut runs = Vec::new();
        for (index, candidate) in candidates.iter().enumerate() {
            for record in 0..self.problem.config.records.len() {
                for (is_loop, more) in models.iter().filter(|own| has_loop_model || !own.0) {
                    runs.push(ConfirmationRun {
                        candidate: index,
                        record,
                        is_loop: *is_loop,
                        plan: self.plan_of(candidate, record, more)?,
                    });
                }
            }
        }
        Ok(runs)
    }

    /// Runs what a confirmation is made of.
    ///
    /// * `done`: hears of every run that is done.
    ///
    /// # Errors
    /// Why a record cannot be run to its end.
    pub fn confirm(
        &self,
        mut candidates: Vec<Candidate>,
        repeats: u32,
        runs: &[ConfirmationRun],
        progress: &dyn Progress,
        done: &(dyn Fn() + Sync),
    ) -> Result<Confirmation, SimulationError> {
        for candidate in &mut candidates {
            let forecasts = self.bench.forecaster(candidate.reading)(&candidate.parts);
            let forecasts = forecasts.unwrap_or_default().figures;
            let printed = self.bench.printed.iter().enumerate();
            candidate.figures = printed
                .map(|(figure, printed)| Confirmed {
                    predicted: forecasts.get(figure).copied().flatten(),
                    print_deviation: printed.deviation(),
                    ..Confirmed::default()
                })
                .collect();
        }
        let told: Vec<Result<Vec<(usize, Simulated)>, SimulationError>> = runs
            .par_iter()
            .with_max_len(1)
            .map(|run| {
                let figures = figures_of(&self.problem, run.record, &run.plan, progress)?;
                done();
                Ok(figures)
            })
            .collect();
        // In their order, whichever was done first.
        for (run, figures) in runs.iter().zip(told) {
            let into = &mut candidates[run.candidate].figures;
            for (figure, simulated) in figures? {
                if run.is_loop {
                    into[figure].loop_model = Some(simulated);
                } else {
                    into[figure].rate_model = Some(simulated);
                }
            }
        }
        Ok(Confirmation {
            repeats,
            candidates,
        })
    }
}
