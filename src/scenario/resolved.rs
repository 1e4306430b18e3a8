//! A scenario with every value settled, and where each of them was written.

use std::sync::Arc;

use super::address::{self, nearest_mark};
use super::check::{check_presence, check_values};
use super::compensation_source;
use super::config::Scenario;
use super::cross;
use super::defaults::{default_of, fill};
use super::deserialize::from_table;
use super::emit::to_toml;
use super::error::{Location, ScenarioError};
use super::numbers;
use super::script;
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};

/// A file that a scenario was read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// Path as seen from the scenario's own folder, with forward slashes; the file name alone
    /// where `extends` gives an absolute path.
    pub file: String,
    /// BLAKE3 of its bytes, hexadecimal.
    pub digest: String,
}

/// One point of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepPoint {
    /// Index of the point, from 0; the last key of the matrix varies fastest.
    pub index: usize,
    /// Number of points.
    pub count: usize,
    /// Keys as the matrix writes them, with their values in TOML.
    pub assignments: Vec<(String, String)>,
}

/// One run, ready to be carried out.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// Its configuration.
    pub scenario: Scenario,
    /// Name of the scenario's own file, without its folder, so that results do not depend on how
    /// a path was typed.
    pub file: String,
    /// BLAKE3 of [`Resolved::to_toml`], hexadecimal.
    pub digest: String,
    /// Every file it was read from, the innermost base first and the table of a script last.
    pub inputs: Vec<InputFile>,
    /// Which point of a sweep it is; `None` without a matrix.
    pub sweep: Option<SweepPoint>,
    /// What is allowed but worth saying about how it was read.
    pub warnings: Vec<String>,
    /// What is worth saying to whoever runs it, but no part of the results: these depend on the
    /// scenario alone.
    pub remarks: Vec<String>,
    /// Whether it is the point of its sweep at which no swept key departs from what the scenario
    /// says without the sweep.
    pub is_base_point: bool,
    /// The calibration scenario whose result its compensation applies.
    pub campaign: Option<Arc<Resolved>>,
    /// Where its gates were written, if a manifest records that.
    gate_places: Vec<String>,
    /// Every value, defaults included.
    tree: Table,
    /// What the marks of the tree point into.
    sources: Arc<Sources>,
    /// Beginning of the scenario's own file.
    root_mark: Mark,
}

/// Equality of the run; where its values were written does not count.
impl PartialEq for Resolved {
    fn eq(&self, other: &Self) -> bool {
        self.scenario == other.scenario
            && self.file == other.file
            && self.digest == other.digest
            && self.inputs == other.inputs
            && self.sweep == other.sweep
    }
}

/// What a scenario is resolved from.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    /// Merged values, without defaults.
    pub(crate) root: Table,
    /// Beginning of the scenario's own file.
    pub(crate) root_mark: Mark,
    /// What the marks point into.
    pub(crate) sources: Arc<Sources>,
    /// Name of the scenario's own file.
    pub(crate) file: String,
    /// Files it was read from.
    pub(crate) inputs: Vec<InputFile>,
    /// What a manifest says about the origin of its scenario.
    pub(crate) recorded: Option<Recorded>,
    /// What is worth saying about how it was read.
    pub(crate) warnings: Vec<String>,
    /// What is worth saying but must not stand in results.
    pub(crate) remarks: Vec<String>,
}

/// The origin of a resolved scenario, as a manifest records it.
#[derive(Clone, Debug)]
pub(crate) struct Recorded {
    /// Digest of the scenario that the record is true of.
    pub(crate) digest: String,
    /// Name of the scenario's own file.
    pub(crate) file: String,
    /// Files it was read from.
    pub(crate) inputs: Vec<InputFile>,
    /// Which point of a sweep it was.
    pub(crate) sweep: Option<SweepPoint>,
    /// Where its gates were written.
    pub(crate) gate_places: Vec<String>,
}

impl Recorded {
    /// The first swept key that has another value than the record says, and what that is.
    pub(crate) fn broken_point(&self, root: &Table) -> Option<(&str, &str)> {
        broken(root, self.sweep.as_ref()?)
    }
}

