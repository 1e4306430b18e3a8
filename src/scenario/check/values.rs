//! Checks of single keys: known, of the right type, inside the range.

use crate::scenario::check::faults::{Faults, Taken};
use crate::scenario::check::leaf::check_leaf;
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{self, Child, Key, join};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::message::suggest::{self, sole_sibling, unknown_key};

/// The version of the file format this build reads.
const SCHEMA_VERSION: i64 = 1;

/// Most complaints of a scenario that say what may have been meant.
const SUGGESTED_MAX: usize = 64;

/// Most tables of an array.
const TABLES_MAX: usize = 10_000;

/// Walks a tree and gathers complaints.
pub(in crate::scenario) struct Checker<'a> {
    pub(in crate::scenario) sources: &'a Sources,
    pub(in crate::scenario) errors: Vec<ScenarioError>,
    pub(in crate::scenario) taken: Vec<Taken>,
}

/// What a check leaves of a value.
enum Left {
    /// All of it.
    Whole,
    /// Something was taken out of it.
    Rest(Value),
    /// None of it.
    Nothing,
}

/// A table under check.
#[derive(Clone, Copy)]
pub(in crate::scenario) struct Place<'a> {
    pub(in crate::scenario) schema_path: &'a str,
    pub(in crate::scenario) shown_path: &'a str,
    pub(in crate::scenario) mark: Mark,
}

/// The place of the root: the first byte of the scenario's own file.
pub(in crate::scenario) fn root_place(root: Mark) -> Place<'static> {
    Place {
        schema_path: "",
        shown_path: "",
        mark: root,
    }
}

/// Refuses unknown keys, wrong types and values out of range, and takes them out; what is in order
/// stays shared.
pub(crate) fn check_values(root: &mut Table, mark: Mark, sources: &Sources) -> Faults {
    if let Some(error) = wrong_version(root, sources, mark) {
        return Faults {
            errors: vec![error],
            taken: Vec::new(),
            is_other_version: true,
        };
    }
    let mut checker = Checker::new(sources);
    if let Some(rest) = checker.table(root_place(mark), root) {
        *root = rest;
    }
    Faults {
        errors: checker.errors,
        taken: checker.taken,
        is_other_version: false,
    }
}

/// A complaint if the file is written for another version of the format.
fn wrong_version(root: &Table, sources: &Sources, mark: Mark) -> Option<ScenarioError> {
    let node = root.get("schema")?;
    match node.value {
        Value::Integer(version) if version != SCHEMA_VERSION => Some(sources.error(
            node.mark.unwrap_or(mark),
            format!(
                "schema = {version} is not supported: this build reads schema {SCHEMA_VERSION}"
            ),
        )),
        _ => None,
    }
}

impl<'a> Checker<'a> {
    pub(in crate::scenario) fn new(sources: &'a Sources) -> Self {
        Self {
            sources,
            errors: Vec::new(),
            taken: Vec::new(),
        }
    }
}

