//! Merged values of a scenario, before anything of them is checked.

use std::sync::Arc;

use crate::recording::LogFacts;
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::Table;
use crate::scenario::read::files::named_files::NamedFile;
use crate::scenario::read::purpose::Purpose;
use crate::scenario::read::resolved::{InputFile, SweepPoint, broken};

/// What a scenario is resolved from.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    /// Merged values, without defaults.
    pub(crate) root: Table,
    /// Beginning of the scenario's own file.
    pub(crate) root_mark: Mark,
    /// What the marks point into.
    pub(crate) sources: Arc<Sources>,
    /// Name of the scenario's own file.
    pub(crate) file: String,
    /// Files it was read from.
    pub(crate) inputs: Vec<InputFile>,
    /// Files that keys name and that are read when it runs.
    pub(crate) named_files: Vec<NamedFile>,
    /// The log that takes the place of table and gyro, once it has been read.
    pub(crate) log: Option<LogFacts>,
    /// What a manifest says about the origin of its scenario.
    pub(crate) recorded: Option<Recorded>,
    /// What is worth saying about how it was read.
    pub(crate) warnings: Vec<String>,
    /// What is worth saying but must not stand in results.
    pub(crate) remarks: Vec<String>,
    /// Whether the file is a record, or a base of which a scenario was made up: what it sets is then
    /// nobody's wish for this run.
    pub(crate) is_record: bool,
    /// What it is read for.
    pub(crate) purpose: Purpose,
    /// Whether a file it builds on could not be read: only what is there can be checked.
    pub(crate) is_partial: bool,
}

impl Draft {
    /// A record that was read whole, as a manifest or a calibration is.
    pub(crate) fn of_record(
        (root, root_mark): (Table, Mark),
        sources: Sources,
        file: String,
        inputs: Vec<InputFile>,
    ) -> Self {
        Self {
            root,
            root_mark,
            sources: Arc::new(sources),
            file,
            inputs,
            named_files: Vec::new(),
            log: None,
            recorded: None,
            warnings: Vec::new(),
            remarks: Vec::new(),
            is_record: true,
            purpose: Purpose::Run,
            is_partial: false,
        }
    }
}

/// The origin of a resolved scenario, as a manifest records it.
#[derive(Clone, Debug)]
pub(crate) struct Recorded {
    /// Digest of the scenario that the record is true of.
    pub(crate) digest: String,
    /// Name of the scenario's own file.
    pub(crate) file: String,
    /// Files it was read from.
    pub(crate) inputs: Vec<InputFile>,
    /// Which point of a sweep it was.
    pub(crate) sweep: Option<SweepPoint>,
    /// Where its gates were written.
    pub(crate) gate_places: Vec<String>,
    /// Keys that nobody wrote; none in a manifest of an earlier build.
    pub(crate) assumed_keys: Option<Vec<String>>,
}

impl Recorded {
    /// The first swept key that has another value than the record says, and what that is.
    pub(crate) fn broken_point(&self, root: &Table) -> Option<(&str, &str)> {
        broken(root, self.sweep.as_ref()?)
    }
}
