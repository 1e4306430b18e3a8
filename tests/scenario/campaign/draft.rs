//! A drawn scenario, one key a line, so that a refusal that names a line says which key to mend.

use std::fmt::Write as _;

use fogbench::scenario::ScenarioError;

use crate::support::seeded::Draws;

/// A key that is written.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// Schema path: `filter[].rls.taps`.
    pub(crate) schema_path: String,
    /// Array of tables and the element of it the key stands in, if in any.
    pub(crate) element: Option<(String, usize)>,
    /// Key within the element, or within the file.
    pub(crate) key: String,
    /// Value as TOML.
    pub(crate) value: String,
    /// Optional part of the file the key belongs to, `0/2` for the part 2 inside the part 0.
    pub(crate) part: String,
    /// Table that must stay when its last key goes, by key and by schema path.
    pub(crate) stem: Option<(String, String)>,
    /// Whether the part cannot do without it.
    pub(crate) is_needed: bool,
    /// How often it has been blamed.
    pub(crate) blamed: u32,
}

/// Part of the keys that stand in no optional part.
pub(crate) const FILE: &str = "file";

/// Keys of a scenario in the order they are written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Draft {
    pub(crate) lines: Vec<Line>,
}

impl Draft {
    /// The file, and for each of its lines (from 1) the key that stands there.
    pub(crate) fn render(&self) -> (String, Vec<Option<usize>>) {
        let mut text = String::new();
        let mut owners = vec![None];
        let mut order: Vec<usize> = (0..self.lines.len()).collect();
        order.sort_by_key(|&index| &self.lines[index].element);
        let mut open = &None;
        for index in order {
            let line = &self.lines[index];
            if open != &line.element {
                open = &line.element;
                let array = open.as_ref().map_or("", |(array, _)| array);
                let _ = writeln!(text, "[[{array}]]");
                owners.push(Some(index));
            }
            let _ = writeln!(text, "{} = {}", line.key, line.value);
            owners.push(Some(index));
        }
        (text, owners)
    }

    /// The value of a key of the file itself.
    pub(crate) fn value(&self, key: &str) -> Option<&str> {
        let line = self.lines.iter().find(|line| line.schema_path == key)?;
        Some(&line.value)
    }

    /// Gives a key of the file itself another value.
    pub(crate) fn set(&mut self, key: &str, value: String) {
        if let Some(line) = self.lines.iter_mut().find(|line| line.schema_path == key) {
            line.value = value;
        }
    }

    /// Names of the elements of an array, such as the filters.
    pub(crate) fn names(&self, array: &str) -> Vec<String> {
        let path = format!("{array}[].name");
        let named = self.lines.iter().filter(|line| line.schema_path == path);
        named
            .map(|line| line.value.trim_matches('"').to_owned())
            .collect()
    }

    /// Keys that the complaints blame, each once, the last first.
    pub(crate) fn blamed(&self, errors: &[ScenarioError]) -> Vec<usize> {
        let (_, owners) = self.render();
        let mut found: Vec<usize> = Vec::new();
        for error in errors {
            // A complaint about a key that is not written stands at whatever is near.
            let by_line = owners.get(error.location.line).copied().flatten();
            let by_line = by_line.filter(|&index| self.may_change(index));
            let is_meant = |index: &usize| error.message.contains(&self.lines[*index].key);
            let index = by_line
                .filter(is_meant)
                .or_else(|| self.named_in(&error.message))
                .or_else(|| by_line.filter(|&index| !self.lines[index].is_needed));
            found.extend(index);
        }
        found.sort_unstable();
        found.dedup();
        found.reverse();
        found
    }

    /// The written key of the longest name that a message holds.
    fn named_in(&self, message: &str) -> Option<usize> {
        let named = (0..self.lines.len())
            .filter(|&index| self.may_change(index) && message.contains(&self.lines[index].key));
        named.max_by_key(|&index| self.lines[index].key.len())
    }

    /// Whether a key may be redrawn or go: all but those without which there is no scenario.
    pub(crate) fn may_change(&self, index: usize) -> bool {
        let line = &self.lines[index];
        !(line.part == FILE && line.is_needed)
    }

    /// Length of an array of the same part, this one's own included.
    pub(crate) fn count_beside(&self, index: usize, draws: &mut Draws) -> usize {
        let part = &self.lines[index].part;
        let beside = self.lines.iter().filter(|line| line.part == *part);
        let counts: Vec<usize> = beside
            .filter(|line| line.value.starts_with('['))
            .map(|line| line.value.split(", ").count())
            .collect();
        if counts.is_empty() {
            1
        } else {
            *draws.pick(&counts)
        }
    }

    /// Takes a key away, and the part that cannot do without it.
    pub(crate) fn remove(&mut self, index: usize) {
        let line = &self.lines[index];
        if !line.is_needed || line.part == FILE {
            self.remove_one(index);
            return;
        }
        let part = line.part.clone();
        let inner = format!("{part}/");
        self.lines
            .retain(|line| line.part != part && !line.part.starts_with(&inner));
    }

    /// Takes one key away; the table that somebody chose stays, without keys.
    fn remove_one(&mut self, index: usize) {
        let line = self.lines.remove(index);
        let Some((key, schema_path)) = line.stem.clone() else {
            return;
        };
        let is_beside = |other: &Line| other.stem == line.stem && other.element == line.element;
        if !self.lines.iter().any(is_beside) {
            self.lines.insert(
                index,
                Line {
                    key,
                    schema_path,
                    value: "{}".to_owned(),
                    is_needed: true,
                    ..line
                },
            );
        }
    }
}
