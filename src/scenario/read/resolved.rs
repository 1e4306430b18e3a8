//! A scenario with every value settled, and where each of them was written.

use std::sync::Arc;

use crate::recording::LogFacts;
use crate::scenario::config::Scenario;
use crate::scenario::document::address::{self, nearest_mark};
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::emit::to_toml;
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::defaults::default_of;
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::read::files::named_files::NamedFile;
use crate::scenario::read::purpose::Purpose;

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

impl SweepPoint {
    /// Most points of one sweep: folders are numbered with four digits.
    pub(in crate::scenario) const COUNT_MAX: usize = 10_000;
}

/// Folder of a run below the output folder, by the name of its scenario and its point of a sweep.
pub(crate) fn run_folder(name: &str, point: Option<usize>) -> String {
    match point {
        None => name.to_owned(),
        Some(index) => format!("{name}/{index:04}"),
    }
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
    /// Every file it was read from, the innermost base first, then the table of a script and those that
    /// its filters name.
    pub inputs: Vec<InputFile>,
    /// Files that its filters name, which are read when it runs.
    pub named_files: Vec<NamedFile>,
    /// The log that takes the place of table and gyro; none of a simulation.
    pub log: Option<LogFacts>,
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
    pub(in crate::scenario) gate_places: Vec<String>,
    /// Keys that nobody wrote, if a manifest records them.
    pub(in crate::scenario) assumed_keys: Option<Vec<String>>,
    /// Every value, defaults included.
    pub(in crate::scenario) tree: Table,
    /// What the marks of the tree point into.
    pub(in crate::scenario) sources: Arc<Sources>,
    /// Beginning of the scenario's own file.
    pub(in crate::scenario) root_mark: Mark,
    /// Whether that file is a record rather than a scenario that somebody wrote.
    pub(in crate::scenario) is_record: bool,
    /// What it was read for.
    pub(in crate::scenario) purpose: Purpose,
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

impl Resolved {
    /// Count of the numbers that its scripts and profiles hold.
    pub(in crate::scenario) fn numbers_in_arrays(&self) -> usize {
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
    pub(in crate::scenario) fn error(&self, mark: Option<Mark>, message: String) -> ScenarioError {
        self.sources.error(mark.unwrap_or(self.root_mark), message)
    }

    /// Folder of the run below the output folder: `<name>`, or `<name>/<nnnn>` in a sweep.
    #[must_use]
    pub fn folder(&self) -> String {
        run_folder(
            &self.scenario.name,
            self.sweep.as_ref().map(|point| point.index),
        )
    }

    /// The resolved scenario in its canonical spelling: every key, defaults included.
    ///
    /// The text is a scenario file of its own and resolves to the same values.
    #[must_use]
    pub fn to_toml(&self) -> String {
        to_toml(&self.tree, "")
    }

    /// The file that a key names, as in `filter[0].replay.samples`; none where the key names none.
    pub(crate) fn named_file(&self, key: &str) -> Option<&NamedFile> {
        self.named_files.iter().find(|file| file.key == key)
    }

    /// Where a key was written, e.g. `gate[2].metric` or `filter[0].lms.step_size`.
    ///
    /// A key that comes from the defaults is placed at its nearest ancestor in the file; a path
    /// that leads nowhere at the beginning of the file.
    #[must_use]
    pub fn locate(&self, key_path: &str) -> Location {
        let path = address::parse(key_path).unwrap_or_default();
        match nearest_mark(&self.tree, &path) {
            Some(mark) => self.sources.locate(mark),
            None => self.sources.locate(self.root_mark).unseen(),
        }
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

    /// Whether somebody asked for the value of a key: it was written, and not by a record, in which
    /// every value is written, if it says what the default says.
    ///
    /// * `key_path`: a path without indices.
    pub(in crate::scenario) fn is_asked_for(&self, key_path: &str) -> bool {
        let path = address::parse(key_path).unwrap_or_default();
        let Some(node) = address::get(&self.tree, &path) else {
            return false;
        };
        let Some(mark) = node.mark else {
            return false;
        };
        let departs =
            || default_of(key_path).is_none_or(|default| default.to_toml() != node.value.to_toml());
        self.is_set_argument(mark) || departs() || !(self.is_record || self.is_written_out())
    }

    /// Where a mark points.
    pub(in crate::scenario) fn place(&self, mark: Mark) -> Location {
        self.sources.locate(mark)
    }

    /// Whether a mark lies in a `--set` argument.
    pub(in crate::scenario) fn is_set_argument(&self, mark: Mark) -> bool {
        self.sources.is_set_argument(mark)
    }

    /// Whether a mark lies in the scenario's own file, and what stands there is its author's wish:
    /// a manifest is a record.
    pub(in crate::scenario) fn is_own(&self, mark: Mark) -> bool {
        !self.is_record && mark.source == self.root_mark.source
    }

    /// Whether every value was written by somebody: a record such as `expand` prints.
    pub(in crate::scenario) fn is_written_out(&self) -> bool {
        fn is_written(node: &Node) -> bool {
            node.mark.is_some()
                && match &node.value {
                    Value::Table(table) => table.values().all(is_written),
                    Value::Array(nodes) => nodes.iter().all(is_written),
                    _ => true,
                }
        }
        self.tree.values().all(is_written)
    }

    /// The settled values.
    pub(in crate::scenario) fn tree(&self) -> &Table {
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
pub(in crate::scenario) fn configuration(
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
pub(in crate::scenario) fn digest(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// The first swept key of a point that has another value than the point says, and what that is.
pub(in crate::scenario) fn broken<'a>(
    root: &Table,
    point: &'a SweepPoint,
) -> Option<(&'a str, &'a str)> {
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
