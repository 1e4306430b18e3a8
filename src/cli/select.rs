//! From paths and `--set` to checked plans, or to printed complaints and an exit code.

use std::path::{Path, PathBuf};

use super::arguments::SelectOptions;
use super::exit::Exit;
use super::{complaint, output};
use crate::experiment::{Plan, plan_suite};

/// Folder whose sub-folders run when no path is given.
const DEFAULT_FOLDER: &str = "scenarios";

/// Reads, checks and plans everything that `options` selects.
///
/// All complaints are printed before the exit code is returned.
pub(super) fn plans(options: &SelectOptions) -> Result<Vec<Plan>, Exit> {
    let paths = if options.paths.is_empty() {
        vec![PathBuf::from(DEFAULT_FOLDER)]
    } else {
        options.paths.clone()
    };
    if options.paths.is_empty() && !Path::new(DEFAULT_FOLDER).is_dir() {
        output::talk(&format!(
            "error: there is no folder `{DEFAULT_FOLDER}` here: name a scenario file or folder"
        ));
        return Err(Exit::NothingSelected);
    }
    let plans = plan_suite(&paths, &options.set).map_err(|errors| {
        complaint::print(&errors);
        Exit::Usage
    })?;
    if plans.is_empty() {
        output::talk("error: nothing selected: no scenario with a `name` was found");
        return Err(Exit::NothingSelected);
    }
    Ok(plans)
}
