//! What came of a run and of a suite.

use crate::gate::Verdict;
use crate::metrics::ChannelMetrics;
use crate::report::RunSummary;
use crate::signal::GyroFacts;

use super::plan::DIVERGED_AT;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunStatus {
    /// Every channel ran and every gate passed.
    Passed,
    /// A gate failed.
    GateFailed,
    /// A channel failed and no gate expected it to.
    ChannelFailed,
}

/// One finished run.
#[derive(Clone, Debug)]
pub struct RunOutcome {
    /// Folder under the output folder.
    pub folder: String,
    /// Scenario file.
    pub file: String,
    /// The gyro in closed form.
    pub facts: GyroFacts,
    /// Channels in order, `raw` first.
    pub channels: Vec<(String, ChannelMetrics)>,
    /// Gates in the order of the file.
    pub verdicts: Vec<Verdict>,
    /// The summary as written, JSON.
    pub summary_json: String,
    /// The table for people, without and with colours.
    pub table: Tables,
}
