//! `fogbench check`: reads and checks scenario files, physics included, without running them.

use std::collections::BTreeSet;
use std::io;

use crate::cli::commands::select;
use crate::cli::options::arguments::SelectOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::experiment::Sound;
use crate::wording::counted;

/// Says for every run that it is sound, or lists what is wrong.
pub(in crate::cli) fn check(options: &SelectOptions) -> io::Result<Exit> {
    let runs = match select::sound(options) {
        Ok(runs) => runs,
        Err(exit) => return Ok(exit),
    };
    output::talk_first("", runs.iter().flat_map(lines));
    let files: BTreeSet<&str> = runs.iter().map(|run| run.file.as_str()).collect();
    let verb = if runs.len() == 1 { "is" } else { "are" };
    output::data(&format!(
        "{} of {} {verb} sound\n",
        counted(runs.len(), "run"),
        counted(files.len(), "file")
    ))?;
    Ok(Exit::Success)
}

/// What is worth saying about a sound run.
fn lines(run: &Sound) -> Vec<String> {
    let plan = run.calibration.as_ref();
    let plan = plan.map(|summary| format!("{}: calibration plan: {summary}", run.name));
    let warnings = run.remarks.iter().chain(&run.warnings);
    let warnings = warnings.map(|warning| format!("warning: {warning}"));
    plan.into_iter().chain(warnings).collect()
}
