//! One scenario from a text or a file, and values set one by one, before anything is resolved.

use std::path::Path;

use crate::scenario::check::inert::IdleSets;
use crate::scenario::document::setting::Setting;
use crate::scenario::document::source::Label;
use crate::scenario::message::error::{ScenarioError, in_order};
use crate::scenario::read::chain::{read_text, read_whole};
use crate::scenario::read::draft::Draft;
use crate::scenario::read::suite::{Reading, apply_sets, load_drafted};

/// A scenario as it was read, with the values that were set after.
#[derive(Clone, Debug)]
pub(crate) struct Unresolved {
    draft: Draft,
    /// As `--set` takes them.
    sets: Vec<String>,
}

impl Unresolved {
    /// Reads a text; files that it names are relative to the working directory.
    ///
    /// # Errors
    /// Every complaint about the text and the bases it extends.
    pub(crate) fn from_toml(text: &str) -> Result<Self, Vec<ScenarioError>> {
        Self::of(read_text(text)?)
    }

    /// Reads a file and its bases, or a manifest.
    ///
    /// # Errors
    /// Every complaint about the files.
    pub(crate) fn from_file(file: &Path) -> Result<Self, Vec<ScenarioError>> {
        Self::of(read_whole(file, &Label::of_scenario(file))?)
    }

    fn of((draft, errors): (Draft, Vec<ScenarioError>)) -> Result<Self, Vec<ScenarioError>> {
        if errors.is_empty() {
            let sets = Vec::new();
            Ok(Self { draft, sets })
        } else {
            Err(in_order(errors))
        }
    }

    /// Sets one key, over the files and what was set before.
    ///
    /// # Errors
    /// Complaints about the key; its value is checked with all others, by [`Unresolved::resolve`].
    pub(crate) fn set(&mut self, key: &str, value: &Setting) -> Result<(), Vec<ScenarioError>> {
        self.sets.push(format!("{key}={}", value.as_toml()));
        let mut trial = self.draft.clone();
        trial.root.remove("matrix");
        let mut errors = Vec::new();
        apply_sets(&mut trial, &self.sets, &mut errors);
        if errors.is_empty() {
            return Ok(());
        }
        self.sets.pop();
        Err(in_order(errors))
    }

    /// Resolves every point and hands it over; returns the complaints.
    pub(crate) fn resolve(&self, visit: &mut dyn FnMut(Reading)) -> Vec<ScenarioError> {
        let findings = load_drafted((self.draft.clone(), Vec::new()), &self.sets, visit);
        let mut idle_sets = IdleSets::default();
        idle_sets.add(findings.idle_sets);
        let mut errors = findings.errors;
        errors.extend(idle_sets.complaints());
        in_order(errors)
    }
}
