//! From paths and `--set` to checked plans, or to printed complaints and an exit code.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use wildmatch::WildMatch;

use crate::cli::options::arguments::SelectOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::experiment::{Listing, Plan, Sound, Wanted, check_suite, list_suite, plan_suite};
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

/// Reads and checks everything that `options` selects, and lists it.
///
/// * `is_kept`: whether the plan of the run in a folder is kept.
///
/// Complaints and remarks are printed before it returns.
pub(in crate::cli) fn listing(
    options: &SelectOptions,
    is_kept: &dyn Fn(&str) -> bool,
    is_estimated: bool,
) -> Result<Listing, Exit> {
    let paths = paths(options)?;
    let names = Names::of(options);
    let wanted = Wanted {
        is_listed: &|name| names.has(name),
        is_kept,
        is_estimated,
    };
    let listing = list_suite(&paths, &options.set, wanted).map_err(|errors| refused(&errors))?;
    let runs = listing.list.runs();
    if runs == 0 {
        return Err(nothing_selected(options, listing.has_others));
    }
    output::talk_first("warning: ", listing.remarks.iter());
    Ok(listing)
}

/// What a reader finds, or every complaint.
type Found<T> = Result<Vec<T>, Vec<ScenarioError>>;

/// What one of the readers makes of a selection.
fn selected<T>(
    options: &SelectOptions,
    read: impl Fn(&[PathBuf], &[String]) -> Found<T>,
    name: impl Fn(&T) -> &str,
) -> Result<Vec<T>, Exit> {
    let paths = paths(options)?;
    let mut found = read(&paths, &options.set).map_err(|errors| refused(&errors))?;
    let has_any = !found.is_empty();
    let names = Names::of(options);
    found.retain(|it| names.has(name(it)));
    if found.is_empty() {
        return Err(nothing_selected(options, has_any));
    }
    Ok(found)
}

/// Files and folders that are selected; what of them is left out is printed.
fn paths(options: &SelectOptions) -> Result<Vec<PathBuf>, Exit> {
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
    Ok(paths)
}

/// Prints complaints.
fn refused(errors: &[ScenarioError]) -> Exit {
    complaint::print(errors);
    Exit::Usage
}

/// Says that there is nothing to run: no scenario at all, or none of a name that is asked for.
fn nothing_selected(options: &SelectOptions, has_others: bool) -> Exit {
    output::talk(&if has_others {
        format!(
            "error: nothing selected: no scenario has a name like `{}`; `fogbench list` shows the names",
            options.names.join("` or `")
        )
    } else {
        "error: nothing selected: no scenario with a `name` was found".to_owned()
    });
    Exit::NothingSelected
}

/// The names that are asked for; all where none is.
struct Names(Vec<WildMatch>);

impl Names {
    fn of(options: &SelectOptions) -> Self {
        Self(options.names.iter().map(|it| WildMatch::new(it)).collect())
    }

    fn has(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|glob| glob.matches(name))
    }
}
