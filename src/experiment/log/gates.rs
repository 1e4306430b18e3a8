//! The gates of a file, to be held against what a recorded log measures.

use std::path::Path;

use crate::gate::{Verdict, judge};
use crate::metrics::{ChannelMetrics, unknown_of_channel};
use crate::scenario::{LogChannels, Purpose, Resolved, ScenarioError, load_base_or_scenario};

/// Name of the log's own channel.
const RAW: &str = "raw";

/// The gates of a scenario, a base or a file of gates alone.
#[derive(Clone, Debug)]
pub struct LogGates {
    resolved: Resolved,
}

/// Reads the gates of a file. A channel that is not the log's must be a filter of the same file.
///
/// # Errors
/// Every complaint about the file; no gate; a metric that nobody knows.
pub fn load_log_gates(path: &Path, channels: LogChannels) -> Result<LogGates, Vec<ScenarioError>> {
    let runs = load_base_or_scenario(path, &[], Purpose::Gates(channels))?;
    let Some(resolved) = runs.into_iter().next() else {
        return Err(Vec::new());
    };
    let gates = &resolved.scenario.gates;
    if gates.is_empty() {
        let message = "it has no [[gate]]: there is nothing to hold against the log".to_owned();
        return Err(vec![ScenarioError::at(resolved.locate("name"), message)]);
    }
    let complaints = gates.iter().enumerate().filter_map(|(index, gate)| {
        let key = format!("gate[{index}].metric");
        let (channel, name) = gate.metric.rsplit_once('.')?;
        let complaint = unknown_of_channel(name, channel != RAW)?;
        let message = format!("{key}: {}: {complaint}", gate.metric);
        Some(ScenarioError::at(resolved.locate(&key), message))
    });
    let complaints: Vec<ScenarioError> = complaints.collect();
    match complaints.is_empty() {
        true => Ok(LogGates { resolved }),
        false => Err(complaints),
    }
}

impl LogGates {
    /// Judges every gate.
    pub(super) fn judge(&self, channels: &[(String, ChannelMetrics)]) -> Vec<Verdict> {
        let gates = self.resolved.scenario.gates.iter().enumerate();
        gates
            .map(|(index, gate)| judge(gate, channels, Some(self.resolved.gate_place(index))))
            .collect()
    }
}
