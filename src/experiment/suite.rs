//! Many runs at once: the thread pool, the order of results and the files of the whole suite.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::channel;

use rayon::prelude::*;

use super::build::VERSION;
use super::comparison::Layout;
use super::in_memory::Run;
use super::ledger::{Ledger, wait};
use super::plan::Plan;
use super::progress::Progress;
use super::resume::Resume;
use super::run::{enter_result, run_scenario};
use super::suite_output::{JUNIT, SUMMARY, Settled, SuiteOutput};
use super::threads;
use crate::report::{self, Comparison, RunOutcome, RunReport};
use crate::store::StoreError;

/// How a suite is run.
#[derive(Clone, Debug)]
pub struct SuiteOptions {
    /// Folder that receives the results; made if absent.
    pub output: PathBuf,
    /// Threads, as [`thread_count`](super::thread_count) takes them.
    pub threads: usize,
    /// Whether to replace files and folders in `output` that are the user's.
    pub force: bool,
    /// Which results of an earlier suite to take over.
    pub resume: Resume,
}

impl SuiteOptions {
    /// Runs everything into `output`, on a thread for each core, and replaces nothing of the user's.
    #[must_use]
    pub fn new(output: PathBuf) -> Self {
        Self {
            output,
            threads: 0,
            force: false,
            resume: Resume::Never,
        }
    }
}

/// What the caller hears of the runs of a suite besides their progress; called from many threads.
pub trait Observer: Progress {
    /// Run `index` of the plan is done and its files stand in their place.
    fn finished(&self, _index: usize, _report: &RunReport) {}
    /// Run `index` of the plan could not finish, or its result could not be written; in the first case a
    /// folder that says so stands in its place, in the second what stood there before.
    fn failed(&self, _index: usize, _outcome: &RunOutcome) {}
    /// Hears how a suite ended that was to stop while runs are still in the middle of a long stage.
    /// Its files stand; these runs will write nothing more. The caller may end the program here:
    /// [`run_suite`] returns the same only once they have come to the end of their stage.
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
pub struct SuiteOutcome {
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
    /// Why files of the suite could not be written, or results of an earlier one not removed.
    pub failures: Vec<String>,
}

/// Why a suite stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// The output folder is in use or holds something of the user's, or a file could not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The system gave not one thread.
    #[error("cannot start a thread: {source}")]
    Threads {
        /// What the system said.
        source: io::Error,
    },
}

/// What the runs of a suite share.
pub(super) struct Suite<'a> {
    /// Where their folders go.
    pub(super) output: &'a SuiteOutput,
    /// Whose results are taken over.
    pub(super) resume: Resume,
    /// Which of them have ended.
    pub(super) ledger: &'a Ledger,
}

/// Runs every plan and writes `options.output`.
///
/// Results come back in the order of `plans`, whatever the order of completion; every file depends
/// on its scenario, seed and the version of the program alone. The suite's own files are removed
/// first and written last, so that a killed suite leaves no verdict of an earlier one; one that the
/// observer stops has files that say which runs have ended. A run that breaks an invariant, or whose
/// folder cannot be written, fails by itself; the others go on.
///
/// # Errors
/// [`SuiteError`], before anything runs: if something of the user's would be replaced; if another
/// process writes into the folder; if it cannot be written, or no thread can be started.
pub fn run_suite(
    plans: &[Plan],
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<SuiteOutcome, SuiteError> {
    let layout = &Layout::of(plans);
    let pool = threads::pool(threads::thread_count(options.threads))
        .map_err(|source| SuiteError::Threads { source })?;
    let output = &SuiteOutput::open(plans, layout, options)?;
    for caution in output.cautions() {
        observer.caution(caution);
    }
    let ledger = &Ledger::new(plans.len());
    let suite = &Suite {
        output,
        resume: options.resume,
        ledger,
    };
    let conclude = || {
        let threads = pool.current_num_threads();
        Ok(SuiteOutcome {
            threads,
            ..conclude(plans, layout, suite)
        })
    };
    let (end_of_work, work) = channel();
    let stopped = pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            run_all(plans, layout, suite, observer);
            drop(end_of_work);
        });
        (!wait(&work, observer)).then(|| {
            let result = conclude();
            output.sign_off();
            observer.abandoned(&result);
            result
        })
    });
    stopped.unwrap_or_else(conclude)
}

