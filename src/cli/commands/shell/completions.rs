//! `fogbench completions`: what a shell needs to complete the command line.

use std::io;

use clap::CommandFactory as _;

use crate::cli::options::arguments::{Arguments, CompletionsOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;

/// Prints the completions of a shell.
pub(in crate::cli) fn completions(options: &CompletionsOptions) -> io::Result<Exit> {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut command, name, &mut script);
    output::data(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Success)
}
