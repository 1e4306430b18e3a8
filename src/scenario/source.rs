//! The texts a scenario is made of, and places in them.

use std::path::{Component, Path, PathBuf};

use super::error::{Location, ScenarioError};

/// One parsed text.
#[derive(Clone, Debug)]
struct Source {
    shown: String,
    text: String,
    /// The path as seen from the scenario's own folder; `None` for a `--set` argument.
    label: Option<Label>,
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
    pub(crate) fn add_file(&mut self, shown: String, text: String, label: Label) -> usize {
        self.0.push(Source {
            shown,
            text,
            label: Some(label),
        });
        self.0.len() - 1
    }

    /// Adds a `--set` argument; returns its index.
    pub(crate) fn add_set(&mut self, argument: &str) -> usize {
        self.0.push(Source {
            shown: format!("--set {argument}"),
            text: String::new(),
            label: None,
        });
        self.0.len() - 1
    }

    /// Path and label of a file that is named at a mark, relative to the file that names it; what a
    /// `--set` argument names is relative to the working directory.
    pub(crate) fn beside(&self, mark: Mark, file: &str) -> (PathBuf, Label) {
        let source = &self.0[mark.source];
        match &source.label {
            Some(label) => {
                let folder = Path::new(&source.shown).parent().unwrap_or(Path::new(""));
                (folder.join(file), label.of_base(file))
            }
            None => (PathBuf::from(file), Label::of_scenario(Path::new(file))),
        }
    }

    /// Whether a mark lies in a `--set` argument.
    pub(crate) fn is_set_argument(&self, mark: Mark) -> bool {
        self.0[mark.source].label.is_none()
    }

    /// Where a mark points.
    pub(crate) fn locate(&self, mark: Mark) -> Location {
        let source = &self.0[mark.source];
        if source.label.is_none() {
            return Location::of_set(&source.shown);
        }
        let mut end = mark.start.min(source.text.len());
        while !source.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &source.text[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let line = before.matches('\n').count() + 1;
        let text = source.text[line_start..].lines().next().unwrap_or_default();
        let start = (end - line_start).min(text.len());
        Location::in_line(source.shown.clone(), line, text, start)
    }

    /// A complaint about a marked place.
    pub(crate) fn error(&self, mark: Mark, message: impl Into<String>) -> ScenarioError {
        ScenarioError::at(self.locate(mark), message)
    }
}

/// A path without `.` and `..`, absolute, without asking the file system about links.
fn absolute(path: &Path) -> PathBuf {
    clean(&std::env::current_dir().unwrap_or_default().join(path))
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
    match below_working_directory(path) {
        Some(inside) if inside.is_empty() => ".".to_owned(),
        Some(inside) => inside,
        None => absolute(path).to_string_lossy().into_owned(),
    }
}

/// A path without `.` and without `..` behind a name, without asking the file system about links.
fn clean(path: &Path) -> PathBuf {
    let mut clean = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if clean.file_name().is_some() => {
                clean.pop();
            }
            other => clean.push(other),
        }
    }
    clean
}

/// The path of an input as seen from the scenario's own folder.
///
/// It is made from the keys that name files alone, never from the working directory or the way in which
/// a path was typed, so that the same files always carry the same labels.
#[derive(Clone, Debug)]
pub(crate) struct Label(PathBuf);

impl Label {
    /// The label of the scenario's own file: its name.
    pub(crate) fn of_scenario(path: &Path) -> Self {
        Self(path.file_name().map(PathBuf::from).unwrap_or_default())
    }

    /// The label of the file that a labelled one names.
    pub(crate) fn of_base(&self, named: &str) -> Self {
        let folder = self.0.parent().unwrap_or(Path::new(""));
        Self(clean(&folder.join(named)))
    }

    /// The label as results carry it: forward slashes; the file name alone of an absolute path.
    pub(crate) fn text(&self) -> String {
        if self.0.has_root() {
            let name = self.0.file_name().unwrap_or_default();
            return name.to_string_lossy().into_owned();
        }
        let parts = self.0.components();
        let parts: Vec<_> = parts
            .map(|part| part.as_os_str().to_string_lossy())
            .collect();
        parts.join("/")
    }
}
