//! Many runs at once: the thread pool, the order of results and the files of the whole suite.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::plan::Plan;
use super::run::run_scenario;
use crate::report::{self, RunOutcome, RunReport};

/// Version of the program, as every result names it.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

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
/// on its scenario, seed and the version of the program alone.
///
/// # Errors
/// [`SuiteError`] if a file cannot be written or the threads cannot be started. Folders of runs
/// that were complete by then stay.
pub fn run_suite(
    plans: &[Plan],
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<Vec<RunOutcome>, SuiteError> {
    create_folder(&options.output)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|error| SuiteError::Threads {
            threads: options.threads,
            message: error.to_string(),
        })?;
    let runs = pool.install(|| run_all(plans, options, observer))?;
    write(
        &options.output.join("summary.json"),
        &report::suite_summary_json(VERSION, &runs),
    )?;
    write(&options.output.join("junit.xml"), &report::junit_xml(&runs))?;
    Ok(runs)
}

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(
    plans: &[Plan],
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<Vec<RunOutcome>, SuiteError> {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].cost().total_cmp(&plans[a].cost()));
    let stopped = AtomicBool::new(false);
    // One item at a time, so that a thread takes the next longest run when it is free.
    let results: Vec<_> = order
        .par_iter()
        .with_max_len(1)
        .map(|&index| {
            if stopped.load(Ordering::Relaxed) {
                return (index, None);
            }
            let result = run_scenario(&plans[index], index, &options.output, observer);
            if result.is_err() {
                stopped.store(true, Ordering::Relaxed);
            }
            (index, Some(result))
        })
        .collect();
    let mut ordered = results;
    ordered.sort_by_key(|(index, _)| *index);
    let mut runs = Vec::with_capacity(plans.len());
    for (_, result) in ordered {
        if let Some(result) = result {
            runs.push(result?);
        }
    }
    Ok(runs)
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
