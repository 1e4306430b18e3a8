//! From paths to resolved runs: discovery, the `extends` chain, `--set` and sweeps.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::address::{self, Step};
use super::check::check_contradictions;
use super::discover::{Found, discover, identity};
use super::error::{Location, ScenarioError};
use super::excerpt::excerpt;
use super::input::{self, Input, InputError};
use super::manifest;
use super::matrix;
use super::resolved::{Draft, InputFile, Resolved};
use super::source::{Label, Mark, Sources, shown_path};
use super::tree::{Node, Table, Value, merge, parse_value, parse_within};
use super::weight;

/// Most bases below one another.
const BASES_MAX: usize = 64;

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
    let mut errors = Vec::new();
    let mut names = Names::default();
    for found in discover(paths, &mut errors) {
        let mut named = |run: Resolved| {
            names.take(&run);
            visit(run);
        };
        if let Err(more) = load_file(&found, sets, &mut named) {
            errors.extend(more);
        }
    }
    errors.extend(names.clashes);
    if errors.is_empty() {
        return Ok(());
    }
    let mut known: BTreeSet<ScenarioError> = BTreeSet::new();
    errors.retain(|error| known.insert(error.clone()));
    Err(errors)
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
    let mut runs = Vec::new();
    let draft = load_draft(file).map(completed)?;
    load_drafted(draft, sets, &mut |run| runs.push(run))?;
    Ok(runs)
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

/// Loads one file with all points of its sweep; a base that was found in a folder is passed over.
fn load_file(
    found: &Found,
    sets: &[String],
    visit: &mut dyn FnMut(Resolved),
) -> Result<(), Vec<ScenarioError>> {
    let file = &found.path;
    match load_labelled(file, &Label::of_scenario(file), !found.is_named)? {
        Some(draft) => load_drafted(draft, sets, visit),
        None => Ok(()),
    }
}

/// Applies `--set` to what was read and resolves it, all points of a sweep.
fn load_drafted(
    (mut draft, mut errors): (Draft, Vec<ScenarioError>),
    sets: &[String],
    visit: &mut dyn FnMut(Resolved),
) -> Result<(), Vec<ScenarioError>> {
    let matrix = draft.root.remove("matrix");
    if matrix.is_some() {
        // A sweep over a manifest is an experiment of its own.
        draft.recorded = None;
    }
    let set_paths = apply_sets(&mut draft, sets, &mut errors);
    let is_sound = errors.is_empty();
    let mut visit_sound = |run| {
        if is_sound {
            visit(run);
        }
    };
    let result = match matrix {
        None => draft.resolve().map(visit_sound),
        Some(matrix) => matrix::expand(&draft, &matrix, &set_paths, &mut visit_sound),
    };
    errors.extend(result.err().unwrap_or_default());
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// Reads a file and its bases, or a manifest, with the complaints that do not hinder more checks.
fn load_draft(file: &Path) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    read_whole(file, &Label::of_scenario(file))
}

/// As [`load_labelled`], whether the file has a name or not.
fn read_whole(
    file: &Path,
    label: &Label,
) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    let draft = load_labelled(file, label, false)?;
    Ok(draft.expect("only bases are passed over, where that is asked for"))
}

/// Reads the scenario of a campaign that another file names, and its bases.
///
/// # Errors
/// Every complaint about the file.
pub(super) fn load_campaign(file: &Path, label: &Label) -> Result<Draft, Vec<ScenarioError>> {
    match read_whole(file, label)? {
        (draft, errors) if errors.is_empty() => Ok(draft),
        (_, errors) => Err(errors),
    }
}

/// Reads a file and its bases, inputs labelled as seen from another file; none if it is a base and
/// those are passed over.
fn load_labelled(
    file: &Path,
    label: &Label,
    passes_bases: bool,
) -> Result<Option<(Draft, Vec<ScenarioError>)>, Vec<ScenarioError>> {
    let mut chain = Chain::new();
    let (root, source) = chain.read(file, label, None)?;
    if passes_bases && !root.contains_key("name") {
        return Ok(None);
    }
    if manifest::is_manifest(&root) {
        let draft = manifest::read(root, source, chain.sources, chain.inputs)?;
        return Ok(Some((draft, Vec::new())));
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
        remarks: Vec::new(),
    };
    Ok(Some((draft, chain.errors)))
}

