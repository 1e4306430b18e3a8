//! The JSON Schema of problem files, for editors.

use serde_json::{Map, Value, json};

use crate::declare::{Content, Presence, Table};
use crate::inference::ProblemConfig;
use crate::scenario::generate::json_schema::leaf;
use crate::scenario::read::files::problem::problem_keys;

/// JSON Schema (draft-07) of a problem file, generated from the declared tables.
#[must_use]
pub fn problem_schema() -> Value {
    let mut document = object(&ProblemConfig::TABLE, "");
    document.insert(
        "$schema".to_owned(),
        json!("http://json-schema.org/draft-07/schema#"),
    );
    document.insert("title".to_owned(), json!("fogbench problem"));
    Value::Object(document)
}

/// Schema of a table; `path` is its own with the dot.
fn object(table: &'static Table, path: &str) -> Map<String, Value> {
    let mut properties = Map::new();
    let mut required = Vec::new();
    for row in table.rows {
        let own = format!("{path}{}", row.name);
        let key = problem_keys().iter().find(|key| key.path == own);
        let value = match (row.content, key) {
            (Content::Tables(inner), _) => json!({
                "type": "array",
                "description": inner.about.join(" ").trim(),
                "items": object(inner, &format!("{own}[].")),
            }),
            (_, Some(key)) => leaf(key),
            (_, None) => continue,
        };
        if row.presence == Presence::Required && key.is_some() {
            required.push(row.name);
        }
        properties.insert(row.name.to_owned(), value);
    }
    let schema = json!({
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
        "required": required,
    });
    match schema {
        Value::Object(schema) => schema,
        _ => Map::new(),
    }
}
