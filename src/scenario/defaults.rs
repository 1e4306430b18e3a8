//! Defaults, all of which stand in `scenarios/reference.toml`.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use super::calibration_config::CalibrationConfig;
use super::deserialize::from_table;
use super::keys::OPTIONAL_TABLES;
use super::schema::{self, Child, Entry, Group, Presence, join};
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
    from_table(settings).expect("the defaults are valid, which a test asserts")
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

/// Tables outside arrays as they are where nothing of them is written, by schema path.
fn absent_table(schema_path: &str) -> Arc<Table> {
    static ABSENT: OnceLock<BTreeMap<&str, Arc<Table>>> = OnceLock::new();
    let absent = ABSENT.get_or_init(|| {
        let mut absent = BTreeMap::new();
        gather_absent("", Some(&defaults().live), &mut absent);
        absent
    });
    absent.get(schema_path).cloned().unwrap_or_default()
}

/// Works out the absent tables below a path, the innermost first; `live` is that of the reference.
fn gather_absent(
    schema_path: &str,
    live: Option<&Table>,
    absent: &mut BTreeMap<&'static str, Arc<Table>>,
) {
    for Entry { name, child, path } in schema::entries(schema_path).iter().copied() {
        if let Child::Table = child {
            let live = live.and_then(|live| live.get(name)?.as_table());
            gather_absent(path, live, absent);
            let inner = |path: &str| absent.get(path).cloned().unwrap_or_default();
            let table = filled(path, &Table::new(), live, &inner).unwrap_or_default();
            absent.insert(path, Arc::new(table));
        }
    }
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
///
/// What needs nothing stays shared, and so are tables of which nothing was written.
pub(crate) fn fill(root: &mut Table) {
    if let Some(filled) = filled("", root, Some(&defaults().live), &absent_table) {
        *root = filled;
    }
}

/// The table with what it lacks; `None` if it lacks nothing.
///
/// * `live`: the same table of the reference; `None` inside arrays and where it has none.
/// * `absent`: the filled table at a path of which nothing was written.
fn filled(
    schema_path: &str,
    table: &Table,
    live: Option<&Table>,
    absent: &dyn Fn(&str) -> Arc<Table>,
) -> Option<Table> {
    let group = Group::of_table(schema_path);
    let is_chosen = group.is_some_and(|group| {
        let mut alternatives = group.alternatives.iter();
        alternatives.any(|name| table.contains_key(*name))
    });
    let mut result = None;
    for Entry { name, child, path } in schema::entries(schema_path).iter().copied() {
        let live = live.and_then(|live| live.get(name));
        let is_alternative = group.is_some_and(|group| group.alternatives.contains(&name));
        let may_add = if is_alternative {
            !is_chosen && live.is_some()
        } else {
            !OPTIONAL_TABLES.contains(&path)
        };
        let inside_live = live.and_then(Node::as_table);
        let node = match (table.get(name), child) {
            (Some(node), Child::Table | Child::Tables) => {
                filled_node(path, node, child, inside_live, absent)
            }
            (None, Child::Leaf(_)) if may_add => default_of(path).map(|value| Node {
                value: value.clone(),
                mark: None,
            }),
            (None, Child::Table) if may_add => Some(Node {
                value: Value::Table(absent_in(path, inside_live, absent)),
                mark: None,
            }),
            _ => None,
        };
        if let Some(node) = node {
            let changed = result.get_or_insert_with(|| table.clone());
            changed.insert(name.to_owned(), node);
        }
    }
    result
}

/// A table of which nothing was written, filled. Those inside arrays have no counterpart in the
/// reference and are not kept.
fn absent_in(path: &str, live: Option<&Table>, absent: &dyn Fn(&str) -> Arc<Table>) -> Arc<Table> {
    if path.contains("[]") {
        Arc::new(filled(path, &Table::new(), live, absent).unwrap_or_default())
    } else {
        absent(path)
    }
}

/// A table or an array of tables with what is lacking inside; `None` if nothing is. The path is
/// that of the table, or of an element of the array.
fn filled_node(
    path: &str,
    node: &Node,
    child: Child,
    live: Option<&Table>,
    absent: &dyn Fn(&str) -> Arc<Table>,
) -> Option<Node> {
    let value = match (&node.value, child) {
        (Value::Table(table), _) => filled(path, table, live, absent).map(Value::from),
        (Value::Array(elements), Child::Tables) => {
            let mut result = None;
            for (index, element) in elements.iter().enumerate() {
                let table = element.as_table();
                if let Some(table) = table.and_then(|table| filled(path, table, None, absent)) {
                    let changed = result.get_or_insert_with(|| elements.to_vec());
                    changed[index].value = table.into();
                }
            }
            result.map(Value::from)
        }
        _ => None,
    };
    let mark = node.mark;
    value.map(|value| Node { value, mark })
}
