//! What a suite tells while it runs, and what comes of it.

use std::fs;
use std::io;
use std::path::PathBuf;

use super::against::Against;
use super::output::SUMMARY;
use crate::comparison::Comparison;
use crate::experiment::run::Progress;
use crate::report::{RunOutcome, RunReport};
use crate::store::StoreError;

/// What the caller hears of the runs of a suite besides their progress; called from many threads.
pub trait Observer: Progress {
    /// Run `index` of the plan begins.
    fn started(&self, _index: usize) {}
    /// Run `index` of the plan is done and its files stand in their place.
    fn finished(&self, _index: usize, _report: &RunReport) {}
    /// Run `index` of the plan could not finish, or its result could not be written; in the first case a
    /// folder that says so stands in its place, in the second what stood there before.
    fn failed(&self, _index: usize, _outcome: &RunOutcome) {}
    /// Hears how a suite ended that was to stop while runs are still in the middle of a long stage.
    /// Its files stand; these runs will write nothing more. The caller may end the program here:
    /// `run_suite` returns the same only once they have come to the end of their stage.
    fn abandoned(&self, _result: &Result<SuiteOutcome, SuiteError>) {}
    /// Run `index` of the plan is not run again: its folder holds the result. It counts as finished.
    fn taken_over(&self, index: usize, report: &RunReport) {
        self.finished(index, report);
    }
    /// Something about the suite is worth saying.
    fn caution(&self, _message: &str) {}
}

impl Observer for () {}

/// What came of a suite.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SuiteOutcome {
    /// The output folder.
    pub folder: PathBuf,
    /// Runs in the order of the plans.
    pub runs: Vec<RunOutcome>,
    /// What they say across scenarios.
    pub comparison: Comparison,
    /// Whether a run was stopped by a broken invariant, which is a defect of the program.
    pub broken: bool,
    /// Threads that it ran on: fewer than asked for where the system had no more.
    pub threads: usize,
    /// Folders that hold results of earlier scenarios of these names.
    pub stale: Vec<String>,
    /// Whether the result of a run could not be written; its outcome says why.
    pub unwritten: bool,
    /// How the results compare with earlier ones.
    pub against: Against,
    /// Why files of the suite could not be written, or results of an earlier one not removed.
    pub failures: Vec<String>,
}

impl SuiteOutcome {
    /// The text of the suite's `summary.json`, as it stands in the output folder.
    ///
    /// # Errors
    /// Whatever the file system says of reading it.
    pub fn summary_json(&self) -> io::Result<String> {
        fs::read_to_string(self.folder.join(SUMMARY))
    }

    /// Why something that belongs into the output folder does not stand there, in words; none if
    /// everything does.
    #[must_use]
    pub fn lack(&self) -> Option<String> {
        let runs = self.runs.iter().filter(|_| self.unwritten);
        let mut reasons = runs
            .filter_map(|run| run.error.as_ref())
            .chain(&self.failures);
        reasons.next().cloned()
    }
}

/// Why a suite stopped before its end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SuiteError {
    /// The output folder is in use or holds something of the user's, or a file could not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Something that was to be written does not stand in its place.
    #[error("{reason}")]
    Unwritten {
        /// Why.
        reason: String,
    },
    /// The system gave not one thread.
    #[error("cannot start a thread: {source}")]
    Threads {
        /// What the system said.
        source: io::Error,
    },
}
