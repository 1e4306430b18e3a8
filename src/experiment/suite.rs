//! Many runs at once: the thread pool, the order of results and the files of the whole suite.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::comparison::Layout;
use super::plan::Plan;
use super::run::run_scenario;
use crate::report::{self, Comparison, RunOutcome, RunReport};

/// Version of the program, as every result names it.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The suite's own files.
const SUITE_FILES: [&str; 2] = ["summary.json", "junit.xml"];

/// How a suite is run.
#[derive(Clone, Debug)]
pub struct SuiteOptions {
    /// Folder that receives the results; made if absent.
    pub output: PathBuf,
    /// Threads; 0 = one per core.
    pub threads: usize,
}

/// What the caller wants to hear while a suite runs; called from many threads.
pub trait Observer: Sync {
    /// `simulated_s` more seconds of gyro time are done.
    fn advanced(&self, simulated_s: f64);
    /// Run `index` of the plan is done and its files stand in their place.
    fn finished(&self, index: usize, report: &RunReport);
    /// Run `index` of the plan could not finish and has written nothing.
    fn failed(&self, index: usize, outcome: &RunOutcome);
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
}

/// Why a suite stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
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
/// [`SuiteError`] if a file cannot be written or the threads cannot be started. Folders of runs
/// that were complete by then stay.
pub fn run_suite(
    plans: &[Plan],
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<SuiteOutcome, SuiteError> {
    create_folder(&options.output)?;
    for name in SUITE_FILES {
        remove(&options.output.join(name))?;
    }
    remove_tables(&options.output)?;
    let layout = Layout::of(plans);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|error| SuiteError::Threads {
            threads: options.threads,
            message: error.to_string(),
        })?;
    let (runs, broken) = pool.install(|| run_all(plans, &layout, options, observer))?;
    let comparison = layout.fill(plans, &runs);
    for (name, text) in report::comparison_files(&comparison) {
        write(&options.output.join(name), &text)?;
    }
    let [summary, junit] = SUITE_FILES;
    write(
        &options.output.join(summary),
        &report::suite_summary_json(VERSION, &runs, &comparison),
    )?;
    write(&options.output.join(junit), &report::junit_xml(&runs))?;
    Ok(SuiteOutcome {
        runs,
        comparison,
        broken,
    })
}

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(
    plans: &[Plan],
    layout: &Layout,
    options: &SuiteOptions,
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
            let run = || run_scenario(&plans[index], index, layout, &options.output, observer);
            let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
                broken.store(true, Ordering::Relaxed);
                Ok(broken_run(&plans[index], &*panic))
            });
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

fn remove(path: &Path) -> Result<(), SuiteError> {
    match std::fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(SuiteError::Write {
            path: path.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}

/// Removes the tables of an earlier suite: the tool names no other file so.
fn remove_tables(output: &Path) -> Result<(), SuiteError> {
    let read = |source| SuiteError::Write {
        path: output.to_owned(),
        source,
    };
    for entry in std::fs::read_dir(output).map_err(read)? {
        let entry = entry.map_err(read)?;
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && report::is_comparison_file(&entry.file_name().to_string_lossy()) {
            remove(&entry.path())?;
        }
    }
    Ok(())
}

fn create_folder(path: &Path) -> Result<(), SuiteError> {
    std::fs::create_dir_all(path).map_err(|source| SuiteError::Write {
        path: path.to_owned(),
        source,
    })
}

fn write(path: &Path, text: &str) -> Result<(), SuiteError> {
    report::write_atomic(path, text.as_bytes()).map_err(|source| SuiteError::Write {
        path: path.to_owned(),
        source,
    })
}
