//! Values that nobody wrote: what a scenario left to the defaults, however far down.

use crate::scenario::check::inert::is_idle;
use crate::scenario::document::emit::to_toml_around;
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

/// The keys that shape what every account says of a gyro: named there where nobody set them.
const NAMED: [&str; 8] = [
    "gyro.source.power_uw",
    "gyro.controller.loop_bandwidth_hz",
    "gyro.output.half_periods_per_sample",
    "gyro.slow_noise.bias_instability_deg_per_h",
    "gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h",
    "gyro.thermal.winding",
    "gyro.thermal.layers",
    "turntable.site.latitude_deg",
];

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
        let mut assumed = self.assumed();
        let count = assumed.len();
        assumed.retain(|value| NAMED.contains(&value.key.as_str()) && !is_idle(self, &value.key));
        AssumedInShort {
            named: assumed,
            count,
        }
    }

    /// The values that nobody set and on which the noise budget of the gyro rests.
    #[must_use]
    pub fn assumed_of_budget(&self) -> Vec<AssumedValue> {
        const TABLES: [&str; 4] = [
            "gyro.source.",
            "gyro.detector.",
            "gyro.adc.",
            "gyro.modulator.depth_deg",
        ];
        let mut assumed = self.assumed();
        assumed.retain(|value| {
            TABLES.iter().any(|table| value.key.starts_with(table)) && !is_idle(self, &value.key)
        });
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
            if self.is_assumed(key, node) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_named_is_a_key() {
        for named in NAMED {
            assert!(keys().any(|key| key.path == named), "{named}");
        }
    }
}
