//! What is wrong with single values, and what is left when it has been taken out.

use crate::scenario::document::source::Mark;
use crate::scenario::keys::schema::Key;
use crate::scenario::message::error::ScenarioError;

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
    pub(in crate::scenario) fn covers(&self, shown: &str) -> bool {
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
