//! Runs of a suite that would write the same folder.

use std::collections::BTreeMap;

use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::read::resolved::Resolved;

/// The names and folders of the runs so far.
#[derive(Default)]
pub(in crate::scenario) struct Names {
    first: BTreeMap<String, NamedRun>,
    folders: BTreeMap<String, Location>,
    /// Complaints about runs that would write the same folder, or a scenario beside a sweep in it.
    pub(in crate::scenario) clashes: Vec<ScenarioError>,
}

/// The first run of a name.
struct NamedRun {
    file: String,
    is_sweep: bool,
    place: Location,
}

impl Names {
    /// Takes the name of one more run.
    pub(in crate::scenario) fn take(&mut self, run: &Resolved) {
        let name = &run.scenario.name;
        let (file, is_sweep) = (run.shown_file(), run.sweep.is_some());
        let (folder, place) = (run.folder(), run.locate("name"));
        let other = match (self.folders.get(&folder), self.first.get(name)) {
            (Some(twin), _) => Some(twin),
            (None, Some(first)) if first.file != file || first.is_sweep != is_sweep => {
                Some(&first.place)
            }
            _ => None,
        };
        if let Some(other) = other {
            let message = format!(
                "name = \"{name}\" is the name of the scenario at {other} already: give each \
                 scenario its own"
            );
            self.clashes.push(ScenarioError::at(place.clone(), message));
        }
        if !self.first.contains_key(name) {
            let place = place.clone();
            let first = NamedRun {
                file,
                is_sweep,
                place,
            };
            self.first.insert(name.clone(), first);
        }
        self.folders.entry(folder).or_insert(place);
    }
}
