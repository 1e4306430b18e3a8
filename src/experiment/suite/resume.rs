//! Results of an earlier suite that need not be computed again.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::files::report_of_plan;
use super::options::Resume;
use super::outcome::Observer;
use super::output::{SUMMARY, SuiteOutput};
use crate::comparison::Layout;
use crate::experiment::build::{BUILD, VERSION, names_one_program};
use crate::experiment::outside::is_of_the_moment;
use crate::experiment::plan::Plan;
use crate::experiment::run::verdicts;
use crate::report::{self, RestoredRun, RunOutcome, RunReport, run_summary_json};
use crate::scenario::manifest_toml;
use crate::store::{Head, MANIFEST_FILE, Ownership, Record, inspect};

/// The outcome of a run whose folder holds its undamaged result; none if it is to be run.
///
/// The same resolved scenario, seed, inputs, gates and version show in equal manifests, and that
/// everything could be read back in an equal summary; so the end result is that of an uninterrupted
/// suite to the byte, or the run is run again.
pub(crate) fn take_over(
    plan: &Plan,
    index: usize,
    layout: &Layout,
    (output, resume): (&SuiteOutput, Resume),
    observer: &dyn Observer,
) -> Option<RunOutcome> {
    let resolved = plan.resolved();
    let folder = resolved.folder();
    let path = output.path().join(&folder);
    if resume == Resume::Never || !is_undamaged(&path) || !is_of(plan, &path, resume) {
        return None;
    }
    let summary = fs::read_to_string(path.join(SUMMARY)).ok()?;
    let restored = RestoredRun::of_summary(&summary)?;
    let mut failures = restored
        .channels
        .iter()
        .filter_map(|(_, metrics)| metrics.error.as_ref());
    if failures.any(is_of_the_moment) {
        return None;
    }
    with_restored(plan, (&summary, &restored), |report| {
        if !has_files(&path, report) {
            return None;
        }
        output.note_placed(folder.clone());
        observer.advanced(plan.simulated_s());
        observer.taken_over(index, report);
        let outcome = RunOutcome::from_report(report, &folder);
        let outcome = outcome.keeping(report, layout.metrics_of(&resolved.scenario.name));
        Some(RunOutcome {
            pictures: pictures(&path),
            ..outcome
        })
    })?
}

/// Hands over the report of a run out of its `summary.json`, the text and what was read of it; none if the
/// report does not give this text again, so that something of it was lost.
pub(super) fn with_restored<T>(
    plan: &Plan,
    (summary, restored): (&str, &RestoredRun),
    take: impl FnOnce(&RunReport) -> T,
) -> Option<T> {
    let verdicts = verdicts(plan, &restored.channels);
    let report = RunReport {
        compensation: restored.compensation.as_ref(),
        channels: &restored.channels,
        calibration: restored.calibration.as_ref(),
        verdicts: &verdicts,
        notes: &restored.notes,
        ..report_of_plan(plan)
    };
    (run_summary_json(&report) == summary).then(|| take(&report))
}

/// Whether a folder holds every file of one result as it was written.
fn is_undamaged(folder: &Path) -> bool {
    matches!(inspect(folder), Ok(Ownership::Ours { is_whole: true }))
}

/// Whether the manifest of a folder is the one that this run would get.
fn is_of(plan: &Plan, folder: &Path, resume: Resume) -> bool {
    let Ok(text) = fs::read_to_string(folder.join(MANIFEST_FILE)) else {
        return false;
    };
    let (found, own) = (
        Head::of(&text),
        manifest_toml(plan.resolved(), VERSION, BUILD),
    );
    let is_same_build = names_one_program(BUILD) && found.build == Head::of(&own).build;
    found.text == Head::of(&own).text && (resume == Resume::AnyBuild || is_same_build)
}

/// Whether a folder holds the files that this build writes, which an earlier one may not have known.
fn has_files(folder: &Path, report: &RunReport) -> bool {
    let record = Record::of_manifest(folder).unwrap_or_default();
    let known: BTreeSet<&str> = record.names().collect();
    let page = RunOutcome::from_report(report, "").has_page;
    let page = page.then(|| report::PAGE.to_owned());
    let mut names = report::run_file_names(report).into_iter().chain(page);
    names.all(|name| known.contains(name.as_str()))
}

/// Pictures in the folder of a run.
fn pictures(folder: &Path) -> Vec<String> {
    let record = Record::of_manifest(folder);
    let names = record.iter().flat_map(Record::names);
    names
        .filter(|name| name.ends_with(".svg"))
        .map(str::to_owned)
        .collect()
}
