//! Problems of inference: a file of tables of its own beside the scenarios it names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::declare::{Content, Key, Keys, Presence, Table as Declared};
use crate::inference::ProblemConfig;
use crate::scenario::check::leaf::check_leaf;
use crate::scenario::config::Scenario;
use crate::scenario::document::address::{self, nearest_mark};
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value, parse_document};
use crate::scenario::keys::defaults::declared_value;
use crate::scenario::message::error::{Location, ScenarioError, in_order};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::message::suggest::unknown_in_table;
use crate::scenario::read::input;

/// The version of the file format this build reads.
const VERSION: i64 = 1;
/// Most elements of one array of tables.
const TABLES_MAX: usize = 1000;

/// A problem as its file says it, and where.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What it says.
    pub config: ProblemConfig,
    /// Bare name of its file.
    pub file: String,
    /// Place of the first figure that a log brings: those before are printed.
    pub logged_from: usize,
    folder: PathBuf,
    tree: Table,
    sources: Sources,
    start: Mark,
}

impl Problem {
    /// A complaint about a key, as in `published[2].metric`.
    #[must_use]
    pub fn complaint(&self, key: &str, message: impl Into<String>) -> ScenarioError {
        let path = address::parse(key).unwrap_or_default();
        let mark = nearest_mark(&self.tree, &path).unwrap_or(self.start);
        self.sources.error(mark, message)
    }

    /// The text of a file that the problem names.
    ///
    /// # Errors
    /// That the key does not lead to a text.
    pub fn read_beside(&self, key: &str, path: &str) -> Result<String, ScenarioError> {
        let read = input::read(&self.beside(path));
        let message = |error| format!("{key}: cannot read {}: {error}", excerpt(path));
        read.map(|input| input.text)
            .map_err(|error| self.complaint(key, message(error)))
    }

    /// A file that the problem names.
    #[must_use]
    pub fn beside(&self, path: &str) -> PathBuf {
        self.folder.join(path)
    }
}

/// Every key that a problem may hold, with its path.
#[must_use]
pub fn problem_keys() -> &'static [Key] {
    static KEYS: OnceLock<Keys> = OnceLock::new();
    &KEYS.get_or_init(|| Keys::of(&ProblemConfig::TABLE)).keys
}

/// Top-level keys of a document that the one declaration knows and the other does not.
fn alone(root: &Table, own: &Declared, other: &Declared) -> usize {
    let knows = |declared: &Declared, name: &str| declared.rows.iter().any(|row| row.name == name);
    root.keys()
        .filter(|name| knows(own, name) && !knows(other, name))
        .count()
}

/// Whether a document is a problem rather than a scenario.
pub(crate) fn is_problem(root: &Table) -> bool {
    let (problem, scenario) = (&ProblemConfig::TABLE, &Scenario::TABLE);
    alone(root, problem, scenario) > alone(root, scenario, problem)
}

/// Whether a document is a scenario rather than a problem.
fn is_scenario(root: &Table) -> bool {
    let (problem, scenario) = (&ProblemConfig::TABLE, &Scenario::TABLE);
    alone(root, scenario, problem) > alone(root, problem, scenario)
}

/// Reads a problem and checks all that can be checked without the scenarios it names.
///
/// # Errors
/// Every complaint, at its line.
pub fn load_problem(file: &Path) -> Result<Problem, Vec<ScenarioError>> {
    let shown = shown_path(file);
    let text = input::read(file)
        .map_err(|error| {
            let location = Location::of_file(shown.clone());
            vec![ScenarioError::at(location, error.to_string())]
        })?
        .text;
    let mut sources = Sources::default();
    let source = sources.add_file(shown, text.clone(), Label::of_scenario(file));
    let start = Mark { source, start: 0 };
    let mut tree = parse_document(source, &text).map_err(|error| {
        let start = error.start;
        vec![sources.error(Mark { source, start }, error.message)]
    })?;
    if is_scenario(&tree) {
        let message = "this is a scenario, which `fogbench run` takes: a problem of inference names it in [[record]]";
        return Err(vec![sources.error(start, message)]);
    }
    let mut reader = Reader {
        sources: &sources,
        errors: Vec::new(),
    };
    if reader.version(&tree, start) {
        reader.table(&ProblemConfig::TABLE, ("", ""), &mut tree, start);
    }
    let errors = reader.errors;
    if !errors.is_empty() {
        return Err(in_order(errors));
    }
    let config: ProblemConfig =
        from_table(&tree).map_err(|error| vec![sources.error(start, error.to_string())])?;
    let name = file.file_name().unwrap_or_default();
    let problem = Problem {
        logged_from: config.published.len(),
        config,
        file: name.to_string_lossy().into_owned(),
        folder: file.parent().unwrap_or(Path::new("")).to_owned(),
        tree,
        sources,
        start,
    };
    match contradictions(&problem) {
        errors if errors.is_empty() => Ok(problem),
        errors => Err(in_order(errors)),
    }
}

