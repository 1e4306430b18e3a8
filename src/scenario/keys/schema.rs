//! What a scenario file may hold: types of the key table and questions asked of it.
//!
//! Paths are dotted; an element of an array of tables is written `[]`, as in `filter[].rls.taps`.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::declare::Keys;
pub(crate) use crate::declare::{Group, Key, Kind, Presence, Range};
use crate::scenario::config::Scenario;

/// Motion whose keys are written behind those of the other tables.
///
/// Digests of calibration scenarios were taken of texts in this order.
const WRITTEN_LAST: &str = "turntable.calibration.";

/// Everything that is declared, with full paths, worked out once.
fn declared() -> &'static Keys {
    static DECLARED: OnceLock<Keys> = OnceLock::new();
    DECLARED.get_or_init(|| {
        let mut declared = Keys::of(&Scenario::TABLE);
        let is_late = |key: &Key| key.path.starts_with(WRITTEN_LAST);
        declared.keys.sort_by_key(is_late);
        declared
    })
}

/// Every key, in the order in which resolved scenarios are written.
pub(crate) fn keys() -> impl Iterator<Item = &'static Key> {
    declared().keys.iter()
}

/// The key at a schema path.
pub(crate) fn declared_key(path: &str) -> Option<&'static Key> {
    keys().find(|key| key.path == path)
}

/// Tables of which exactly one alternative stands.
pub(crate) fn groups() -> &'static [Group] {
    &declared().groups
}

/// The group whose alternatives stand in a table.
pub(crate) fn group_of(schema_path: &str) -> Option<&'static Group> {
    groups().iter().find(|group| group.table == schema_path)
}

/// Whether a table is absent unless a file gives it, whatever stands inside.
pub(crate) fn is_optional_table(schema_path: &str) -> bool {
    declared().optional_tables.contains(&schema_path)
}

/// What a name inside a table stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Child {
    /// A value.
    Leaf(&'static Key),
    /// A table.
    Table,
    /// An array of tables.
    Tables,
}

/// A name inside a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    /// The name.
    pub(crate) name: &'static str,
    /// What it stands for.
    pub(crate) child: Child,
    /// Schema path of it, of an element if it is an array of tables.
    pub(crate) path: &'static str,
}

/// What each table may hold, in the order of the key table, by schema path.
type Tables = BTreeMap<&'static str, Vec<Entry>>;

/// The key table by tables, worked out once.
fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let mut tables = Tables::new();
        for key in keys() {
            let mut start = 0;
            for part in key.path.split('.') {
                let end = start + part.len();
                let table = &key.path[..start.saturating_sub(1)];
                let (name, child) = match part.strip_suffix("[]") {
                    Some(name) => (name, Child::Tables),
                    None if end == key.path.len() => (part, Child::Leaf(key)),
                    None => (part, Child::Table),
                };
                let found = tables.entry(table).or_default();
                if found.iter().all(|known| known.name != name) {
                    let path = &key.path[..end];
                    found.push(Entry { name, child, path });
                }
                start = end + 1;
            }
        }
        tables
    })
}

/// Unit of a key as a sweep writes its path, where an element stands by its index or its name; none where
/// it is no number, or keys of its name differ in their units.
pub(crate) fn unit_of_written(written: &str) -> &'static str {
    if let Some(key) = keys().find(|key| key.path == written) {
        return key.unit;
    }
    let last = |path: &str| path.rsplit('.').next().map(str::to_owned);
    let name = last(written);
    let mut units = keys().filter(|key| last(key.path) == name);
    let unit = units.next().map_or("", |key| key.unit);
    if units.all(|key| key.unit == unit) {
        unit
    } else {
        ""
    }
}

/// What a table may hold, in the order of the key table.
pub(crate) fn entries(schema_path: &str) -> &'static [Entry] {
    tables().get(schema_path).map_or(&[], Vec::as_slice)
}

/// Names a table may hold, in the order of the key table.
pub(crate) fn children(schema_path: &str) -> impl Iterator<Item = (&'static str, Child)> {
    entries(schema_path)
        .iter()
        .map(|entry| (entry.name, entry.child))
}

/// What a name inside a table stands for; `None` if unknown.
pub(crate) fn child(schema_path: &str, name: &str) -> Option<Child> {
    children(schema_path)
        .find(|(known, _)| *known == name)
        .map(|(_, child)| child)
}

/// `parent.name`, or `name` at the root.
pub(crate) fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() {
        name.to_owned()
    } else {
        format!("{parent}.{name}")
    }
}
