//! The JSON Schema of the scenario file, for editors.

use serde_json::{Map, Value, json};

use crate::declare::{Content, DIGEST_DIGITS};
use crate::scenario::check::cross::RESERVED;
use crate::scenario::config::RangeConfig;
use crate::scenario::document::tree;
use crate::scenario::keys::defaults::default_of;
use crate::scenario::keys::schema::{self, Child, Group, Key, Kind, Presence, join};

/// JSON Schema (draft-07) of a scenario file, generated from the key table.
///
/// In a base, or a file that builds on one, no key of a plain table is required and a choice may be
/// left open, as the other file may give it. A file with a `name` that extends nothing must be
/// complete, and so must every element of an array of tables, as arrays are replaced whole.
#[must_use]
pub fn json_schema() -> Value {
    let mut schema = object("");
    let head = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "fogbench scenario",
    });
    let mut document = match head {
        Value::Object(head) => head,
        _ => Map::new(),
    };
    document.append(&mut schema);
    document.insert(
        "if".to_owned(),
        json!({"required": ["name"], "not": {"required": ["extends"]}}),
    );
    document.insert("then".to_owned(), complete("").into());
    Value::Object(document)
}

/// Schema of a table.
fn object(schema_path: &str) -> Map<String, Value> {
    let mut properties = Map::new();
    for (name, child) in schema::children(schema_path) {
        let below = join(schema_path, name);
        let value = match child {
            Child::Leaf(key) => leaf(key),
            Child::Table => Value::Object(object(&below)),
            Child::Tables => {
                json!({"type": "array", "items": element(&format!("{below}[]"))})
            }
        };
        properties.insert(name.to_owned(), value);
    }
    let mut schema = Map::new();
    schema.insert("type".to_owned(), json!("object"));
    schema.insert("additionalProperties".to_owned(), json!(false));
    if let Some(group) = schema::group_of(schema_path)
        && group.alternatives.len() > 1
    {
        schema.insert("not".to_owned(), json!({"anyOf": pairs(group)}));
    }
    schema.insert("properties".to_owned(), Value::Object(properties));
    schema
}

/// Schema of an element of an array of tables, which is always complete.
fn element(schema_path: &str) -> Value {
    let mut schema = object(schema_path);
    // One rule says it all: the weaker one would only double the complaint of an editor.
    if schema::group_of(schema_path).is_some() {
        schema.remove("not");
    }
    for (keyword, rule) in complete(schema_path) {
        // The tables inside have their own properties already: what they need stands beside them.
        let (keyword, rule) = match keyword.as_str() {
            "properties" => ("allOf".to_owned(), json!([{"properties": rule}])),
            _ => (keyword, rule),
        };
        schema.insert(keyword, rule);
    }
    if schema_path == "gate[]" {
        let limits = json!([{"required": ["min"]}, {"required": ["max"]}]);
        schema.insert("anyOf".to_owned(), limits);
    }
    schema.into()
}

/// What a table needs in order to be complete: its required keys, a choice where there is no
/// default one, and the same of the tables inside it, if they are there.
fn complete(schema_path: &str) -> Map<String, Value> {
    let mut required = Vec::new();
    let mut properties = Map::new();
    for (name, child) in schema::children(schema_path) {
        match child {
            Child::Leaf(key) if key.presence == Presence::Required => required.push(name),
            Child::Table => {
                let inner = complete(&join(schema_path, name));
                if !inner.is_empty() {
                    properties.insert(name.to_owned(), inner.into());
                }
            }
            Child::Leaf(_) | Child::Tables => {}
        }
    }
    let mut rules = Map::new();
    if !required.is_empty() {
        rules.insert("required".to_owned(), json!(required));
    }
    if let Some(group) = schema::group_of(schema_path)
        && group.default().is_none()
    {
        let choices = group.alternatives.iter();
        let choices: Vec<Value> = choices.map(|name| json!({"required": [name]})).collect();
        rules.insert("oneOf".to_owned(), choices.into());
    }
    if !properties.is_empty() {
        rules.insert("properties".to_owned(), properties.into());
    }
    rules
}

