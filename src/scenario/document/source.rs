//! The texts a scenario is made of, and places in them.

use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, OnceLock};

use crate::scenario::message::error::{Location, ScenarioError, Snippet};
use crate::scenario::message::excerpt::excerpt;

/// Bytes from one [`Waypoint`] to the next.
const STRIDE: usize = 1024;

/// One parsed text.
#[derive(Debug)]
struct Source {
    shown: String,
    text: String,
    /// The path as seen from the scenario's own folder; `None` for a `--set` argument.
    label: Option<Label>,
    /// Whether the program made the text: no place in it is one of the file.
    is_made_up: bool,
    /// Places of every [`STRIDE`]th byte, worked out when a place is asked for: many complaints
    /// about a long text do not count its lines again and again.
    waypoints: OnceLock<Vec<Waypoint>>,
}

/// Line and column of a byte, both from 1.
#[derive(Clone, Copy, Debug)]
struct Waypoint {
    line: usize,
    column: usize,
}

impl Waypoint {
    /// The place behind the bytes that begin here.
    fn after(mut self, bytes: &[u8]) -> Self {
        const CONTINUATION: u8 = 0b1000_0000;
        for byte in bytes {
            if *byte == b'\n' {
                self.line += 1;
                self.column = 1;
            } else if byte & 0b1100_0000 != CONTINUATION {
                self.column += 1;
            }
        }
        self
    }
}

impl Source {
    fn new(shown: String, text: String, label: Option<Label>) -> Self {
        Self {
            shown,
            text,
            label,
            is_made_up: false,
            waypoints: OnceLock::new(),
        }
    }

    /// Line and column of a byte; of the last one for a byte behind the end.
    fn place(&self, start: usize) -> Waypoint {
        let waypoints = self.waypoints.get_or_init(|| {
            let mut place = Waypoint { line: 1, column: 1 };
            let mut waypoints = vec![place];
            for bytes in self.text.as_bytes().chunks_exact(STRIDE) {
                place = place.after(bytes);
                waypoints.push(place);
            }
            waypoints
        });
        let mut end = start.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let index = end / STRIDE;
        waypoints[index].after(&self.text.as_bytes()[index * STRIDE..end])
    }
}

/// Every text of one scenario: its files and the `--set` arguments.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sources(Vec<Arc<Source>>);

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
        self.add(Source::new(shown, text, Some(label)))
    }

    /// Adds a text that the program puts around what a file holds; complaints about it are about the
    /// file as a whole. Returns its index.
    pub(crate) fn add_frame(&mut self, shown: String, text: String, label: Label) -> usize {
        self.add(Source {
            is_made_up: true,
            ..Source::new(shown, text, Some(label))
        })
    }

    /// Adds a `--set` argument; returns its index.
    pub(crate) fn add_set(&mut self, argument: &str) -> usize {
        let shown = format!("--set {}", excerpt(argument));
        self.add(Source::new(shown, String::new(), None))
    }

    fn add(&mut self, source: Source) -> usize {
        self.0.push(Arc::new(source));
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

    /// The whole text that a mark lies in.
    pub(crate) fn text_of(&self, mark: Mark) -> &str {
        &self.0[mark.source].text
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
        if source.is_made_up {
            return Location::of_file(source.shown.clone());
        }
        let Waypoint { line, column } = source.place(mark.start);
        let snippet = Snippet::around(&source.text, mark.start);
        Location::in_file(source.shown.clone(), line, column, snippet)
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
