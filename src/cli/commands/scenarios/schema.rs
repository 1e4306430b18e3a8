//! `fogbench schema`: the JSON Schema of scenario files, for editors.

use std::io;

use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::scenario;

/// Prints the schema.
pub(in crate::cli) fn schema() -> io::Result<Exit> {
    output::data(&format!("{:#}\n", scenario::json_schema()))?;
    Ok(Exit::Success)
}