impl Draft {
    /// Checks every value, fills in the defaults and checks across values.
    ///
    /// # Errors
    /// Every complaint about the scenario.
    pub(crate) fn resolve(mut self) -> Result<Resolved, Vec<ScenarioError>> {
        let sources = Arc::make_mut(&mut self.sources);
        script::read_into(&mut self.root, sources, &mut self.inputs)
            .map_err(|error| vec![error])?;
        let campaign = compensation_source::read_into(&mut self.root, sources, &mut self.inputs)?;
        let mut errors = check_values(&self.root, self.root_mark, &self.sources);
        numbers::settle(&mut self.root);
        if errors.is_empty() || !self.is_other_version() {
            fill(&mut self.root);
            errors.extend(check_presence(&self.root, self.root_mark, &self.sources));
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let scenario = configuration(&self.root, self.root_mark, &self.sources)?;
        let digest = digest(&to_toml(&self.root, ""));
        let origin = match self.recorded {
            Some(recorded)
                if recorded.digest == digest && recorded.broken_point(&self.root).is_none() =>
            {
                recorded
            }
            // The record is of another scenario: what was read now is the origin. A sweep point
            // stays one as long as the swept keys have their values.
            recorded => Recorded {
                digest,
                file: self.file,
                inputs: self.inputs,
                sweep: recorded
                    .and_then(|recorded| recorded.sweep)
                    .filter(|point| broken(&self.root, point).is_none()),
                gate_places: Vec::new(),
            },
        };
        let resolved = Resolved {
            scenario,
            file: origin.file,
            digest: origin.digest,
            inputs: origin.inputs,
            sweep: origin.sweep,
            warnings: self.warnings,
            remarks: self.remarks,
            is_base_point: false,
            campaign,
            gate_places: origin.gate_places,
            tree: self.root,
            sources: self.sources,
            root_mark: self.root_mark,
        };
        let errors = cross::check(&resolved);
        if errors.is_empty() {
            Ok(resolved)
        } else {
            Err(errors)
        }
    }

    /// Whether the file is written for another version of the format.
    fn is_other_version(&self) -> bool {
        let version = self.root.get("schema").map(|node| &node.value);
        !matches!(version, None | Some(Value::Integer(1)))
    }
}

impl Resolved {
    /// The run with other values, all of them checked one by one, and their canonical text.
    ///
    /// # Errors
    /// Every contradiction between the values.
    pub(super) fn with_tree(&self, tree: Table, text: &str) -> Result<Self, Vec<ScenarioError>> {
        let other = Self {
            scenario: configuration(&tree, self.root_mark, &self.sources)?,
            digest: digest(text),
            tree,
            file: self.file.clone(),
            inputs: self.inputs.clone(),
            sweep: None,
            warnings: self.warnings.clone(),
            remarks: self.remarks.clone(),
            is_base_point: false,
            campaign: self.campaign.clone(),
            gate_places: self.gate_places.clone(),
            sources: Arc::clone(&self.sources),
            root_mark: self.root_mark,
        };
        let errors = cross::check(&other);
        if errors.is_empty() {
            Ok(other)
        } else {
            Err(errors)
        }
    }

    /// Count of the numbers that its scripts and profiles hold.
    pub(super) fn numbers_in_arrays(&self) -> usize {
        fn of(value: &Value) -> usize {
            match value {
                Value::Array(nodes) => {
                    let numbers = nodes.iter();
                    let inside: usize = nodes.iter().map(|node| of(&node.value)).sum();
                    let is_number = |node: &&Node| matches!(node.value, Value::Float(_));
                    inside + numbers.filter(is_number).count()
                }
                Value::Table(table) => table.values().map(|node| of(&node.value)).sum(),
                _ => 0,
            }
        }
        self.tree.values().map(|node| of(&node.value)).sum()
    }

    /// A complaint about a marked place.
    pub(super) fn error(&self, mark: Option<Mark>, message: String) -> ScenarioError {
        self.sources.error(mark.unwrap_or(self.root_mark), message)
    }

    /// The value at a path if it is not the default of its key, as TOML.
    ///
    /// * `schema_path`: the path without indices, as the key table has it.
    pub(crate) fn departure(&self, path: &str, schema_path: &str) -> Option<String> {
        let node = address::get(&self.tree, &address::parse(path).ok()?)?;
        // What nobody has written is the default.
        node.mark?;
        let value = node.value.to_toml();
        let default = default_of(schema_path)?.to_toml();
        (value != default).then_some(value)
    }

