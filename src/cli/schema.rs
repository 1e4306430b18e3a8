//! `fogbench schema`: the JSON Schema of scenario files, for editors.

use std::io;

use super::exit::Exit;
use super::output;
use crate::scenario;

/// Prints the schema.
pub(super) fn schema() -> io::Result<Exit> {
    output::data(&format!("{:#}\n", scenario::json_schema()))?;
    Ok(Exit::Success)
}
