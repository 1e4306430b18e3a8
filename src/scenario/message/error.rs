//! What is wrong with a scenario, and where.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::scenario::message::excerpt::bounded;

/// A place in an input: prints as `file:line:column`, or as the `--set` argument itself.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    /// Path of the file, or `--set key=value`.
    pub file: String,
    /// Line, from 1; 0 for a `--set` argument or a file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 for a `--set` argument or a file as a whole.
    pub column: usize,
    /// The text there; none for a file as a whole.
    snippet: Option<Box<Snippet>>,
}

/// The line of a place, or a `--set` argument, cut to what surrounds the place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Snippet {
    /// The text.
    pub(crate) text: String,
    /// Byte at which the place begins.
    pub(crate) start: usize,
}

/// Characters of a long line that are shown before and behind a place.
const BEFORE_MAX: usize = 40;
const BEHIND_MAX: usize = 80;
/// What stands for the rest of a long line.
const CUT: &str = "...";

impl Snippet {
    /// What surrounds a byte of a text in its line. However long the line is, no more of it is read
    /// than is shown: a line may hold thousands of faults.
    pub(crate) fn around(text: &str, start: usize) -> Self {
        let mut start = start.min(text.len());
        while !text.is_char_boundary(start) {
            start -= 1;
        }
        let (before, behind) = text.split_at(start);
        let is_inside = |c: &char| *c != '\n';
        let before = before.chars().rev().take_while(is_inside);
        let mut head: Vec<char> = before.take(BEFORE_MAX + 1).collect();
        let is_cut = head.len() > BEFORE_MAX;
        head.truncate(BEFORE_MAX);
        let mut text: String = if is_cut {
            CUT.to_owned()
        } else {
            String::new()
        };
        text.extend(head.iter().rev());
        let start = text.len();
        let behind = behind.chars().take_while(is_inside);
        for (index, c) in behind.enumerate() {
            if index == BEHIND_MAX {
                text.push_str(CUT);
                break;
            }
            text.push(c);
        }
        if text.ends_with('\r') {
            text.pop();
        }
        let start = start.min(text.len());
        Self { text, start }
    }

    /// The bytes that a complaint is about: a key, or a key with its value, or a value alone.
    pub(crate) fn span(&self, is_of_key: bool) -> std::ops::Range<usize> {
        let rest = &self.text[self.start..];
        let end = if is_of_key {
            key_end(rest)
        } else {
            value_end(rest)
        };
        self.start..self.start + end.max(usize::from(!rest.is_empty()))
    }
}

/// End of the key that a text begins with.
fn key_end(text: &str) -> usize {
    if let Some(quote) = text.chars().next().filter(|c| matches!(c, '"' | '\'')) {
        return text[1..].find(quote).map_or(text.len(), |at| at + 2);
    }
    let is_end = |c: char| c.is_whitespace() || matches!(c, '=' | ']' | '}' | ',' | '#');
    text.find(is_end).unwrap_or(text.len())
}

/// End of the value that a text begins with, or of the pair of key and value: a comma, a bracket of
/// the table or array around it, or a comment.
fn value_end(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut quote = None;
    let mut end = text.len();
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') if depth > 0 => depth -= 1,
            (None, ']' | '}' | '#') => {
                end = at;
                break;
            }
            (None, ',') if depth == 0 => {
                end = at;
                break;
            }
            _ => {}
        }
    }
    text[..end].trim_end().len()
}

impl Location {
    /// A file as a whole.
    pub(crate) fn of_file(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            line: 0,
            column: 0,
            snippet: None,
        }
    }

    /// A `--set` argument.
    pub(crate) fn of_set(shown: &str) -> Self {
        const OPTION: &str = "--set ";
        let start = if shown.starts_with(OPTION) {
            OPTION.len()
        } else {
            0
        };
        Self {
            snippet: Some(Box::new(Snippet::around(shown, start))),
            ..Self::of_file(shown)
        }
    }

    /// A place in a file.
    pub(crate) fn in_file(file: String, line: usize, column: usize, snippet: Snippet) -> Self {
        Self {
            file,
            line,
            column,
            snippet: Some(Box::new(snippet)),
        }
    }

    /// The same place, of which there is nothing to be seen: something is missing there.
    pub(crate) fn unseen(self) -> Self {
        Self {
            snippet: None,
            ..self
        }
    }

    /// The text there.
    pub(crate) fn snippet(&self) -> Option<&Snippet> {
        self.snippet.as_deref()
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
    /// Whether it is about the name of a key and not about its value.
    is_of_key: bool,
}

