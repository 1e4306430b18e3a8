//! A suite in text: a line for each scenario, what failed, the verdict.

use crate::gate::{VerdictKind, count_accepted};
use crate::report::layout::text::{Tone, fitted, toned, wrapped};
use crate::report::record::sweep::assignments_text;
use crate::report::text::table::gate_line;
use crate::report::{RunOutcome, RunStatus};
use crate::wording::counted;

/// Details stand below the line that they belong to.
const DEEP: &str = "      ";
/// Most points of a sweep that are listed where it stands alone.
const POINTS_MAX: usize = 10;
/// Most details of one run in a list of several.
const DETAILS_MAX: usize = 10;
/// Most failures that are repeated at the end of a suite.
const FAILURES_MAX: usize = 20;
/// Most failures that are told at the end of a sweep that stands alone, without their details.
const POINT_FAILURES_MAX: usize = 3;

/// How lines are laid out.
#[derive(Clone, Copy, Debug)]
pub struct SuiteStyle {
    /// Columns of a line.
    pub width: usize,
    /// Columns of the names, up to which shorter ones are filled up.
    pub name_width: usize,
    /// Whether lines carry the colours of a terminal.
    pub colour: bool,
}

impl SuiteStyle {
    /// The style for scenarios of these names.
    pub fn new<'a>(names: impl Iterator<Item = &'a str>, width: usize, colour: bool) -> Self {
        let longest = names.map(|name| name.chars().count()).max();
        Self {
            width,
            name_width: longest.unwrap_or(0),
            colour,
        }
    }
}

/// The whole suite: a line for each scenario, then [`closing_text`]. A sweep is one line among others,
/// and at most twenty-five where it stands alone, however many points it has.
#[must_use]
pub fn suite_text(runs: &[RunOutcome], width: usize, colour: bool) -> String {
    let style = SuiteStyle::new(runs.iter().map(|run| run.name.as_str()), width, colour);
    let mut text = String::new();
    for of_scenario in runs.chunk_by(|one, next| one.name == next.name) {
        text.push_str(&scenario_text(of_scenario, style, ""));
    }
    text + &closing_text(runs, style)
}

/// The lines of one scenario: one for its run or its sweep, and the details of what failed.
///
/// * `runs`: the run, or the points of the sweep; those that a stopped suite has not run are left out.
/// * `aside`: what else stands at the end of the line.
#[must_use]
pub fn scenario_text(runs: &[RunOutcome], style: SuiteStyle, aside: &str) -> String {
    let ended: Vec<&RunOutcome> = runs.iter().filter(|run| !run.is_not_run).collect();
    let Some(first) = ended.first() else {
        return String::new();
    };
    if runs.len() == 1 && first.sweep.is_none() {
        return run_line(first, &first.name, style, aside) + &details(first, style, DETAILS_MAX);
    }
    let mut text = sweep_line(&first.name, &ended, style, aside);
    let failed: Vec<_> = ended.iter().filter(|run| run.has_failed()).collect();
    for run in failed.iter().take(POINT_FAILURES_MAX) {
        let point = format!("{}: {}", run.folder, point_text(run));
        text.push_str(&wrapped(&point, DEEP, style.width));
        text.push_str(&details(run, style, POINT_FAILURES_MAX));
    }
    text.push_str(&more(failed.len(), POINT_FAILURES_MAX, "failed point"));
    text
}

/// A sweep that is all there is to tell of: a line for each of its first points, those that failed first.
#[must_use]
pub fn sweep_text(runs: &[RunOutcome], style: SuiteStyle) -> String {
    let ended: Vec<&RunOutcome> = runs.iter().filter(|run| !run.is_not_run).collect();
    let Some(first) = ended.first() else {
        return String::new();
    };
    let mut text = sweep_line(&first.name, &ended, style, "");
    let mut shown: Vec<&&RunOutcome> = ended.iter().collect();
    if shown.len() > POINTS_MAX {
        shown.sort_by_key(|run| !run.has_failed());
        shown.truncate(POINTS_MAX);
    }
    let points: Vec<String> = shown.iter().map(|run| point_text(run)).collect();
    let longest = points.iter().map(|point| point.chars().count()).max();
    let style = SuiteStyle {
        name_width: longest.unwrap_or(0),
        ..style
    };
    for (run, point) in shown.iter().zip(&points) {
        text.push_str(&run_line(run, point, style, ""));
    }
    text.push_str(&more(ended.len(), POINTS_MAX, "point"));
    text
}