/// Walks the tables of a file and gathers complaints.
struct Reader<'a> {
    sources: &'a Sources,
    errors: Vec<ScenarioError>,
}

impl Reader<'_> {
    /// Whether the file is of the version that this build reads.
    fn version(&mut self, root: &Table, start: Mark) -> bool {
        match root.get("schema") {
            Some(node) if matches!(node.value, Value::Integer(version) if version != VERSION) => {
                let message = format!(
                    "schema = {} is not supported: this build reads schema {VERSION}",
                    node.value.to_toml()
                );
                let mark = node.mark.unwrap_or(start);
                self.errors.push(self.sources.error(mark, message));
                false
            }
            _ => true,
        }
    }

    /// Checks a table, fills in its defaults and goes on into its arrays of tables.
    ///
    /// * `(path, shown)`: of the table as the declaration and as the user writes it, with the dot.
    fn table(
        &mut self,
        declared: &'static Declared,
        (path, shown): (&str, &str),
        table: &mut Table,
        mark: Mark,
    ) {
        for (name, node) in table.iter_mut() {
            let place = node.mark.unwrap_or(mark);
            let shown = format!("{shown}{name}");
            let row = declared.rows.iter().find(|row| row.name == name);
            let Some(row) = row else {
                let known = declared.rows.iter().map(|row| row.name);
                let message = unknown_in_table(&shown, name, known);
                self.errors.push(self.sources.error(place, message));
                continue;
            };
            match row.content {
                Content::Tables(inner) => {
                    self.tables(inner, (&format!("{path}{name}[]."), &shown), node, place);
                }
                _ => {
                    let path = format!("{path}{name}");
                    let key = problem_keys().iter().find(|key| key.path == path);
                    let fault = key.and_then(|key| check_leaf(key, &shown, node).err());
                    if let Some(fault) = fault {
                        let place = fault.mark.unwrap_or(place);
                        self.errors.push(self.sources.error(place, fault.message));
                    }
                }
            }
        }
        for row in declared.rows {
            let Content::Value(_) = row.content else {
                continue;
            };
            if table.contains_key(row.name) {
                continue;
            }
            let path = format!("{path}{}", row.name);
            let key = problem_keys().iter().find(|key| key.path == path);
            match (row.presence, key) {
                (Presence::Required, _) => {
                    let message = format!("{shown}{} is missing: it is required", row.name);
                    self.errors.push(self.sources.error(mark, message));
                }
                (Presence::Defaulted, Some(key)) => {
                    let value = declared_value(key);
                    table.insert(row.name.to_owned(), Node { value, mark: None });
                }
                _ => {}
            }
        }
    }

    /// Checks an array of tables.
    fn tables(
        &mut self,
        declared: &'static Declared,
        (path, shown): (&str, &str),
        node: &mut Node,
        mark: Mark,
    ) {
        let count = node.as_array().map(<[Node]>::len);
        let Some(elements) = node.as_array_mut().filter(|_| count <= Some(TABLES_MAX)) else {
            let message = match count {
                None => format!("{shown} has the wrong type: expected tables, written [[{shown}]]"),
                Some(count) => format!("{shown} has {count} tables: allowed up to {TABLES_MAX}"),
            };
            self.errors.push(self.sources.error(mark, message));
            return;
        };
        for (index, element) in elements.iter_mut().enumerate() {
            let mark = element.mark.unwrap_or(mark);
            match element.as_table_mut() {
                Some(table) => {
                    self.table(declared, (path, &format!("{shown}[{index}].")), table, mark);
                }
                None => {
                    let message = format!("{shown}[{index}] has the wrong type: expected a table");
                    self.errors.push(self.sources.error(mark, message));
                }
            }
        }
    }
}

