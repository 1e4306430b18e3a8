//! Many runs at once: the thread pool, the order of results and the files of the whole suite.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::comparison::Layout;
use super::plan::Plan;
use super::resume::Resume;
use super::run::run_scenario;
use super::suite_output::{JUNIT, SUMMARY, SuiteOutput};
use crate::report::{self, Comparison, RunOutcome, RunReport};
use crate::store::StoreError;

/// Version of the program, as every result names it.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// How a suite is run.
#[derive(Clone, Debug)]
pub struct SuiteOptions {
    /// Folder that receives the results; made if absent.
    pub output: PathBuf,
    /// Threads; 0 = one per core.
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

/// What the caller wants to hear while a suite runs; called from many threads.
pub trait Observer: Sync {
    /// `simulated_s` more seconds of gyro time are done.
    fn advanced(&self, simulated_s: f64);
    /// Run `index` of the plan is done and its files stand in their place.
    fn finished(&self, index: usize, report: &RunReport);
    /// Run `index` of the plan could not finish; a folder that says so stands in its place.
    fn failed(&self, index: usize, outcome: &RunOutcome);
    /// Run `index` of the plan is not run again: its folder holds the result. It counts as finished.
    fn taken_over(&self, index: usize, report: &RunReport) {
        self.finished(index, report);
    }
    /// Something about the suite is worth saying.
    fn caution(&self, _message: &str) {}
}

/// What came of a suite.
#[derive(Clone, Debug)]
pub struct SuiteOutcome {
    /// Runs in the order of the plans.
    pub runs: Vec<RunOutcome>,
    /// What they say across scenarios.
    pub comparison: Comparison,
    /// Whether a run was stopped by a broken invariant, which is a defect of the program.
    pub broken: bool,
    /// Folders that hold results of earlier scenarios of these names.
    pub stale: Vec<String>,
}

/// Why a suite stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// The output folder is in use or holds something of the user's, or a file could not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The thread pool could not be made.
    #[error("cannot start {threads} threads: {message}")]
    Threads {
        /// Number asked for.
        threads: usize,
        /// What the pool said.
        message: String,
    },
}

/// Runs every plan and writes `options.output`.
///
/// Results come back in the order of `plans`, whatever the order of completion; every file depends
/// on its scenario, seed and the version of the program alone. The suite's own files are removed
/// first and written last, so that an interrupted suite leaves no verdict of an earlier one. A run
/// that breaks an invariant fails by itself; the others go on.
///
/// # Errors
/// [`SuiteError`] if something of the user's would be replaced, before anything runs; if another
/// process writes into the folder; if a file cannot be written or the threads cannot be started.
/// Folders of runs that were complete by then stay.
pub fn run_suite(
    plans: &[Plan],
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<SuiteOutcome, SuiteError> {
    let layout = Layout::of(plans);
    let output = SuiteOutput::open(plans, &layout, options)?;
    if let Some(caution) = output.caution() {
        observer.caution(caution);
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|error| SuiteError::Threads {
            threads: options.threads,
            message: error.to_string(),
        })?;
    let run = || run_all(plans, &layout, options, &output, observer);
    let (runs, broken) = pool.install(run)?;
    let comparison = layout.fill(plans, &runs);
    let stale = output.settle()?;
    let mut files = report::comparison_files(&comparison);
    files.push((
        SUMMARY.to_owned(),
        report::suite_summary_json(VERSION, &runs, &comparison, &stale),
    ));
    files.push((JUNIT.to_owned(), report::junit_xml(&runs)));
    output.publish(&files)?;
    Ok(SuiteOutcome {
        runs,
        comparison,
        broken,
        stale,
    })
}

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(
    plans: &[Plan],
    layout: &Layout,
    options: &SuiteOptions,
    output: &SuiteOutput,
    observer: &dyn Observer,
) -> Result<(Vec<RunOutcome>, bool), SuiteError> {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].cost().total_cmp(&plans[a].cost()));
    let stopped = AtomicBool::new(false);
    let broken = AtomicBool::new(false);
    // One item at a time, so that a thread takes the next longest run when it is free.
    let mut results: Vec<_> = order
        .par_iter()
        .with_max_len(1)
        .filter(|_| !stopped.load(Ordering::Relaxed))
        .map(|&index| {
            let plan = &plans[index];
            let run = || run_scenario(plan, index, layout, (output, options.resume), observer);
            let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
                broken.store(true, Ordering::Relaxed);
                Ok(broken_run(plan, &*panic))
            });
            let result = result.and_then(|outcome| output.record_failure(plan, outcome));
            match &result {
                Ok(outcome) if outcome.error.is_some() => observer.failed(index, outcome),
                Ok(_) => {}
                Err(_) => stopped.store(true, Ordering::Relaxed),
            }
            (index, result)
        })
        .collect();
    results.sort_by_key(|(index, _)| *index);
    let runs: Result<Vec<_>, _> = results.into_iter().map(|(_, result)| result).collect();
    Ok((runs?, broken.load(Ordering::Relaxed)))
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
