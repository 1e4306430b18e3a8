//! What a scenario file may hold: types of the key table and questions asked of it.
//!
//! Paths are dotted; an element of an array of tables is written `[]`, as in `filter[].rls.taps`.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};
use std::sync::OnceLock;

use super::keys::{GROUPS, keys};

/// One key of a scenario file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    /// Schema path.
    pub(crate) path: &'static str,
    /// Type and range.
    pub(crate) kind: Kind,
    /// Unit as printed; empty for a number without unit and for everything that is no number.
    pub(crate) unit: &'static str,
    /// What happens when it is absent.
    pub(crate) presence: Presence,
    /// One line for people.
    pub(crate) doc: &'static str,
}

/// Type and allowed values of a key.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// Binary64; whole numbers are accepted and converted.
    Float(Range),
    /// Whole number.
    Integer(Integers),
    /// `true` or `false`.
    Boolean,
    /// Any text.
    Text,
    /// Any text, also none.
    FreeText,
    /// Name of a scenario or channel.
    Name,
    /// One of a list of words.
    Choice(&'static [&'static str]),
    /// Non-empty array of words of a list.
    Choices(&'static [&'static str]),
    /// Non-empty array of binary64.
    Floats(Range),
    /// Non-empty array of texts, none of them empty.
    Texts,
    /// Array of three binary64, one for each case axis x, y, z.
    Triple(Range),
    /// A table that holds no keys (an alternative with nothing to set).
    EmptyTable,
    /// The table of swept keys.
    Matrix,
}

/// What happens when a key is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Presence {
    /// Its value in `reference.toml` stands.
    Defaulted,
    /// The file is refused.
    Required,
    /// The thing it describes is absent.
    Optional,
}

/// Closed interval of finite binary64 values.
///
/// No end is open: just above an open 0 lie numbers, as 5e-324, whose reciprocals and squares are no
/// numbers any more. Each least value is one of the physics or of the arithmetic behind the key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    /// Least value.
    pub(crate) low: f64,
    /// Greatest value.
    pub(crate) high: f64,
}

impl Range {
    /// Limits and published figures in the unit of any metric, whose squares are finite too.
    pub(crate) const ANY_METRIC: Self = Self::closed(-1e30, 1e30);

    /// `[low, high]`.
    pub(crate) const fn closed(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Whether a value is finite and inside.
    pub(crate) fn contains(&self, value: f64) -> bool {
        value.is_finite() && (self.low..=self.high).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", number(self.low), number(self.high))
    }
}

/// A bound without a trailing `.0`.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// Closed interval of whole numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integers {
    /// Least value.
    pub(crate) min: i64,
    /// Greatest value.
    pub(crate) max: i64,
    /// Whether odd values are refused.
    pub(crate) is_even: bool,
}

impl Integers {
    /// Whether a value is inside (and even, if asked).
    pub(crate) fn contains(&self, value: i64) -> bool {
        (self.min..=self.max).contains(&value) && !(self.is_even && value % 2 != 0)
    }
}

impl fmt::Display for Integers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let even = if self.is_even { "even " } else { "" };
        write!(f, "{even}{}..={}", self.min, self.max)
    }
}

/// Alternatives of a table, of which a file gives at most one and a resolved run has exactly one.
///
/// A later source that gives one replaces whichever an earlier source gave. The one that stands
/// live in `reference.toml` is the default; a group without such needs a choice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// Schema path of the table the alternatives stand in.
    pub(crate) table: &'static str,
    /// What they are alternatives of.
    pub(crate) noun: &'static str,
    /// Names of the alternatives.
    pub(crate) alternatives: &'static [&'static str],
}

impl Group {
    /// The group whose alternatives stand in a table.
    pub(crate) fn of_table(schema_path: &str) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.table == schema_path)
    }
}

/// What a name inside a table stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Child {
    /// A value.
    Leaf(&'static Key),
    /// A table.
    Table,
    /// An array of tables.
    Tables,
}

/// A name inside a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    /// The name.
    pub(crate) name: &'static str,
    /// What it stands for.
    pub(crate) child: Child,
    /// Schema path of it, of an element if it is an array of tables.
    pub(crate) path: &'static str,
}

/// What each table may hold, in the order of the key table, by schema path.
type Tables = BTreeMap<&'static str, Vec<Entry>>;