impl Checker<'_> {
    fn complain(&mut self, mark: Mark, message: String) {
        self.errors.push(self.sources.error(mark, message));
    }

    /// Checks a table; returns what is left of it if something had to be taken out.
    fn table(&mut self, place: Place<'_>, table: &Table) -> Option<Table> {
        let mut rest: Option<Table> = None;
        let mut faulty: Vec<&String> = Vec::new();
        for (name, node) in table {
            let left = self.value(place, name, node);
            if let Left::Whole = left {
                continue;
            }
            let changed = rest.get_or_insert_with(|| table.clone());
            if let Left::Rest(value) = left {
                let mark = node.mark;
                changed.insert(name.clone(), Node { value, mark });
            } else {
                changed.remove(name);
                faulty.push(name);
            }
        }
        if let Some(rest) = &mut rest {
            for name in faulty {
                self.take(place, rest, name, &table[name]);
            }
        }
        rest
    }

    /// Checks one entry of a table.
    fn value(&mut self, place: Place<'_>, name: &str, node: &Node) -> Left {
        let Some(child) = schema::child(place.schema_path, name) else {
            self.unknown(place, name, node.mark.unwrap_or(place.mark));
            return Left::Nothing;
        };
        let shown = join(place.shown_path, name);
        let inner = Place {
            schema_path: &join(place.schema_path, name),
            shown_path: &shown,
            mark: node.mark.unwrap_or(place.mark),
        };
        match (child, &node.value) {
            (Child::Leaf(key), _) => self.leaf(key, inner, node),
            (Child::Table, Value::Table(table)) => match self.table(inner, table) {
                None => Left::Whole,
                Some(rest) => Left::Rest(rest.into()),
            },
            (Child::Table, other) => {
                self.not_a_table(inner, other, &format!("[{shown}]"));
                Left::Nothing
            }
            (Child::Tables, _) => self.tables(inner, node),
        }
    }

    /// Sets a faulty value aside, or puts it where it must have been meant to stand; what is wrong
    /// with it there follows from the fault and is not said.
    fn take(&mut self, place: Place<'_>, rest: &mut Table, name: &str, node: &Node) {
        let mark = node.mark.unwrap_or(place.mark);
        let meant = match schema::child(place.schema_path, name) {
            // Nothing depends on a key that does not exist.
            None if self.errors.len() > SUGGESTED_MAX => return,
            None => {
                let sibling = sole_sibling(place.schema_path, name);
                match sibling.filter(|sibling| !rest.contains_key(*sibling)) {
                    Some(sibling) => (sibling.to_owned(), node.clone()),
                    None => return,
                }
            }
            Some(Child::Tables) if node.as_table().is_some() => {
                let value = vec![node.clone()].into();
                let mark = Some(mark);
                (name.to_owned(), Node { value, mark })
            }
            child => {
                let key = match child {
                    Some(Child::Leaf(key)) => Some(key),
                    _ => None,
                };
                let shown = join(place.shown_path, name);
                self.taken.push(Taken { shown, key, mark });
                return;
            }
        };
        let said = self.errors.len();
        let shown = join(place.shown_path, &meant.0);
        let meant = Table::from([meant]);
        let mut meant = self.table(place, &meant).unwrap_or(meant);
        self.errors.truncate(said);
        rest.append(&mut meant);
        let key = None;
        self.taken.push(Taken { shown, key, mark });
    }

    /// Checks an array of tables; what is no table in it becomes an empty one.
    fn tables(&mut self, place: Place<'_>, node: &Node) -> Left {
        let header = format!("[[{}]]", place.shown_path);
        let Value::Array(elements) = &node.value else {
            self.not_a_table(place, &node.value, &header);
            return Left::Nothing;
        };
        if elements.len() > TABLES_MAX {
            let count = elements.len();
            let shown = place.shown_path;
            let message = format!("{shown} holds {count} tables: allowed up to {TABLES_MAX}");
            self.complain(place.mark, message);
            return Left::Nothing;
        }
        let mut rest: Option<Vec<Node>> = None;
        for (index, element) in elements.iter().enumerate() {
            let shown = format!("{}[{index}]", place.shown_path);
            let mark = element.mark.unwrap_or(place.mark);
            let inner = Place {
                schema_path: &format!("{}[]", place.schema_path),
                shown_path: &shown,
                mark,
            };
            let left = if let Value::Table(table) = &element.value {
                self.table(inner, table)
            } else {
                self.not_a_table(inner, &element.value, &header);
                let key = None;
                self.taken.push(Taken { shown, key, mark });
                Some(Table::new())
            };
            if let Some(table) = left {
                let changed = rest.get_or_insert_with(|| elements.to_vec());
                changed[index].value = table.into();
            }
        }
        rest.map_or(Left::Whole, |rest| Left::Rest(rest.into()))
    }

    /// Complains of a value that is no table.
    fn not_a_table(&mut self, place: Place<'_>, value: &Value, header: &str) {
        let wanted = if header.starts_with("[[") {
            "an array of tables"
        } else {
            "a table"
        };
        let message = format!(
            "{} has the wrong type: expected {wanted}, written {header}, got {}",
            place.shown_path,
            value.type_name()
        );
        self.complain(place.mark, message);
    }

    /// Complains of an unknown key.
    fn unknown(&mut self, place: Place<'_>, name: &str, mark: Mark) {
        // The search for what was meant takes longest, and nobody reads the thousandth complaint.
        let message = if self.errors.len() < SUGGESTED_MAX {
            let table = suggest::Place {
                schema_path: place.schema_path,
                shown: place.shown_path,
                root: None,
            };
            unknown_key(table, name)
        } else {
            format!("unknown key {}", excerpt(&join(place.shown_path, name)))
        };
        let error = self.sources.error(mark, message).at_key();
        self.errors.push(error);
    }

    fn leaf(&mut self, key: &Key, place: Place<'_>, node: &Node) -> Left {
        let Err(fault) = check_leaf(key, place.shown_path, node) else {
            return Left::Whole;
        };
        self.complain(fault.mark.unwrap_or(place.mark), fault.message);
        Left::Nothing
    }
}
