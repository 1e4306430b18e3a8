//! Checks of single values: type and range.

use crate::declare::DIGEST_DIGITS;
use crate::scenario::document::source::Mark;
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{self, Key, Kind, join};
use crate::scenario::message::excerpt::excerpt;
use crate::wording::is_misspelling;

/// Most values of an array: as many as the rows of a script.
const ELEMENTS_MAX: usize = 100_000;

/// Elements of a [`Kind::Triple`].
const AXES: usize = 3;

/// What is wrong with a value, and where if not at its key.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub(crate) struct Fault {
    pub(crate) mark: Option<Mark>,
    pub(crate) message: String,
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Self {
            mark: None,
            message,
        }
    }
}

/// Checks one value.
pub(crate) fn check_leaf(key: &Key, shown: &str, node: &Node) -> Result<(), Fault> {
    if let Value::Array(values) = &node.value
        && values.len() > ELEMENTS_MAX
    {
        let count = values.len();
        let message = format!("{shown} holds {count} values: allowed up to {ELEMENTS_MAX}");
        return Err(message.into());
    }
    let is_allowed = match (key.kind, &node.value) {
        (Kind::Float(range), value) => check_float(key, shown, range, value)?,
        (Kind::Integer(range), Value::Integer(value)) => range.contains(*value),
        (Kind::Floats(range), Value::Array(values)) => {
            if values.is_empty() {
                return Err(format!("{shown} is empty: expected {}", key.expected()).into());
            }
            check_elements(key, shown, range, values)?;
            true
        }
        (Kind::Texts | Kind::Files | Kind::Command, Value::Array(values)) => {
            let is_text = |node: &Node| node.as_text().is_some_and(|text| !text.trim().is_empty());
            if values.is_empty() || !values.iter().all(is_text) {
                let value = node.value.to_toml();
                let value = excerpt(&value);
                return Err(format!("{shown} = {value}: expected {}", key.expected()).into());
            }
            true
        }
        (Kind::Triple(range), Value::Array(values)) => {
            if values.len() != AXES {
                let count = values.len();
                let message = format!("{shown} holds {count} values: expected {}", key.expected());
                return Err(message.into());
            }
            check_elements(key, shown, range, values)?;
            true
        }
        (Kind::Choices(words), Value::Array(values)) => {
            check_words(key, shown, words, values)?;
            true
        }
        (Kind::Name, Value::Text(name)) => is_name(name),
        (Kind::Digest, Value::Text(digest)) => is_digest(digest),
        (Kind::Choice(words), Value::Text(word)) => words.contains(&word.as_str()),
        (Kind::EmptyTable, Value::Table(table)) => {
            if let Some(name) = table.keys().next() {
                let unknown = join(shown, name);
                let unknown = excerpt(&unknown);
                return Err(
                    format!("unknown key {unknown}: {shown} is a table without keys").into(),
                );
            }
            true
        }
        (Kind::Parameters, Value::Table(table)) => {
            check_parameters(key, shown, table)?;
            true
        }
        (Kind::Spelled(lack), Value::Text(text)) if !text.trim().is_empty() => match lack(text) {
            Some(why) => return Err(no_such_form(shown, &node.value, &why).into()),
            None => true,
        },
        (Kind::Text | Kind::Spelled(_) | Kind::File, Value::Text(text)) => !text.trim().is_empty(),
        (Kind::FreeText, Value::Text(_)) | (Kind::Boolean, Value::Boolean(_)) => true,
        (_, value) => return Err(wrong_type(key, shown, value).into()),
    };
    if is_allowed {
        Ok(())
    } else {
        Err(out_of_range(key, shown, &node.value).into())
    }
}