/// The key table by tables, worked out once.
fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let mut tables = Tables::new();
        for key in keys() {
            let mut start = 0;
            for part in key.path.split('.') {
                let end = start + part.len();
                let table = &key.path[..start.saturating_sub(1)];
                let (name, child) = match part.strip_suffix("[]") {
                    Some(name) => (name, Child::Tables),
                    None if end == key.path.len() => (part, Child::Leaf(key)),
                    None => (part, Child::Table),
                };
                let found = tables.entry(table).or_default();
                if found.iter().all(|known| known.name != name) {
                    let path = &key.path[..end];
                    found.push(Entry { name, child, path });
                }
                start = end + 1;
            }
        }
        tables
    })
}

/// What a table may hold, in the order of the key table.
pub(crate) fn entries(schema_path: &str) -> &'static [Entry] {
    tables().get(schema_path).map_or(&[], Vec::as_slice)
}

/// Names a table may hold, in the order of the key table.
pub(crate) fn children(schema_path: &str) -> impl Iterator<Item = (&'static str, Child)> {
    entries(schema_path)
        .iter()
        .map(|entry| (entry.name, entry.child))
}

/// What a name inside a table stands for; `None` if unknown.
pub(crate) fn child(schema_path: &str, name: &str) -> Option<Child> {
    children(schema_path)
        .find(|(known, _)| *known == name)
        .map(|(_, child)| child)
}

/// `parent.name`, or `name` at the root.
pub(crate) fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() {
        name.to_owned()
    } else {
        format!("{parent}.{name}")
    }
}

impl Key {
    /// Allowed values with the unit, as error messages print them.
    pub(crate) fn allowed(&self) -> String {
        let range = match self.kind {
            Kind::Float(range) | Kind::Floats(range) | Kind::Triple(range) => range.to_string(),
            Kind::Integer(range) => range.to_string(),
            Kind::Boolean => "true or false".to_owned(),
            Kind::Text | Kind::FreeText | Kind::Texts => "text".to_owned(),
            Kind::Name => "[a-z0-9][a-z0-9_-]{0,63}".to_owned(),
            Kind::Choice(words) | Kind::Choices(words) => quoted(words),
            Kind::EmptyTable => "a table without keys".to_owned(),
            Kind::Matrix => "a table of arrays".to_owned(),
        };
        self.with_unit(&range)
    }

    /// Type, allowed values and unit, as type errors print them.
    pub(crate) fn expected(&self) -> String {
        match self.kind {
            Kind::Float(_) => format!("a number, {}", self.allowed()),
            Kind::Integer(_) => format!("a whole number, {}", self.allowed()),
            Kind::Choice(_) => format!("one of {}", self.allowed()),
            Kind::Choices(_) => format!("an array of words, each one of {}", self.allowed()),
            Kind::Floats(_) => format!("an array of numbers, each {}", self.allowed()),
            Kind::Texts => "an array of texts, none of them empty".to_owned(),
            Kind::Triple(_) => {
                format!(
                    "an array of three numbers (x, y, z), each {}",
                    self.allowed()
                )
            }
            Kind::Name => format!("a name {}", self.allowed()),
            _ => self.allowed(),
        }
    }

    /// A value's text followed by the unit, if there is one.
    pub(crate) fn with_unit(&self, text: &str) -> String {
        if self.unit.is_empty() {
            text.to_owned()
        } else {
            format!("{text} {}", self.unit)
        }
    }

    /// Type, unit, range and presence: the fixed line above the key in `reference.toml`.
    pub(crate) fn line(&self) -> String {
        let mut line = match self.kind {
            Kind::Float(range) => format!("Number {range}"),
            Kind::Floats(range) => format!("Array of numbers {range}"),
            Kind::Triple(range) => format!("Array of three numbers (x, y, z) {range}"),
            Kind::Integer(range) => format!("Integer {range}"),
            Kind::Boolean => "Boolean true or false".to_owned(),
            Kind::Text | Kind::FreeText => "Text".to_owned(),
            Kind::Texts => "Array of texts".to_owned(),
            Kind::Name => format!("Name {}", self.allowed()),
            Kind::Choice(words) => format!("Choice {}", quoted(words)),
            Kind::Choices(words) => format!("Array of choices {}", quoted(words)),
            Kind::EmptyTable => "Table without keys".to_owned(),
            Kind::Matrix => "Table of arrays, quoted key = values".to_owned(),
        };
        if !self.unit.is_empty() {
            let _ = write!(line, "; unit {}", self.unit);
        }
        line.push_str(match self.presence {
            Presence::Defaulted => "; default.",
            Presence::Required => "; required.",
            Presence::Optional => "; optional.",
        });
        line
    }
}

/// Words in quotes, separated by commas.
fn quoted(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    quoted.join(", ")
}
