//! Values that nobody wrote: what a scenario left to the defaults, however far down.

use crate::declare::{Key, Told};
use crate::scenario::check::inert::is_idle;
use crate::scenario::check::inert_rules::is_of_bench;
use crate::scenario::document::emit::to_toml_around;
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::declared_key;
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

/// What an account says of the values that nobody set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AssumedInShort {
    /// Those that shape its figures.
    pub named: Vec<AssumedValue>,
    /// How many there are in all.
    pub count: usize,
}

impl AssumedInShort {
    /// Whether a key is among those that are named.
    #[must_use]
    pub fn names(&self, key: &str) -> bool {
        self.named.iter().any(|value| value.key == key)
    }
}

impl AssumedValue {
    /// Name, value and unit: `power_uw = 0.87 uW`.
    #[must_use]
    pub fn shown(&self) -> String {
        let name = self.key.rsplit('.').next().unwrap_or(&self.key);
        format!("{name} = {} {}", self.value, self.unit)
            .trim_end()
            .to_owned()
    }
}

impl Resolved {
    /// The values that nobody set, those that act and shape every account by name.
    #[must_use]
    pub fn assumed_in_short(&self) -> AssumedInShort {
        AssumedInShort {
            named: self.assumed_and_told(Told::Account),
            count: self.assumed().len(),
        }
    }

    /// The values that nobody set and on which the noise budget of the gyro rests.
    #[must_use]
    pub fn assumed_of_budget(&self) -> Vec<AssumedValue> {
        self.assumed_and_told(Told::Budget)
    }

    /// The values that nobody set, that act, and that are told there.
    fn assumed_and_told(&self, place: Told) -> Vec<AssumedValue> {
        let is_told = |value: &AssumedValue| {
            let key = declared(&value.key);
            key.is_some_and(|key| key.told.contains(&place)) && !is_idle(self, &value.key)
        };
        let mut assumed = self.assumed();
        assumed.retain(is_told);
        assumed
    }

    /// The canonical text, behind each value where it comes from unless the scenario's own file says it:
    /// `assumed` where nobody does.
    #[must_use]
    pub fn to_toml_with_origins(&self) -> String {
        let (mut nodes, mut origins): (Vec<&Node>, Vec<String>) = (Vec::new(), Vec::new());
        enter(&self.tree, "", &mut |key, node| {
            if let Some(origin) = self.origin(key, node) {
                nodes.push(node);
                origins.push(origin);
            }
        });
        let (text, places) = to_toml_around(&self.tree, &nodes);
        let mut told = String::new();
        let mut from = 0;
        for (index, place) in places {
            told.push_str(&text[from..place.end]);
            told.push_str(&format!("  # {}", origins[index]));
            from = place.end;
        }
        told + &text[from..]
    }

    /// Where a value comes from, unless the scenario's own file says it.
    fn origin(&self, key: &str, node: &Node) -> Option<String> {
        if self.is_assumed(key, node) {
            return Some("assumed".to_owned());
        }
        let mark = node.mark?;
        if self.is_set_argument(mark) {
            return Some("from --set".to_owned());
        }
        (mark.source != self.root_mark.source).then(|| format!("from {}", self.place(mark).file))
    }

    fn is_assumed(&self, key: &str, node: &Node) -> bool {
        match &self.assumed_keys {
            Some(recorded) => recorded.iter().any(|known| known == key),
            None => node.mark.is_none(),
        }
    }

    /// The values that neither the scenario, its bases nor the command line set, by key.
    ///
    /// In a run repeated from its manifest these are those of the original run.
    #[must_use]
    pub fn assumed(&self) -> Vec<AssumedValue> {
        let mut found = Vec::new();
        enter(&self.tree, "", &mut |key, node| {
            if self.is_assumed(key, node) && !(self.log.is_some() && is_of_bench(key)) {
                found.push(assumed(key, node));
            }
        });
        found
    }
}

/// Visits the values of a table, arrays of tables element by element.
fn enter<'a>(table: &'a Table, prefix: &str, visit: &mut dyn FnMut(&str, &'a Node)) {
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

/// The declaration of a value; one of an element of an array is known without its index.
fn declared(key: &str) -> Option<&'static Key> {
    let mut path = String::new();
    let mut is_index = false;
    for letter in key.chars() {
        is_index &= letter != ']';
        if !is_index {
            path.push(letter);
        }
        is_index |= letter == '[';
    }
    declared_key(&path)
}

fn assumed(key: &str, node: &Node) -> AssumedValue {
    let declared = declared(key);
    let lines = declared.map_or(&[][..], |declared| declared.doc).iter();
    let lines: Vec<&str> = lines.map(|line| line.trim()).collect();
    AssumedValue {
        key: key.to_owned(),
        value: node.value.to_toml(),
        unit: declared.map_or("", |declared| declared.unit),
        meaning: lines.join(" "),
    }
}
