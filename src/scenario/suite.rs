//! From paths to resolved runs: discovery, the `extends` chain, `--set` and sweeps.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::address::{self, Step};
use super::check::check_contradictions;
use super::clashes::name_clashes;
use super::discover::{discover, identity};
use super::draft::{Draft, UnsoundReading};
use super::error::{Location, ScenarioError, in_order};
use super::inert::{Idle, IdleSet, IdleSets};
use super::manifest;
use super::matrix;
use super::resolved::{InputFile, Resolved};
use super::source::{Label, Mark, Sources, shown_path};
use super::tree::{Node, Table, Value, merge, parse_document, parse_value};

/// A suite as far as it could be read.
#[derive(Debug, Default)]
pub(crate) struct Suite {
    /// The runs that are sound.
    pub(crate) runs: Vec<Resolved>,
    /// Every complaint so far, each once.
    pub(crate) errors: Vec<ScenarioError>,
    /// The scenarios that are not sound, for the checks that are still to come.
    pub(crate) readings: Vec<UnsoundReading>,
}

/// Reads, resolves and checks every run of a suite; empty if the folders hold nothing to run.
///
/// A folder gives every `*.toml` below it that has a `name` of its own, in the order of their
/// paths; files without one are bases. A named file must have a name or be a manifest. Each of
/// `sets` is `key=value` and applies to every scenario after the files.
///
/// # Errors
/// Every complaint about every file, each once, in the order of the files and their lines.
pub fn load_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let suite = read_suite(paths, sets);
    if suite.errors.is_empty() {
        Ok(suite.runs)
    } else {
        Err(suite.errors)
    }
}

/// As [`load_suite`], with what can be checked further though it is not sound.
pub(crate) fn read_suite(paths: &[PathBuf], sets: &[String]) -> Suite {
    let mut suite = Suite::default();
    let mut idle_sets = IdleSets::default();
    for file in discover(paths, &mut suite.errors) {
        let mut read = match load_draft(&file) {
            Ok(drafted) => load_drafted(drafted, sets),
            Err(errors) => errors.into(),
        };
        suite.runs.append(&mut read.runs);
        suite.readings.extend(read.reading);
        suite.errors.append(&mut in_order(read.errors));
        idle_sets.add(read.idle_sets);
    }
    suite.errors.extend(name_clashes(&suite.runs));
    suite.errors.extend(idle_sets.complaints());
    suite
}

/// One file, read.
#[derive(Default)]
struct FileReading {
    runs: Vec<Resolved>,
    errors: Vec<ScenarioError>,
    reading: Option<UnsoundReading>,
    /// Wishes by `--set` that act in no point of it.
    idle_sets: Vec<IdleSet>,
}

impl From<Vec<ScenarioError>> for FileReading {
    fn from(errors: Vec<ScenarioError>) -> Self {
        Self {
            errors,
            ..Self::default()
        }
    }
}

impl From<FileReading> for Result<Vec<Resolved>, Vec<ScenarioError>> {
    fn from(read: FileReading) -> Self {
        let mut idle_sets = IdleSets::default();
        idle_sets.add(read.idle_sets);
        let mut errors = in_order(read.errors);
        errors.extend(idle_sets.complaints());
        if errors.is_empty() {
            Ok(read.runs)
        } else {
            Err(errors)
        }
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
) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    if file.is_dir() {
        let location = Location::of_file(shown_path(file));
        return Err(vec![ScenarioError::at(
            location,
            "it is a folder: name one scenario or base file",
        )]);
    }
    load_drafted(load_draft(file).map(completed)?, sets).into()
}

/// A draft with a name and a duration.
fn completed((mut draft, errors): (Draft, Vec<ScenarioError>)) -> (Draft, Vec<ScenarioError>) {
    let made_up = [
        ("name", Value::Text("base".to_owned())),
        ("duration_s", Value::Float(1.0)),
    ];
    draft.is_record |= !draft.root.contains_key("name");
    for (key, value) in made_up {
        let node = Node { value, mark: None };
        draft.root.entry(key.to_owned()).or_insert(node);
    }
    (draft, errors)
}

