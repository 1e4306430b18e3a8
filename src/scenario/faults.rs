//! What is wrong with single values, and what is left when it has been taken out.

use super::error::ScenarioError;
use super::schema::Key;
use super::source::Mark;

/// A faulty value that was taken out of a tree.
#[derive(Clone, Debug)]
pub(crate) struct Taken {
    /// Its path as complaints show it.
    pub(crate) shown: String,
    /// Its key; none for a table.
    pub(crate) key: Option<&'static Key>,
    /// Where it stood.
    pub(crate) mark: Mark,
}

impl Taken {
    /// Whether a path is the value's, or one below it.
    pub(super) fn covers(&self, shown: &str) -> bool {
        let rest = shown.strip_prefix(self.shown.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    }
}

/// What is wrong with single values.
pub(crate) struct Faults {
    pub(crate) errors: Vec<ScenarioError>,
    /// What was taken out of the tree: the rest is sound, as far as it goes.
    pub(crate) taken: Vec<Taken>,
    /// Whether the file is written for another version of the format: then nothing else counts.
    pub(crate) is_other_version: bool,
}
