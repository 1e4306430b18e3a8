//! `fogbench run`: runs scenarios, prints a line of each as they become ready, ends with the verdict.

mod account;
mod against;
mod clock;
mod progress;
mod server_files;
mod shard;

use std::io;

use crate::cli::commands::consent::consent;
use crate::cli::commands::select;
use crate::cli::options::arguments::{ResumeFrom, RunOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::signals::Interrupt;
use crate::experiment::{
    Observer, Plan, Resume, SuiteError, SuiteOptions, SuiteOutcome, program_files, run_suite,
};
use crate::program::Programs;
use crate::scenario::bounded;
use progress::Progress;
use server_files::ServerFiles;

/// Plans, runs, prints and judges; a part of a suite is run alone.
pub(in crate::cli) fn run(options: &RunOptions, interrupt: &Interrupt) -> io::Result<Exit> {
    if options.shard.is_asked() {
        return shard::run(options, interrupt);
    }
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    if options.account.require_gates && without_gates(&plans) {
        return Ok(Exit::GateFailed);
    }
    let programs = match programs(&plans, options) {
        Ok(programs) => programs,
        Err(exit) => return Ok(exit),
    };
    conclude_by(&plans, options, interrupt, programs, |suite, observer| {
        run_suite(&plans, suite, observer)
    })
}

/// Says so where no scenario has a gate.
pub(super) fn without_gates(plans: &[Plan]) -> bool {
    let mut plans = plans.iter();
    let is_lacking = plans.all(|plan| plan.resolved().scenario.gates.is_empty());
    if is_lacking {
        output::talk("error: --require-gates: no selected scenario has a gate; nothing was run");
    }
    is_lacking
}

/// The right to start the programs that some plans name, where there are any.
fn programs<'a>(
    plans: impl IntoIterator<Item = &'a Plan>,
    options: &RunOptions,
) -> Result<Option<Programs>, Exit> {
    let programs = plans
        .into_iter()
        .flat_map(|plan| program_files(plan.resolved()));
    consent(programs, options.allow_programs)
}

/// Makes the output folder of a suite by `make`, prints and judges.
pub(super) fn conclude_by(
    plans: &[Plan],
    options: &RunOptions,
    interrupt: &Interrupt,
    programs: Option<Programs>,
    make: impl FnOnce(&SuiteOptions, &dyn Observer) -> Result<SuiteOutcome, SuiteError>,
) -> io::Result<Exit> {
    let beside = against::earlier(options)
        .and_then(|earlier| Ok((earlier, ServerFiles::check(options, plans)?)));
    let (earlier, server) = match beside {
        Ok(beside) => beside,
        Err(exit) => return Ok(exit),
    };
    let suite = SuiteOptions {
        earlier,
        threads: usize::from(options.account.jobs),
        force: options.force,
        resume: resume(options.resume),
        ..SuiteOptions::new(options.output.clone())
    };
    let progress = Progress::new(plans, options, server, interrupt).starting(programs);
    warn_of_threads(options);
    interrupt.defer();
    let result = make(&suite, &progress);
    Ok(progress.conclude(&result))
}

/// Says so where the variable for the number of threads holds none.
fn warn_of_threads(options: &RunOptions) {
    if let Some(text) = senseless_threads(options) {
        output::talk(&format!(
            "warning: RAYON_NUM_THREADS = `{}` is no number of threads: one per core",
            bounded(&text)
        ));
    }
}

/// What the variable for the number of threads says in vain; none if it is not asked, or a number.
fn senseless_threads(options: &RunOptions) -> Option<String> {
    let text = std::env::var("RAYON_NUM_THREADS").ok()?;
    let is_idle = options.account.jobs > 0 || text.is_empty() || text.parse::<usize>().is_ok();
    (!is_idle).then_some(text)
}

/// Whose results the suite takes over.
fn resume(from: Option<ResumeFrom>) -> Resume {
    match from {
        None => Resume::Never,
        Some(ResumeFrom::SameBuild) => Resume::SameBuild,
        Some(ResumeFrom::AnyBuild) => Resume::AnyBuild,
    }
}
