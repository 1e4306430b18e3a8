//! From paths to resolved runs: discovery, the `extends` chain, `--set` and sweeps.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::address::{self, Step};
use super::check::check_contradictions;
use super::discover::{discover, identity};
use super::error::{Location, ScenarioError};
use super::manifest;
use super::matrix;
use super::resolved::{Draft, InputFile, Resolved};
use super::source::{Label, Mark, Sources, shown_path};
use super::tree::{Node, Table, Value, merge, parse_document, parse_value};

/// Reads, resolves and checks every run of a suite; empty if the folders hold nothing to run.
///
/// A folder gives every `*.toml` below it that has a `name` of its own, in the order of their
/// paths; files without one are bases. A named file must have a name or be a manifest. Each of
/// `sets` is `key=value` and applies to every scenario after the files.
///
/// # Errors
/// Every complaint about every file, in order, each once.
pub fn load_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let mut runs = Vec::new();
    let mut errors = Vec::new();
    for file in discover(paths, &mut errors) {
        match load_file(&file, sets) {
            Ok(more) => runs.extend(more),
            Err(more) => errors.extend(more),
        }
    }
    errors.extend(name_clashes(&runs));
    if errors.is_empty() {
        return Ok(runs);
    }
    let mut unique: Vec<ScenarioError> = Vec::new();
    for error in errors {
        if !unique.contains(&error) {
            unique.push(error);
        }
    }
    Err(unique)
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
) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    if file.is_dir() {
        let location = Location::of_file(shown_path(file));
        return Err(vec![ScenarioError::at(
            location,
            "it is a folder: name one scenario or base file",
        )]);
    }
    load_drafted(load_draft(file).map(completed)?, sets)
}

/// A draft with a name and a duration.
fn completed((mut draft, errors): (Draft, Vec<ScenarioError>)) -> (Draft, Vec<ScenarioError>) {
    let made_up = [
        ("name", Value::Text("base".to_owned())),
        ("duration_s", Value::Float(1.0)),
    ];
    for (key, value) in made_up {
        let node = Node { value, mark: None };
        draft.root.entry(key.to_owned()).or_insert(node);
    }
    (draft, errors)
}

/// Loads one file with all points of its sweep.
fn load_file(file: &Path, sets: &[String]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    load_drafted(load_draft(file)?, sets)
}

/// Applies `--set` to what was read and resolves it, all points of a sweep.
fn load_drafted(
    (mut draft, mut errors): (Draft, Vec<ScenarioError>),
    sets: &[String],
) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let matrix = draft.root.remove("matrix");
    if matrix.is_some() {
        // A sweep over a manifest is an experiment of its own.
        draft.recorded = None;
    }
    let set_paths = apply_sets(&mut draft, sets, &mut errors);
    let runs = match matrix {
        None => draft.resolve().map(|run| vec![run]),
        Some(matrix) => matrix::expand(&draft, &matrix, &set_paths),
    };
    match runs {
        Ok(runs) if errors.is_empty() => Ok(runs),
        Ok(_) => Err(errors),
        Err(more) => {
            errors.extend(more);
            Err(errors)
        }
    }
}

/// Reads a file and its bases, or a manifest, with the complaints that do not hinder more checks.
fn load_draft(file: &Path) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    load_labelled(file, &Label::of_scenario(file))
}

/// Reads the scenario of a campaign that another file names, and its bases.
///
/// # Errors
/// Every complaint about the file.
pub(super) fn load_campaign(file: &Path, label: &Label) -> Result<Draft, Vec<ScenarioError>> {
    match load_labelled(file, label)? {
        (draft, errors) if errors.is_empty() => Ok(draft),
        (_, errors) => Err(errors),
    }
}

/// As [`load_draft`], inputs labelled as seen from another file.
fn load_labelled(
    file: &Path,
    label: &Label,
) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    let mut chain = Chain::default();
    let (root, source) = chain.read(file, label, None)?;
    if manifest::is_manifest(&root) {
        let draft = manifest::read(root, source, chain.sources, chain.inputs)?;
        return Ok((draft, Vec::new()));
    }
    let root = chain.merge_bases(file, label, root, source)?;
    chain.inputs.reverse();
    let draft = Draft {
        root,
        root_mark: Mark { source, start: 0 },
        sources: Arc::new(chain.sources),
        file: label.text(),
        inputs: chain.inputs,
        recorded: None,
        warnings: Vec::new(),
    };
    Ok((draft, chain.errors))
}

/// A file and its bases, as far as they have been read.
#[derive(Default)]
struct Chain {
    sources: Sources,
    /// The scenario's own file first.
    inputs: Vec<InputFile>,
    /// Files read so far, to find cycles.
    open: Vec<PathBuf>,
    errors: Vec<ScenarioError>,
}

