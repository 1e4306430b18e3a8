//! From paths and `--set` to checked plans, or to printed complaints and an exit code.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use wildmatch::WildMatch;

use crate::cli::options::arguments::SelectOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::experiment::{Plan, Sound, check_suite, plan_suite};
use crate::scenario::{ScenarioError, left_out};

/// Folder whose sub-folders run when no path is given.
const DEFAULT_FOLDER: &str = "scenarios";

/// Reads, checks and plans everything that `options` selects.
///
/// Complaints and remarks are printed before it returns.
pub(in crate::cli) fn plans(options: &SelectOptions) -> Result<Vec<Plan>, Exit> {
    let plans = selected(options, plan_suite, |plan| &plan.resolved().scenario.name)?;
    // What is said of a scenario is said once, not for each of its points.
    let mut said = BTreeSet::new();
    let remarks = plans.iter().flat_map(|plan| &plan.resolved().remarks);
    output::talk_first("warning: ", remarks.filter(|remark| said.insert(*remark)));
    Ok(plans)
}

/// Reads and checks everything that `options` selects.
///
/// Complaints are printed before the exit code is returned.
pub(in crate::cli) fn sound(options: &SelectOptions) -> Result<Vec<Sound>, Exit> {
    selected(options, check_suite, |sound| &sound.name)
}

/// What a reader finds, or every complaint.
type Found<T> = Result<Vec<T>, Vec<ScenarioError>>;

/// What one of the readers makes of a selection.
fn selected<T>(
    options: &SelectOptions,
    read: impl Fn(&[PathBuf], &[String]) -> Found<T>,
    name: impl Fn(&T) -> &str,
) -> Result<Vec<T>, Exit> {
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
    for folder in left_out(&paths) {
        let folder = folder.display();
        output::talk(&format!("note: {folder} is left out: name it to take it"));
    }
    let mut found = read(&paths, &options.set).map_err(|errors| {
        complaint::print(&errors);
        Exit::Usage
    })?;
    if found.is_empty() {
        output::talk("error: nothing selected: no scenario with a `name` was found");
        return Err(Exit::NothingSelected);
    }
    let globs: Vec<WildMatch> = options.names.iter().map(|it| WildMatch::new(it)).collect();
    if !globs.is_empty() {
        found.retain(|it| globs.iter().any(|glob| glob.matches(name(it))));
    }
    if found.is_empty() {
        output::talk(&format!(
            "error: nothing selected: no scenario has a name like `{}`; `fogbench list` shows the names",
            options.names.join("` or `")
        ));
        return Err(Exit::NothingSelected);
    }
    Ok(found)
}
