//! What is said of a log: the table `[log]` of a file, and what options add to it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use crate::declare::{Key, Keys};
use crate::recording::LogFormat;
use crate::scenario::check::leaf::{Fault, check_leaf};
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::setting::Setting;
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value, parse_document};
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::message::suggest::unknown_in_table;
use crate::scenario::read::input;
use crate::wording::option_of;

/// The table of a file.
const TABLE: &str = "log";
/// Keys that name files, from the folder of the one that says so.
const FILES: [&str; 2] = ["segments", "calibration"];

fn keys() -> &'static [Key] {
    static KEYS: OnceLock<Keys> = OnceLock::new();
    &KEYS.get_or_init(|| Keys::of(&LogFormat::TABLE)).keys
}

/// Reads the table `[log]` of a file, if one is named, and puts options over it.
///
/// * `given`: keys of the table with their values.
///
/// # Errors
/// Every complaint about the file, at its line, and about the options.
pub fn load_log_format(
    file: Option<&Path>,
    given: &[(&str, Setting)],
) -> Result<LogFormat, Vec<ScenarioError>> {
    let mut table = match file {
        Some(file) => read(file)?,
        None => Table::new(),
    };
    let mut errors = Vec::new();
    for (name, setting) in given {
        let node = Node {
            value: setting.clone().into_value(),
            mark: None,
        };
        let option = option_of(name);
        if let Err(error) = check(name, name, &node) {
            errors.push(ScenarioError::at(
                Location::of_file(option),
                error.to_string(),
            ));
        }
        table.insert((*name).to_owned(), node);
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    from_table(&table).map_err(|error| {
        let location = Location::of_file(file.map_or_else(|| TABLE.to_owned(), shown_path));
        vec![ScenarioError::at(location, error.to_string())]
    })
}

/// A table `[log]` as a file holds it.
///
/// # Panics
/// Never: a flat table of words and numbers is TOML.
#[must_use]
pub fn log_format_toml(format: &LogFormat) -> String {
    let table = BTreeMap::from([(TABLE, format)]);
    toml::to_string(&table).expect("a flat table of words and numbers is TOML")
}

/// The checked table of a file.
fn read(file: &Path) -> Result<Table, Vec<ScenarioError>> {
    let shown = shown_path(file);
    let of_file =
        |message: String| vec![ScenarioError::at(Location::of_file(shown.clone()), message)];
    let text = input::read(file)
        .map_err(|error| of_file(error.to_string()))?
        .text;
    let mut sources = Sources::default();
    let source = sources.add_file(shown.clone(), text.clone(), Label::of_scenario(file));
    let at = |start: usize| Mark { source, start };
    let mut root = parse_document(source, &text)
        .map_err(|error| vec![sources.error(at(error.start), error.message)])?;
    let Some(node) = root.remove(TABLE) else {
        let message = format!("this is no layout of a log: expected a table [{TABLE}]");
        return Err(vec![sources.error(at(0), message)]);
    };
    let mark = node.mark.unwrap_or(at(0));
    let Some(table) = node.as_table() else {
        let message = format!("{TABLE} has the wrong type: expected a table, written [{TABLE}]");
        return Err(vec![sources.error(mark, message)]);
    };
    let mut table = table.clone();
    let mut errors = Vec::new();
    for (name, node) in &mut table {
        if let Err(error) = check(name, &format!("{TABLE}.{name}"), node) {
            errors.push(sources.error(node.mark.unwrap_or(mark), error.to_string()));
        }
        if FILES.contains(&name.as_str())
            && let Value::Text(path) = &node.value
        {
            let beside = file.parent().unwrap_or(Path::new("")).join(path);
            node.value = Value::Text(beside.to_string_lossy().into_owned());
        }
    }
    match errors.is_empty() {
        true => Ok(table),
        false => Err(errors),
    }
}

/// What is wrong with a value of the table.
#[derive(Debug, thiserror::Error)]
enum KeyError {
    /// With what may have been meant.
    #[error("{0}")]
    Unknown(String),
    #[error(transparent)]
    Value(#[from] Fault),
}

/// Checks one value of the table; `shown` is what the user calls its key.
fn check(name: &str, shown: &str, node: &Node) -> Result<(), KeyError> {
    let Some(key) = keys().iter().find(|key| key.path == name) else {
        let known = keys().iter().map(|key| key.path);
        return Err(KeyError::Unknown(unknown_in_table(shown, name, known)));
    };
    Ok(check_leaf(key, shown, node)?)
}
