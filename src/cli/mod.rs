//! The command line: options, commands, and the only code that prints.
//!
//! Data goes to stdout, talk and progress to stderr. A progress bar is drawn on a terminal only.

mod commands;
mod options;
mod terminal;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use crate::experiment::start_threads;
#[cfg(unix)]
use crate::program::supervise;
use commands::comparison::{baseline, claim, compare};
use commands::scenarios::{check, expand, init, list, reference, schema};
use commands::shards::{merge, plan, status};
use commands::shell::{completions, man};
use commands::{budget, calibrate, export, infer, log, points, records, run, timing, wordlength};
use options::arguments::{Arguments, Command};
use options::idle;
use terminal::exit::{self, Exit};
use terminal::panics;
use terminal::signals::Interrupt;

/// Runs the program: parses the arguments, dispatches the command and returns the exit code.
#[must_use]
pub fn main() -> ExitCode {
    #[cfg(unix)]
    if supervise(std::env::args_os()).is_some() {
        return ExitCode::SUCCESS;
    }
    panics::install();
    let interrupt = match Interrupt::install() {
        Ok(interrupt) => interrupt,
        Err(error) => return exit::io_failure(error).code(),
    };
    let arguments = match idle::parse() {
        Ok(arguments) => arguments,
        Err(error) => return exit::usage(error),
    };
    terminal::output::set_colour(arguments.color);
    // The panic hook has already printed what broke, and may have done so on another thread.
    let outcome = catch_unwind(AssertUnwindSafe(|| dispatch(&arguments, &interrupt)));
    let broken = panics::happened().then_some(Exit::Internal);
    let exit = outcome.unwrap_or(Exit::Internal);
    exit.worst(broken.unwrap_or(exit)).code()
}

fn dispatch(arguments: &Arguments, interrupt: &Interrupt) -> Exit {
    // A suite has threads of its own.
    if !matches!(arguments.command, Command::Run(_) | Command::Merge(_)) {
        start_threads();
    }
    let result = match &arguments.command {
        Command::Init(options) => init::init(options),
        Command::Run(options) => run::run(options, interrupt),
        Command::Plan(options) => plan::plan(options),
        Command::Merge(options) => merge::merge(options, interrupt),
        Command::Status(options) => status::status(options),
        Command::Check(options) => check::check(options),
        Command::Expand(options) => expand::expand(options),
        Command::List(options) => list::list(options),
        Command::Reference(options) => reference::reference(options),
        Command::Schema => schema::schema(),
        Command::Compare(options) => compare::compare(options),
        Command::Baseline(options) => baseline::baseline(options),
        Command::Budget(options) => budget::budget(options),
        Command::Infer(options) => infer::infer(options),
        Command::Analyze(options) => log::analyze(options),
        Command::Filter(options) => log::filter(options),
        Command::Claim(options) => claim::claim(options),
        Command::Calibrate(options) => calibrate::calibrate(options),
        Command::ScaleFactor(options) => points::scale_factor(options),
        Command::Timing(options) => timing::timing(options),
        Command::Wordlength(options) => wordlength::wordlength(options),
        Command::Export(options) => export::export(options),
        Command::Records(options) => records::records(options),
        Command::Completions(options) => completions::completions(options),
        Command::Man(options) => man::man(options),
    };
    result.unwrap_or_else(exit::io_failure)
}