/// Writes runs that are already in memory as [`run_suite`] writes them.
///
/// # Errors
/// As [`run_suite`], threads aside.
pub fn write_runs(runs: &[Run], options: &SuiteOptions) -> Result<SuiteOutcome, SuiteError> {
    let plans: Vec<Plan> = runs.iter().map(|run| run.plan().clone()).collect();
    let layout = &Layout::of(&plans);
    let suite = &Suite {
        output: &SuiteOutput::open(&plans, layout, options)?,
        resume: Resume::Never,
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

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(plans: &[Plan], layout: &Layout, suite: &Suite, observer: &dyn Observer) {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].cost().total_cmp(&plans[a].cost()));
    // One item at a time, so that a thread takes the next longest run when it is free.
    let order = order.par_iter().with_max_len(1);
    let ledger = suite.ledger;
    order.for_each(|&index| {
        if observer.should_stop() {
            return;
        }
        let plan = &plans[index];
        let run = || run_scenario(plan, index, layout, suite, observer);
        let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
            ledger.note_broken();
            Ok(Some(broken_run(plan, &*panic)))
        });
        match result {
            Ok(Some(outcome)) => {
                if let Some(reason) = &outcome.error {
                    enter_failure((plan, index), &outcome, reason, suite, observer);
                }
            }
            Ok(None) => {}
            Err(error) => enter_unwritten((plan, index), &error, suite, observer),
        }
    });
}

/// Puts a folder that says so in the place of a run that could not finish, enters the run and tells
/// the observer.
fn enter_failure(
    (plan, index): (&Plan, usize),
    outcome: &RunOutcome,
    reason: &str,
    suite: &Suite,
    observer: &dyn Observer,
) {
    let record = || suite.output.record_failure(plan, reason);
    match suite.ledger.commit(index, outcome, record) {
        Ok(true) => tell_failed(index, outcome, suite, observer),
        Ok(false) => {}
        Err(error) => enter_unwritten((plan, index), &error, suite, observer),
    }
}

/// Enters a run whose folder could not be written, which leaves what stood in its place, and tells the
/// observer.
fn enter_unwritten(
    (plan, index): (&Plan, usize),
    error: &StoreError,
    suite: &Suite,
    observer: &dyn Observer,
) {
    let resolved = plan.resolved();
    let name = &resolved.scenario.name;
    let reason = error.to_string();
    let outcome = RunOutcome::failed(name, &resolved.folder(), &resolved.file, reason);
    if suite.ledger.enter(index, &outcome) {
        suite.ledger.note_unwritten();
        tell_failed(index, &outcome, suite, observer);
    }
}

fn tell_failed(index: usize, outcome: &RunOutcome, suite: &Suite, observer: &dyn Observer) {
    let tell = || observer.failed(index, outcome);
    if catch_unwind(AssertUnwindSafe(tell)).is_err() {
        suite.ledger.note_broken();
    }
}

/// Closes the ledger and writes the files of the suite. What breaks an invariant is left out, and
/// the rest is written all the same.
fn conclude(plans: &[Plan], layout: &Layout, suite: &Suite) -> SuiteOutcome {
    let Suite { output, ledger, .. } = *suite;
    let runs = ledger.close(plans);
    let comparison = unbroken(ledger, || layout.fill(plans, &runs)).unwrap_or_default();
    let Settled { stale, failures } = output.settle();
    let mut failures: Vec<String> = failures.iter().map(ToString::to_string).collect();
    let tables = unbroken(ledger, || report::comparison_files(&comparison));
    let mut files = tables.unwrap_or_default();
    let summary = || report::suite_summary_json(VERSION, &runs, &comparison, &stale);
    let junit = || report::junit_xml(&runs);
    files.extend(unbroken(ledger, summary).map(|text| (SUMMARY.to_owned(), text)));
    files.extend(unbroken(ledger, junit).map(|text| (JUNIT.to_owned(), text)));
    failures.extend(output.publish(&files).err().map(|error| error.to_string()));
    SuiteOutcome {
        runs,
        comparison,
        broken: ledger.is_broken(),
        threads: 0,
        stale,
        unwritten: ledger.is_unwritten(),
        failures,
    }
}

/// What `make` makes; none, and a note in the ledger, if it breaks an invariant.
fn unbroken<T>(ledger: &Ledger, make: impl FnOnce() -> T) -> Option<T> {
    let made = catch_unwind(AssertUnwindSafe(make)).ok();
    if made.is_none() {
        ledger.note_broken();
    }
    made
}

/// The outcome of a run that broke an invariant, with what the panic said.
fn broken_run(plan: &Plan, panic: &(dyn Any + Send)) -> RunOutcome {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    let resolved = plan.resolved();
    RunOutcome::failed(
        &resolved.scenario.name,
        &resolved.folder(),
        &resolved.file,
        format!("internal error, please report it: {message}"),
    )
}
