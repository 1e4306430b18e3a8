//! Keys that were given under a former name.

use crate::scenario::check::leaf::binary64;
use crate::scenario::document::tree::{Node, Table};
use crate::scenario::keys::schema::{self, Child, Entry, join};

/// A warning of each key that has a new name, which says what to write instead.
pub(crate) fn warnings(root: &Table) -> Vec<String> {
    let mut found = Vec::new();
    gather("", "", root, &mut found);
    found
}

fn gather(schema_path: &str, shown_path: &str, table: &Table, found: &mut Vec<String>) {
    for Entry { name, child, path } in schema::entries(schema_path).iter().copied() {
        // Hardly any key has one, and each point of a sweep is asked.
        if matches!(child, Child::Leaf(key) if key.successor.is_none()) {
            continue;
        }
        let Some(node) = table.get(name) else {
            continue;
        };
        let shown = join(shown_path, name);
        match child {
            Child::Leaf(key) => {
                let Some(successor) = key.successor else {
                    continue;
                };
                // Only numbers change their unit.
                let value = binary64(&node.value).unwrap_or(f64::NAN);
                found.push(format!(
                    "{shown} = {} is the former name and unit of {}: write {} = {:?} ({})",
                    key.with_unit(&format!("{value:?}")),
                    successor.name,
                    successor.name,
                    value * successor.factor,
                    successor.unit
                ));
            }
            Child::Table => {
                if let Some(inner) = node.as_table() {
                    gather(path, &shown, inner, found);
                }
            }
            Child::Tables => elements(path, &shown, node, found),
        }
    }
}

fn elements(schema_path: &str, shown_path: &str, node: &Node, found: &mut Vec<String>) {
    for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
        if let Some(inner) = element.as_table() {
            gather(schema_path, &format!("{shown_path}[{index}]"), inner, found);
        }
    }
}
