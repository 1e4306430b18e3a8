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
use crate::wording::printable;

/// Prints folder, length, channels and file of each run.
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
        let file = resolved.shown_file();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:width$}  {repeats}{} s  {}",
            resolved.folder(),
            scenario.duration_s,
            printable(scenario.description.as_deref().unwrap_or(&file)),
        );
    }
    text
}
