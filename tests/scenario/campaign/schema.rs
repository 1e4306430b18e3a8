//! The keys of a scenario file as the JSON Schema tells them: types, ranges, units, alternatives.
//!
//! Nothing about a single key stands here, so that a new key is drawn without an edit.

use std::collections::BTreeMap;

use serde_json::Value;

/// A table, or an element of an array of tables.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    /// Names in the order of the schema.
    pub(crate) children: Vec<(String, Child)>,
    /// Names that must be given where the table is.
    pub(crate) required: Vec<String>,
    /// Names of which one at most is given, and whether one must be.
    pub(crate) choices: Vec<Choice>,
}

/// Names of which a table holds one at most.
#[derive(Clone, Debug)]
pub(crate) struct Choice {
    pub(crate) names: Vec<String>,
    pub(crate) is_required: bool,
}

/// What stands under a name.
#[derive(Clone, Debug)]
pub(crate) enum Child {
    Leaf(Leaf),
    Table(Table),
    Tables(Table),
}

/// A key.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    pub(crate) kind: Kind,
    /// Unit of a number, as the description names it.
    pub(crate) unit: Option<String>,
    /// Value that stands if the key does not.
    pub(crate) default: Option<f64>,
}

/// Type and range of a key.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Number(Range),
    Integer {
        min: i64,
        max: i64,
        step: i64,
    },
    Boolean,
    /// Any text, or a name where the schema gives a pattern.
    Text,
    Words(Vec<String>),
    /// Array of numbers; of that many, if it says so.
    Numbers(Range, Option<usize>),
    /// Array of words; any text if the list is empty.
    WordArray(Vec<String>),
    EmptyTable,
    /// Anything else, such as the table of swept keys.
    Other,
}

/// Interval of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) is_low_open: bool,
    pub(crate) high: f64,
}

/// The whole scenario file.
pub(crate) fn root() -> Table {
    let schema = fogbench::scenario::json_schema();
    table(&schema, &schema["then"])
}

/// A table from its schema and the rules of a complete file for it.
fn table(schema: &Value, complete: &Value) -> Table {
    let mut found = Table {
        required: [&schema["required"], &complete["required"]]
            .into_iter()
            .flat_map(words)
            .collect(),
        ..Table::default()
    };
    for rule in [&schema["oneOf"], &complete["oneOf"]] {
        let names: Vec<String> = array(rule).iter().flat_map(required_of).collect();
        if !names.is_empty() {
            found.choices.push(Choice {
                names,
                is_required: true,
            });
        }
    }
    if found.choices.is_empty() {
        found.choices = exclusive(&schema["not"]["anyOf"]);
    }
    for (name, child) in schema["properties"].as_object().into_iter().flatten() {
        let complete = &complete["properties"][name];
        found
            .children
            .push((name.clone(), self::child(child, complete)));
    }
    found
}

/// Groups of names that may not stand together, from the forbidden pairs.
fn exclusive(pairs: &Value) -> Vec<Choice> {
    let mut groups: Vec<Choice> = Vec::new();
    for pair in array(pairs) {
        let names = required_of(pair);
        let known = groups
            .iter_mut()
            .find(|group| names.iter().any(|name| group.names.contains(name)));
        match known {
            Some(group) => {
                for name in names {
                    if !group.names.contains(&name) {
                        group.names.push(name);
                    }
                }
            }
            None => groups.push(Choice {
                names,
                is_required: false,
            }),
        }
    }
    groups
}

fn child(schema: &Value, complete: &Value) -> Child {
    let properties = schema["properties"].as_object();
    match schema["type"].as_str() {
        Some("object") if properties.is_some_and(|below| !below.is_empty()) => {
            Child::Table(table(schema, complete))
        }
        Some("array") if schema["items"]["type"] == "object" => {
            let complete = &schema["items"]["allOf"][0];
            Child::Tables(table(&schema["items"], complete))
        }
        _ => Child::Leaf(leaf(schema)),
    }
}

fn leaf(schema: &Value) -> Leaf {
    let kind = match schema["type"].as_str() {
        Some("number") => Kind::Number(range(schema)),
        Some("integer") => Kind::Integer {
            min: schema["minimum"].as_i64().unwrap_or(i64::MIN),
            max: schema["maximum"].as_i64().unwrap_or(i64::MAX),
            step: schema["multipleOf"].as_i64().unwrap_or(1),
        },
        Some("boolean") => Kind::Boolean,
        Some("string") if schema["enum"].is_array() => Kind::Words(words(&schema["enum"])),
        Some("string") => Kind::Text,
        Some("array") if schema["items"]["type"] == "number" => {
            let count = schema["maxItems"].as_u64();
            let count = count.map(|count| usize::try_from(count).expect("a small count"));
            Kind::Numbers(range(&schema["items"]), count)
        }
        Some("array") => Kind::WordArray(words(&schema["items"]["enum"])),
        Some("object") if schema["additionalProperties"] == false => Kind::EmptyTable,
        _ => Kind::Other,
    };
    Leaf {
        kind,
        unit: schema["description"].as_str().and_then(unit),
        default: schema["default"].as_f64(),
    }
}

fn range(schema: &Value) -> Range {
    let open = schema["exclusiveMinimum"].as_f64();
    let low = open.or(schema["minimum"].as_f64());
    Range {
        low: low.unwrap_or(f64::MIN),
        is_low_open: open.is_some(),
        high: schema["maximum"].as_f64().unwrap_or(f64::MAX),
    }
}

/// What stands between `unit ` and the next semicolon of a key's line.
fn unit(description: &str) -> Option<String> {
    let (_, rest) = description.rsplit_once("; unit ")?;
    rest.split_once(';').map(|(unit, _)| unit.to_owned())
}

fn words(list: &Value) -> Vec<String> {
    let texts = array(list).iter().filter_map(Value::as_str);
    texts.map(str::to_owned).collect()
}

fn required_of(rule: &Value) -> Vec<String> {
    words(&rule["required"])
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Every key by its schema path, for the count of what a campaign has drawn.
pub(crate) fn leaves(table: &Table) -> BTreeMap<String, Leaf> {
    fn walk(table: &Table, path: &str, found: &mut BTreeMap<String, Leaf>) {
        for (name, child) in &table.children {
            let path = join(path, name);
            match child {
                Child::Leaf(leaf) => {
                    found.insert(path, leaf.clone());
                }
                Child::Table(table) => walk(table, &path, found),
                Child::Tables(table) => walk(table, &format!("{path}[]"), found),
            }
        }
    }
    let mut found = BTreeMap::new();
    walk(table, "", &mut found);
    found
}

/// `parent.name`, or `name` at the root.
pub(crate) fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() {
        name.to_owned()
    } else {
        format!("{parent}.{name}")
    }
}
