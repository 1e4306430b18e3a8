//! Where the files of a suite go: whose folders may be replaced, and what an earlier suite left behind.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::options::SuiteOptions;
use crate::comparison::Layout;
use crate::experiment::build::{BUILD, VERSION};
use crate::experiment::plan::Plan;
use crate::report::{self, FailedRun, RunOutcome};
use crate::scenario::{manifest_toml, slug};
use crate::store::{
    self, MANIFEST_FILE, OutputFolder, Staged, StoreError, StoreOptions, SuiteFileNames,
};

/// Files of every suite.
pub(crate) const SUMMARY: &str = report::SUITE_SUMMARY.name;
pub(crate) const JUNIT: &str = report::JUNIT.name;
pub(crate) const INDEX: &str = report::INDEX.name;
pub(crate) const FILTERS: &str = report::FILTERS.name;
pub(crate) const METRICS: &str = report::METRICS.name;

/// The output folder of a suite that runs.
pub(crate) struct SuiteOutput {
    folder: OutputFolder,
    scenarios: Vec<Scenario>,
    /// Folders of runs that this suite has put in place or taken over.
    placed: Mutex<BTreeSet<String>>,
}

/// What became of what earlier suites left.
#[derive(Debug, Default)]
pub(super) struct Settled {
    /// Folders that hold results of theirs.
    pub(super) stale: Vec<String>,
    /// Why some of them could not be removed.
    pub(super) failures: Vec<StoreError>,
}

/// The runs of one scenario in a suite.
struct Scenario {
    /// Its name and folder.
    name: String,
    /// Folders of its runs in this suite.
    folders: Vec<String>,
    /// Points of its sweep; none without one.
    points: Option<usize>,
}

impl Scenario {
    /// Whether the suite holds every run that the scenario stands for.
    fn is_complete(&self) -> bool {
        self.points.is_none_or(|count| count == self.folders.len())
    }

    /// What an earlier scenario of this name left in the folder, by folder: points beyond the sweep, and
    /// the scenario's own folder for a result that is no point.
    fn leftovers(&self, output: &Path) -> io::Result<Vec<String>> {
        let entries = match fs::read_dir(output.join(&self.name)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries?,
        };
        let mut stale = BTreeSet::new();
        let own = store::sweep_files(&output.join(&self.name))?;
        for entry in entries {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let index: Option<usize> = name.parse().ok().filter(|_| name.len() >= 4);
            match (index, self.points) {
                (Some(index), Some(count)) if index < count => {}
                (None, Some(_)) if own.contains(&name) => {}
                (Some(_), _) => drop(stale.insert(format!("{}/{name}", self.name))),
                (None, Some(_)) => drop(stale.insert(self.name.clone())),
                (None, None) => {}
            }
        }
        Ok(stale.into_iter().collect())
    }
}

impl SuiteOutput {
    /// Takes the output folder and removes the suite's files of an earlier run.
    ///
    /// # Errors
    /// A folder or file in the way that is not the tool's; another process that writes there; whatever
    /// the file system says.
    pub(crate) fn open(
        plans: &[Plan],
        layout: &Layout,
        options: &SuiteOptions,
    ) -> Result<Self, StoreError> {
        let scenarios = scenarios(plans);
        let suite = report::suite_files().into_iter().map(str::to_owned);
        let mut names: Vec<String> = suite.collect();
        names.extend(layout.comparisons.iter().flat_map(|comparison| {
            report::comparison_file_names(comparison.kind, &slug(&comparison.name))
        }));
        let store = StoreOptions {
            force: options.force,
            ..StoreOptions::default()
        };
        let check = |output: &Path| {
            let mut scenarios = scenarios.iter();
            scenarios.try_for_each(|scenario| refuse_theirs(output, scenario))
        };
        let folder = OutputFolder::of_suite(&options.output, store, SuiteFileNames(names), &check)?;
        folder.forget_suite_files()?;
        let output = Self {
            folder,
            scenarios,
            placed: Mutex::new(BTreeSet::new()),
        };
        output.forget_sweep_pictures()?;
        Ok(output)
    }

    /// What is worth saying of the folder.
    pub(crate) fn cautions(&self) -> &[String] {
        self.folder.cautions()
    }

    /// The output folder.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Takes the name of this process off the lock, before the process ends.
    pub(crate) fn sign_off(&self) {
        self.folder.sign_off();
    }

