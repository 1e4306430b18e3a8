//! A TOML document as a tree of values that know where they were written.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::excerpt::excerpt;
use super::schema::{group_of, join};
use super::source::Mark;
use super::weight;

/// Keys and values of a table.
pub(crate) type Table = BTreeMap<String, Node>;

/// A value and where to point when it is wrong: its key, or itself inside an array.
///
/// Values filled in from `reference.toml` have no mark.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) mark: Option<Mark>,
}

/// A TOML value.
///
/// Arrays and tables are shared until one of their owners changes them: the points of a sweep and
/// the scenarios on the same defaults keep only what is their own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    /// A number that does not fit into its type: nothing here accepts it.
    Beyond(String, NumberType),
    /// A date: nothing here accepts it.
    Date(String),
    Float(f64),
    Boolean(bool),
    Array(Arc<Vec<Node>>),
    Table(Arc<Table>),
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberType {
    /// 64 bits with sign.
    Whole,
    /// Binary64.
    Float,
}

impl NumberType {
    /// What a number that does not fit is.
    pub(crate) fn overflow(self) -> &'static str {
        match self {
            Self::Whole => "beyond 64 bits with sign",
            Self::Float => "beyond the range of binary64",
        }
    }
}

impl Node {
    /// The value as a table.
    pub(crate) fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The value as a table to change.
    pub(crate) fn as_table_mut(&mut self) -> Option<&mut Table> {
        match &mut self.value {
            Value::Table(table) => Some(Arc::make_mut(table)),
            _ => None,
        }
    }

    /// The value as an array.
    pub(crate) fn as_array(&self) -> Option<&[Node]> {
        match &self.value {
            Value::Array(array) => Some(array),
            _ => None,
        }
    }

    /// The value as an array to change.
    pub(crate) fn as_array_mut(&mut self) -> Option<&mut Vec<Node>> {
        match &mut self.value {
            Value::Array(array) => Some(Arc::make_mut(array)),
            _ => None,
        }
    }

    /// The value as text.
    pub(crate) fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Gives every value of the tree the same mark.
    pub(crate) fn remark(&mut self, mark: Option<Mark>) {
        self.mark = mark;
        match &mut self.value {
            Value::Array(array) => {
                let nodes = Arc::make_mut(array).iter_mut();
                nodes.for_each(|node| node.remark(mark));
            }
            Value::Table(table) => {
                let nodes = Arc::make_mut(table).values_mut();
                nodes.for_each(|node| node.remark(mark));
            }
            _ => {}
        }
    }
}

impl Value {
    /// What it is, with an article.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) => "a whole number",
            Self::Beyond(_, NumberType::Whole) => "a whole number beyond 64 bits",
            Self::Beyond(_, NumberType::Float) => "a number beyond binary64",
            Self::Date(_) => "a date",
            Self::Float(_) => "a number with a fraction",
            Self::Boolean(_) => "a boolean",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
        }
    }

    /// The value in TOML, on one line.
    pub(crate) fn to_toml(&self) -> String {
        let mut text = String::new();
        self.write_toml(&mut text);
        text
    }

    /// Appends the value in TOML, on one line.
    pub(crate) fn write_toml(&self, to: &mut String) {
        // Writing to a string cannot fail.
        let _ = match self {
            Self::Text(text) => write!(to, "{}", toml::Value::String(text.clone())),
            Self::Integer(value) => write!(to, "{value}"),
            Self::Beyond(text, _) | Self::Date(text) => to.write_str(text),
            Self::Float(value) if value.is_nan() => to.write_str("nan"),
            Self::Float(value) => write!(to, "{value:?}"),
            Self::Boolean(value) => write!(to, "{value}"),
            Self::Array(array) => {
                to.push('[');
                for (index, node) in array.iter().enumerate() {
                    to.push_str(if index == 0 { "" } else { ", " });
                    node.value.write_toml(to);
                }
                to.write_str("]")
            }
            Self::Table(table) => {
                to.push_str("{ ");
                for (index, (key, node)) in table.iter().enumerate() {
                    to.push_str(if index == 0 { "" } else { ", " });
                    to.push_str(key);
                    to.push_str(" = ");
                    node.value.write_toml(to);
                }
                to.write_str(" }")
            }
        };
    }
}

impl From<Table> for Value {
    fn from(table: Table) -> Self {
        Self::Table(Arc::new(table))
    }
}

impl From<Vec<Node>> for Value {
    fn from(nodes: Vec<Node>) -> Self {
        Self::Array(Arc::new(nodes))
    }
}

/// What the TOML parser calls a key given twice.
const DUPLICATE: &str = "duplicate key";

