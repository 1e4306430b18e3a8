//! The verdict of a suite in Markdown, for the page of a job.

use std::fmt::Write as _;

use super::junit::gate_names;
use crate::gate::{VerdictKind, limits_text};
use crate::report::layout::markdown::cell;
use crate::report::{RunOutcome, RunStatus};
use crate::scenario::portable_place;
use crate::wording::counted;

/// First line of every summary; by it a file is known as one.
const MARK: &str = "<!-- written by fogbench -->\n";

/// Rows of a table; a job's page holds 1 MiB.
const ROWS_MAX: usize = 200;

/// Whether a text is a summary that [`suite_markdown`] made.
#[must_use]
pub fn is_suite_markdown(text: &str) -> bool {
    text.starts_with(MARK)
}

/// The verdict of every run, failed ones first, and what failed with value, interval, limits and place.
///
/// * `failed`: figures that fail against a baseline.
/// * `appendix`: Markdown that follows, as of a comparison with a baseline.
#[must_use]
pub fn suite_markdown(runs: &[RunOutcome], failed: usize, appendix: &str) -> String {
    let is_good = |run: &&RunOutcome| run.status() == RunStatus::Pass;
    let good = runs.iter().filter(is_good).count();
    let total = runs.len();
    let mut text = format!("{MARK}## fogbench: {good} of {total} runs passed");
    if failed > 0 {
        let figures = counted(failed, "figure");
        // Writing to a String cannot fail.
        let _ = write!(text, ", {figures} failed against the baseline");
    }
    text.push('\n');
    let mut sorted: Vec<&RunOutcome> = runs.iter().collect();
    sorted.sort_by_key(|run| std::cmp::Reverse(run.status()));
    let rows = sorted.iter().map(|run| {
        let [pass, fail, open] = [
            VerdictKind::Pass,
            VerdictKind::Fail,
            VerdictKind::Inconclusive,
        ]
        .map(|kind| run.count(kind));
        let status = run.status().as_str();
        format!(
            "| {} | {status} | {pass} | {fail} | {open} |",
            cell(&run.folder)
        )
    });
    let head = "| run | verdict | gates passed | failed | inconclusive |\n|---|---|---|---|---|";
    table(&mut text, head, rows.collect());
    let failures: Vec<String> = sorted.iter().flat_map(|run| failures(run)).collect();
    if !failures.is_empty() {
        text.push_str("\n### What failed\n");
        let head = "| run | what | outcome | limits | place |\n|---|---|---|---|---|";
        table(&mut text, head, failures);
    }
    text.push_str(appendix);
    text
}

fn table(text: &mut String, head: &str, rows: Vec<String>) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n{head}");
    for row in rows.iter().take(ROWS_MAX) {
        let _ = writeln!(text, "{row}");
    }
    if let Some(more) = rows.len().checked_sub(ROWS_MAX).filter(|more| *more > 0) {
        let _ = writeln!(text, "\nand {more} more");
    }
}

fn failures(run: &RunOutcome) -> Vec<String> {
    let row = |what: &str, outcome: &str, limits: &str, place: &str| {
        let cells = [&run.folder, what, outcome, limits, place].map(cell);
        format!("| {} |", cells.join(" | "))
    };
    let broken = run
        .error
        .iter()
        .map(|error| row("run", error, "", &run.file));
    let channels = run.channels.iter().filter(|it| !it.expected_failure);
    let channels = channels.filter_map(|channel| {
        let name = format!("channel {}", channel.name);
        Some(row(&name, &channel.failure_text()?, "", &run.file))
    });
    let gates = run.verdicts.iter().zip(gate_names(&run.verdicts));
    let gates = gates.filter(|(verdict, _)| !verdict.accepted);
    let gates = gates.map(|(verdict, name)| {
        let limits = limits_text(verdict.min, verdict.max);
        let place = verdict.location.as_deref().map_or("", portable_place);
        let outcome = format!("{}: {}", verdict.kind.as_str(), verdict.reason);
        row(&name, &outcome, &limits, place)
    });
    broken.chain(channels).chain(gates).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_stays_one_whatever_its_texts_hold() {
        let error = "a | b\n<script>*x*</script>".to_owned();
        let run = RunOutcome::failed("bad", "bad", "bad.toml", error);
        let text = suite_markdown(&[run], 0, "");
        assert!(
            is_suite_markdown(&text) && text.contains("0 of 1 runs passed"),
            "{text}"
        );
        let row = text.lines().last().expect("a row");
        assert!(
            row.contains("a \\| b &lt;script&gt;\\*x\\*&lt;/script&gt;"),
            "{row}"
        );
        assert!(text.contains("| bad | run\\_failed | 0 | 0 | 0 |") || text.contains("run_failed"));
    }

    #[test]
    fn failed_runs_come_first_and_long_tables_end() {
        let good =
            |index: usize| RunOutcome::not_run(&format!("n{index}"), &format!("n{index}"), "a");
        let mut runs: Vec<_> = (0..300).map(good).collect();
        runs.push(RunOutcome::failed(
            "bad",
            "bad",
            "bad.toml",
            "broken".to_owned(),
        ));
        let text = suite_markdown(&runs, 2, "");
        let first = text.lines().find(|line| line.starts_with("| bad"));
        let at = |word: &str| text.find(word).expect("a row");
        assert!(first.is_some() && at("| bad") < at("| n0"), "{text}");
        assert!(text.contains("and 101 more") && text.len() < 1 << 20);
    }
}
