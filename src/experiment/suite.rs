//! Many runs at once: the thread pool, the order of results and the files of the whole suite.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;

use rayon::prelude::*;

use super::comparison::Layout;
use super::ledger::{Ledger, wait};
use super::plan::Plan;
use super::run::run_scenario;
use super::threads;
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
    /// Threads, as [`thread_count`](super::thread_count) takes them.
    pub threads: usize,
}

/// What the caller wants to hear and to say while a suite runs; called from many threads.
pub trait Observer: Sync {
    /// `simulated_s` more seconds of gyro time are done.
    fn advanced(&self, simulated_s: f64);
    /// Run `index` of the plan is done and its files stand in their place.
    fn finished(&self, index: usize, report: &RunReport);
    /// Run `index` of the plan could not finish and has written nothing.
    fn failed(&self, index: usize, outcome: &RunOutcome);
    /// Whether the suite is to stop. Asked between the blocks and stages of every run; what has
    /// ended by then stays, the rest is not run.
    fn should_stop(&self) -> bool {
        false
    }
    /// Hears how a suite ended that was to stop while runs are still in the middle of a long stage.
    /// Its files stand; these runs will write nothing more. The caller may end the program here:
    /// [`run_suite`] returns the same only once they have come to the end of their stage.
    fn abandoned(&self, _result: &Result<SuiteOutcome, SuiteError>) {}
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
    /// Threads that it ran on: fewer than asked for where the system had no more.
    pub threads: usize,
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
    /// The system gave not one thread.
    #[error("cannot start a thread: {source}")]
    Threads {
        /// What the system said.
        source: io::Error,
    },
}

/// Runs every plan and writes `options.output`.
///
/// Results come back in the order of `plans`, whatever the order of completion; every file depends
/// on its scenario, seed and the version of the program alone. The suite's own files are removed
/// first and written last, so that a killed suite leaves no verdict of an earlier one; one that the
/// observer stops has files that say which runs have ended. A run that breaks an invariant fails by
/// itself; the others go on.
///
/// # Errors
/// [`SuiteError`] if a file cannot be written or no thread can be started. Folders of runs that
/// were complete by then stay.
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
    let layout = &Layout::of(plans);
    let pool = threads::pool(threads::thread_count(options.threads))
        .map_err(|source| SuiteError::Threads { source })?;
    let ledger = &Ledger::new(plans.len());
    let conclude = || {
        let outcome = conclude(plans, layout, options, ledger)?;
        let threads = pool.current_num_threads();
        Ok(SuiteOutcome { threads, ..outcome })
    };
    let (end_of_work, work) = channel();
    let stopped = pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            run_all(plans, layout, options, ledger, observer);
            drop(end_of_work);
        });
        (!wait(&work, observer)).then(|| {
            let result = conclude();
            observer.abandoned(&result);
            result
        })
    });
    stopped.unwrap_or_else(conclude)
}

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(
    plans: &[Plan],
    layout: &Layout,
    options: &SuiteOptions,
    ledger: &Ledger,
    observer: &dyn Observer,
) {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].cost().total_cmp(&plans[a].cost()));
    // One item at a time, so that a thread takes the next longest run when it is free.
    let order = order.par_iter().with_max_len(1);
    order.for_each(|&index| {
        if ledger.is_stopped() || observer.should_stop() {
            return;
        }
        let plan = &plans[index];
        let run = || run_scenario(plan, index, layout, &options.output, ledger, observer);
        let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
            ledger.note_broken();
            Ok(Some(broken_run(plan, &*panic)))
        });
        match result {
            Ok(Some(outcome)) if outcome.error.is_some() => {
                ledger.enter(index, &outcome);
                let tell = || observer.failed(index, &outcome);
                if catch_unwind(AssertUnwindSafe(tell)).is_err() {
                    ledger.note_broken();
                }
            }
            Ok(_) => {}
            Err(error) => ledger.fail(index, error),
        }
    });
}

/// Closes the ledger and writes the files of the suite. What breaks an invariant is left out, and
/// the rest is written all the same.
fn conclude(
    plans: &[Plan],
    layout: &Layout,
    options: &SuiteOptions,
    ledger: &Ledger,
) -> Result<SuiteOutcome, SuiteError> {
    let runs = ledger.close(plans)?;
    let comparison = unbroken(ledger, || layout.fill(plans, &runs)).unwrap_or_default();
    let tables = unbroken(ledger, || report::comparison_files(&comparison));
    for (name, text) in tables.into_iter().flatten() {
        write(&options.output.join(name), &text)?;
    }
    let summary = || report::suite_summary_json(VERSION, &runs, &comparison);
    let texts = [
        unbroken(ledger, summary),
        unbroken(ledger, || report::junit_xml(&runs)),
    ];
    for (name, text) in SUITE_FILES.into_iter().zip(texts) {
        if let Some(text) = text {
            write(&options.output.join(name), &text)?;
        }
    }
    Ok(SuiteOutcome {
        runs,
        comparison,
        broken: ledger.is_broken(),
        threads: 0,
    })
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
