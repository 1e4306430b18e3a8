//! The keys of a file: the rows of nested tables under their full paths.

use std::fmt::Write as _;

use super::kind::{Content, DIGEST_DIGITS, Kind};
use super::row::{Group, Presence, Row, Successor, Table, Told};

/// One key of a file.
///
/// Paths are dotted; an element of an array of tables is written `[]`, as in `filter[].rls.taps`.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Schema path.
    pub path: &'static str,
    /// Type and range.
    pub kind: Kind,
    /// Unit as printed; empty for a number without unit and for everything that is no number.
    pub unit: &'static str,
    /// What happens when it is absent.
    pub presence: Presence,
    /// Default, or an example where there is none, as TOML writes it.
    pub literal: &'static str,
    /// What it means and where its default comes from, line by line.
    pub doc: &'static [&'static str],
    /// What names it where nobody sets it.
    pub told: &'static [Told],
    /// The key that has taken its place, if its name is a former one.
    pub successor: Option<Successor>,
}

/// Every key of a file, the groups of alternatives and the tables that may be absent.
#[derive(Clone, Debug, Default)]
pub struct Keys {
    /// Keys, in the order in which resolved files are written.
    pub keys: Vec<Key>,
    /// Tables of alternatives.
    pub groups: Vec<Group>,
    /// Schema paths of tables that are absent unless a file gives them, whatever is inside.
    pub optional_tables: Vec<&'static str>,
}

impl Keys {
    /// The keys of the whole file that a table declares.
    ///
    /// Their paths live as long as the program, as the declarations do: call it once.
    #[must_use]
    pub fn of(file: &'static Table) -> Self {
        let mut found = Self::default();
        found.gather("", file, &[]);
        found
    }

    fn gather(&mut self, at: &'static str, table: &'static Table, told: &'static [Told]) {
        let group = table.group;
        self.groups
            .extend(group.map(|group| Group { table: at, ..group }));
        for row in table.rows {
            let told = if row.told.is_empty() { told } else { row.told };
            let path = || -> &'static str { join(at, row.name).leak() };
            match row.content {
                Content::Table(inner) if row.name.is_empty() => self.gather(at, inner, told),
                Content::Table(inner) if !inner.rows.is_empty() => {
                    let path = path();
                    if row.presence == Presence::Optional {
                        self.optional_tables.push(path);
                    }
                    self.gather(path, inner, told);
                }
                Content::Table(_) => self.keys.push(Key::of_empty_table(row, path()).told(told)),
                Content::Tables(inner) => self.gather(format!("{}[]", path()).leak(), inner, told),
                Content::Value(kind) => self.keys.push(Key::of(row, path(), kind).told(told)),
            }
        }
    }
}

/// `parent.name`, or `name` at the root.
fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() {
        name.to_owned()
    } else {
        format!("{parent}.{name}")
    }
}

impl Key {
    /// The key of a row that is a value.
    pub(crate) fn of(row: &'static Row, path: &'static str, kind: Kind) -> Self {
        Self {
            path,
            kind,
            unit: row.unit,
            presence: row.presence,
            literal: row.literal,
            doc: row.about(),
            told: row.told,
            successor: row.successor,
        }
    }

    fn told(self, told: &'static [Told]) -> Self {
        Self { told, ..self }
    }

    /// The key of a table that holds none: to give it is to choose it.
    pub(crate) fn of_empty_table(row: &'static Row, path: &'static str) -> Self {
        Self {
            presence: Presence::Defaulted,
            ..Self::of(row, path, Kind::EmptyTable)
        }
    }

    /// Its documentation in one line.
    #[must_use]
    pub fn sentence(&self) -> String {
        let lines: Vec<&str> = self.doc.iter().map(|line| line.trim()).collect();
        lines.join(" ")
    }

