//! Values that stand in for faulty and missing ones, so that the rest of a file can be checked.
//!
//! What is found with them counts only if it is found with every variant: a complaint that follows
//! from one made-up value does not follow from another.

use crate::declare::DIGEST_DIGITS;
use crate::scenario::check::faults::Taken;
use crate::scenario::document::address::{Step, get, get_mut, parse};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::defaults::{default_of, fill};
use crate::scenario::keys::schema::{
    Child, Key, Kind, Presence, Range, child, children, group_of, join,
};

/// Which made-up values are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scenario) enum Variant {
    /// The defaults, or something ordinary.
    Ordinary,
    /// Smaller ones, and the first of words.
    Small,
    /// Larger ones, and the last of words.
    Large,
}

impl Variant {
    pub(in crate::scenario) const ALL: [Self; 3] = [Self::Ordinary, Self::Small, Self::Large];

    fn index(self) -> usize {
        match self {
            Self::Ordinary => 0,
            Self::Small => 1,
            Self::Large => 2,
        }
    }
}

/// Makes a tree whole: what was taken out and what is missing is made up.
pub(in crate::scenario) fn make_whole(root: &mut Table, taken: &[Taken], variant: Variant) {
    for one in taken {
        if let (Some(key), Ok(path)) = (one.key, parse(&one.shown)) {
            let value = made_up(key, variant);
            let mark = Some(one.mark);
            insert(root, &path, Node { value, mark });
        }
    }
    fill(root);
    complete("", root, variant);
    fill(root);
    complete("", root, variant);
}

/// Puts a value where none is, if its table is there.
fn insert(root: &mut Table, path: &[Step], node: Node) {
    let Some((Step::Key(name), parent)) = path.split_last() else {
        return;
    };
    if parent.is_empty() {
        root.entry(name.clone()).or_insert(node);
    } else if get(root, path).is_none()
        && let Some(table) = get_mut(root, parent).and_then(Node::as_table_mut)
    {
        table.insert(name.clone(), node);
    }
}

/// Makes up required keys and choices that are missing.
fn complete(schema_path: &str, table: &mut Table, variant: Variant) {
    if let Some(group) = group_of(schema_path)
        && !group
            .alternatives
            .iter()
            .any(|name| table.contains_key(*name))
        && let Some(first) = group.alternatives.first()
    {
        let value = match child(schema_path, first) {
            Some(Child::Leaf(key)) => made_up(key, variant),
            _ => Table::new().into(),
        };
        table.insert((*first).to_owned(), Node { value, mark: None });
    }
    for (name, child) in children(schema_path) {
        let below = join(schema_path, name);
        match (child, table.get_mut(name)) {
            (Child::Leaf(key), None) if key.presence == Presence::Required => {
                let value = made_up(key, variant);
                table.insert(name.to_owned(), Node { value, mark: None });
            }
            (Child::Table, Some(node)) => {
                if let Some(inner) = node.as_table_mut() {
                    complete(&below, inner, variant);
                }
            }
            (Child::Tables, Some(node)) => {
                let elements = node.as_array_mut().into_iter().flatten();
                for inner in elements.filter_map(Node::as_table_mut) {
                    complete(&format!("{below}[]"), inner, variant);
                }
            }
            _ => {}
        }
    }
}

/// A value of a key within its range.
fn made_up(key: &Key, variant: Variant) -> Value {
    let default = default_of(key.path);
    if let (Variant::Ordinary, Some(default)) = (variant, default) {
        return default.clone();
    }
    let float = |range| float(range, default, variant);
    let floats = |values: Vec<f64>| {
        let node = |value| Node {
            value: Value::Float(value),
            mark: None,
        };
        values.into_iter().map(node).collect::<Vec<Node>>().into()
    };
    let texts = |words: Vec<String>| {
        let node = |word| Node {
            value: Value::Text(word),
            mark: None,
        };
        words.into_iter().map(node).collect::<Vec<Node>>().into()
    };
    // Another number of elements in each variant, so that no count is blamed on them.
    let count = variant.index() + 1;
    match key.kind {
        Kind::Float(range) => Value::Float(float(range)),
        Kind::Floats(range) => floats(vec![float(range); count]),
        Kind::Triple(range) => floats(vec![float(range); 3]),
        Kind::Integer(range) => {
            let start = match default {
                Some(Value::Integer(default)) => *default,
                _ => 2,
            };
            let wanted = match variant {
                Variant::Ordinary => start,
                Variant::Small => start / 4,
                Variant::Large => start.saturating_mul(4),
            };
            let whole = wanted.clamp(range.min, range.max);
            Value::Integer(if range.contains(whole) {
                whole
            } else {
                range.min
            })
        }
        Kind::Boolean => Value::Boolean(variant == Variant::Large),
        Kind::Choice(words) => Value::Text(words[variant.index() % words.len()].to_owned()),
        Kind::Choices(words) => texts(vec![words[variant.index() % words.len()].to_owned(); count]),
        Kind::Texts | Kind::Files | Kind::Command => {
            texts(vec!["raw.mean_deg_per_h".to_owned(); count])
        }
        Kind::Name => Value::Text(format!("stand-in-{count}")),
        Kind::Text | Kind::Spelled(_) | Kind::FreeText | Kind::File => {
            Value::Text(format!("stand-in {count}"))
        }
        Kind::Digest => Value::Text("0".repeat(DIGEST_DIGITS)),
        Kind::EmptyTable | Kind::Matrix | Kind::Parameters => Table::new().into(),
    }
}

fn float(range: Range, default: Option<&Value>, variant: Variant) -> f64 {
    const ORDINARY: f64 = 1.0;
    const SMALL: f64 = 0.25;
    const LARGE: f64 = 1e4;
    let start = match default {
        Some(Value::Float(default)) => Some(*default),
        _ => None,
    };
    let wanted = match variant {
        Variant::Ordinary => start.unwrap_or(ORDINARY),
        Variant::Small => start.map_or(SMALL, |value| SMALL * value),
        Variant::Large => start.map_or(LARGE, |value| value / SMALL + f64::from(value == 0.0)),
    };
    if range.contains(wanted) {
        return wanted;
    }
    let (low, high) = (range.low, range.high);
    let inside = [high.min(LARGE), 0.5 * (low + high), high];
    inside
        .into_iter()
        .find(|value| range.contains(*value))
        .unwrap_or(low)
}
