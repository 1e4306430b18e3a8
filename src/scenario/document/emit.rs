//! The canonical text of a resolved scenario: one spelling, in the order of the key table.

use std::ops::Range;

use crate::scenario::document::tree::{Node, Table};
use crate::scenario::keys::schema::{self, Child, Entry, Key, Kind, join};

/// The tree as TOML; `prefix` is the table it stands in, empty at the root.
pub(crate) fn to_toml(root: &Table, prefix: &str) -> String {
    let mut emitter = Emitter::default();
    if !prefix.is_empty() {
        emitter.text.push_str(&format!("[{prefix}]\n"));
    }
    emitter.table("", prefix, root);
    emitter.text
}

/// The tree as TOML, and where in it the values of some nodes of the tree stand: their indices with
/// the bytes, in the order of the text.
pub(crate) fn to_toml_around(
    root: &Table,
    nodes: &[&Node],
) -> (String, Vec<(usize, Range<usize>)>) {
    let mut emitter = Emitter {
        nodes,
        ..Emitter::default()
    };
    emitter.table("", "", root);
    (emitter.text, emitter.places)
}

/// A text on its way.
#[derive(Default)]
struct Emitter<'a> {
    text: String,
    /// Nodes whose places are asked for.
    nodes: &'a [&'a Node],
    places: Vec<(usize, Range<usize>)>,
}

impl Emitter<'_> {
    /// Writes the values of a table, then the tables inside it.
    fn table(&mut self, schema_path: &str, written_path: &str, values: &Table) {
        let entries = schema::entries(schema_path);
        for Entry { name, child, .. } in entries {
            if let (Child::Leaf(key), Some(node)) = (child, values.get(*name))
                && (node.as_table().is_none() || is_inline(key))
            {
                self.value(name, node);
            }
        }
        for Entry { name, child, path } in entries {
            let Some(node) = values.get(*name) else {
                continue;
            };
            match child {
                Child::Tables => {
                    let written = join(written_path, name);
                    let elements = node.as_array().unwrap_or_default();
                    for inner in elements.iter().filter_map(Node::as_table) {
                        self.text.push_str(&format!("\n[[{written}]]\n"));
                        self.table(path, &written, inner);
                    }
                }
                Child::Leaf(key) if is_inline(key) => {}
                Child::Leaf(_) | Child::Table => {
                    if let Some(inner) = node.as_table() {
                        let written = join(written_path, name);
                        let is_value = |node: &Node| node.as_table().is_none();
                        if inner.is_empty() || inner.values().any(is_value) {
                            self.text.push_str(&format!("\n[{written}]\n"));
                        }
                        self.table(path, &written, inner);
                    }
                }
            }
        }
    }

    /// Writes a line.
    fn value(&mut self, name: &str, node: &Node) {
        self.text.push_str(name);
        self.text.push_str(" = ");
        let start = self.text.len();
        node.value.write_toml(&mut self.text);
        let place = start..self.text.len();
        let asked = self
            .nodes
            .iter()
            .position(|asked| std::ptr::eq(*asked, node));
        self.places.extend(asked.map(|index| (index, place)));
        self.text.push('\n');
    }
}

/// Whether the table of a key stands on its line: its names are no keys of the bench.
fn is_inline(key: &Key) -> bool {
    matches!(key.kind, Kind::Parameters)
}
