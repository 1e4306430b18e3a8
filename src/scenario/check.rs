//! Checks of single keys: known, of the right type, inside the range, present.

use super::error::ScenarioError;
use super::faults::{Faults, Taken};
use super::leaf::check_leaf;
use super::schema::{self, Child, Group, Key, Presence, join};
use super::source::{Mark, Sources};
use super::suggest::{self, sole_sibling, unknown_key};
use super::tree::{Node, Table, Value};

/// The version of the file format this build reads.
const SCHEMA_VERSION: i64 = 1;

/// Most unknown keys for which a suggestion is looked up: more complaints than that nobody reads.
const SUGGESTED_MAX: usize = 64;

/// Walks a tree and gathers complaints.
pub(crate) struct Checker<'a> {
    sources: &'a Sources,
    errors: Vec<ScenarioError>,
    taken: Vec<Taken>,
    unknown: usize,
}

/// A table under check.
#[derive(Clone, Copy)]
struct Place<'a> {
    schema_path: &'a str,
    shown_path: &'a str,
    mark: Mark,
}

/// The place of the root: the first byte of the scenario's own file.
fn root_place(root: Mark) -> Place<'static> {
    Place {
        schema_path: "",
        shown_path: "",
        mark: root,
    }
}

/// Refuses unknown keys, wrong types and values out of range, and takes them out; turns whole numbers
/// given for binary64 keys into binary64.
pub(crate) fn check_values(root: &mut Table, mark: Mark, sources: &Sources) -> Faults {
    if let Some(error) = wrong_version(root, sources, mark) {
        return Faults {
            errors: vec![error],
            taken: Vec::new(),
            is_other_version: true,
        };
    }
    let mut checker = Checker::new(sources);
    checker.table(root_place(mark), root);
    Faults {
        errors: checker.errors,
        taken: checker.taken,
        is_other_version: false,
    }
}

/// Refuses missing required keys and missing choices, after defaults have been filled in, but for
/// those that were taken out.
pub(crate) fn check_presence(
    root: &Table,
    mark: Mark,
    sources: &Sources,
    taken: &[Taken],
) -> Vec<ScenarioError> {
    let mut checker = Checker::new(sources);
    checker.taken = taken.to_vec();
    checker.presence(root_place(mark), root);
    checker.errors
}

/// Refuses a file that gives two alternatives of one group.
pub(crate) fn check_contradictions(
    root: &Table,
    mark: Mark,
    sources: &Sources,
) -> Vec<ScenarioError> {
    let mut checker = Checker::new(sources);
    checker.contradictions(root_place(mark), root);
    checker.errors
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
    fn new(sources: &'a Sources) -> Self {
        Self {
            sources,
            errors: Vec::new(),
            taken: Vec::new(),
            unknown: 0,
        }
    }
}

