//! Runs of a suite that would write the same folder.

use std::collections::BTreeMap;

use super::error::ScenarioError;
use super::resolved::Resolved;

/// Complaints about runs that would write the same folder, or a scenario beside a sweep in it.
pub(super) fn name_clashes(runs: &[Resolved]) -> Vec<ScenarioError> {
    let mut first: BTreeMap<&str, &Resolved> = BTreeMap::new();
    let mut folders: BTreeMap<String, &Resolved> = BTreeMap::new();
    let mut errors = Vec::new();
    for run in runs {
        let earlier = *first.entry(&run.scenario.name).or_insert(run);
        let twin = folders.get(&run.folder()).copied();
        folders.entry(run.folder()).or_insert(run);
        let is_same_sweep = earlier.shown_file() == run.shown_file()
            && earlier.sweep.is_some() == run.sweep.is_some();
        let clash = match twin {
            Some(twin) => Some(twin),
            None if std::ptr::eq(earlier, run) || is_same_sweep => None,
            None => Some(earlier),
        };
        if let Some(other) = clash {
            let message = format!(
                "name = \"{}\" is the name of the scenario at {} already: give each scenario its own",
                run.scenario.name,
                other.locate("name")
            );
            errors.push(ScenarioError::at(run.locate("name"), message));
        }
    }
    errors
}