/// What the tables of a problem say that does not go together.
fn contradictions(problem: &Problem) -> Vec<ScenarioError> {
    let config = &problem.config;
    let mut errors = Vec::new();
    if config.records.is_empty() {
        let message = "the problem has no [[record]]: expected at least one";
        errors.push(problem.complaint("record", message));
    }
    if config.published.is_empty() && config.logs.is_empty() {
        let message = "the problem has neither [[published]] nor [[log]]: expected a figure";
        errors.push(problem.complaint("published", message));
    }
    errors.extend(twins(problem));
    errors.extend(strangers(problem));
    for (index, parameter) in config.parameters.iter().enumerate() {
        let at = format!("parameter[{index}].low");
        let (low, high) = (parameter.low, parameter.high);
        if low >= high {
            let message = format!("{at} = {low}: expected less than high, which is {high}");
            errors.push(problem.complaint(&at, message));
        }
        if parameter.prior == crate::vocabulary::Prior::LogUniform && low <= 0.0 {
            let message = format!("{at} = {low}: expected above 0, as prior = \"log-uniform\"");
            errors.push(problem.complaint(&at, message));
        }
    }
    for (index, figure) in config.published.iter().enumerate() {
        let given = (figure.rounding, figure.standard_uncertainty);
        if given.0.is_some() == given.1.is_some() {
            let at = format!("published[{index}]");
            let message = format!("{at}: expected either rounding or standard_uncertainty");
            errors.push(problem.complaint(&at, message));
        }
    }
    errors.extend(gate_limits(problem));
    errors
}

/// Gates whose limits accept everything or nothing.
fn gate_limits(problem: &Problem) -> Vec<ScenarioError> {
    let gates = problem.config.gates.iter().enumerate();
    gates
        .filter_map(|(index, gate)| {
            let at = format!("gate[{index}]");
            let message = match (gate.min, gate.max) {
                (None, None) => format!("{at}: expected min, max or both"),
                (Some(min), Some(max)) if min > max => {
                    format!("{at}.min = {min}: expected at most max, which is {max}")
                }
                _ => return None,
            };
            Some(problem.complaint(&at, message))
        })
        .collect()
}

/// Names that two rows of one table share.
fn twins(problem: &Problem) -> Vec<ScenarioError> {
    let config = &problem.config;
    let tables: [(&str, Vec<&str>); 3] = [
        (
            "record",
            config.records.iter().map(|row| row.name.as_str()).collect(),
        ),
        (
            "parameter",
            config
                .parameters
                .iter()
                .map(|row| row.name.as_str())
                .collect(),
        ),
        (
            "experiment",
            config
                .experiments
                .iter()
                .map(|row| row.name.as_str())
                .collect(),
        ),
    ];
    let mut errors = Vec::new();
    for (table, names) in tables {
        let mut seen = BTreeSet::new();
        for (index, name) in names.into_iter().enumerate() {
            if !seen.insert(name) {
                let at = format!("{table}[{index}].name");
                let message = format!("{at} = \"{name}\": another {table} has this name");
                errors.push(problem.complaint(&at, message));
            }
        }
    }
    errors
}

/// Names of records that there are not.
fn strangers(problem: &Problem) -> Vec<ScenarioError> {
    let config = &problem.config;
    let mut named: Vec<(String, &str)> = Vec::new();
    let several =
        |table: &str, index: usize, records: Option<&Vec<String>>| -> Vec<(String, String)> {
            let records = records.map(Vec::as_slice).unwrap_or_default();
            let at = format!("{table}[{index}].records");
            records
                .iter()
                .map(|name| (at.clone(), name.clone()))
                .collect()
        };
    let mut lists = Vec::new();
    for (index, row) in config.parameters.iter().enumerate() {
        lists.extend(several("parameter", index, row.records.as_ref()));
    }
    for (index, row) in config.choices.iter().enumerate() {
        lists.extend(several("choice", index, row.records.as_ref()));
    }
    named.extend(lists.iter().map(|(at, name)| (at.clone(), name.as_str())));
    for (index, row) in config.published.iter().enumerate() {
        named.push((format!("published[{index}].record"), &row.record));
    }
    for (index, row) in config.logs.iter().enumerate() {
        named.push((format!("log[{index}].record"), &row.record));
    }
    for (index, row) in config.experiments.iter().enumerate() {
        named.push((format!("experiment[{index}].record"), &row.record));
    }
    let known: Vec<&str> = config.records.iter().map(|row| row.name.as_str()).collect();
    let unknown = named.into_iter().filter(|(_, name)| !known.contains(name));
    unknown
        .map(|(at, name)| {
            let name = excerpt(name);
            let message = format!(
                "{at} = \"{name}\" is no record: expected one of {}",
                known.join(", ")
            );
            problem.complaint(&at, message)
        })
        .collect()
}
