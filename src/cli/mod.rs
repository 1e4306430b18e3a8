//! The command line: one file per command, exit codes, and the only code that prints.
//!
//! Data goes to stdout, talk and progress to stderr. A progress bar is drawn on a terminal only.

mod arguments;
mod budget;
mod calibrate;
mod calibrate_arguments;
mod check;
mod exit;
mod expand;
mod export;
mod hardware_arguments;
mod list;
mod log;
mod log_arguments;
mod output;
mod place;
mod run;
mod schema;
mod select;
mod stimulus;
mod timing;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use exit::Exit;

/// Runs the program: parses the arguments, dispatches the command and returns the exit code.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return exit::usage(&error),
    };
    let outcome = std::panic::catch_unwind(|| dispatch(&arguments));
    // The panic hook has already printed what broke.
    outcome.unwrap_or(Exit::Internal).code()
}

fn dispatch(arguments: &Arguments) -> Exit {
    let result = match &arguments.command {
        Command::Run(options) => run::run(options),
        Command::Check(options) => check::check(options),
        Command::Expand(options) => expand::expand(options),
        Command::List(options) => list::list(options),
        Command::Schema => schema::schema(),
        Command::Budget(options) => budget::budget(options),
        Command::Analyze(options) => log::analyze(options),
        Command::Filter(options) => log::filter(options),
        Command::Calibrate(options) => calibrate::calibrate(options),
        Command::Timing(options) => timing::timing(options),
        Command::Export(options) => export::export(options),
    };
    result.unwrap_or_else(exit::io_failure)
}
