//! The texts a scenario is made of, and places in them.

use std::path::{Component, Path, PathBuf};

use super::error::{Location, ScenarioError};

/// One parsed text.
#[derive(Clone, Debug)]
struct Source {
    shown: String,
    text: String,
    is_file: bool,
}

/// Every text of one scenario: its files and the `--set` arguments.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sources(Vec<Source>);

/// A byte in a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Mark {
    /// Index of the source.
    pub(crate) source: usize,
    /// Byte offset.
    pub(crate) start: usize,
}

impl Sources {
    /// Adds the text of a file; returns its index.
    pub(crate) fn add_file(&mut self, shown: String, text: String) -> usize {
        self.0.push(Source {
            shown,
            text,
            is_file: true,
        });
        self.0.len() - 1
    }

    /// Adds a `--set` argument; returns its index.
    pub(crate) fn add_set(&mut self, argument: &str) -> usize {
        self.0.push(Source {
            shown: format!("--set {argument}"),
            text: String::new(),
            is_file: false,
        });
        self.0.len() - 1
    }

    /// Where a mark points.
    pub(crate) fn locate(&self, mark: Mark) -> Location {
        let source = &self.0[mark.source];
        if !source.is_file {
            return Location::of_file(source.shown.clone());
        }
        let mut end = mark.start.min(source.text.len());
        while !source.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &source.text[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Location {
            file: source.shown.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// A complaint about a marked place.
    pub(crate) fn error(&self, mark: Mark, message: impl Into<String>) -> ScenarioError {
        ScenarioError::at(self.locate(mark), message)
    }
}

/// A path without `.` and `..`, absolute, without asking the file system about links.
fn absolute(path: &Path) -> PathBuf {
    let start = std::env::current_dir().unwrap_or_default();
    let mut clean = PathBuf::new();
    for component in start.join(path).components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                clean.pop();
            }
            other => clean.push(other),
        }
    }
    clean
}

/// The path below the working directory with forward slashes; `None` outside it.
fn below_working_directory(path: &Path) -> Option<String> {
    let start = absolute(Path::new(""));
    let clean = absolute(path);
    let inside = clean.strip_prefix(start).ok()?;
    Some(inside.to_string_lossy().replace('\\', "/"))
}

/// The path as error messages show it: below the working directory, else in full.
pub(crate) fn shown_path(path: &Path) -> String {
    below_working_directory(path).unwrap_or_else(|| absolute(path).to_string_lossy().into_owned())
}

/// The path as results carry it, never absolute: below the working directory, else the file name.
pub(crate) fn label_path(path: &Path) -> String {
    below_working_directory(path).unwrap_or_else(|| {
        path.file_name().map_or_else(
            || "scenario.toml".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        )
    })
}
