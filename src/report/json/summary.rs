//! `summary.json` of a run and of a suite.

use crate::comparison::Comparison;
use crate::gate::{Verdict, VerdictKind};
use crate::report::calibration::documents::calibration_json;
use crate::report::comparison::json::comparison;
use crate::report::json::channel::channel;
use crate::report::json::compensation::compensation_json;
use crate::report::layout::json::{INTERVALS, SCHEMA, tool};
use crate::report::layout::json::{numbers, object, pretty, put};
use crate::report::text::scale_factor::filter_state_word;
use crate::report::{RunOutcome, RunReport, RunStatus};
use crate::scenario::{Fidelity, PublishedConfig, portable_place};
use crate::signal::GyroFacts;
use serde_json::{Map, Value};

/// The text of `<scenario>/summary.json`.
///
/// Keys stand in a fixed order: those of the record as documented, metrics, curves and reasons by
/// name, channels and gates as given.
#[must_use]
pub fn run_summary_json(report: &RunReport) -> String {
    let channels: Map<String, Value> = report
        .channels
        .iter()
        .map(|(name, metrics)| (name.clone(), channel(metrics)))
        .collect();
    let published = report.scenario.published.iter().map(published).collect();
    let gates = report.verdicts.iter().map(gate).collect();
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(report.tool_version)),
        ("scenario", scenario(report)),
        ("gyro", gyro(report.gyro)),
        ("intervals", INTERVALS.into()),
        ("channels", channels.into()),
        ("published", Value::Array(published)),
        ("gates", Value::Array(gates)),
    ]);
    if let Some(sheet) = report.compensation {
        root.insert("compensation".to_owned(), compensation_json(sheet));
    }
    if let Some(sheet) = report.calibration {
        root.insert("calibration".to_owned(), calibration_json(sheet));
    }
    if !report.notes.is_empty() {
        root.insert("notes".to_owned(), report.notes.to_vec().into());
    }
    pretty(&root.into())
}

/// The text of the suite's `summary.json`: every run with its folder, verdict counts and status;
/// then what the suite says across its scenarios, and folders that hold results of earlier ones.
#[must_use]
pub fn suite_summary_json(
    tool_version: &str,
    runs: &[RunOutcome],
    across: &Comparison,
    stale: &[String],
) -> String {
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
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(tool_version)),
        ("runs", runs.iter().map(run_entry).collect()),
        ("totals", totals.into()),
    ]);
    if !stale.is_empty() {
        root.insert("stale".to_owned(), stale.to_vec().into());
    }
    root.extend(comparison(across));
    pretty(&root.into())
}

fn run_entry(run: &RunOutcome) -> Value {
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
    entry.into()
}

fn scenario(report: &RunReport) -> Value {
    let scenario = report.scenario;
    let fidelity = match scenario.fidelity {
        Fidelity::Loop => "loop",
        Fidelity::Rate => "rate",
    };
    let mut record = object([
        ("name", scenario.name.as_str().into()),
        ("file", report.file.into()),
        ("digest", report.digest.into()),
        ("seed", scenario.seed.into()),
        ("repeats", scenario.repeats.into()),
        ("fidelity", fidelity.into()),
    ]);
    put(&mut record, "duration_s", scenario.duration_s);
    put(&mut record, "warm_up_s", scenario.warm_up_s);
    if let Some(stairs) = scenario.turntable.motion.stairs() {
        let state = filter_state_word(scenario.trial.filter_state);
        record.insert("filter_state".to_owned(), state.into());
        put(&mut record, "settle_s", stairs.settle_s);
    }
    if let Some(description) = &scenario.description {
        record.insert("description".to_owned(), description.as_str().into());
    }
    if let Some((index, point)) = &report.sweep {
        let point: Map<String, Value> = point
            .iter()
            .map(|(key, value)| (key.clone(), value.as_str().into()))
            .collect();
        let sweep = object([("index", (*index).into()), ("point", point.into())]);
        record.insert("sweep".to_owned(), sweep.into());
    }
    record.into()
}

fn gyro(facts: &GyroFacts) -> Value {
    let mut budget = Map::new();
    for (source, value) in &facts.angle_random_walk_budget_deg_per_sqrt_h {
        put(&mut budget, source, *value);
    }
    let mut record = numbers([
        ("scale_factor_s", facts.scale_factor_s),
        ("transit_time_us", facts.transit_time_us),
        ("proper_frequency_khz", facts.proper_frequency_khz),
        ("output_rate_hz", facts.output_rate_hz),
        ("loop_gain", facts.loop_gain),
        ("loop_bandwidth_hz", facts.loop_bandwidth_hz),
        ("delay_ms", facts.delay_ms),
    ]);
    record.insert(
        "angle_random_walk_budget_deg_per_sqrt_h".to_owned(),
        budget.into(),
    );
    record.into()
}

fn published(figure: &PublishedConfig) -> Value {
    let mut record = object([("metric", figure.metric.as_str().into())]);
    put(&mut record, "value", figure.value);
    record.extend(object([
        ("unit", figure.unit.as_str().into()),
        ("source", figure.source.as_str().into()),
    ]));
    record.into()
}

fn gate(verdict: &Verdict) -> Value {
    let mut record = object([
        ("metric", verdict.metric.as_str().into()),
        ("verdict", verdict.kind.as_str().into()),
        ("accepted", verdict.accepted.into()),
    ]);
    let numbers = [
        ("value", verdict.value),
        ("low", verdict.low),
        ("high", verdict.high),
        ("min", verdict.min),
        ("max", verdict.max),
    ];
    for (key, value) in numbers {
        put(&mut record, key, value);
    }
    let words = [
        ("unit", Some(verdict.unit.as_str())),
        ("relative_to", verdict.relative_to.as_deref()),
        ("reason", Some(verdict.reason.as_str())),
        ("location", verdict.location.as_deref().map(portable_place)),
    ];
    for (key, value) in words {
        if let Some(value) = value.filter(|value| !value.is_empty()) {
            record.insert(key.to_owned(), value.into());
        }
    }
    record.into()
}
