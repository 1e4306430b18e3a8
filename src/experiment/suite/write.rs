//! Runs in memory, written as a suite writes them.

use std::path::PathBuf;

use super::conclude::{conclude, layout};
use super::entry::{Suite, enter_result};
use super::ledger::Ledger;
use super::options::{Resume, SuiteOptions};
use super::outcome::{SuiteError, SuiteOutcome};
use super::output::SuiteOutput;
use super::runner::enter_unwritten;
use crate::experiment::plan::Plan;
use crate::experiment::run::Run;

impl Run {
    /// Writes what `fogbench run` writes of this scenario into a folder: the same files, byte for byte.
    ///
    /// # Errors
    /// As `run_suite`(crate::experiment::run_suite), or [`SuiteError::Unwritten`]: nothing of the
    /// user's is replaced.
    pub fn write(&self, folder: impl Into<PathBuf>) -> Result<(), SuiteError> {
        let runs = std::slice::from_ref(self);
        let outcome = write_runs(runs, &SuiteOptions::new(folder.into()))?;
        match outcome.lack() {
            None => Ok(()),
            Some(reason) => Err(SuiteError::Unwritten { reason }),
        }
    }
}

/// Writes runs that are already in memory as `run_suite` writes them.
///
/// # Errors
/// As `run_suite`, threads aside.
pub fn write_runs(runs: &[Run], options: &SuiteOptions) -> Result<SuiteOutcome, SuiteError> {
    let plans: Vec<Plan> = runs.iter().map(|run| run.plan().clone()).collect();
    let layout = &layout(&plans);
    let suite = &Suite {
        output: &SuiteOutput::open(&plans, layout, options)?,
        resume: Resume::Never,
        earlier: options.earlier.as_ref(),
        ledger: &Ledger::new(plans.len()),
    };
    for (index, run) in runs.iter().enumerate() {
        let plan = &plans[index];
        let written = enter_result((plan, index), &run.results, layout, suite, &());
        if let Err(error) = written {
            enter_unwritten((plan, index), &error, suite, &());
        }
    }
    Ok(SuiteOutcome {
        threads: rayon::current_num_threads(),
        ..conclude(&plans, layout, suite)
    })
}
