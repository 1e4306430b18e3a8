//! Records of known settings, simulated.

use super::bench::{Bench, sets_of};
use super::measurand::Measurand;
use crate::experiment::Run;
use crate::experiment::plan::{Plan, plan_suite};
use crate::experiment::run::Progress;
use crate::inference::{ProblemConfig, Simulated};
use crate::metrics::Estimate;
use crate::scenario::{Problem, ScenarioError};

/// Why there are no records of settings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The settings do not make a sound scenario.
    #[error("record {record}: {}", complaints.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Scenario {
        /// Name of the record.
        record: String,
        /// What is wrong with it.
        complaints: Vec<ScenarioError>,
    },
    /// The scenario names nothing to run.
    #[error("record {record}: nothing to run")]
    Empty {
        /// Name of the record.
        record: String,
    },
    /// It cannot be run to its end.
    #[error("record {record}: {reason}")]
    Unfinished {
        /// Name of the record.
        record: String,
        /// Why.
        reason: String,
    },
    /// No gyro has what was drawn from the priors.
    #[error("no gyro in {0} draws from the priors")]
    NoGyro(usize),
}

/// Settings of a problem.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Settings {
    /// The reading.
    pub(super) reading: usize,
    /// Values of the parameters.
    pub(super) values: Vec<f64>,
}

impl Settings {
    /// The keys that parameters have under these settings in a record, with what sets them.
    fn moved<'a>(&self, config: &'a ProblemConfig, record: usize) -> Vec<(&'a str, String)> {
        let name = &config.records[record].name;
        let values = config.parameters.iter().zip(&self.values);
        let own = values.filter(|(parameter, _)| {
            let records = parameter.records.as_ref();
            records.is_none_or(|names| names.contains(name))
        });
        own.flat_map(|(parameter, value)| {
            let keys = parameter.keys.iter();
            keys.map(move |key| (key.as_str(), format!("{key}={value:?}")))
        })
        .collect()
    }

    /// The plan of a record.
    ///
    /// A parameter that several records share need not act in each of them: a coefficient of the temperature does
    /// nothing at the reference temperature. There it is left out.
    ///
    /// * `more`: keys over those of the settings.
    ///
    /// # Errors
    /// Complaints about the scenario.
    pub(super) fn plan(
        &self,
        problem: &Problem,
        bench: &Bench,
        record: usize,
        more: &[String],
    ) -> Result<Plan, SimulationError> {
        let config = &problem.config;
        let mut sets = sets_of(config, record, &bench.readings[self.reading]);
        let mut waiting = self.moved(config, record);
        loop {
            let plan = plan_of_record(problem, record, [&sets, more].concat())?;
            let (acting, idle): (Vec<_>, Vec<_>) = waiting
                .into_iter()
                .partition(|(key, _)| plan.resolved().acts(key));
            if acting.is_empty() {
                return Ok(plan);
            }
            // What is set now may let another one act.
            sets.extend(acting.into_iter().map(|(_, set)| set));
            waiting = idle;
        }
    }
}

/// The plan of a record with what is set in it; its name is that of the record if none is set.
///
/// # Errors
/// Complaints about the scenario.
fn plan_of_record(
    problem: &Problem,
    record: usize,
    mut sets: Vec<String>,
) -> Result<Plan, SimulationError> {
    let row = &problem.config.records[record];
    if !sets.iter().any(|set| set.starts_with("name=")) {
        sets.push(format!("name=\"{}\"", row.name));
    }
    let file = problem.beside(&row.scenario);
    let record = || row.name.clone();
    let plans = plan_suite(&[file], &sets).map_err(|complaints| SimulationError::Scenario {
        record: record(),
        complaints,
    })?;
    let plan = plans.into_iter().next();
    plan.ok_or_else(|| SimulationError::Empty { record: record() })
}

/// Looks whether every record and every experiment can be run, so that nothing is searched in vain.
///
/// # Errors
/// Complaints about the scenarios, with what their files, the problem and the middle of its priors set.
pub(super) fn check_runs(problem: &Problem, bench: &Bench) -> Result<(), Vec<ScenarioError>> {
    let config = &problem.config;
    let place = |name: &String| config.records.iter().position(|row| row.name == *name);
    let records =
        (0..config.records.len()).map(|record| (record, None, format!("record[{record}]")));
    let experiments = config.experiments.iter().enumerate();
    let experiments = experiments.filter_map(|(index, experiment)| {
        let at = format!("experiment[{index}]");
        Some((place(&experiment.record)?, experiment.set.as_ref(), at))
    });
    let middle = Settings {
        reading: 0,
        values: bench.values(&vec![0.5; config.parameters.len()]),
    };
    let mut errors = Vec::new();
    for (record, more, at) in records.chain(experiments) {
        let more: Vec<String> = more.into_iter().flatten().cloned().collect();
        if let Err(error) = middle.plan(problem, bench, record, &more) {
            errors.push(problem.complaint(&at, format!("{at}: {error}")));
        }
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// Figures of one run of every record, in the order of the problem; none of one that the run does not
/// have.
///
/// * `seed`: of the first record; each has noise of its own.
///
/// # Errors
/// Why a record cannot be simulated.
pub(super) fn simulate(
    problem: &Problem,
    bench: &Bench,
    settings: &Settings,
    seed: u64,
) -> Result<Vec<Option<f64>>, SimulationError> {
    let mut figures = vec![None; problem.config.published.len()];
    for record in 0..problem.config.records.len() {
        let own = seed.wrapping_add((record as u64) << SEED_BITS) % (1 << 32);
        let plan = settings.plan(problem, bench, record, &[format!("seed={own}")])?;
        for (figure, simulated) in figures_of(problem, record, &plan, &())? {
            figures[figure] = Some(simulated.value);
        }
    }
    Ok(figures)
}

/// Bits of a seed below those that tell records apart: far more than draws are asked for.
const SEED_BITS: u32 = 20;

/// Figures of a run of a record, by their place in the problem; without those that it does not have.
///
/// # Errors
/// Why it cannot be run to its end.
pub(super) fn figures_of(
    problem: &Problem,
    record: usize,
    plan: &Plan,
    progress: &dyn Progress,
) -> Result<Vec<(usize, Simulated)>, SimulationError> {
    let record = &problem.config.records[record].name;
    let ended = plan
        .run_with(progress)
        .map_err(|error| SimulationError::Unfinished {
            record: record.clone(),
            reason: error.to_string(),
        })?;
    let published = problem.config.published.iter().enumerate();
    let own = published.filter(|(_, figure)| figure.record == *record);
    Ok(own
        .filter_map(|(index, figure)| Some((index, simulated(&ended, &figure.metric)?)))
        .collect())
}

/// A metric of a run; none where it does not have it.
fn simulated(run: &Run, written: &str) -> Option<Simulated> {
    let (channel, measurand) = Measurand::of(written).ok()?;
    let Estimate {
        value, low, high, ..
    } = measurand.read(run.channel(&channel).ok()?)?;
    Some(Simulated { value, low, high })
}
