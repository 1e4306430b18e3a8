//! A comparison in Markdown.

use std::fmt::Write as _;

use super::rows::{change, counts, figure, grounds, notable, unit};
use crate::baseline::Comparison;
use crate::report::layout::markdown::cell;

/// Rows of the table.
const ROWS_MAX: usize = 200;

/// What differs as a table, the worst first.
#[must_use]
pub fn comparison_with_baseline_markdown(comparison: &Comparison) -> String {
    let mut text = format!(
        "\n### Compared with the baseline\n\n{}\n",
        counts(comparison)
    );
    let rows = notable(comparison);
    if rows.is_empty() {
        return text;
    }
    text.push_str(
        "\n| outcome | figure | was | is | unit | change | by |\n|---|---|---|---|---|---|---|\n",
    );
    for row in rows.iter().take(ROWS_MAX) {
        let cells = [
            row.outcome.as_str(),
            &row.id.to_string(),
            &figure(row.old.as_ref()),
            &figure(row.new.as_ref()),
            unit(row),
            &change(row).unwrap_or_default(),
            &grounds(row),
        ]
        .map(cell);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    if let Some(more) = rows.len().checked_sub(ROWS_MAX).filter(|more| *more > 0) {
        let _ = writeln!(text, "\nand {more} more");
    }
    text
}
