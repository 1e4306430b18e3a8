//! `fogbench check`: reads and checks scenario files, physics included, without running them.

use std::io;

use super::arguments::SelectOptions;
use super::exit::Exit;
use super::{output, select};
use crate::wording::counted;

/// Says for every run that it is sound, or lists what is wrong.
pub(super) fn check(options: &SelectOptions) -> io::Result<Exit> {
    let plans = match select::plans(options) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    for plan in &plans {
        if let Some(summary) = plan.calibration() {
            let name = &plan.resolved().scenario.name;
            output::talk(&format!("{name}: calibration plan: {summary}"));
        }
        for warning in plan.warnings() {
            output::talk(&format!("warning: {warning}"));
        }
    }
    let files: std::collections::BTreeSet<_> = plans
        .iter()
        .map(|plan| plan.resolved().shown_file())
        .collect();
    let verb = if plans.len() == 1 { "is" } else { "are" };
    output::data(&format!(
        "{} of {} {verb} sound\n",
        counted(plans.len(), "run"),
        counted(files.len(), "file")
    ))?;
    Ok(Exit::Success)
}