impl ScenarioError {
    /// A complaint about a place.
    #[must_use]
    pub fn at(location: Location, message: impl Into<String>) -> Self {
        Self {
            location,
            message: bounded(&message.into()).into_owned(),
            is_of_key: false,
        }
    }

    /// The same complaint, about the name of the key at its place.
    pub(crate) fn at_key(self) -> Self {
        Self {
            is_of_key: true,
            ..self
        }
    }

    /// The text that it is about: a line, its number, and the bytes to point at.
    #[must_use]
    pub fn source(&self) -> Option<(&str, usize, std::ops::Range<usize>)> {
        let snippet = self.location.snippet()?;
        let line = self.location.line.max(1);
        Some((&snippet.text, line, snippet.span(self.is_of_key)))
    }
}

/// Complaints in the order of their files and lines, each once.
pub(crate) fn in_order(mut errors: Vec<ScenarioError>) -> Vec<ScenarioError> {
    let mut files: BTreeMap<String, usize> = BTreeMap::new();
    for error in &errors {
        let file = &error.location.file;
        if !files.contains_key(file) {
            files.insert(file.clone(), files.len());
        }
    }
    errors.sort_by_cached_key(|error| {
        let Location {
            file, line, column, ..
        } = &error.location;
        (files.get(file).copied(), *line, *column)
    });
    // Equal complaints are about the same place.
    let places = errors.chunk_by(|one, other| {
        let place = |error: &ScenarioError| (error.location.line, error.location.column);
        place(one) == place(other) && one.location.file == other.location.file
    });
    let mut is_first: Vec<bool> = Vec::with_capacity(errors.len());
    for place in places {
        let mut said: BTreeSet<&str> = BTreeSet::new();
        is_first.extend(place.iter().map(|error| said.insert(&error.message)));
    }
    let mut is_first = is_first.into_iter();
    errors.retain(|_| is_first.next().unwrap_or(true));
    errors
}

/// The complaints of one list that stand in another as well.
pub(crate) fn in_both(one: Vec<ScenarioError>, other: &[ScenarioError]) -> Vec<ScenarioError> {
    let other: BTreeSet<&ScenarioError> = other.iter().collect();
    one.into_iter()
        .filter(|error| other.contains(error))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pointed_at(line: &str, start: usize, is_of_key: bool) -> String {
        let snippet = Snippet::around(&format!("a = 0\n{line}\r\nb = 0"), start + 6);
        snippet.text[snippet.span(is_of_key)].to_owned()
    }

    #[test]
    fn the_span_is_the_key_or_the_key_with_its_value() {
        for (line, start, key, pair) in [
            ("lenght_m = 800.0", 0, "lenght_m", "lenght_m = 800.0"),
            ("  a = \"#,\" # note", 2, "a", "a = \"#,\""),
            ("[turntables]", 1, "turntables", "turntables"),
            ("x = { a = 1, b = [2, 3] }", 13, "b", "b = [2, 3]"),
            ("rates = [0.0, 1, 3e3]", 17, "3e3", "3e3"),
            ("\"a b\" = 1", 0, "\"a b\"", "\"a b\" = 1"),
            ("é = 1", 0, "é", "é = 1"),
        ] {
            assert_eq!(pointed_at(line, start, true), key);
            assert_eq!(pointed_at(line, start, false), pair);
        }
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let line = format!("{}here = 1{}", "é".repeat(1000), "x".repeat(1000));
        let start = 2000;
        assert!(pointed_at(&line, start, true) == "here");
        let snippet = Snippet::around(&line, start);
        assert!(snippet.text.chars().count() <= 126, "{}", snippet.text);
        assert!(snippet.text.starts_with(CUT) && snippet.text.ends_with(CUT));
    }
}