/// Applies `--set` to what was read and resolves it, all points of a sweep.
fn load_drafted((mut draft, errors): (Draft, Vec<ScenarioError>), sets: &[String]) -> FileReading {
    let mut read = FileReading::from(errors);
    let matrix = draft.root.remove("matrix");
    let is_sweep = matrix.is_some();
    if is_sweep {
        // A sweep over a manifest is an experiment of its own.
        draft.recorded = None;
    }
    let set_paths = apply_sets(&mut draft, sets, &mut read.errors);
    let mut swept = Vec::new();
    let runs = match matrix {
        None => draft.resolve().map(|run| vec![run]),
        Some(matrix) => matrix::expand(&draft, &matrix, &set_paths).map(|(runs, axes)| {
            swept = axes;
            runs
        }),
    };
    match runs {
        Ok(runs) => {
            let mut points = runs.iter();
            if let Some(first) = points.next() {
                let mut idle = Idle::of(first, &swept);
                for point in points {
                    if idle.is_empty() {
                        break;
                    }
                    idle.keep_idle(point);
                }
                let (own, idle_sets) = idle.complaints(first);
                read.errors.extend(own);
                read.idle_sets = idle_sets;
            }
            read.runs = runs;
        }
        Err(unsound) => {
            read.errors.extend(unsound.errors);
            let idle = unsound
                .reading
                .as_ref()
                .map(|reading| &reading.variants[..]);
            if let (Some([first, more @ ..]), false) = (idle, is_sweep) {
                let mut idle = Idle::of(first, &swept);
                more.iter().for_each(|variant| idle.keep_idle(variant));
                let (mut own, _) = idle.complaints(first);
                // What is refused for its value need not act as well.
                own.retain(|one| {
                    read.errors
                        .iter()
                        .all(|other| other.location != one.location)
                });
                read.errors.extend(own);
            }
            read.reading = unsound.reading;
        }
    }
    read
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
    let root = chain.merge_bases(file, label, root, source);
    chain.inputs.reverse();
    let draft = Draft {
        root,
        root_mark: Mark { source, start: 0 },
        sources: Arc::new(chain.sources),
        file: label.text(),
        inputs: chain.inputs,
        recorded: None,
        warnings: Vec::new(),
        is_record: false,
        is_partial: chain.is_partial,
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
    /// Whether a base could not be read.
    is_partial: bool,
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

    /// Merges a file onto the bases it extends, as far as they can be read.
    fn merge_bases(&mut self, file: &Path, label: &Label, mut root: Table, source: usize) -> Table {
        let start = Mark { source, start: 0 };
        let contradictions = check_contradictions(&root, start, &self.sources);
        self.errors.extend(contradictions);
        let Some(extends) = root.remove("extends") else {
            return root;
        };
        let mark = extends.mark.unwrap_or(start);
        let Some(base) = extends.as_text() else {
            let message = format!(
                "extends has the wrong type: expected the path of a file, got {}",
                extends.value.type_name()
            );
            self.is_partial = true;
            self.errors.push(self.sources.error(mark, message));
            return root;
        };
        let path = file.parent().unwrap_or(Path::new("")).join(base);
        if self.open.contains(&identity(&path)) {
            let message = format!(
                "extends = \"{base}\" closes a cycle: {} is being extended already",
                shown_path(&path)
            );
            self.is_partial = true;
            self.errors.push(self.sources.error(mark, message));
            return root;
        }
        let base_label = label.of_base(base);
        match self.read(&path, &base_label, Some(mark)) {
            Ok((base_root, base_source)) => {
                let mut merged = self.merge_bases(&path, &base_label, base_root, base_source);
                // The name is the scenario's own: two files may build on one that can be run itself.
                merged.remove("name");
                merge("", &mut merged, root);
                merged
            }
            Err(errors) => {
                self.is_partial = true;
                self.errors.extend(errors);
                root
            }
        }
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
