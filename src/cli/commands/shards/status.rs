//! `fogbench status`: which shards are done, failed or missing.

use std::io;

use crate::cli::options::shard::StatusOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{output, place};
use crate::experiment::{GatherError, ranges_text, shard_status};
use crate::wording::counted;

/// Prints how far the shards of a folder are; starts nothing.
pub(in crate::cli) fn status(options: &StatusOptions) -> io::Result<Exit> {
    let status = match shard_status(&options.folder) {
        Ok(status) => status,
        Err(error) => return Ok(refused(error)),
    };
    for damaged in &status.damaged {
        output::talk(&format!("warning: {damaged}: it counts as missing"));
    }
    let shown = |numbers: &[u32]| {
        let numbers = numbers.iter();
        let numbers: Vec<u32> = numbers
            .map(|number| number.saturating_sub(options.shard_offset))
            .collect();
        ranges_text(&numbers)
    };
    if options.missing {
        let missing = shown(&status.missing);
        let line = if missing.is_empty() {
            missing
        } else {
            missing + "\n"
        };
        output::data(&line)?;
        return Ok(Exit::Success);
    }
    let mut text = counted(status.count as usize, "shard");
    if let Some(plan) = &status.plan {
        text.push_str(&format!(" of plan {}", plan.get(..12).unwrap_or(plan)));
    }
    text.push('\n');
    for (word, numbers) in [
        ("done", &status.done),
        ("failed", &status.failed),
        ("running", &status.running),
        ("begun", &status.begun),
        ("missing", &status.missing),
    ] {
        if !numbers.is_empty() {
            text.push_str(&format!(
                "{word:<8} {:>4}  {}\n",
                numbers.len(),
                shown(numbers)
            ));
        }
    }
    if !status.missing.is_empty() {
        text.push_str(&format!("--array={}\n", shown(&status.missing)));
    }
    output::data(&text)?;
    Ok(Exit::Success)
}

/// Says why shards are not taken, and gives the exit code.
pub(in crate::cli) fn refused(error: GatherError) -> Exit {
    output::talk(&format!("error: {error}"));
    match error {
        GatherError::Store(error) => place::exit_of(&error),
        _ => Exit::Usage,
    }
}