/// Checks settings that are passed on: names that need no quotes, and values that JSON can say.
fn check_parameters(key: &Key, shown: &str, table: &Table) -> Result<(), Fault> {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    for (name, node) in table {
        let shown = join(shown, name);
        let shown = excerpt(&shown);
        let mark = node.mark;
        if name.is_empty() || !name.chars().all(is_bare) {
            let message = format!("{shown} is not a valid name: allowed A-Z, a-z, 0-9, _ and -");
            return Err(Fault { mark, message });
        }
        if !is_parameter(&node.value) {
            let message = format!(
                "{shown} has the wrong type: expected one of {}, got {}",
                key.allowed(),
                node.value.type_name()
            );
            return Err(Fault { mark, message });
        }
    }
    Ok(())
}

/// Whether a value can be passed on.
fn is_parameter(value: &Value) -> bool {
    match value {
        Value::Text(_) | Value::Integer(_) | Value::Boolean(_) => true,
        Value::Float(number) => number.is_finite(),
        Value::Array(values) => values.iter().all(|node| is_parameter(&node.value)),
        Value::Beyond(..) | Value::Date(_) | Value::Table(_) => false,
    }
}

/// Checks the words of an array; the first wrong one is blamed where it stands.
fn check_words(key: &Key, shown: &str, words: &[&str], values: &[Node]) -> Result<(), Fault> {
    if values.is_empty() {
        return Err(format!("{shown} is empty: expected {}", key.expected()).into());
    }
    for (index, node) in values.iter().enumerate() {
        let shown = format!("{shown}[{index}]");
        let message = match &node.value {
            Value::Text(word) if words.contains(&word.as_str()) => continue,
            Value::Text(word) => format!(
                "{shown} = \"{}\" is unknown: expected one of {}{}",
                excerpt(word),
                key.allowed(),
                hint(words, word)
            ),
            other => format!(
                "{shown} has the wrong type: expected one of {}, got {}{}",
                key.allowed(),
                other.type_name(),
                scalar_text(other)
            ),
        };
        let mark = node.mark;
        return Err(Fault { mark, message });
    }
    Ok(())
}

/// Most bytes of a word that may stand for a known one: all are shorter.
const WORD_LENGTH_MAX: usize = 128;

/// Words of the field for some choices.
const SYNONYMS: &[(&str, &str)] = &[
    ("adev", "plain"),
    ("oadev", "overlapping"),
    ("mdev", "modified"),
    ("hdev", "hadamard"),
    ("double", "binary64"),
    ("float64", "binary64"),
    ("float", "binary32"),
    ("float32", "binary32"),
    ("single", "binary32"),
    ("quadrupolar", "quadrupole"),
];

/// The known word that may be what was meant: the only one that is a slip away.
fn hint(words: &[&str], word: &str) -> String {
    if word.len() > WORD_LENGTH_MAX {
        return String::new();
    }
    let means = |known: &&&str| SYNONYMS.contains(&(word, known));
    let synonym = words.iter().find(means);
    let mut alike = words.iter().filter(|known| is_misspelling(word, known));
    let only = match (alike.next(), alike.next()) {
        (Some(one), None) => Some(one),
        _ => None,
    };
    synonym
        .or(only)
        .map_or_else(String::new, |known| format!(" (did you mean \"{known}\"?)"))
}

/// Checks the numbers of an array; the first wrong one is blamed where it stands.
fn check_elements(
    key: &Key,
    shown: &str,
    range: schema::Range,
    values: &[Node],
) -> Result<(), Fault> {
    for (index, node) in values.iter().enumerate() {
        // Most numbers are in order: the name is made for those that are not.
        if binary64(&node.value).is_some_and(|number| range.contains(number)) {
            continue;
        }
        let shown = format!("{shown}[{index}]");
        let mark = node.mark;
        check_float(key, &shown, range, &node.value).map_err(|fault| Fault { mark, ..fault })?;
        let message = out_of_range(key, &shown, &node.value);
        return Err(Fault { mark, message });
    }
    Ok(())
}

