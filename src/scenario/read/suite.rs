//! From paths to resolved runs: discovery, `--set` and sweeps.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::scenario::check::inert::{Idle, IdleSet, IdleSets};
use crate::scenario::check::presence::check_contradictions;
use crate::scenario::document::address::{self, AddressError, Step};
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value, parse_value};
use crate::scenario::message::error::{Location, ScenarioError, in_order};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::chain::{load_labelled, read_whole};
use crate::scenario::read::clashes::Names;
use crate::scenario::read::discover::discover;
use crate::scenario::read::draft::Draft;
use crate::scenario::read::files::named_files::LOG;
use crate::scenario::read::purpose::Purpose;
use crate::scenario::read::resolve::{Unsound, UnsoundReading};
use crate::scenario::read::resolved::Resolved;
use crate::scenario::read::sweep::matrix::{self, Swept};

/// What a scenario is read as: a run, or what can be checked further though it is not sound.
pub(crate) type Reading = Result<Resolved, UnsoundReading>;

/// Reads, resolves and checks every run of a suite; empty if the folders hold nothing to run.
///
/// A folder gives every `*.toml` below it that has a `name` of its own, in the order of their
/// paths; files without one are bases. A named file must have a name or be a manifest. Each of
/// `sets` is `key=value` and applies to every scenario after the files.
///
/// # Errors
/// Every complaint about every file, each once, in the order of the files and their lines.
pub fn load_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let mut runs = Vec::new();
    visit_suite(paths, sets, &mut |run| runs.push(run))?;
    Ok(runs)
}

/// As [`load_suite`], but hands each run over as soon as it is resolved: a suite of many runs need
/// not be held in memory. If there are complaints in the end, the runs are not to be trusted.
///
/// # Errors
/// As [`load_suite`].
pub fn visit_suite(
    paths: &[PathBuf],
    sets: &[String],
    visit: &mut dyn FnMut(Resolved),
) -> Result<(), Vec<ScenarioError>> {
    let errors = read_suite(paths, sets, &mut |reading| {
        if let Ok(run) = reading {
            visit(run);
        }
    });
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// As [`visit_suite`], but hands over what is not sound as well, for the checks that are still to
/// come; returns the complaints so far.
pub(crate) fn read_suite(
    paths: &[PathBuf],
    sets: &[String],
    visit: &mut dyn FnMut(Reading),
) -> Vec<ScenarioError> {
    let mut errors = Vec::new();
    let mut names = Names::default();
    let mut idle_sets = IdleSets::default();
    for found in discover(paths, &mut errors) {
        let file = &found.path;
        let draft = load_labelled(file, &Label::of_scenario(file), !found.is_named);
        let drafted = match draft {
            Ok(Some(drafted)) => Ok(drafted),
            // A base that was found in a folder is passed over.
            Ok(None) => continue,
            Err(errors) => Err(errors),
        };
        let findings = drafted.map_or_else(Findings::from, |drafted| {
            load_drafted(drafted, sets, &mut |reading| {
                if let Ok(run) = &reading {
                    names.take(run);
                }
                visit(reading);
            })
        });
        errors.extend(in_order(findings.errors));
        idle_sets.add(findings.idle_sets);
    }
    errors.extend(names.clashes);
    errors.extend(idle_sets.complaints());
    in_order(errors)
}

/// What is wrong with one file.
#[derive(Default)]
pub(in crate::scenario) struct Findings {
    pub(in crate::scenario) errors: Vec<ScenarioError>,
    /// Wishes by `--set` that act in no point of it.
    pub(in crate::scenario) idle_sets: Vec<IdleSet>,
}

impl From<Vec<ScenarioError>> for Findings {
    fn from(errors: Vec<ScenarioError>) -> Self {
        let idle_sets = Vec::new();
        Self { errors, idle_sets }
    }
}

/// Reads and checks the runs of one file of which only the gyro or the filters matter.
///
/// A base without a name and without a duration will do: both are then made up, and every other
/// check is that of [`load_suite`].
///
/// # Errors
/// Every complaint about the file.
pub fn load_base_or_scenario(
    file: &Path,
    sets: &[String],
    purpose: Purpose,
) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    if file.is_dir() {
        let location = Location::of_file(shown_path(file));
        return Err(vec![ScenarioError::at(
            location,
            "it is a folder: name one scenario or base file",
        )]);
    }
    let mut runs = Vec::new();
    let draft = read_whole(file, &Label::of_scenario(file)).map(|read| completed(read, purpose))?;
    let findings = load_drafted(draft, sets, &mut |reading| runs.extend(reading));
    let mut idle_sets = IdleSets::default();
    idle_sets.add(findings.idle_sets);
    let mut errors = findings.errors;
    errors.extend(idle_sets.complaints());
    if errors.is_empty() {
        Ok(runs)
    } else {
        Err(in_order(errors))
    }
}

/// A draft with a name and a duration.
fn completed(
    (mut draft, errors): (Draft, Vec<ScenarioError>),
    purpose: Purpose,
) -> (Draft, Vec<ScenarioError>) {
    draft.purpose = purpose;
    let made_up = [
        ("name", Value::Text("base".to_owned())),
        ("duration_s", Value::Float(1.0)),
    ];
    // Of a scenario that measures a log of its own only gates and filters are asked for.
    draft.root.remove(LOG);
    draft.is_record |= !draft.root.contains_key("name");
    for (key, value) in made_up {
        let node = Node { value, mark: None };
        draft.root.entry(key.to_owned()).or_insert(node);
    }
    (draft, errors)
}

