//! `fogbench expand`: every resolved run, defaults included, as TOML.

use std::fmt::Write;
use std::io;

use super::arguments::SelectOptions;
use super::exit::Exit;
use super::{output, select};

/// Prints each resolved run under a comment that names its folder.
pub(super) fn expand(options: &SelectOptions) -> io::Result<Exit> {
    let plans = match select::plans(options) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    let mut text = String::new();
    for (index, plan) in plans.iter().enumerate() {
        let resolved = plan.resolved();
        let gap = if index == 0 { "" } else { "\n" };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{gap}# {} ({})",
            resolved.folder(),
            resolved.shown_file()
        );
        text.push_str(&resolved.to_toml());
    }
    output::data(&text)?;
    Ok(Exit::Success)
}