/// A number as binary64.
pub(crate) fn binary64(value: &Value) -> Option<f64> {
    match *value {
        Value::Float(number) => Some(number),
        #[expect(
            clippy::cast_precision_loss,
            reason = "a whole number beyond 2^53 rounds as it would if written with a fraction"
        )]
        Value::Integer(number) => Some(number as f64),
        _ => None,
    }
}

/// Whether a number is inside a range.
fn check_float(key: &Key, shown: &str, range: schema::Range, value: &Value) -> Result<bool, Fault> {
    let Some(number) = binary64(value) else {
        return Err(wrong_element(key, shown, value).into());
    };
    if !number.is_finite() {
        return Err(format!(
            "{shown} = {} is not a finite number: allowed {}",
            value.to_toml(),
            key.allowed()
        )
        .into());
    }
    Ok(range.contains(number))
}

/// Whether a text is a valid name of a scenario or channel.
pub(crate) fn is_name(name: &str) -> bool {
    let is_first = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit();
    let is_rest = |c: u8| is_first(c) || c == b'_' || c == b'-';
    match name.as_bytes() {
        [first, rest @ ..] => {
            is_first(*first) && rest.len() < 64 && rest.iter().all(|c| is_rest(*c))
        }
        [] => false,
    }
}

/// Whether a text is a digest as it is spelt here.
fn is_digest(text: &str) -> bool {
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    text.len() == DIGEST_DIGITS && text.bytes().all(is_digit)
}

/// The complaint about a text that has not the form of its key.
fn no_such_form(shown: &str, value: &Value, why: &str) -> String {
    let text = value.to_toml();
    format!("{shown} = {}: {why}", excerpt(&text))
}

/// The complaint about a value outside the allowed ones.
fn out_of_range(key: &Key, shown: &str, value: &Value) -> String {
    let text = value.to_toml();
    let text = excerpt(&text);
    match (key.kind, value) {
        (Kind::Choice(words), Value::Text(word)) => {
            format!(
                "{shown} = {text} is unknown: expected {}{}",
                key.expected(),
                hint(words, word)
            )
        }
        (Kind::Digest, _) => format!("{shown} = {text} is no digest: expected {}", key.expected()),
        (Kind::Name, _) => format!(
            "{shown} = {text} is not a valid name: allowed {}",
            key.allowed()
        ),
        (Kind::Text | Kind::Spelled(_), _) => format!("{shown} = {text} is empty: expected text"),
        _ => format!(
            "{shown} = {} is out of range: allowed {}",
            key.with_unit(&text),
            key.allowed()
        ),
    }
}

/// The complaint about a value that is no number where one is expected, alone or in an array.
fn wrong_element(key: &Key, shown: &str, value: &Value) -> String {
    match key.kind {
        Kind::Floats(_) | Kind::Triple(_) if !matches!(value, Value::Beyond(..)) => format!(
            "{shown} has the wrong type: expected a number, {}, got {}{}",
            key.allowed(),
            value.type_name(),
            scalar_text(value)
        ),
        _ => wrong_type(key, shown, value),
    }
}

/// The complaint about a value of another type.
fn wrong_type(key: &Key, shown: &str, value: &Value) -> String {
    let is_number = matches!(
        key.kind,
        Kind::Float(_) | Kind::Floats(_) | Kind::Triple(_) | Kind::Integer(_)
    );
    if let Value::Beyond(text, number_type) = value
        && is_number
    {
        return format!(
            "{shown} = {} is {}: allowed {}",
            excerpt(text),
            number_type.overflow(),
            key.allowed()
        );
    }
    format!(
        "{shown} has the wrong type: expected {}, got {}{}",
        key.expected(),
        value.type_name(),
        scalar_text(value)
    )
}

/// A blank and the value, if it is short enough to be shown.
fn scalar_text(value: &Value) -> String {
    match value {
        Value::Array(_) | Value::Table(_) => String::new(),
        scalar => format!(" {}", excerpt(&scalar.to_toml())),
    }
}
