//! `fogbench list`: the runs a selection holds.

use std::fmt::Write;
use std::io;

use serde_json::json;

use crate::cli::commands::select;
use crate::cli::options::arguments::ListOptions;
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::experiment::Plan;
use crate::report::{assignments_text, swept_value};
use crate::wording::printable;

/// Prints folder, length and description of each run; of a point of a sweep what it sets.
pub(in crate::cli) fn list(options: &ListOptions) -> io::Result<Exit> {
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    let text = match options.format {
        Format::Text => text(&plans),
        Format::Json => {
            let rows: Vec<_> = plans.iter().map(row).collect();
            format!("{:#}\n", serde_json::Value::from(rows))
        }
        Format::Jsonl => plans
            .iter()
            .map(|plan| format!("{}\n", row(plan)))
            .collect(),
    };
    output::data(&text)?;
    Ok(Exit::Success)
}

fn row(plan: &Plan) -> serde_json::Value {
    let resolved = plan.resolved();
    let scenario = &resolved.scenario;
    json!({
        "folder": resolved.folder(),
        "file": resolved.shown_file(),
        "duration_s": scenario.duration_s,
        "repeats": scenario.repeats,
        "channels": plan.channel_names(),
        "gates": scenario.gates.len(),
        "description": scenario.description,
        "sweep": resolved.sweep.as_ref().map(|point| {
            let set = point.assignments.iter();
            let set = set.map(|(key, toml)| (key.clone(), swept_value(toml)));
            set.collect::<serde_json::Map<_, _>>()
        }),
    })
}

fn text(plans: &[Plan]) -> String {
    let width = plans
        .iter()
        .map(|plan| plan.resolved().folder().len())
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for plan in plans {
        let resolved = plan.resolved();
        let scenario = &resolved.scenario;
        let repeats = if scenario.repeats > 1 {
            format!("{} x ", scenario.repeats)
        } else {
            String::new()
        };
        // Points of a sweep differ in nothing else.
        let about = match (&resolved.sweep, &scenario.description) {
            (Some(point), _) => assignments_text(&point.assignments),
            // A line for each run, however many its description has.
            (None, Some(description)) => description.lines().collect::<Vec<_>>().join(" "),
            (None, None) => resolved.shown_file(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:width$}  {repeats}{} s  {}",
            resolved.folder(),
            scenario.duration_s,
            printable(&about),
        );
    }
    text
}
