//! `fogbench check`: reads and checks scenario files, physics included, without running them.

use std::io;

use super::arguments::SelectOptions;
use super::exit::Exit;
use super::{output, select};

/// Says for every run that it is sound, or lists what is wrong.
pub(super) fn check(options: &SelectOptions) -> io::Result<Exit> {
    let plans = match select::plans(options) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    for plan in &plans {
        for warning in plan.warnings() {
            output::talk(&format!("warning: {warning}"));
        }
    }
    let files: std::collections::BTreeSet<_> = plans
        .iter()
        .map(|plan| plan.resolved().file.as_str())
        .collect();
    output::data(&format!(
        "{} runs of {} files are sound\n",
        plans.len(),
        files.len()
    ))?;
    Ok(Exit::Success)
}
