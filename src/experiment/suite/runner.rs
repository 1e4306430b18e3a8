//! Many runs at once: the thread pool and the order of work.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::channel;

use rayon::prelude::*;

use super::conclude::{conclude, layout};
use super::entry::{Suite, run_scenario};
use super::files::failed;
use super::ledger::{Ledger, wait};
use super::options::SuiteOptions;
use super::outcome::{Observer, SuiteError, SuiteOutcome};
use super::output::SuiteOutput;
use super::threads;
use crate::comparison::Layout;
use crate::experiment::plan::Plan;
use crate::report::RunOutcome;
use crate::store::StoreError;

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
    let layout = &layout(plans);
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
        earlier: options.earlier.as_ref(),
        ledger,
    };
    let work = || run_all(plans, layout, suite, observer);
    conduct((plans, layout), suite, &pool, observer, work)
}

/// Does the work of a suite on a pool and writes what it comes to; where the observer stops it in the middle of
/// a long stage, it hears of that with what there is.
pub(crate) fn conduct(
    (plans, layout): (&[Plan], &Layout),
    suite: &Suite,
    pool: &rayon::ThreadPool,
    observer: &dyn Observer,
    work: impl FnOnce() + Send,
) -> Result<SuiteOutcome, SuiteError> {
    let conclude = || {
        Ok(SuiteOutcome {
            threads: pool.current_num_threads(),
            ..conclude(plans, layout, suite)
        })
    };
    let (end_of_work, ends) = channel();
    let stopped = pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            work();
            drop(end_of_work);
        });
        (!wait(&ends, observer)).then(|| {
            let result = conclude();
            suite.output.sign_off();
            observer.abandoned(&result);
            result
        })
    });
    stopped.unwrap_or_else(conclude)
}

/// Runs the plans longest first, so that the last core is not left alone with the longest run.
fn run_all(plans: &[Plan], layout: &Layout, suite: &Suite, observer: &dyn Observer) {
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by(|&a, &b| plans[b].cost().total_cmp(&plans[a].cost()));
    // One item at a time, so that a thread takes the next longest run when it is free.
    let order = order.par_iter().with_max_len(1);
    let ledger = suite.ledger;
    order.for_each(|&index| {
        if observer.should_stop() || !observer.may_start() {
            return;
        }
        let plan = &plans[index];
        let run = || {
            observer.started(index);
            run_scenario(plan, index, layout, suite, observer)
        };
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
pub(crate) fn enter_failure(
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
pub(crate) fn enter_unwritten(
    (plan, index): (&Plan, usize),
    error: &StoreError,
    suite: &Suite,
    observer: &dyn Observer,
) {
    let outcome = failed(plan, error.to_string());
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

/// The outcome of a run that broke an invariant, with what the panic said.
fn broken_run(plan: &Plan, panic: &(dyn Any + Send)) -> RunOutcome {
    failed(plan, panic_text(panic))
}

/// A broken invariant, as users are told of it.
pub(crate) fn panic_text(panic: &(dyn Any + Send)) -> String {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    format!("internal error, please report it: {message}")
}