/// Applies `--set` to what was read and resolves it, all points of a sweep.
pub(in crate::scenario) fn load_drafted(
    (mut draft, errors): (Draft, Vec<ScenarioError>),
    sets: &[String],
    visit: &mut dyn FnMut(Reading),
) -> Findings {
    let mut findings = Findings::from(errors);
    let matrix = draft.root.remove("matrix");
    if matrix.is_some() {
        // A sweep over a manifest is an experiment of its own.
        draft.recorded = None;
    }
    let set_paths = apply_sets(&mut draft, sets, &mut findings.errors);
    let mut idle: Option<Idle> = None;
    let mut take = |run: Resolved, swept: &[Swept]| {
        match &mut idle {
            None => idle = Some(Idle::of(&run, swept)),
            Some(idle) => idle.keep_idle(&run),
        }
        visit(Ok(run));
    };
    let result = match &matrix {
        None => draft.resolve().map(|run| take(run, &[])),
        Some(matrix) => matrix::expand(&draft, matrix, &set_paths, &mut take),
    };
    match result {
        Ok(()) => {
            let (own, idle_sets) = idle.map(Idle::complaints).unwrap_or_default();
            findings.errors.extend(own);
            findings.idle_sets = idle_sets;
        }
        Err(Unsound { errors, reading }) => {
            findings.errors.extend(errors);
            if let Some(reading) = reading {
                if matrix.is_none() {
                    let own = idle_in_all(&reading, &findings.errors);
                    findings.errors.extend(own);
                }
                visit(Err(reading));
            }
        }
    }
    findings
}

/// Complaints about keys that act in no variant of a scenario. What is refused for its value need not
/// act as well.
fn idle_in_all(reading: &UnsoundReading, said: &[ScenarioError]) -> Vec<ScenarioError> {
    let Some((first, more)) = reading.variants.split_first() else {
        return Vec::new();
    };
    let mut idle = Idle::of(first, &[]);
    more.iter().for_each(|variant| idle.keep_idle(variant));
    let (mut own, _) = idle.complaints();
    own.retain(|one| said.iter().all(|other| other.location != one.location));
    own
}

/// Applies the `--set` arguments in order; returns the paths they set.
pub(in crate::scenario) fn apply_sets(
    draft: &mut Draft,
    sets: &[String],
    errors: &mut Vec<ScenarioError>,
) -> Vec<Vec<Step>> {
    let mut sources = Sources::clone(&draft.sources);
    let mut paths = Vec::new();
    for argument in sets {
        let source = sources.add_set(argument);
        let mark = Mark { source, start: 0 };
        match apply_set(&mut draft.root, argument, mark) {
            Ok((path, remark)) => {
                let shown = excerpt(argument);
                draft
                    .remarks
                    .extend(remark.map(|remark| format!("--set {shown}: {remark}")));
                paths.push(path);
            }
            Err(error) => errors.push(sources.error(mark, error.to_string())),
        }
    }
    errors.extend(check_contradictions(&draft.root, draft.root_mark, &sources));
    draft.sources = Arc::new(sources);
    paths
}

/// Why a `--set` argument sets nothing.
#[derive(Debug, thiserror::Error)]
enum SetError {
    #[error("expected key=value, as in gyro.coil.length_m=800")]
    NoValue,
    #[error("extends cannot be set: write it into a file")]
    Extends,
    #[error("{0} cannot be set: write the sweep into a file, or give one value, as in seed=2")]
    Matrix(String),
    #[error(transparent)]
    Address(#[from] AddressError),
    /// What the reader of TOML says.
    #[error("{0} in the value")]
    Value(String),
}

/// Applies one `--set` argument; the path it sets, and what is worth saying of it.
fn apply_set(
    root: &mut Table,
    argument: &str,
    mark: Mark,
) -> Result<(Vec<Step>, Option<String>), SetError> {
    let (key, value) = argument.split_once('=').ok_or(SetError::NoValue)?;
    let key = key.trim();
    match key.split('.').next() {
        Some("extends") => return Err(SetError::Extends),
        Some("matrix") => return Err(SetError::Matrix(excerpt(key).to_string())),
        _ => {}
    }
    let (path, _) = address::resolve(root, key)?;
    let mut node = set_value(value.trim(), mark)?;
    node.remark(Some(mark));
    let remark = address::kind_replaced(root, &path);
    address::assign(root, &path, node, mark)?;
    Ok((path, remark))
}

/// The value of a `--set` argument: TOML, or a bare word as text.
fn set_value(text: &str, mark: Mark) -> Result<Node, SetError> {
    match parse_value(mark.source, text) {
        Ok(node) => Ok(node),
        Err(_) if !text.is_empty() && !text.starts_with(['"', '\'', '[', '{']) => Ok(Node {
            value: Value::Text(text.to_owned()),
            mark: Some(mark),
        }),
        Err(error) => Err(SetError::Value(error.message)),
    }
}