    /// Folder of the run below the output folder: `<name>`, or `<name>/<nnnn>` in a sweep.
    #[must_use]
    pub fn folder(&self) -> String {
        match &self.sweep {
            None => self.scenario.name.clone(),
            Some(point) => format!("{}/{:04}", self.scenario.name, point.index),
        }
    }

    /// The resolved scenario in its canonical spelling: every key, defaults included.
    ///
    /// The text is a scenario file of its own and resolves to the same values.
    #[must_use]
    pub fn to_toml(&self) -> String {
        to_toml(&self.tree, "")
    }

    /// Where a key was written, e.g. `gate[2].metric` or `filter[0].lms.step_size`.
    ///
    /// A key that comes from the defaults is placed at its nearest ancestor in the file; a path
    /// that leads nowhere at the beginning of the file.
    #[must_use]
    pub fn locate(&self, key_path: &str) -> Location {
        let path = address::parse(key_path).unwrap_or_default();
        let mark = nearest_mark(&self.tree, &path).unwrap_or(self.root_mark);
        self.sources.locate(mark)
    }

    /// Where the metric of a gate was written: `file:line:column`, or the `--set` argument.
    ///
    /// In a run repeated from its manifest it is the place in the original file.
    #[must_use]
    pub fn gate_place(&self, index: usize) -> String {
        let here = || self.locate(&format!("gate[{index}].metric")).to_string();
        self.gate_places.get(index).cloned().unwrap_or_else(here)
    }

    /// The scenario's own file as messages show it, the folder included.
    #[must_use]
    pub fn shown_file(&self) -> String {
        self.sources.locate(self.root_mark).file
    }

    /// Whether a key was written by somebody rather than filled in.
    pub(crate) fn is_written(&self, key_path: &str) -> bool {
        address::parse(key_path)
            .ok()
            .and_then(|path| address::get(&self.tree, &path)?.mark)
            .is_some()
    }

    /// The settled values.
    pub(super) fn tree(&self) -> &Table {
        &self.tree
    }

    /// The value of a key as people write it in `--set`, in TOML; `None` where the scenario has
    /// no such key.
    #[must_use]
    pub fn value_of(&self, written: &str) -> Option<String> {
        let (path, _) = address::resolve(&self.tree, written).ok()?;
        self.value_toml(&path)
    }

    /// The value of a numeric key as people write it in `--set`; `None` where the scenario has no
    /// such number.
    #[must_use]
    pub fn number_of(&self, written: &str) -> Option<f64> {
        self.value_of(written)?.parse().ok()
    }

    /// The unit of a key as people write it in `--set`; empty where it has none.
    pub(crate) fn unit_of(&self, written: &str) -> &'static str {
        let found = address::resolve(&self.tree, written).ok();
        found.and_then(|(_, key)| key).map_or("", |key| key.unit)
    }

    /// The value of a key in TOML.
    pub(crate) fn value_toml(&self, path: &[address::Step]) -> Option<String> {
        address::get(&self.tree, path).map(|node| node.value.to_toml())
    }

    /// The canonical text as an element of an array of tables: one of several runs in a document.
    #[must_use]
    pub fn to_toml_in_array(&self, array: &str) -> String {
        let table = self.to_toml_below(array);
        let rest = table.strip_prefix(&format!("[{array}]")).unwrap_or(&table);
        format!("[[{array}]]{rest}")
    }

    /// The canonical text as a table of a larger document.
    pub(crate) fn to_toml_below(&self, prefix: &str) -> String {
        to_toml(&self.tree, prefix)
    }
}

/// The configuration in a checked and filled tree.
fn configuration(
    root: &Table,
    root_mark: Mark,
    sources: &Sources,
) -> Result<Scenario, Vec<ScenarioError>> {
    from_table(root).map_err(|error| {
        let message = format!("the scenario does not fit its configuration: {error}");
        vec![sources.error(root_mark, message)]
    })
}

/// BLAKE3 of a canonical text, hexadecimal.
fn digest(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// The first swept key of a point that has another value than the point says, and what that is.
fn broken<'a>(root: &Table, point: &'a SweepPoint) -> Option<(&'a str, &'a str)> {
    let is_true = |(key, value): &&(String, String)| {
        address::resolve(root, key)
            .ok()
            .and_then(|(path, _)| address::get(root, &path))
            .is_some_and(|node| node.value.to_toml() == *value)
    };
    let mut assignments = point.assignments.iter();
    let (key, value) = assignments.find(|assignment| !is_true(assignment))?;
    Some((key, value))
}
