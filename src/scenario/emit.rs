//! The canonical text of a resolved scenario: one spelling, in the order of the key table.

use super::schema::{self, Child, join};
use super::tree::{Node, Table};

/// The tree as TOML; `prefix` is the table it stands in, empty at the root.
pub(crate) fn to_toml(root: &Table, prefix: &str) -> String {
    let mut text = String::new();
    if !prefix.is_empty() {
        text.push_str(&format!("[{prefix}]\n"));
    }
    table(&mut text, "", prefix, root);
    text
}

/// Writes the values of a table, then the tables inside it.
fn table(text: &mut String, schema_path: &str, written_path: &str, values: &Table) {
    let children = schema::children(schema_path);
    for (name, child) in &children {
        if let (Child::Leaf(_), Some(node)) = (child, values.get(*name))
            && node.as_table().is_none()
        {
            text.push_str(&format!("{name} = {}\n", node.value.to_toml()));
        }
    }
    for (name, child) in &children {
        let Some(node) = values.get(*name) else {
            continue;
        };
        let below = join(schema_path, name);
        let written = join(written_path, name);
        match child {
            Child::Tables => {
                let elements = node.as_array().unwrap_or_default();
                for inner in elements.iter().filter_map(Node::as_table) {
                    text.push_str(&format!("\n[[{written}]]\n"));
                    table(text, &format!("{below}[]"), &written, inner);
                }
            }
            Child::Leaf(_) | Child::Table => {
                if let Some(inner) = node.as_table() {
                    let is_needed =
                        inner.is_empty() || inner.values().any(|node| node.as_table().is_none());
                    if is_needed {
                        text.push_str(&format!("\n[{written}]\n"));
                    }
                    table(text, &below, &written, inner);
                }
            }
        }
    }
}