/// A file and its bases, as far as they have been read.
struct Chain {
    sources: Sources,
    /// The scenario's own file first.
    inputs: Vec<InputFile>,
    /// Files read so far, to find cycles.
    open: Vec<PathBuf>,
    /// Bytes that may still be read.
    bytes_left: u64,
    /// Memory that may still be taken, bytes.
    memory_left: u64,
    errors: Vec<ScenarioError>,
}

impl Chain {
    fn new() -> Self {
        Self {
            sources: Sources::default(),
            inputs: Vec::new(),
            open: Vec::new(),
            bytes_left: input::BYTES_MAX,
            memory_left: weight::MEMORY_BYTES_MAX,
            errors: Vec::new(),
        }
    }

    /// Reads a file and takes it off what may still be read.
    fn input(&mut self, file: &Path) -> Result<Input, InputError> {
        let input = input::read(file)?;
        let left = self.bytes_left.checked_sub(input.text.len() as u64);
        self.bytes_left = left.ok_or(InputError::TooLongTogether)?;
        Ok(input)
    }

    /// Reads and parses one file; `extends` is the mark of the key that names it.
    fn read(
        &mut self,
        file: &Path,
        label: &Label,
        extends: Option<Mark>,
    ) -> Result<(Table, usize), Vec<ScenarioError>> {
        let shown = shown_path(file);
        let Input { text, digest } = self.input(file).map_err(|error| {
            let location = Location::of_file(shown.clone());
            vec![match extends {
                // The text itself is at fault, not the key that names it.
                Some(mark) if !matches!(error, InputError::NotText) => self
                    .sources
                    .error(mark, format!("extends {shown}: {error}")),
                _ => ScenarioError::at(location, error.to_string()),
            }]
        })?;
        self.inputs.push(InputFile {
            file: label.text(),
            digest,
        });
        self.open.push(identity(file));
        let source = self.sources.add_file(shown, text.clone(), label.clone());
        let root = parse_within(source, &text, &mut self.memory_left).map_err(|error| {
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
            let base = excerpt(base);
            let message = format!(
                "extends = \"{base}\" closes a cycle: {} is being extended already",
                shown_path(&path)
            );
            self.errors.push(self.sources.error(mark, message));
            return Err(std::mem::take(&mut self.errors));
        }
        if self.open.len() > BASES_MAX {
            let base = excerpt(base);
            let message = format!(
                "extends = \"{base}\" is base {} below one another: allowed up to {BASES_MAX}",
                self.open.len()
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
            let key = excerpt(key);
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

/// The names and folders of the runs so far.
#[derive(Default)]
struct Names {
    first: BTreeMap<String, NamedRun>,
    folders: BTreeMap<String, Location>,
    /// Complaints about runs that would write the same folder, or a scenario beside a sweep in it.
    clashes: Vec<ScenarioError>,
}

/// The first run of a name.
struct NamedRun {
    file: String,
    is_sweep: bool,
    place: Location,
}

impl Names {
    /// Takes the name of one more run.
    fn take(&mut self, run: &Resolved) {
        let name = &run.scenario.name;
        let (file, is_sweep) = (run.shown_file(), run.sweep.is_some());
        let (folder, place) = (run.folder(), run.locate("name"));
        let other = match (self.folders.get(&folder), self.first.get(name)) {
            (Some(twin), _) => Some(twin),
            (None, Some(first)) if first.file != file || first.is_sweep != is_sweep => {
                Some(&first.place)
            }
            _ => None,
        };
        if let Some(other) = other {
            let message = format!(
                "name = \"{name}\" is the name of the scenario at {other} already: give each \
                 scenario its own"
            );
            self.clashes.push(ScenarioError::at(place.clone(), message));
        }
        if !self.first.contains_key(name) {
            let place = place.clone();
            let first = NamedRun {
                file,
                is_sweep,
                place,
            };
            self.first.insert(name.clone(), first);
        }
        self.folders.entry(folder).or_insert(place);
    }
}
