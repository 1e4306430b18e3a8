//! `fogbench man`: the pages of the manual.

use std::io;

use clap::CommandFactory as _;
use clap_mangen::Man;

use crate::cli::options::arguments::{Arguments, ManOptions};
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::wording::is_misspelling;

/// Prints the page of the program or of a command.
pub(in crate::cli) fn man(options: &ManOptions) -> io::Result<Exit> {
    let mut page = Arguments::command();
    page.build();
    for name in &options.command {
        let found = page.find_subcommand(name).cloned();
        let Some(below) = found else {
            complaint::print(&[unknown(&page, name)]);
            return Ok(Exit::Usage);
        };
        page = below;
    }
    let mut text = Vec::new();
    Man::new(page).render(&mut text)?;
    output::data(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Success)
}

/// The complaint about a command that there is not.
fn unknown(command: &clap::Command, name: &str) -> String {
    let known: Vec<&str> = command
        .get_subcommands()
        .map(clap::Command::get_name)
        .collect();
    let said = format!(
        "`{}` has no command {name}",
        command.get_bin_name().unwrap_or(command.get_name())
    );
    if known.is_empty() {
        return said;
    }
    match known.iter().find(|known| is_misspelling(name, known)) {
        Some(meant) => format!("{said}: did you mean {meant}?"),
        None => format!("{said}: it has {}", known.join(", ")),
    }
}
