//! `summary.json` of a suite: every run with its metrics, one run in memory at a time.

use std::io::{self, Write};

use serde_json::{Map, Value};

use crate::comparison::Comparison;
use crate::gate::VerdictKind;
use crate::report::baseline::rows::ComparedSides;
use crate::report::comparison::json::comparison;
use crate::report::csv::metrics::metric_rows;
use crate::report::json::summary::point_json;
use crate::report::layout::json::{METRICS, SCHEMA, tool};
use crate::report::layout::json::{numbers, object, pretty, pretty_at, put};
use crate::report::{RunOutcome, RunStatus};

/// What the summary of a suite tells.
#[derive(Clone, Copy, Debug)]
pub struct SuiteReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Runs in the order of the plans.
    pub runs: &'a [RunOutcome],
    /// What they say across scenarios.
    pub across: &'a Comparison,
    /// Folders that hold results of earlier scenarios of these names.
    pub stale: &'a [String],
    /// How they compare with earlier results; none if that was not asked. The page alone shows it.
    pub against: Option<ComparedSides<'a>>,
}

/// Stands for the runs in the text around them.
const RUNS: &str = "\"@runs\"";

/// Writes the suite's `summary.json`: every run with its folder, verdict counts, status and metrics;
/// then what the suite says across its scenarios, and folders that hold results of earlier ones.
///
/// * `metrics_of`: text of the `metrics.csv` of a run; none if it failed or was stopped.
///
/// # Errors
/// What `out` and `metrics_of` say.
pub fn write_suite_summary(
    out: &mut dyn Write,
    suite: &SuiteReport,
    metrics_of: &dyn Fn(&RunOutcome) -> io::Result<Option<String>>,
) -> io::Result<()> {
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(suite.tool_version)),
        ("runs", RUNS.trim_matches('"').into()),
        ("totals", totals(suite.runs)),
    ]);
    if !suite.stale.is_empty() {
        root.insert("stale".to_owned(), suite.stale.to_vec().into());
    }
    root.extend(comparison(suite.across));
    let text = pretty(&root.into());
    let (before, behind) = text.split_once(RUNS).unwrap_or((&text, ""));
    write!(out, "{before}[")?;
    for (index, run) in suite.runs.iter().enumerate() {
        let separator = if index == 0 { "" } else { "," };
        let entry = run_entry(run, metrics_of(run)?.as_deref());
        write!(out, "{separator}\n    {}", pretty_at(&entry, 2))?;
    }
    let end = if suite.runs.is_empty() { "]" } else { "\n  ]" };
    write!(out, "{end}{behind}")
}

fn totals(runs: &[RunOutcome]) -> Value {
    let with = |status: RunStatus| runs.iter().filter(|run| run.status() == status).count();
    let verdicts = |kind: VerdictKind| runs.iter().map(|run| run.count(kind)).sum::<usize>();
    let mut totals = object([
        ("runs", runs.len().into()),
        ("passed", with(RunStatus::Pass).into()),
        ("gate_failed", with(RunStatus::GateFailed).into()),
        ("channel_failed", with(RunStatus::ChannelFailed).into()),
        ("run_failed", with(RunStatus::RunFailed).into()),
        ("gates_passed", verdicts(VerdictKind::Pass).into()),
        ("gates_failed", verdicts(VerdictKind::Fail).into()),
        (
            "gates_inconclusive",
            verdicts(VerdictKind::Inconclusive).into(),
        ),
    ]);
    // Only a suite that was stopped has such runs.
    let not_run = with(RunStatus::NotRun);
    if not_run > 0 {
        totals.insert("not_run".to_owned(), not_run.into());
    }
    totals.into()
}

fn run_entry(run: &RunOutcome, metrics: Option<&str>) -> Value {
    let gates = object([
        ("pass", run.count(VerdictKind::Pass).into()),
        ("fail", run.count(VerdictKind::Fail).into()),
        ("inconclusive", run.count(VerdictKind::Inconclusive).into()),
    ]);
    let mut entry = object([
        ("name", run.name.as_str().into()),
        ("folder", run.folder.as_str().into()),
        ("file", run.file.as_str().into()),
        ("status", run.status().as_str().into()),
        ("gates", gates.into()),
    ]);
    if let Some(sweep) = &run.sweep {
        entry.insert("sweep".to_owned(), point_json(sweep));
    }
    let failed: Map<String, Value> = run
        .channels
        .iter()
        .filter_map(|channel| {
            let failure = channel.failure.as_ref()?;
            let record = object([
                ("kind", failure.kind.as_str().into()),
                ("expected", channel.expected_failure.into()),
                ("message", failure.message.as_str().into()),
            ]);
            Some((channel.name.clone(), record.into()))
        })
        .collect();
    if !failed.is_empty() {
        entry.insert("failed_channels".to_owned(), failed.into());
    }
    if let Some(error) = &run.error {
        entry.insert("error".to_owned(), error.as_str().into());
    }
    if let Some(metrics) = metrics {
        entry.insert("channels".to_owned(), channels(metrics));
    }
    entry.into()
}

/// `runs[].channels`: the metrics of every channel, as the run's own summary has them.
fn channels(metrics_csv: &str) -> Value {
    let mut channels: Map<String, Value> = Map::new();
    for row in metric_rows(metrics_csv) {
        let mut record = numbers([("value", row.value)]);
        if let Some([low, high, confidence]) = row.interval {
            put(&mut record, "low", low);
            put(&mut record, "high", high);
            put(&mut record, "confidence", confidence);
        }
        record.insert("unit".to_owned(), row.unit.into());
        let channel = channels.entry(row.channel);
        let channel = channel.or_insert_with(|| object([(METRICS, Map::new().into())]).into());
        if let Some(metrics) = channel.get_mut(METRICS).and_then(Value::as_object_mut) {
            metrics.insert(row.metric, record.into());
        }
    }
    channels.into()
}