/// Every two alternatives of a group, which may not stand together.
fn pairs(group: &Group) -> Vec<Value> {
    let mut pairs = Vec::new();
    for (index, first) in group.alternatives.iter().enumerate() {
        for second in &group.alternatives[index + 1..] {
            pairs.push(json!({"required": [first, second]}));
        }
    }
    pairs
}

/// Schema of a key.
pub(in crate::scenario::generate) fn leaf(key: &Key) -> Value {
    let mut schema = match key.kind {
        Kind::Float(range) => number(range),
        Kind::Floats(range) => {
            json!({"type": "array", "minItems": 1, "items": number(range)})
        }
        Kind::Texts | Kind::Files | Kind::Command => {
            json!({"type": "array", "minItems": 1, "items": {"type": "string", "minLength": 1}})
        }
        Kind::Triple(range) => {
            json!({"type": "array", "minItems": 3, "maxItems": 3, "items": number(range)})
        }
        Kind::Integer(range) => {
            let mut schema = json!({"type": "integer", "minimum": range.min, "maximum": range.max});
            if range.is_even {
                schema["multipleOf"] = json!(2);
            }
            schema
        }
        Kind::Boolean => json!({"type": "boolean"}),
        Kind::Text | Kind::Spelled(_) | Kind::File => json!({"type": "string", "minLength": 1}),
        Kind::Digest => {
            json!({"type": "string", "pattern": format!("^[0-9a-f]{{{DIGEST_DIGITS}}}$")})
        }
        Kind::FreeText => json!({"type": "string"}),
        Kind::Name => json!({
            "type": "string",
            "pattern": "^[a-z0-9][a-z0-9_-]{0,63}$",
            "not": {"enum": RESERVED},
        }),
        Kind::Choice(words) => json!({"type": "string", "enum": words}),
        Kind::Choices(words) => {
            json!({"type": "array", "minItems": 1, "items": {"type": "string", "enum": words}})
        }
        Kind::EmptyTable => {
            json!({"type": "object", "additionalProperties": false, "properties": {}})
        }
        Kind::Parameters => json!({
            "type": "object",
            "additionalProperties": {"type": ["string", "number", "boolean", "array"]},
        }),
        Kind::Matrix => matrix(),
    };
    schema["description"] = json!(format!("{} {}", key.sentence(), key.line()));
    if key.successor.is_some() {
        schema["deprecated"] = json!(true);
    }
    if let Some(default) = default_of(key.path).and_then(plain) {
        schema["default"] = default;
    }
    schema
}

/// Schema of the table of swept keys: of each its values, or a range of them. A key that is written
/// without quotes makes tables in tables.
fn matrix() -> Value {
    let rows = || RangeConfig::TABLE.rows.iter();
    let properties = rows().filter_map(|row| match row.content {
        Content::Value(kind) => Some((row.name.to_owned(), leaf(&Key::of(row, row.name, kind)))),
        _ => None,
    });
    let properties: Map<String, Value> = properties.collect();
    let required = rows().filter(|row| row.presence == Presence::Required);
    let required: Vec<&str> = required.map(|row| row.name).collect();
    json!({
        "type": "object",
        "minProperties": 1,
        "additionalProperties": {"anyOf": [
            {"type": "array", "minItems": 1},
            {
                "type": "object",
                "additionalProperties": false,
                "properties": properties,
                "required": required,
            },
            {"type": "object", "minProperties": 1, "additionalProperties": {"type": ["object", "array"]}},
        ]},
    })
}

/// Schema of a number.
fn number(range: schema::Range) -> Value {
    json!({"type": "number", "minimum": range.low, "maximum": range.high})
}

/// A scalar default in JSON, or an array of such.
fn plain(value: &tree::Value) -> Option<Value> {
    match value {
        tree::Value::Text(text) => Some(json!(text)),
        tree::Value::Integer(number) => Some(json!(number)),
        tree::Value::Float(number) => Some(json!(number)),
        tree::Value::Boolean(is_set) => Some(json!(is_set)),
        tree::Value::Array(elements) => elements.iter().map(|node| plain(&node.value)).collect(),
        _ => None,
    }
}
