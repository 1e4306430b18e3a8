//! What is wrong with a table, or doubtful.

use std::fmt;
use std::path::Path;

use super::words::{DecimalSign, Separator};
use crate::recording::error::{LogError, Place};
use crate::recording::text::lines::{FirstLineError, shown};
use crate::wording::{counted, option_of};

/// A complaint about a line.
#[derive(Debug)]
pub(in crate::recording) struct Fault {
    /// The line, from 1; none if the file as a whole is meant.
    pub(in crate::recording) line: Option<usize>,
    pub(in crate::recording) error: LayoutError,
}

impl Fault {
    /// The complaint about a file.
    pub(in crate::recording) fn of(self, path: &Path) -> LogError {
        let key = self.error.key();
        let complaint = match self.line {
            Some(line) => LogError::at(path, Place::Line(line), self.error),
            None => LogError::of_file(path, self.error),
        };
        complaint.about(key)
    }
}

impl From<LayoutError> for Fault {
    fn from(error: LayoutError) -> Self {
        Self { line: None, error }
    }
}

/// A column that is asked for.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Asked<'a> {
    /// Its heading, a part of it, or its number from 1.
    pub(in crate::recording) name: &'a str,
    /// Key of `[log]`, or option of a command, that names it; none where it has to be so named.
    pub(in crate::recording) key: Option<&'static str>,
}

/// A column that was asked for in vain.
#[derive(Debug)]
pub(in crate::recording) struct AskedName {
    name: String,
    key: Option<&'static str>,
}

impl<'a> Asked<'a> {
    /// One that a key of `[log]`, or an option, names.
    pub(in crate::recording) fn by(name: &'a str, key: &'static str) -> Self {
        let key = Some(key);
        Self { name, key }
    }
}

impl From<Asked<'_>> for AskedName {
    fn from(asked: Asked<'_>) -> Self {
        Self {
            name: shown(asked.name),
            key: asked.key,
        }
    }
}

impl fmt::Display for AskedName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.name)?;
        match self.key {
            Some(key) => write!(f, ", which {} names", option_of(key)),
            None => Ok(()),
        }
    }
}

/// What is said of how rows are cut into numbers.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Cut {
    pub(in crate::recording) separator: Option<Separator>,
    pub(in crate::recording) decimal: Option<DecimalSign>,
}

impl Cut {
    /// Key of the first that is said.
    fn key(self) -> &'static str {
        match self.separator {
            Some(_) => "separator",
            None => "decimal",
        }
    }
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let separator = self.separator.map(|it| format!("--separator {it}"));
        let decimal = self.decimal.map(|it| format!("--decimal {it}"));
        let both: Vec<String> = separator.into_iter().chain(decimal).collect();
        f.write_str(&both.join(" "))
    }
}

/// Keys of two quantities.
pub(in crate::recording) type Keys = [Option<&'static str>; 2];

/// The keys that name one column, as a message says them.
fn by_keys(keys: Keys) -> String {
    match keys {
        [Some(a), Some(b)] if a == b => format!(", twice by {}", option_of(a)),
        [Some(a), Some(b)] => format!(", by {} and by {}", option_of(a), option_of(b)),
        _ => String::new(),
    }
}

/// What is wrong with the first lines of a text, with what is asked of it, or with the cells of a row.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum LayoutError {
    #[error(transparent)]
    FirstLine(#[from] FirstLineError),
    #[error("{0}; --skip-lines {1} passes over it and what stands above")]
    AbovePassable(FirstLineError, usize),
    #[error("{count} columns have the name {wanted}: name one by its number, from 1")]
    Ambiguous { wanted: AskedName, count: usize },
    /// With their names.
    #[error(
        "{count} columns, {listed}, have a part {wanted}: name one of them, or `*` where letters may stand \
         for all"
    )]
    AmbiguousPart {
        wanted: AskedName,
        count: usize,
        listed: String,
    },
    /// With what there is.
    #[error("there is no column {wanted}: {listed}")]
    NoColumn { wanted: AskedName, listed: String },
    #[error("there is no column beside {0}: --column names the one that is measured")]
    NoOther(String),
    /// With what there is.
    #[error("name one column with --column: {0}")]
    SeveralColumns(String),
    #[error("column {name} is named for two quantities{}: expected another for each", by_keys(*.keys))]
    NamedTwice { name: String, keys: Keys },
    /// With the beginning of a row, and what would cut it.
    #[error(
        "`{row}` cannot be read with {given}, but with {found}, as {}: say that, or leave it out",
        counted(*.cells, "cell")
    )]
    Given {
        row: String,
        given: Cut,
        found: Cut,
        cells: usize,
    },
    /// With their names.
    #[error("{0} may all be the time: name one with --time, or `--time none`")]
    SeveralTimes(String),
    #[error("--time-unit names {units} units of {columns} columns of --time: expected one of each")]
    TimeUnits { units: usize, columns: usize },
    #[error("{} where the {reference} has {expected}{way_out}", counted(*.got, "cell"))]
    Width {
        got: usize,
        reference: &'static str,
        expected: usize,
        way_out: String,
    },
    #[error(
        "column {column} has a number where the first row has `{word}`: expected a heading without \
         numbers, or a first row like this one; --heading-line {line} takes it for the heading, \
         --skip-lines {line} passes over it"
    )]
    WordInFirstRow {
        column: usize,
        word: String,
        line: usize,
    },
    #[error(
        "`{0}` has a decimal comma, or one between thousands: say --decimal comma, or write it without"
    )]
    Thousands(String),
    #[error("the file ends before line {line}, which {} names", option_of(.key))]
    NoLine { line: usize, key: &'static str },
    #[error("{got} in line {line}, which an option names, where the rows have {expected} cells")]
    Heading {
        line: usize,
        got: String,
        expected: usize,
    },
    #[error("no row stands below line {line}, which {} names", option_of(.key))]
    NoRowBelow { line: usize, key: &'static str },
    #[error(
        "the file ends within a record: {got} of {expected} values, which --wrapped-columns names"
    )]
    WrappedEnd { got: usize, expected: usize },
}

impl LayoutError {
    /// Key of `[log]`, or option, that asks for what cannot be, if it is one alone.
    pub(in crate::recording) fn key(&self) -> Option<&'static str> {
        match self {
            Self::Ambiguous { wanted, .. }
            | Self::AmbiguousPart { wanted, .. }
            | Self::NoColumn { wanted, .. } => wanted.key,
            Self::NamedTwice { keys: [key, _], .. } => *key,
            Self::TimeUnits { .. } => Some("time_unit"),
            Self::Given { given, .. } => Some(given.key()),
            Self::NoLine { key, .. } | Self::NoRowBelow { key, .. } => Some(key),
            Self::WrappedEnd { .. } => Some("wrapped_columns"),
            _ => None,
        }
    }
}