/// A complaint of the TOML parser and the byte it is about.
pub(crate) struct SyntaxError {
    pub(crate) message: String,
    pub(crate) start: usize,
}

impl SyntaxError {
    fn new(error: &toml::de::Error, text: &str) -> Self {
        let span = error.span().unwrap_or_default();
        let mut message = format!("syntax error: {}", error.message());
        // The parser marks the second of the keys without naming it.
        if error.message() == DUPLICATE
            && let Some(key) = text.get(span.clone())
        {
            message.push_str(&format!(" {}", excerpt(key.trim())));
        }
        Self {
            message,
            start: span.start,
        }
    }
}

/// Parses a document.
///
/// # Errors
/// The parser's first complaint, or that the document would take too much memory.
pub(crate) fn parse_document(source: usize, text: &str) -> Result<Table, SyntaxError> {
    parse_within(source, text, &mut weight::MEMORY_BYTES_MAX.clone())
}

/// Parses one of several documents that share an amount of memory, `left`, bytes.
///
/// # Errors
/// As [`parse_document`].
pub(crate) fn parse_within(
    source: usize,
    text: &str,
    left: &mut u64,
) -> Result<Table, SyntaxError> {
    weight::charge(text, left).map_err(|start| SyntaxError {
        message: format!(
            "too many values: up to here the scenario takes {} MB of memory, which is the most \
             that is allowed",
            weight::MEMORY_BYTES_MAX / 1_000_000
        ),
        start,
    })?;
    let parsed = DeTable::parse(text).map_err(|error| SyntaxError::new(&error, text))?;
    Ok(table(source, parsed.into_inner()))
}

/// Parses one value; every part of it points at the source as a whole.
///
/// # Errors
/// The parser's first complaint.
pub(crate) fn parse_value(source: usize, text: &str) -> Result<Node, SyntaxError> {
    let parsed = DeValue::parse(text).map_err(|error| SyntaxError::new(&error, text))?;
    Ok(node(source, None, parsed))
}

/// Converts a table, pointing at its keys.
fn table(source: usize, parsed: DeTable<'_>) -> Table {
    parsed
        .into_iter()
        .map(|(key, value)| {
            let span = key.span();
            (
                key.into_inner().into_owned(),
                node(source, Some(span), value),
            )
        })
        .collect()
}

/// Converts a value, pointing at its key if it has one.
fn node(source: usize, key: Option<Range<usize>>, parsed: Spanned<DeValue<'_>>) -> Node {
    let start = key.map_or(parsed.span().start, |span| span.start);
    let value = match parsed.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .map_or_else(
                |_| Value::Beyond(number.to_string(), NumberType::Whole),
                Value::Integer,
            ),
        DeValue::Float(number) => float(number.as_str()),
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Array(array) => {
            let items = array.into_iter().map(|item| node(source, None, item));
            items.collect::<Vec<Node>>().into()
        }
        DeValue::Table(inner) => table(source, inner).into(),
    };
    Node {
        value,
        mark: Some(Mark { source, start }),
    }
}

/// A number with a fraction; one that rounds to infinity without being written so does not fit.
fn float(text: &str) -> Value {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() || !text.contains(|c: char| c.is_ascii_digit()) => {
            Value::Float(number)
        }
        _ => Value::Beyond(text.to_owned(), NumberType::Float),
    }
}

/// Merges a later table into an earlier one: tables deeply, everything else replaced.
///
/// In a table of alternatives ([`Group`]) an alternative of the later table removes those of the
/// earlier one that the later does not give.
pub(crate) fn merge(schema_path: &str, base: &mut Table, over: Table) {
    if let Some(group) = group_of(schema_path) {
        let is_given = |name: &str| over.contains_key(name);
        if group.alternatives.iter().any(|name| is_given(name)) {
            for name in group.alternatives.iter().filter(|name| !is_given(name)) {
                base.remove(*name);
            }
        }
    }
    for (key, node) in over {
        match base.get_mut(&key) {
            Some(existing) => merge_node(&join(schema_path, &key), existing, node),
            None => {
                base.insert(key, node);
            }
        }
    }
}

/// Merges a later value into an earlier one.
pub(crate) fn merge_node(schema_path: &str, base: &mut Node, over: Node) {
    match (&mut base.value, over.value) {
        (Value::Table(earlier), Value::Table(later)) => {
            let later = Arc::unwrap_or_clone(later);
            merge(schema_path, Arc::make_mut(earlier), later);
            base.mark = over.mark.or(base.mark);
        }
        (earlier, later) => {
            *earlier = later;
            base.mark = over.mark;
        }
    }
}
