//! Checks of single keys: known, of the right type, inside the range, present.

use super::error::ScenarioError;
use super::excerpt::excerpt;
use super::leaf::check_leaf;
use super::schema::{self, Child, Group, Key, Presence, join};
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};

/// The version of the file format this build reads.
const SCHEMA_VERSION: i64 = 1;

/// Most complaints of a scenario that say what may have been meant.
const HINTS_MAX: usize = 64;

/// Most tables of an array.
const TABLES_MAX: usize = 10_000;

/// Most bytes of a name that may stand for a known one: all are shorter.
const KNOWN_LENGTH_MAX: usize = 128;

/// Walks a tree and gathers complaints.
pub(crate) struct Checker<'a> {
    sources: &'a Sources,
    errors: Vec<ScenarioError>,
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

/// Refuses unknown keys, wrong types and values out of range.
pub(crate) fn check_values(root: &Table, mark: Mark, sources: &Sources) -> Vec<ScenarioError> {
    if let Some(error) = wrong_version(root, sources, mark) {
        return vec![error];
    }
    let mut checker = Checker {
        sources,
        errors: Vec::new(),
    };
    checker.table(root_place(mark), root);
    checker.errors
}

/// Refuses missing required keys and missing choices, after defaults have been filled in.
pub(crate) fn check_presence(root: &Table, mark: Mark, sources: &Sources) -> Vec<ScenarioError> {
    let mut checker = Checker {
        sources,
        errors: Vec::new(),
    };
    checker.presence(root_place(mark), root);
    checker.errors
}

/// Refuses a file that gives two alternatives of one group.
pub(crate) fn check_contradictions(
    root: &Table,
    mark: Mark,
    sources: &Sources,
) -> Vec<ScenarioError> {
    let mut checker = Checker {
        sources,
        errors: Vec::new(),
    };
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

impl Checker<'_> {
    fn complain(&mut self, mark: Mark, message: String) {
        self.errors.push(self.sources.error(mark, message));
    }

    fn table(&mut self, place: Place<'_>, table: &Table) {
        for (name, node) in table {
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            let mark = node.mark.unwrap_or(place.mark);
            let inner = Place {
                schema_path: &below,
                shown_path: &shown,
                mark,
            };
            match schema::child(place.schema_path, name) {
                None => self.unknown(place, name, mark),
                Some(Child::Leaf(key)) => self.leaf(key, inner, node),
                Some(Child::Table) => match &node.value {
                    Value::Table(table) => self.table(inner, table),
                    other => self.not_a_table(inner, other, &format!("[{shown}]")),
                },
                Some(Child::Tables) => self.tables(inner, node),
            }
        }
    }

    fn tables(&mut self, place: Place<'_>, node: &Node) {
        let Value::Array(elements) = &node.value else {
            let header = format!("[[{}]]", place.shown_path);
            return self.not_a_table(place, &node.value, &header);
        };
        if elements.len() > TABLES_MAX {
            let count = elements.len();
            let shown = place.shown_path;
            let message = format!("{shown} holds {count} tables: allowed up to {TABLES_MAX}");
            return self.complain(place.mark, message);
        }
        for (index, element) in elements.iter().enumerate() {
            let shown = format!("{}[{index}]", place.shown_path);
            let inner = Place {
                schema_path: &format!("{}[]", place.schema_path),
                shown_path: &shown,
                mark: element.mark.unwrap_or(place.mark),
            };
            match &element.value {
                Value::Table(table) => self.table(inner, table),
                other => self.not_a_table(inner, other, &format!("[[{}]]", place.shown_path)),
            }
        }
    }

    fn not_a_table(&mut self, place: Place<'_>, value: &Value, header: &str) {
        let message = format!(
            "{} has the wrong type: expected a table, written {header}, got {}",
            place.shown_path,
            value.type_name()
        );
        self.complain(place.mark, message);
    }

    fn unknown(&mut self, place: Place<'_>, name: &str, mark: Mark) {
        let shown = join(place.shown_path, name);
        // The search for what was meant takes longest, and nobody reads the thousandth complaint.
        let message = if self.errors.len() < HINTS_MAX {
            unknown_key(place.schema_path, &shown, name)
        } else {
            format!("unknown key {}", excerpt(&shown))
        };
        self.complain(mark, message);
    }

    fn leaf(&mut self, key: &Key, place: Place<'_>, node: &Node) {
        if let Err(fault) = check_leaf(key, place.shown_path, node) {
            self.complain(fault.mark.unwrap_or(place.mark), fault.message);
        }
    }

    fn presence(&mut self, place: Place<'_>, table: &Table) {
        let group = Group::of_table(place.schema_path);
        if let Some(group) = group
            && !group
                .alternatives
                .iter()
                .any(|name| table.contains_key(*name))
        {
            let message = format!(
                "{} needs exactly one {}: {}",
                place.shown_path,
                group.noun,
                choices(group, place.shown_path)
            );
            self.complain(place.mark, message);
        }
        for (name, child) in schema::children(place.schema_path) {
            let node = table.get(name);
            let is_settled = match child {
                Child::Leaf(key) => node.is_some() || key.presence != Presence::Required,
                Child::Table | Child::Tables => node.is_none(),
            };
            if is_settled {
                continue;
            }
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            let mark = node.and_then(|node| node.mark).unwrap_or(place.mark);
            match (child, node) {
                (Child::Leaf(key), None) if key.presence == Presence::Required => {
                    let message = format!(
                        "{shown} is required: expected {} ({})",
                        key.expected(),
                        key.doc.trim_end_matches('.')
                    );
                    self.complain(mark, message);
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
                self.complain(mark, message);
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

/// The complaint about a key that nobody knows.
pub(crate) fn unknown_key(schema_path: &str, shown: &str, name: &str) -> String {
    let shown = excerpt(shown);
    if name.len() > KNOWN_LENGTH_MAX {
        return format!("unknown key {shown}");
    }
    match schema::nearest(schema_path, name) {
        (nearest, true) => format!("unknown key {shown}: did you mean {nearest}?"),
        (nearest, false) => format!("unknown key {shown}: the nearest known key is {nearest}"),
    }
}
