//! Values that nobody wrote: what a scenario left to the defaults, however far down.

use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::keys;
use crate::scenario::read::resolved::Resolved;

/// A value that a scenario left to its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssumedValue {
    /// Key, as in `filter[0].rls.taps`.
    pub key: String,
    /// Value in TOML.
    pub value: String,
    /// Unit; empty where there is none.
    pub unit: &'static str,
    /// What the key means and where its default comes from.
    pub meaning: String,
}

impl Resolved {
    /// The values that neither the scenario, its bases nor the command line set, by key.
    ///
    /// In a run repeated from its manifest these are those of the original run.
    #[must_use]
    pub fn assumed(&self) -> Vec<AssumedValue> {
        let mut found = Vec::new();
        enter(&self.tree, "", &mut |key, node| {
            let is_assumed = match &self.assumed_keys {
                Some(recorded) => recorded.iter().any(|known| known == key),
                None => node.mark.is_none(),
            };
            if is_assumed {
                found.push(assumed(key, node));
            }
        });
        found
    }
}

/// Visits the values of a table, arrays of tables element by element.
fn enter(table: &Table, prefix: &str, visit: &mut dyn FnMut(&str, &Node)) {
    for (name, node) in table {
        let key = match prefix {
            "" => name.clone(),
            prefix => format!("{prefix}.{name}"),
        };
        match &node.value {
            Value::Table(inner) => enter(inner, &key, visit),
            Value::Array(nodes) if nodes.iter().any(|node| node.as_table().is_some()) => {
                for (index, node) in nodes.iter().enumerate() {
                    if let Some(inner) = node.as_table() {
                        enter(inner, &format!("{key}[{index}]"), visit);
                    }
                }
            }
            Value::Array(nodes) if nodes.is_empty() => {}
            _ => visit(&key, node),
        }
    }
}

fn assumed(key: &str, node: &Node) -> AssumedValue {
    // The declarations know an element of an array without its index.
    let mut path = String::new();
    let mut is_index = false;
    for letter in key.chars() {
        is_index &= letter != ']';
        if !is_index {
            path.push(letter);
        }
        is_index |= letter == '[';
    }
    let declared = keys().find(|declared| declared.path == path);
    let lines = declared.map_or(&[][..], |declared| declared.doc).iter();
    let lines: Vec<&str> = lines.map(|line| line.trim()).collect();
    AssumedValue {
        key: key.to_owned(),
        value: node.value.to_toml(),
        unit: declared.map_or("", |declared| declared.unit),
        meaning: lines.join(" "),
    }
}
