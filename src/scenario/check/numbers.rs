//! Whole numbers given for binary64 keys, as binary64: one spelling of each value.

use crate::scenario::check::leaf::binary64;
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{self, Child, Kind, join};

/// Turns whole numbers given for binary64 keys into binary64; what needs no change stays shared.
pub(crate) fn settle(root: &mut Table) {
    if let Some(settled) = settled_table("", root) {
        *root = settled;
    }
}

/// The table with its numbers settled; `None` if they are.
fn settled_table(schema_path: &str, table: &Table) -> Option<Table> {
    let mut settled = None;
    for (name, node) in table {
        let value = match schema::child(schema_path, name) {
            Some(Child::Leaf(key)) => settled_value(key.kind, &node.value),
            Some(Child::Table) => node
                .as_table()
                .and_then(|inner| settled_table(&join(schema_path, name), inner))
                .map(Value::from),
            Some(Child::Tables) => settled_elements(&join(schema_path, name), node),
            None => None,
        };
        if let Some(value) = value {
            let changed = settled.get_or_insert_with(|| table.clone());
            let mark = node.mark;
            changed.insert(name.clone(), Node { value, mark });
        }
    }
    settled
}

/// The elements of an array of tables with their numbers settled; `None` if they are.
fn settled_elements(schema_path: &str, node: &Node) -> Option<Value> {
    let elements = node.as_array()?;
    let path = format!("{schema_path}[]");
    let mut settled = None;
    for (index, element) in elements.iter().enumerate() {
        let table = element.as_table();
        if let Some(table) = table.and_then(|table| settled_table(&path, table)) {
            let changed = settled.get_or_insert_with(|| elements.to_vec());
            changed[index].value = table.into();
        }
    }
    settled.map(Value::from)
}

/// The value of a key as binary64, alone or in an array; `None` if nothing needs to change.
pub(crate) fn settled_value(kind: Kind, value: &Value) -> Option<Value> {
    match (kind, value) {
        (Kind::Float(_), Value::Integer(_)) => binary64(value).map(Value::Float),
        (Kind::Floats(_) | Kind::Triple(_), Value::Array(nodes)) => {
            let is_whole = |node: &Node| matches!(node.value, Value::Integer(_));
            if !nodes.iter().any(is_whole) {
                return None;
            }
            let settle = |node: &Node| Node {
                value: binary64(&node.value).map_or_else(|| node.value.clone(), Value::Float),
                mark: node.mark,
            };
            Some(nodes.iter().map(settle).collect::<Vec<Node>>().into())
        }
        _ => None,
    }
}
