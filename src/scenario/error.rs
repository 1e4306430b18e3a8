//! What is wrong with a scenario, and where.

use std::fmt;

use super::excerpt::bounded;

/// A place in an input: prints as `file:line:column`, or as the `--set` argument itself.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    /// Path of the file, or `--set key=value`.
    pub file: String,
    /// Line, from 1; 0 for a `--set` argument or a file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 for a `--set` argument or a file as a whole.
    pub column: usize,
}

impl Location {
    /// A file as a whole.
    pub(crate) fn of_file(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            line: 0,
            column: 0,
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            f.write_str(&self.file)
        } else {
            write!(f, "{}:{}:{}", self.file, self.line, self.column)
        }
    }
}

/// A place as results carry it: the file name without its folder, which differs from machine to
/// machine and with the way a path is typed; a `--set` argument as it is.
pub(crate) fn portable_place(place: &str) -> &str {
    if place.starts_with("--set ") {
        return place;
    }
    place.rsplit(['/', '\\']).next().unwrap_or(place)
}

/// One complaint about a scenario.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
#[error("{location}: {message}")]
pub struct ScenarioError {
    /// Where it is wrong.
    pub location: Location,
    /// What is wrong: key, value, unit, allowed range and the way out.
    pub message: String,
}

impl ScenarioError {
    /// A complaint about a place.
    #[must_use]
    pub fn at(location: Location, message: impl Into<String>) -> Self {
        Self {
            location,
            message: bounded(&message.into()).into_owned(),
        }
    }
}
