//! `summary.json` of a run that could not finish.

use crate::report::layout::json::{SCHEMA, tool};
use crate::report::layout::json::{object, pretty};
use crate::scenario::Scenario;

/// A run that could not finish.
#[derive(Clone, Copy, Debug)]
pub struct FailedRun<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// The resolved scenario.
    pub scenario: &'a Scenario,
    /// Name of its file, without the folder.
    pub file: &'a str,
    /// Digest of the resolved scenario.
    pub digest: &'a str,
    /// Why it could not finish.
    pub reason: &'a str,
}

/// The text of `<scenario>/summary.json` of a run that could not finish: whose run, that it failed, and
/// why.
#[must_use]
pub fn failed_run_json(run: &FailedRun) -> String {
    let scenario = object([
        ("name", run.scenario.name.as_str().into()),
        ("file", run.file.into()),
        ("digest", run.digest.into()),
        ("seed", run.scenario.seed.into()),
    ]);
    let root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(run.tool_version)),
        ("scenario", scenario.into()),
        ("status", "failed".into()),
        ("reason", run.reason.into()),
    ]);
    pretty(&root.into())
}
