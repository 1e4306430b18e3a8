//! Defaults, all of which stand in `scenarios/reference.toml`.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde::Deserialize;

use super::calibration_config::CalibrationConfig;
use super::keys::OPTIONAL_TABLES;
use super::resolved::plain_table;
use super::schema::{self, Child, Group, Presence, join};
use super::tree::{Node, Table, Value, parse_document};

/// The reference, embedded.
const REFERENCE: &str = include_str!("../../scenarios/reference.toml");

/// How a line of a commented alternative begins.
const ALTERNATIVE: &str = "#| ";

/// The complete, commented manual of the scenario file, and the source of every default.
#[must_use]
pub fn reference_toml() -> &'static str {
    REFERENCE
}

/// The calibration settings that stand in the reference: what a file of groups is calibrated with
/// if nothing else is said.
///
/// # Panics
/// If the reference is not valid, which a test excludes.
#[must_use]
pub fn reference_calibration() -> CalibrationConfig {
    let mut root = Table::new();
    fill(&mut root);
    let settings = root.get("calibration").and_then(Node::as_table);
    let settings = settings.expect("the reference has every default, which a test asserts");
    CalibrationConfig::deserialize(plain_table(settings))
        .expect("the defaults are valid, which a test asserts")
}

/// The commented alternatives of the reference, each a document of its own.
pub(crate) fn alternatives() -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    let mut is_inside = false;
    for line in REFERENCE.lines() {
        let Some(content) = line.strip_prefix(ALTERNATIVE) else {
            is_inside = false;
            continue;
        };
        if !is_inside {
            blocks.push(String::new());
        }
        is_inside = true;
        let block = blocks.last_mut().expect("a block was begun above");
        block.push_str(content);
        block.push('\n');
    }
    blocks
}

/// Default values by schema path and the tables that stand live in the reference.
struct Defaults {
    values: BTreeMap<String, Value>,
    live: Table,
}

/// The defaults, read once.
fn defaults() -> &'static Defaults {
    static DEFAULTS: OnceLock<Defaults> = OnceLock::new();
    DEFAULTS.get_or_init(|| {
        let live = parse(REFERENCE);
        let mut values = BTreeMap::new();
        gather("", &live, &mut values);
        for block in alternatives() {
            gather("", &parse(&block), &mut values);
        }
        Defaults { values, live }
    })
}

/// Parses the reference or one of its alternatives.
fn parse(text: &str) -> Table {
    parse_document(0, text)
        .map_err(|error| error.message)
        .expect("reference.toml is valid TOML, which a test asserts")
}

/// Takes the values of the defaulted keys; the first one given stands.
fn gather(schema_path: &str, table: &Table, values: &mut BTreeMap<String, Value>) {
    for (name, node) in table {
        let path = join(schema_path, name);
        match schema::child(schema_path, name) {
            Some(Child::Leaf(key)) if key.presence == Presence::Defaulted => {
                let mut node = node.clone();
                if let (schema::Kind::Float(_), Value::Integer(_)) = (key.kind, &node.value) {
                    unreachable!(
                        "reference.toml writes {path} with a fraction, which a test asserts"
                    )
                }
                node.remark(None);
                values.entry(path).or_insert(node.value);
            }
            Some(Child::Table) => gather(&path, node.as_table().unwrap_or(&Table::new()), values),
            Some(Child::Tables) => {
                for table in node
                    .as_array()
                    .unwrap_or_default()
                    .iter()
                    .filter_map(Node::as_table)
                {
                    gather(&format!("{path}[]"), table, values);
                }
            }
            _ => {}
        }
    }
}

/// The default of a key, if it has one.
pub(crate) fn default_of(schema_path: &str) -> Option<&'static Value> {
    defaults().values.get(schema_path)
}

/// Whether a group without a choice takes one that stands live in the reference.
pub(crate) fn has_default_alternative(group: &Group) -> bool {
    let live = group
        .table
        .split('.')
        .try_fold(&defaults().live, |table, name| table.get(name)?.as_table());
    let stands = |live: &Table| {
        group
            .alternatives
            .iter()
            .any(|name| live.contains_key(*name))
    };
    live.is_some_and(stands)
}

/// Fills every absent defaulted key and table of a tree; chosen alternatives stay, a group without a
/// choice takes the alternative that stands live in the reference, and an optional table that is
/// absent stays so.
pub(crate) fn fill(root: &mut Table) {
    fill_table("", root, Some(&defaults().live));
}

/// Fills one table; `live` is the same table of the reference.
fn fill_table(schema_path: &str, table: &mut Table, live: Option<&Table>) {
    let group = Group::of_table(schema_path);
    let is_chosen = group.is_some_and(|group| {
        group
            .alternatives
            .iter()
            .any(|name| table.contains_key(*name))
    });
    for (name, child) in schema::children(schema_path) {
        let path = join(schema_path, name);
        let live_node = live.and_then(|live| live.get(name));
        let is_alternative = group.is_some_and(|group| group.alternatives.contains(&name));
        let may_add = if is_alternative {
            !is_chosen && live_node.is_some()
        } else {
            !OPTIONAL_TABLES.contains(&path.as_str())
        };
        if !table.contains_key(name) && may_add {
            let value = match child {
                Child::Leaf(_) => default_of(&path).cloned(),
                Child::Table => Some(Value::Table(Table::new())),
                Child::Tables => None,
            };
            if let Some(value) = value {
                table.insert(name.to_owned(), Node { value, mark: None });
            }
        }
        match table.get_mut(name).map(|node| &mut node.value) {
            Some(Value::Table(inner)) => {
                fill_table(&path, inner, live_node.and_then(Node::as_table));
            }
            Some(Value::Array(elements)) if matches!(child, Child::Tables) => {
                for inner in elements.iter_mut().filter_map(Node::as_table_mut) {
                    fill_table(&format!("{path}[]"), inner, None);
                }
            }
            _ => {}
        }
    }
}
