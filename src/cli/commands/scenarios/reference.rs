//! `fogbench reference`: what a scenario may hold, whole or of one key or table.

use std::io;

use crate::cli::options::arguments::ReferenceOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::scenario::{reference_part, reference_toml};

/// Prints the reference.
pub(in crate::cli) fn reference(options: &ReferenceOptions) -> io::Result<Exit> {
    match options.key.as_deref().map(reference_part) {
        None => output::data(reference_toml())?,
        Some(Ok(part)) => output::data(&part)?,
        Some(Err(refused)) => {
            complaint::print(&[refused.to_string()]);
            return Ok(Exit::Usage);
        }
    }
    Ok(Exit::Success)
}
