//! `fogbench expand`: every resolved run, defaults included, as one TOML document.

use std::fmt::Write;
use std::io;

use crate::cli::commands::select;
use crate::cli::options::arguments::ExpandOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;

/// Prints each resolved run under a comment that names its folder: a single one as a scenario file,
/// several as the array of tables `run`.
pub(in crate::cli) fn expand(options: &ExpandOptions) -> io::Result<Exit> {
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    let mut text = String::new();
    let is_single = plans.len() == 1;
    if options.origins && !is_single {
        let count = plans.len();
        complaint::print(&[format!(
            "--origins tells of a single run, and the selection holds {count}: name a file without [matrix]"
        )]);
        return Ok(Exit::Usage);
    }
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
        text.push_str(&if is_single && options.origins {
            resolved.to_toml_with_origins()
        } else if is_single {
            resolved.to_toml()
        } else {
            resolved.to_toml_in_array("run")
        });
    }
    output::data(&text)?;
    Ok(Exit::Success)
}
