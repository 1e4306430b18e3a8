//! The last table of a suite: every scenario, channel and gate.

use crate::gate::{VerdictKind, limits_text, plain};
use crate::report::layout::text::{Grid, Tone, toned, wrapped};
use crate::report::{RunOutcome, RunStatus};
use crate::wording::counted;

const INDENT: &str = "  ";

/// Every run with its channels and gates, and a line of totals. Runs that a stopped suite has not run
/// are only counted.
#[must_use]
pub fn suite_text(runs: &[RunOutcome], width: usize, colour: bool) -> String {
    let mut text = String::new();
    for run in runs.iter().filter(|run| !run.is_not_run) {
        text.push_str(&run_text(run, width, colour));
    }
    text.push_str(&totals(runs, colour));
    text
}

fn status_word(status: RunStatus, colour: bool) -> String {
    match status {
        RunStatus::Pass => toned("PASS", Tone::Good, colour),
        RunStatus::GateFailed => toned("GATE FAILED", Tone::Bad, colour),
        RunStatus::ChannelFailed => toned("CHANNEL FAILED", Tone::Bad, colour),
        RunStatus::NotRun => toned("NOT RUN", Tone::Bad, colour),
        RunStatus::RunFailed => toned("RUN FAILED", Tone::Bad, colour),
    }
}

fn run_text(run: &RunOutcome, width: usize, colour: bool) -> String {
    let mut text = format!(
        "{}  {}\n",
        toned(&run.folder, Tone::Heading, colour),
        status_word(run.status(), colour)
    );
    if let Some(error) = &run.error {
        text.push_str(&wrapped(error, INDENT, width));
    }
    let mut grid = Grid::default();
    let mut messages = String::new();
    for channel in &run.channels {
        let mut cells = vec![channel.name.clone()];
        match &channel.failure {
            Some(failure) => {
                let (word, tone) = if channel.expected_failure {
                    ("failed as expected", Tone::Good)
                } else {
                    ("FAILED", Tone::Bad)
                };
                cells.push(toned(word, tone, colour));
                // A message among the cells would push the other rows' columns apart.
                let message = format!(
                    "{} failed at sample {}: {}",
                    channel.name, failure.sample, failure.message
                );
                messages.push_str(&wrapped(&message, INDENT, width));
            }
            None => cells.extend(
                channel
                    .headline
                    .iter()
                    .map(|(title, value)| format!("{title} {value}")),
            ),
        }
        grid.row(cells);
    }
    text.push_str(&grid.lines(INDENT));
    text.push_str(&messages);
    let mut grid = Grid::default();
    for verdict in &run.verdicts {
        grid.row(gate_cells(verdict, colour));
    }
    text.push_str(&grid.lines(INDENT));
    text
}

/// Verdict, metric, value and limits; a gate without a value shows why instead.
fn gate_cells(verdict: &crate::gate::Verdict, colour: bool) -> Vec<String> {
    let (word, tone) = match (verdict.kind, verdict.accepted) {
        (VerdictKind::Pass, _) => ("pass", Tone::Good),
        (VerdictKind::Fail, _) => ("FAIL", Tone::Bad),
        (VerdictKind::Inconclusive, true) => ("inconclusive, allowed", Tone::Doubt),
        (VerdictKind::Inconclusive, false) => ("INCONCLUSIVE", Tone::Bad),
    };
    let unit = match verdict.unit.as_str() {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let name = match &verdict.relative_to {
        Some(other) => format!("{} / {other}", verdict.metric),
        None => verdict.metric.clone(),
    };
    let number = match (verdict.value, verdict.low, verdict.high) {
        (Some(value), Some(low), Some(high)) if low < high => {
            format!("{}{unit} [{}, {}]", plain(value), plain(low), plain(high))
        }
        (Some(value), _, _) => format!("{}{unit}", plain(value)),
        _ => verdict.reason.clone(),
    };
    let limits = format!("{}{unit}", limits_text(verdict.min, verdict.max));
    vec![toned(word, tone, colour), name, number, limits]
}

fn totals(runs: &[RunOutcome], colour: bool) -> String {
    let with = |status| runs.iter().filter(|run| run.status() == status).count();
    let gates = |kind| runs.iter().map(|run| run.count(kind)).sum::<usize>();
    let passed = with(RunStatus::Pass);
    let not_run = with(RunStatus::NotRun);
    let (word, tone) = if runs.is_empty() || passed + not_run < runs.len() {
        ("FAIL", Tone::Bad)
    } else if not_run == 0 {
        ("PASS", Tone::Good)
    } else {
        ("INCOMPLETE", Tone::Bad)
    };
    let not_run = match not_run {
        0 => String::new(),
        count => format!(", {count} not run"),
    };
    format!(
        "{}  {}: {} passed, {} with a failed gate, {} with a failed channel, {} failed{not_run}; \
         {}: {} passed, {} failed, {} inconclusive\n",
        toned(word, tone, colour),
        counted(runs.len(), "run"),
        passed,
        with(RunStatus::GateFailed),
        with(RunStatus::ChannelFailed),
        with(RunStatus::RunFailed),
        counted(
            runs.iter().map(|run| run.verdicts.len()).sum::<usize>(),
            "gate"
        ),
        gates(VerdictKind::Pass),
        gates(VerdictKind::Fail),
        gates(VerdictKind::Inconclusive),
    )
}