impl Chain {
    /// Reads and parses one file; `extends` is the mark of the key that names it.
    fn read(
        &mut self,
        file: &Path,
        label: &Label,
        extends: Option<Mark>,
    ) -> Result<(Table, usize), Vec<ScenarioError>> {
        let shown = shown_path(file);
        let bytes = fs::read(file).map_err(|error| {
            let message = match error.kind() {
                std::io::ErrorKind::NotFound => "no such file".to_owned(),
                _ if file.is_dir() => "it is a folder, not a file".to_owned(),
                _ => format!("cannot read the file: {error}"),
            };
            vec![match extends {
                None => ScenarioError::at(Location::of_file(shown.clone()), message),
                Some(mark) => self
                    .sources
                    .error(mark, format!("extends {shown}: {message}")),
            }]
        })?;
        self.inputs.push(InputFile {
            file: label.text(),
            digest: blake3::hash(&bytes).to_hex().to_string(),
        });
        self.open.push(identity(file));
        let text = String::from_utf8(bytes).map_err(|_| {
            let location = Location::of_file(shown.clone());
            vec![ScenarioError::at(location, "the file is not UTF-8 text")]
        })?;
        let source = self.sources.add_file(shown, text.clone(), label.clone());
        let root = parse_document(source, &text).map_err(|error| {
            let mark = Mark {
                source,
                start: error.start,
            };
            vec![self.sources.error(mark, error.message)]
        })?;
        Ok((root, source))
    }

    /// Merges a file onto the bases it extends.
    fn merge_bases(
        &mut self,
        file: &Path,
        label: &Label,
        mut root: Table,
        source: usize,
    ) -> Result<Table, Vec<ScenarioError>> {
        let start = Mark { source, start: 0 };
        let contradictions = check_contradictions(&root, start, &self.sources);
        self.errors.extend(contradictions);
        let Some(extends) = root.remove("extends") else {
            return Ok(root);
        };
        let mark = extends.mark.unwrap_or(start);
        let Some(base) = extends.as_text() else {
            let message = format!(
                "extends has the wrong type: expected the path of a file, got {}",
                extends.value.type_name()
            );
            self.errors.push(self.sources.error(mark, message));
            return Ok(root);
        };
        let path = file.parent().unwrap_or(Path::new("")).join(base);
        if self.open.contains(&identity(&path)) {
            let message = format!(
                "extends = \"{base}\" closes a cycle: {} is being extended already",
                shown_path(&path)
            );
            self.errors.push(self.sources.error(mark, message));
            return Err(std::mem::take(&mut self.errors));
        }
        let base_label = label.of_base(base);
        let (base_root, base_source) =
            self.read(&path, &base_label, Some(mark))
                .map_err(|mut errors| {
                    errors.splice(0..0, std::mem::take(&mut self.errors));
                    errors
                })?;
        let mut merged = self.merge_bases(&path, &base_label, base_root, base_source)?;
        // The name is the scenario's own: two files may build on one that can be run itself.
        merged.remove("name");
        merge("", &mut merged, root);
        Ok(merged)
    }
}

/// Applies the `--set` arguments in order; returns the paths they set.
fn apply_sets(
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
            Ok(path) => paths.push(path),
            Err(message) => errors.push(sources.error(mark, message)),
        }
    }
    errors.extend(check_contradictions(&draft.root, draft.root_mark, &sources));
    draft.sources = Arc::new(sources);
    paths
}

/// Applies one `--set` argument.
fn apply_set(root: &mut Table, argument: &str, mark: Mark) -> Result<Vec<Step>, String> {
    let Some((key, value)) = argument.split_once('=') else {
        return Err("expected key=value, as in gyro.coil.length_m=800".to_owned());
    };
    let key = key.trim();
    match key.split('.').next() {
        Some("extends") => return Err("extends cannot be set: write it into a file".to_owned()),
        Some("matrix") => {
            return Err(format!(
                "{key} cannot be set: write the sweep into a file, or give one value, as in seed=2"
            ));
        }
        _ => {}
    }
    let (path, _) = address::resolve(root, key)?;
    let mut node = set_value(value.trim(), mark)?;
    node.remark(Some(mark));
    address::assign(root, &path, node, mark)?;
    Ok(path)
}

/// The value of a `--set` argument: TOML, or a bare word as text.
fn set_value(text: &str, mark: Mark) -> Result<Node, String> {
    match parse_value(mark.source, text) {
        Ok(node) => Ok(node),
        Err(_) if !text.is_empty() && !text.starts_with(['"', '\'', '[', '{']) => Ok(Node {
            value: Value::Text(text.to_owned()),
            mark: Some(mark),
        }),
        Err(error) => Err(format!("{} in the value", error.message)),
    }
}

/// Complaints about runs that would write the same folder, or a scenario beside a sweep in it.
fn name_clashes(runs: &[Resolved]) -> Vec<ScenarioError> {
    let mut first: BTreeMap<&str, &Resolved> = BTreeMap::new();
    let mut folders: BTreeMap<String, &Resolved> = BTreeMap::new();
    let mut errors = Vec::new();
    for run in runs {
        let earlier = *first.entry(&run.scenario.name).or_insert(run);
        let twin = folders.get(&run.folder()).copied();
        folders.entry(run.folder()).or_insert(run);
        let is_same_sweep = earlier.shown_file() == run.shown_file()
            && earlier.sweep.is_some() == run.sweep.is_some();
        let clash = match twin {
            Some(twin) => Some(twin),
            None if std::ptr::eq(earlier, run) || is_same_sweep => None,
            None => Some(earlier),
        };
        if let Some(other) = clash {
            let message = format!(
                "name = \"{}\" is the name of the scenario at {} already: give each scenario its own",
                run.scenario.name,
                other.locate("name")
            );
            errors.push(ScenarioError::at(run.locate("name"), message));
        }
    }
    errors
}