/// The end of a suite: what failed once more, then a line with the verdict and the counts.
#[must_use]
pub fn closing_text(runs: &[RunOutcome], style: SuiteStyle) -> String {
    let failed: Vec<&RunOutcome> = runs.iter().filter(|run| run.has_failed()).collect();
    let is_one_sweep = runs.windows(2).all(|two| two[0].name == two[1].name) && runs.len() > 1;
    let (most, details_max) = if is_one_sweep {
        (POINT_FAILURES_MAX, 1)
    } else {
        (FAILURES_MAX, DETAILS_MAX)
    };
    let mut text = String::new();
    if !failed.is_empty() {
        let heading = toned("Failures", Tone::Heading, style.colour);
        text.push_str(&format!("\n{heading}\n"));
        for run in failed.iter().take(most) {
            text.push_str(&run_line(run, &run.folder, style, ""));
            let width = if is_one_sweep {
                usize::MAX
            } else {
                style.width
            };
            text.push_str(&details(run, SuiteStyle { width, ..style }, details_max));
        }
        text.push_str(&more(failed.len(), most, "failed run"));
        text.push('\n');
    }
    text + &totals(runs, style.colour)
}

fn more(count: usize, shown: usize, of: &str) -> String {
    match count.saturating_sub(shown) {
        0 => String::new(),
        left => format!("{DEEP}and {}\n", counted(left, &format!("more {of}"))),
    }
}

fn word(is_failure: bool, colour: bool) -> String {
    if is_failure {
        toned("FAIL", Tone::Bad, colour)
    } else {
        toned("PASS", Tone::Good, colour)
    }
}

/// Verdict, name, gates and figures of a run, as many as a line holds.
fn run_line(run: &RunOutcome, name: &str, style: SuiteStyle, aside: &str) -> String {
    let head = format!(
        "{}  {name:width$}  {:12}",
        word(run.has_failed(), style.colour),
        how_it_ended(run),
        width = style.name_width,
    );
    fitted(&head, &run.figures, aside, style.width)
}

/// Verdict, name, points and gates of a sweep.
fn sweep_line(name: &str, points: &[&RunOutcome], style: SuiteStyle, aside: &str) -> String {
    let failed = points.iter().filter(|run| run.has_failed()).count();
    let (gates, accepted) = points.iter().fold((0, 0), |(gates, accepted), run| {
        (
            gates + run.verdicts.len(),
            accepted + count_accepted(&run.verdicts),
        )
    });
    let head = format!(
        "{}  {name:width$}  {:12}",
        word(failed > 0, style.colour),
        gates_text(accepted, gates),
        width = style.name_width,
    );
    let mut points = vec![counted(points.len(), "point")];
    if failed > 0 {
        points.push(format!("{failed} failed"));
    }
    fitted(&head, &points, aside, style.width)
}

/// The gates that accept a run, or what kept it from being judged.
fn how_it_ended(run: &RunOutcome) -> String {
    match run.status() {
        RunStatus::RunFailed => "not finished".to_owned(),
        RunStatus::NotRun => "not run".to_owned(),
        RunStatus::Pass | RunStatus::GateFailed | RunStatus::ChannelFailed => {
            gates_text(count_accepted(&run.verdicts), run.verdicts.len())
        }
    }
}

fn gates_text(accepted: usize, gates: usize) -> String {
    match gates {
        0 => "no gate".to_owned(),
        _ if accepted == gates => counted(gates, "gate"),
        _ => format!("{accepted} of {}", counted(gates, "gate")),
    }
}

fn point_text(run: &RunOutcome) -> String {
    match &run.sweep {
        Some((_, point)) => assignments_text(point),
        None => run.folder.clone(),
    }
}

/// Why a run failed: the run itself, its channels, its gates; no line of what passed.
fn details(run: &RunOutcome, style: SuiteStyle, most: usize) -> String {
    let failed = run.channels.iter().filter_map(|channel| {
        let failure = channel.failure.as_ref()?;
        (!channel.expected_failure).then(|| {
            format!(
                "{} channel {} at sample {}: {}",
                word(true, style.colour),
                channel.name,
                failure.sample,
                failure.message
            )
        })
    });
    let gates = run.verdicts.iter().filter(|verdict| !verdict.accepted);
    let gates = gates.map(|verdict| gate_line(verdict, style.colour));
    let lines: Vec<String> = run
        .error
        .iter()
        .cloned()
        .chain(failed)
        .chain(gates)
        .collect();
    let mut text = String::new();
    for line in lines.iter().take(most) {
        text.push_str(&wrapped(line, DEEP, style.width));
    }
    if most > 1 {
        text.push_str(&more(lines.len(), most, "failure"));
    }
    text
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
