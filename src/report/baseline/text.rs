//! A comparison for people.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::rows::{counts, notable, row_line};
use crate::baseline::{Judged, Outcome, Row};
use crate::report::layout::text::{Tone, toned};
use crate::scenario::bounded;
use crate::wording::counted;

/// Rows of an outcome that are printed.
const ROWS_MAX: usize = 50;

/// What differs, the worst first, and how much of what there is; the last line says whether a figure fails.
#[must_use]
pub fn comparison_with_baseline_text(judged: Judged, colour: bool) -> String {
    let comparison = judged.comparison;
    let mut text = String::new();
    let rows = notable(comparison);
    for outcome in Outcome::ALL {
        if outcome == Outcome::ChangedScenario {
            text.push_str(&changed_scenarios(&rows));
            continue;
        }
        let of = rows.iter().filter(|row| row.outcome == outcome);
        for row in of.clone().take(ROWS_MAX) {
            let tone = match outcome {
                _ if judged.fail_on.contains(&outcome) => Tone::Bad,
                Outcome::Better => Tone::Good,
                _ => Tone::Doubt,
            };
            let word = toned(&format!("{:16}", outcome.as_str()), tone, colour);
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{word} {}", bounded(&row_line(row)));
        }
        if let Some(more) = of.count().checked_sub(ROWS_MAX).filter(|more| *more > 0) {
            let _ = writeln!(text, "and {more} more are {}", outcome.as_str());
        }
    }
    let (verdict, tone) = if judged.has_failed() {
        ("FAIL", Tone::Bad)
    } else {
        ("PASS", Tone::Good)
    };
    let versions = if comparison.old_version == comparison.new_version {
        String::new()
    } else {
        format!(
            " (fogbench {} and {})",
            comparison.old_version, comparison.new_version
        )
    };
    let verdict = toned(verdict, tone, colour);
    let _ = writeln!(text, "{verdict}  compared {}{versions}", counts(comparison));
    text
}

/// A line for each run whose scenario differs, as none of its figures is judged.
fn changed_scenarios(rows: &[&Row]) -> String {
    let mut runs: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows {
        if row.outcome == Outcome::ChangedScenario {
            *runs.entry(row.id.run_text()).or_default() += 1;
        }
    }
    let mut text = String::new();
    let word = Outcome::ChangedScenario.as_str();
    for (run, count) in runs.iter().take(ROWS_MAX) {
        let count = counted(*count, "figure");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{word:16} {}: {count} not judged", bounded(run));
    }
    if let Some(more) = runs.len().checked_sub(ROWS_MAX).filter(|more| *more > 0) {
        let _ = writeln!(text, "and {more} more scenarios differ");
    }
    text
}
