//! Runs of a suite that would write the same folder.

use std::collections::BTreeMap;

use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::read::resolved::Resolved;

/// The names and folders of the runs so far.
#[derive(Default)]
pub(in crate::scenario) struct Names {
    of_name: BTreeMap<String, NamedRuns>,
    /// Complaints about runs that would write the same folder, or a scenario beside a sweep in it.
    pub(in crate::scenario) clashes: Vec<ScenarioError>,
}

/// The runs of a name.
struct NamedRuns {
    /// The first of them.
    file: String,
    is_sweep: bool,
    place: Location,
    /// Folders by index, that of a run without a sweep as 0: first index of those in a row to the end of the
    /// row and the place of the name. A sweep of many points is one row.
    taken: BTreeMap<usize, (usize, Location)>,
}

impl NamedRuns {
    /// The place of the run that has taken an index; none if it is free.
    fn twin(&self, index: usize) -> Option<&Location> {
        let (_, (end, place)) = self.taken.range(..=index).next_back()?;
        (index < *end).then_some(place)
    }

    /// Takes an index that is free.
    fn take(&mut self, index: usize, place: Location) {
        if let Some((_, (end, known))) = self.taken.range_mut(..=index).next_back()
            && *end == index
            && *known == place
        {
            *end += 1;
            return;
        }
        self.taken.insert(index, (index + 1, place));
    }
}

impl Names {
    /// Takes the name of one more run.
    pub(in crate::scenario) fn take(&mut self, run: &Resolved) {
        let name = &run.scenario.name;
        let (file, place) = (run.shown_file(), run.locate("name"));
        let is_sweep = run.sweep.is_some();
        let index = run.sweep.as_ref().map_or(0, |point| point.index);
        let known = self.of_name.get(name);
        let other = known.and_then(|known| {
            let twin = known.twin(index).filter(|_| known.is_sweep == is_sweep);
            let is_apart = known.file != file || known.is_sweep != is_sweep;
            twin.or_else(|| is_apart.then_some(&known.place))
        });
        if let Some(other) = other {
            let message = format!(
                "name = \"{name}\" is the name of the scenario at {other} already: give each \
                 scenario its own"
            );
            self.clashes.push(ScenarioError::at(place.clone(), message));
        }
        let known = self.of_name.entry(name.clone());
        let known = known.or_insert_with(|| NamedRuns {
            file,
            is_sweep,
            place: place.clone(),
            taken: BTreeMap::new(),
        });
        if known.twin(index).is_none() {
            known.take(index, place);
        }
    }
}