    /// The first sentence of it, without its full stop.
    #[must_use]
    pub fn summary(&self) -> String {
        let sentence = self.sentence();
        let first = sentence
            .split_once(". ")
            .map_or(sentence.as_str(), |(first, _)| first);
        first.trim_end_matches('.').to_owned()
    }

    /// Allowed values with the unit, as error messages print them.
    #[must_use]
    pub fn allowed(&self) -> String {
        let range = match self.kind {
            Kind::Float(range) | Kind::Floats(range) | Kind::Triple(range) => range.to_string(),
            Kind::Integer(range) => range.to_string(),
            Kind::Boolean => "true or false".to_owned(),
            Kind::Text | Kind::Spelled(_) | Kind::FreeText | Kind::Texts => "text".to_owned(),
            Kind::File => "the path of a file".to_owned(),
            Kind::Files => "paths of files".to_owned(),
            Kind::Command => "a program and its arguments".to_owned(),
            Kind::Parameters => "numbers, texts, booleans and arrays of them".to_owned(),
            Kind::Digest => format!("{DIGEST_DIGITS} digits of 0-9 and a-f"),
            Kind::Name => "[a-z0-9][a-z0-9_-]{0,63}".to_owned(),
            Kind::Choice(words) | Kind::Choices(words) => quoted(words),
            Kind::EmptyTable => "a table without keys".to_owned(),
            Kind::Matrix => "a table of arrays and ranges".to_owned(),
        };
        self.with_unit(&range)
    }

    /// Type, allowed values and unit, as type errors print them.
    #[must_use]
    pub fn expected(&self) -> String {
        let allowed = self.allowed();
        match self.kind {
            Kind::Float(_) => format!("a number, {allowed}"),
            Kind::Integer(_) => format!("a whole number, {allowed}"),
            Kind::Choice(_) => format!("one of {allowed}"),
            Kind::Choices(_) => format!("an array of words, each one of {allowed}"),
            Kind::Floats(_) => format!("an array of numbers, each {allowed}"),
            Kind::Texts | Kind::Files | Kind::Command => {
                "an array of texts, none of them empty".to_owned()
            }
            Kind::Parameters => format!("a table of {allowed}"),
            Kind::Triple(_) => format!("an array of three numbers (x, y, z), each {allowed}"),
            Kind::Name => format!("a name {allowed}"),
            Kind::Digest => format!("a BLAKE3 digest, {allowed}"),
            _ => allowed,
        }
    }

    /// A value's text followed by the unit, if there is one.
    #[must_use]
    pub fn with_unit(&self, text: &str) -> String {
        if self.unit.is_empty() {
            text.to_owned()
        } else {
            format!("{text} {}", self.unit)
        }
    }

    /// Type, unit, range and presence: the fixed line above the key in the reference.
    #[must_use]
    pub fn line(&self) -> String {
        let mut line = match self.kind {
            Kind::Float(range) => format!("Number {range}"),
            Kind::Floats(range) => format!("Array of numbers {range}"),
            Kind::Triple(range) => format!("Array of three numbers (x, y, z) {range}"),
            Kind::Integer(range) => format!("Integer {range}"),
            Kind::Boolean => "Boolean true or false".to_owned(),
            Kind::Text | Kind::Spelled(_) | Kind::FreeText => "Text".to_owned(),
            Kind::File => "Path of a file".to_owned(),
            Kind::Files => "Array of paths of files".to_owned(),
            Kind::Command => "Array of texts, a program and its arguments".to_owned(),
            Kind::Parameters => format!("Table of {}", self.allowed()),
            Kind::Digest => format!("Digest {}", self.allowed()),
            Kind::Texts => "Array of texts".to_owned(),
            Kind::Name => format!("Name {}", self.allowed()),
            Kind::Choice(words) => format!("Choice {}", quoted(words)),
            Kind::Choices(words) => format!("Array of choices {}", quoted(words)),
            Kind::EmptyTable => "Table without keys".to_owned(),
            Kind::Matrix => "Table of arrays and ranges, quoted key = values".to_owned(),
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
