//! What can be wrong with a log.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a log was not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The file system refused.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// What the file holds, or what was said of it, is wrong.
    #[error("{place}: {message}")]
    Content {
        /// The file, with line or index where there is one.
        place: String,
        /// What is wrong: column, value, unit, what is allowed.
        message: String,
        /// Key of `[log]`, or option, that asks for what cannot be.
        key: Option<&'static str>,
    },
}

impl LogError {
    /// A complaint about a file as a whole.
    pub fn of_file(path: &Path, message: impl fmt::Display) -> Self {
        Self::Content {
            place: path.display().to_string(),
            message: message.to_string(),
            key: None,
        }
    }

    /// Key of `[log]`, or option, that asks for what cannot be, if it is one alone.
    #[must_use]
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Content { key, .. } => *key,
            Self::Read { .. } => None,
        }
    }

    /// The complaint about the unit of a reference, which has an option of its own.
    pub(crate) fn of_reference(mut self) -> Self {
        if let Self::Content { message, key, .. } = &mut self {
            *message = message
                .replace("the numbers", "the reference")
                .replace("--unit", "--reference-unit");
            *key = key.map(|key| match key {
                "unit" => "reference_unit",
                key => key,
            });
        }
        self
    }

    /// The complaint, with the key that asks for what cannot be.
    pub(crate) fn about(mut self, asking: Option<&'static str>) -> Self {
        if let Self::Content { key, .. } = &mut self {
            *key = asking;
        }
        self
    }

    /// A complaint about a line, counted from 1, or about an element of an array.
    pub(crate) fn at(path: &Path, place: Place, message: impl fmt::Display) -> Self {
        let path = path.display();
        Self::Content {
            place: match place {
                Place::Line(line) => format!("{path}:{line}"),
                Place::Index(index) => format!("{path}: index {index}"),
            },
            message: message.to_string(),
            key: None,
        }
    }

    pub(crate) fn read(path: &Path, source: io::Error) -> Self {
        Self::Read {
            path: path.to_owned(),
            source,
        }
    }
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Line of a text, from 1.
    Line(usize),
    /// Element of an array, from 0.
    Index(usize),
}
