//! Where a command writes its one result.

use std::path::Path;

use super::exit::Exit;
use super::output;
use crate::store::{OutputFolder, StoreError, StoreOptions};

/// Checks the folder of a result, if one is asked for, before anything is computed.
///
/// A refusal is printed before its exit code is returned.
pub(super) fn check(folder: Option<&Path>, force: bool) -> Result<(), Exit> {
    let Some(path) = folder else {
        return Ok(());
    };
    OutputFolder::check_result(path, options(force)).map_err(|error| refused(&error))
}

/// Takes the folder of a result and gives it to `write`.
pub(super) fn fill(
    path: &Path,
    force: bool,
    write: impl FnOnce(&OutputFolder) -> Result<(), StoreError>,
) -> Result<(), Exit> {
    let written = OutputFolder::of_result(path, options(force)).and_then(|folder| {
        if let Some(caution) = folder.caution() {
            output::talk(&format!("warning: {caution}"));
        }
        write(&folder)
    });
    written.map_err(|error| refused(&error))
}

fn options(force: bool) -> StoreOptions {
    StoreOptions {
        force,
        ..StoreOptions::default()
    }
}

/// Says why results are not written.
fn refused(error: &StoreError) -> Exit {
    output::talk(&format!("error: {error}"));
    exit_of(error)
}

/// The exit code of results that are not written.
pub(super) fn exit_of(error: &StoreError) -> Exit {
    if error.is_refusal() {
        Exit::Usage
    } else {
        Exit::Io
    }
}
