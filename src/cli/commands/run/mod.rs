//! `fogbench run`: runs scenarios, prints a line of each as they become ready, ends with the verdict.

mod account;
mod against;
mod clock;
mod progress;
mod server_files;

use std::io;

use crate::cli::commands::consent::consent;
use crate::cli::commands::select;
use crate::cli::options::arguments::{ResumeFrom, RunOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::signals::Interrupt;
use crate::experiment::{Resume, SuiteOptions, program_files, run_suite};
use crate::scenario::bounded;
use progress::Progress;
use server_files::ServerFiles;

/// Plans, runs, prints and judges.
pub(in crate::cli) fn run(options: &RunOptions, interrupt: &Interrupt) -> io::Result<Exit> {
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    if options.require_gates
        && plans
            .iter()
            .all(|plan| plan.resolved().scenario.gates.is_empty())
    {
        output::talk("error: --require-gates: no selected scenario has a gate; nothing was run");
        return Ok(Exit::GateFailed);
    }
    let programs = plans.iter().flat_map(|plan| program_files(plan.resolved()));
    let programs = match consent(programs, options.allow_programs) {
        Ok(programs) => programs,
        Err(exit) => return Ok(exit),
    };
    let beside = against::earlier(options)
        .and_then(|earlier| Ok((earlier, ServerFiles::check(options, &plans)?)));
    let (earlier, server) = match beside {
        Ok(beside) => beside,
        Err(exit) => return Ok(exit),
    };
    let suite = SuiteOptions {
        earlier,
        threads: usize::from(options.jobs),
        force: options.force,
        resume: resume(options.resume),
        ..SuiteOptions::new(options.output.clone())
    };
    let progress = Progress::new(&plans, options, server, interrupt).starting(programs);
    if let Some(text) = senseless_threads(options) {
        output::talk(&format!(
            "warning: RAYON_NUM_THREADS = `{}` is no number of threads: one per core",
            bounded(&text)
        ));
    }
    interrupt.defer();
    let result = run_suite(&plans, &suite, &progress);
    Ok(progress.conclude(&result))
}

/// What the variable for the number of threads says in vain; none if it is not asked, or a number.
fn senseless_threads(options: &RunOptions) -> Option<String> {
    let text = std::env::var("RAYON_NUM_THREADS").ok()?;
    let is_idle = options.jobs > 0 || text.is_empty() || text.parse::<usize>().is_ok();
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