    /// Starts the folder of a run.
    pub(crate) fn stage(&self) -> Result<Staged<'_>, StoreError> {
        self.folder.stage()
    }

    /// Records what the folder of a run holds, with the run's origin, and swaps it into its place.
    pub(crate) fn put_in_place(&self, staged: Staged, plan: &Plan) -> Result<(), StoreError> {
        let manifest = manifest_toml(plan.resolved(), VERSION, BUILD);
        staged.seal(MANIFEST_FILE, &manifest)?;
        let folder = plan.resolved().folder();
        staged.put_in_place(&folder)?;
        self.note_placed(folder);
        Ok(())
    }

    /// Notes that the folder of a run holds the result of this suite.
    pub(crate) fn note_placed(&self, folder: String) {
        let mut placed = self.placed.lock().unwrap_or_else(PoisonError::into_inner);
        placed.insert(folder);
    }

    /// Puts a folder that says so in the place of a run that could not finish; no earlier result of the
    /// scenario passes for it.
    pub(crate) fn record_failure(&self, plan: &Plan, reason: &str) -> Result<(), StoreError> {
        let resolved = plan.resolved();
        let summary = report::failed_run_json(&FailedRun {
            tool_version: VERSION,
            scenario: &resolved.scenario,
            file: &resolved.file,
            digest: &resolved.digest,
            reason,
        });
        let staged = self.stage()?;
        staged.write(SUMMARY, summary.as_bytes())?;
        self.put_in_place(staged, plan)
    }

    /// Removes what earlier scenarios of these names left behind, each in one step, where every run of
    /// the scenario stands in its place.
    pub(super) fn settle(&self) -> Settled {
        let placed = self.placed.lock().unwrap_or_else(PoisonError::into_inner);
        let mut settled = Settled::default();
        for scenario in &self.scenarios {
            let unplaced = scenario.folders.iter();
            let mut unplaced = unplaced
                .filter(|folder| !placed.contains(*folder))
                .peekable();
            let is_done = scenario.is_complete() && unplaced.peek().is_none();
            // What could not be replaced is of an earlier suite.
            let held = unplaced.filter(|folder| self.path().join(folder).join(SUMMARY).is_file());
            settled.stale.extend(held.cloned());
            let left = match scenario.leftovers(self.path()) {
                Ok(left) => left,
                Err(source) => {
                    let path = self.path().join(&scenario.name);
                    settled.failures.push(StoreError::Write { path, source });
                    continue;
                }
            };
            if left.is_empty() {
                continue;
            }
            if !is_done || scenario.points.is_none() {
                settled.stale.extend(left);
                continue;
            }
            let own = format!("{}/", scenario.name);
            let points = scenario.folders.iter();
            let points: Vec<String> = points
                .filter_map(|folder| folder.strip_prefix(&own))
                .map(str::to_owned)
                .collect();
            if let Err(error) = self.folder.keep_only(&scenario.name, &points) {
                settled.failures.push(error);
                settled.stale.extend(left);
            }
        }
        settled.stale.sort();
        settled.stale.dedup();
        settled
    }

    /// Writes the suite's own files by `write`, as one.
    pub(crate) fn publish(
        &self,
        write: impl FnOnce(&Staged) -> Result<(), StoreError>,
    ) -> Result<(), StoreError> {
        let staged = self.stage()?;
        write(&staged)?;
        staged.seal_plainly()?;
        staged.put_files_in_place()
    }

    /// Whether the runs of a scenario are all of its points.
    pub(crate) fn is_whole_sweep(&self, name: &str) -> bool {
        let mut scenarios = self.scenarios.iter();
        scenarios.any(|scenario| scenario.name == name && scenario.is_complete())
    }

    /// Removes the pictures of sweeps that are run anew, so that none outlives its points.
    fn forget_sweep_pictures(&self) -> Result<(), StoreError> {
        let swept = self.scenarios.iter().filter(|it| it.points.is_some());
        let mut whole = swept.filter(|scenario| scenario.is_complete());
        whole.try_for_each(|scenario| self.put_pictures(&scenario.name, &[]))
    }

    /// Puts the pictures of a sweep, name and text, beside its points, in place of earlier ones.
    pub(crate) fn put_pictures(
        &self,
        sweep: &str,
        pictures: &[(&str, &str)],
    ) -> Result<(), StoreError> {
        let staged = self.stage()?;
        for (name, svg) in pictures {
            staged.write(&format!("{sweep}/{name}"), svg.as_bytes())?;
        }
        staged.put_beside_points(sweep)
    }

    /// The metrics of a run out of its folder; none of one that has not ended with a result.
    ///
    /// # Errors
    /// Whatever the file system says of reading them.
    pub(crate) fn metrics_of(&self, run: &RunOutcome) -> io::Result<Option<String>> {
        if run.error.is_some() || run.is_not_run {
            return Ok(None);
        }
        let path = self.path().join(&run.folder).join(METRICS);
        let text = fs::read_to_string(&path);
        let text = text.map_err(|source| {
            io::Error::new(source.kind(), format!("{}: {source}", path.display()))
        });
        text.map(Some)
    }
}

/// The scenarios of a suite, by name.
fn scenarios(plans: &[Plan]) -> Vec<Scenario> {
    let mut by_name: BTreeMap<&str, Scenario> = BTreeMap::new();
    for plan in plans {
        let resolved = plan.resolved();
        let name = resolved.scenario.name.as_str();
        let scenario = by_name.entry(name).or_insert_with(|| Scenario {
            name: name.to_owned(),
            folders: Vec::new(),
            points: resolved.sweep.as_ref().map(|point| point.count),
        });
        scenario.folders.push(resolved.folder());
    }
    by_name.into_values().collect()
}

/// Refuses a scenario whose folder holds something of the user's.
///
/// A suite that holds some points of a sweep touches only these, so only these are looked into.
fn refuse_theirs(output: &Path, scenario: &Scenario) -> Result<(), StoreError> {
    let own = output.join(&scenario.name);
    if scenario.is_complete() {
        return store::refuse_theirs(&own);
    }
    match fs::symlink_metadata(&own) {
        Err(_) => return Ok(()),
        // The reason is found by looking into it.
        Ok(kind) if !kind.is_dir() => return store::refuse_theirs(&own),
        Ok(_) => {}
    }
    let mut folders = scenario.folders.iter().map(|folder| output.join(folder));
    folders.try_for_each(|folder| store::refuse_theirs(&folder))
}
