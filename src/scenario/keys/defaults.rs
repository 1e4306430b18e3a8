//! Defaults, each of which stands in the declaration of its key.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crate::scenario::document::tree::{Node, Table, Value, parse_document};
use crate::scenario::keys::schema::{self, Child, Entry, Group, Key, Kind, Presence, keys};

/// The default of a key, if it has one.
pub(crate) fn default_of(schema_path: &str) -> Option<&'static Value> {
    static DEFAULTS: OnceLock<BTreeMap<&str, Value>> = OnceLock::new();
    let defaults = DEFAULTS.get_or_init(|| {
        let defaulted = keys().filter(|key| key.presence == Presence::Defaulted);
        defaulted
            .map(|key| (key.path, declared_value(key)))
            .collect()
    });
    defaults.get(schema_path)
}

/// The value that the declaration of a key writes.
pub(crate) fn declared_value(key: &Key) -> Value {
    if let Kind::EmptyTable = key.kind {
        return Value::from(Table::new());
    }
    let read = parse_document(0, &format!("value = {}", key.literal)).ok();
    let node = read.and_then(|mut table| table.remove("value"));
    let mut node = node.expect("a default is written in TOML, which a test asserts");
    node.remark(None);
    node.value
}

/// Tables outside arrays as they are where nothing of them is written, by schema path.
fn absent_table(schema_path: &str) -> Arc<Table> {
    static ABSENT: OnceLock<BTreeMap<&str, Arc<Table>>> = OnceLock::new();
    let absent = ABSENT.get_or_init(|| {
        let mut absent = BTreeMap::new();
        gather_absent("", &mut absent);
        absent
    });
    absent.get(schema_path).cloned().unwrap_or_default()
}

/// Works out the absent tables below a path, the innermost first.
fn gather_absent(schema_path: &str, absent: &mut BTreeMap<&'static str, Arc<Table>>) {
    for Entry { child, path, .. } in schema::entries(schema_path).iter().copied() {
        if let Child::Table = child {
            gather_absent(path, absent);
            let inner = |path: &str| absent.get(path).cloned().unwrap_or_default();
            let table = filled(path, &Table::new(), &inner).unwrap_or_default();
            absent.insert(path, Arc::new(table));
        }
    }
}

/// Fills every absent defaulted key and table of a tree; chosen alternatives stay, a group without a
/// choice takes its default one, and an optional table that is absent stays so.
///
/// What needs nothing stays shared, and so are tables of which nothing was written.
pub(crate) fn fill(root: &mut Table) {
    if let Some(filled) = filled("", root, &absent_table) {
        *root = filled;
    }
}

/// The table with what it lacks; `None` if it lacks nothing.
///
/// * `absent`: the filled table at a path of which nothing was written.
fn filled(schema_path: &str, table: &Table, absent: &dyn Fn(&str) -> Arc<Table>) -> Option<Table> {
    let group = schema::group_of(schema_path);
    let is_chosen = group.is_some_and(|group| {
        let mut alternatives = group.alternatives.iter();
        alternatives.any(|name| table.contains_key(*name))
    });
    let mut result = None;
    for Entry { name, child, path } in schema::entries(schema_path).iter().copied() {
        let is_alternative = group.is_some_and(|group| group.alternatives.contains(&name));
        let may_add = if is_alternative {
            !is_chosen && group.and_then(Group::default) == Some(name)
        } else {
            !schema::is_optional_table(path)
        };
        let node = match (table.get(name), child) {
            (Some(node), Child::Table | Child::Tables) => filled_node(path, node, child, absent),
            (None, Child::Leaf(_)) if may_add => default_of(path).map(|value| Node {
                value: value.clone(),
                mark: None,
            }),
            (None, Child::Table) if may_add => Some(Node {
                value: Value::Table(absent_in(path, absent)),
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

/// What of a filled tree says more than [`fill`] would add.
pub(crate) fn sparse(root: &Table) -> Table {
    sparse_below("", root)
}

fn sparse_below(schema_path: &str, table: &Table) -> Table {
    let group = schema::group_of(schema_path);
    let mut result = table.clone();
    for Entry { name, child, path } in schema::entries(schema_path).iter().copied() {
        let is_alternative = group.is_some_and(|group| group.alternatives.contains(&name));
        let would_be_added = if is_alternative {
            group.and_then(Group::default) == Some(name)
        } else {
            !schema::is_optional_table(path)
        };
        let Some(node) = result.get_mut(name) else {
            continue;
        };
        let says_nothing = match (&mut node.value, child) {
            (value, Child::Leaf(_)) => default_of(path) == Some(&*value),
            (Value::Table(inner), Child::Table) => {
                *inner = Arc::new(sparse_below(path, inner));
                inner.is_empty()
            }
            (Value::Array(elements), Child::Tables) => {
                for element in Arc::make_mut(elements) {
                    if let Some(table) = element.as_table_mut() {
                        *table = sparse_below(path, table);
                    }
                }
                false
            }
            _ => false,
        };
        if says_nothing && would_be_added {
            result.remove(name);
        }
    }
    result
}

/// A table of which nothing was written, filled. Those inside arrays are not kept.
fn absent_in(path: &str, absent: &dyn Fn(&str) -> Arc<Table>) -> Arc<Table> {
    if path.contains("[]") {
        Arc::new(filled(path, &Table::new(), absent).unwrap_or_default())
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
    absent: &dyn Fn(&str) -> Arc<Table>,
) -> Option<Node> {
    let value = match (&node.value, child) {
        (Value::Table(table), _) => filled(path, table, absent).map(Value::from),
        (Value::Array(elements), Child::Tables) => {
            let mut result = None;
            for (index, element) in elements.iter().enumerate() {
                let table = element.as_table();
                if let Some(table) = table.and_then(|table| filled(path, table, absent)) {
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