impl Checker<'_> {
    fn complain(&mut self, mark: Mark, message: String) {
        self.errors.push(self.sources.error(mark, message));
    }

    /// Complains of something that is missing in a table; nothing is to be seen of it in a file.
    fn miss(&mut self, mark: Mark, message: String) {
        let location = self.sources.locate(mark);
        let location = if mark.start == 0 {
            location.unseen()
        } else {
            location
        };
        self.errors
            .push(ScenarioError::at(location, message).at_key());
    }

    /// Checks a table and takes out what is wrong.
    fn table(&mut self, place: Place<'_>, table: &mut Table) {
        let mut faulty: Vec<String> = Vec::new();
        for (name, node) in table.iter_mut() {
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            let mark = node.mark.unwrap_or(place.mark);
            let inner = Place {
                schema_path: &below,
                shown_path: &shown,
                mark,
            };
            let is_sound = match schema::child(place.schema_path, name) {
                None => self.unknown(place, name, mark),
                Some(Child::Leaf(key)) => self.leaf(key, inner, node),
                Some(Child::Table) => match &mut node.value {
                    Value::Table(table) => {
                        self.table(inner, table);
                        true
                    }
                    other => self.not_a_table(inner, other, &format!("[{shown}]")),
                },
                Some(Child::Tables) => self.tables(inner, node),
            };
            if !is_sound {
                faulty.push(name.clone());
            }
        }
        for name in faulty {
            if let Some(node) = table.remove(&name) {
                self.take(place, table, &name, node);
            }
        }
    }

    /// Sets a faulty value aside, or puts it where it must have been meant to stand; what is wrong
    /// with it there follows from the fault and is not said.
    fn take(&mut self, place: Place<'_>, table: &mut Table, name: &str, node: Node) {
        let mark = node.mark.unwrap_or(place.mark);
        let meant = match schema::child(place.schema_path, name) {
            None if self.unknown <= SUGGESTED_MAX => sole_sibling(place.schema_path, name)
                .filter(|sibling| !table.contains_key(*sibling))
                .map(|sibling| (sibling.to_owned(), node)),
            Some(Child::Tables) if node.as_table().is_some() => {
                let array = Node {
                    value: Value::Array(vec![node]),
                    mark: Some(mark),
                };
                Some((name.to_owned(), array))
            }
            child => {
                let key = match child {
                    Some(Child::Leaf(key)) => Some(key),
                    _ => None,
                };
                self.taken.push(Taken {
                    shown: join(place.shown_path, name),
                    key,
                    mark,
                });
                None
            }
        };
        let Some((name, node)) = meant else {
            return;
        };
        let said = self.errors.len();
        let shown = join(place.shown_path, &name);
        let mut meant = Table::from([(name, node)]);
        self.table(place, &mut meant);
        self.errors.truncate(said);
        table.append(&mut meant);
        self.taken.push(Taken {
            shown,
            key: None,
            mark,
        });
    }

    /// Checks an array of tables; what is no table in it becomes an empty one.
    fn tables(&mut self, place: Place<'_>, node: &mut Node) -> bool {
        let Value::Array(elements) = &mut node.value else {
            let header = format!("[[{}]]", place.shown_path);
            return self.not_a_table(place, &node.value, &header);
        };
        for (index, element) in elements.iter_mut().enumerate() {
            let shown = format!("{}[{index}]", place.shown_path);
            let mark = element.mark.unwrap_or(place.mark);
            let inner = Place {
                schema_path: &format!("{}[]", place.schema_path),
                shown_path: &shown,
                mark,
            };
            if let Value::Table(table) = &mut element.value {
                self.table(inner, table);
                continue;
            }
            self.not_a_table(inner, &element.value, &format!("[[{}]]", place.shown_path));
            element.value = Value::Table(Table::new());
            let key = None;
            self.taken.push(Taken { shown, key, mark });
        }
        true
    }

    /// Complains of a value that is no table; always false.
    fn not_a_table(&mut self, place: Place<'_>, value: &Value, header: &str) -> bool {
        let message = format!(
            "{} has the wrong type: expected a table, written {header}, got {}",
            place.shown_path,
            value.type_name()
        );
        self.complain(place.mark, message);
        false
    }

    /// Complains of an unknown key; always false.
    fn unknown(&mut self, place: Place<'_>, name: &str, mark: Mark) -> bool {
        self.unknown += 1;
        let message = if self.unknown <= SUGGESTED_MAX {
            let table = suggest::Place {
                schema_path: place.schema_path,
                shown: place.shown_path,
                root: None,
            };
            unknown_key(table, name)
        } else {
            format!("unknown key {}", join(place.shown_path, name))
        };
        let error = self.sources.error(mark, message).at_key();
        self.errors.push(error);
        false
    }

    fn leaf(&mut self, key: &Key, place: Place<'_>, node: &mut Node) -> bool {
        let Err(fault) = check_leaf(key, place.shown_path, node) else {
            return true;
        };
        self.complain(fault.mark.unwrap_or(place.mark), fault.message);
        false
    }

    fn is_taken(&self, shown: &str) -> bool {
        self.taken.iter().any(|taken| taken.covers(shown))
    }

    fn presence(&mut self, place: Place<'_>, table: &Table) {
        let group = Group::of_table(place.schema_path);
        if let Some(group) = group
            && !group
                .alternatives
                .iter()
                .any(|name| table.contains_key(*name))
            && !self.is_taken(place.shown_path)
            && !(group.alternatives.iter()).any(|name| self.is_taken(&join(place.shown_path, name)))
        {
            let message = format!(
                "{} needs exactly one {}: {}",
                place.shown_path,
                group.noun,
                choices(group, place.shown_path)
            );
            self.miss(place.mark, message);
        }
        for (name, child) in schema::children(place.schema_path) {
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            let node = table.get(name);
            let mark = node.and_then(|node| node.mark).unwrap_or(place.mark);
            match (child, node) {
                (Child::Leaf(key), None)
                    if key.presence == Presence::Required && !self.is_taken(&shown) =>
                {
                    let message = format!(
                        "{shown} is required: expected {} ({})",
                        key.expected(),
                        key.doc.trim_end_matches('.')
                    );
                    self.miss(mark, message);
                }
                (Child::Table, Some(node)) => {
                    let inner = Place {
                        schema_path: &below,
                        shown_path: &shown,
                        mark,
                    };
                    if let Some(table) = node.as_table() {
                        self.presence(inner, table);
                    }
                }
                (Child::Tables, Some(node)) => self.presence_in_tables(&below, &shown, mark, node),
                _ => {}
            }
        }
    }

    fn presence_in_tables(&mut self, below: &str, shown: &str, mark: Mark, node: &Node) {
        for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
            let inner = Place {
                schema_path: &format!("{below}[]"),
                shown_path: &format!("{shown}[{index}]"),
                mark: element.mark.unwrap_or(mark),
            };
            if let Some(table) = element.as_table() {
                self.presence(inner, table);
            }
        }
    }

    fn contradictions(&mut self, place: Place<'_>, table: &Table) {
        if let Some(group) = Group::of_table(place.schema_path) {
            let mut given: Vec<(Mark, &str)> = group
                .alternatives
                .iter()
                .filter_map(|name| Some((table.get(*name)?.mark?, *name)))
                .collect();
            given.sort_unstable();
            if let [(_, first), .., (mark, last)] = given[..] {
                let message = format!(
                    "{} contradicts {}: give exactly one {}: {}",
                    join(place.shown_path, last),
                    join(place.shown_path, first),
                    group.noun,
                    choices(group, place.shown_path)
                );
                let error = self.sources.error(mark, message).at_key();
                self.errors.push(error);
            }
        }
        for (name, node) in table {
            let mark = node.mark.unwrap_or(place.mark);
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            if let Some(table) = node.as_table() {
                let inner = Place {
                    schema_path: &below,
                    shown_path: &shown,
                    mark,
                };
                self.contradictions(inner, table);
            }
            for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
                if let Some(table) = element.as_table() {
                    let inner = Place {
                        schema_path: &format!("{below}[]"),
                        shown_path: &format!("{shown}[{index}]"),
                        mark: element.mark.unwrap_or(mark),
                    };
                    self.contradictions(inner, table);
                }
            }
        }
    }
}

/// The alternatives of a group as they are written in a file.
fn choices(group: &Group, shown_path: &str) -> String {
    let paths: Vec<String> = group
        .alternatives
        .iter()
        .map(|name| join(shown_path, name))
        .collect();
    paths.join(", ")
}
