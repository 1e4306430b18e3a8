//! The end of a suite: what its runs say across scenarios, and the files of the whole.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::against::Sides;
use super::entry::Suite;
use super::ledger::Ledger;
use super::outcome::SuiteOutcome;
use super::output::{FILTERS, INDEX, JUNIT, METRICS, SUMMARY, Settled, SuiteOutput};
use crate::comparison::{ComparedRun, Comparison, Layout};
use crate::experiment::build::VERSION;
use crate::experiment::plan::Plan;
use crate::report::{self, RunOutcome, SuiteMetrics, SuiteReport, SweepPictures};
use crate::scenario::Resolved;
use crate::store::{Staged, StoreError};

/// What the plans ask of the runs of all.
pub(crate) fn layout(plans: &[Plan]) -> Layout<'_> {
    let suite: Vec<&Resolved> = plans.iter().map(Plan::resolved).collect();
    Layout::of(&suite)
}

/// The tables over the runs that have ended; `runs` are those of `plans`, in their order.
fn compare(plans: &[Plan], layout: &Layout, runs: &[RunOutcome]) -> Comparison {
    let ended = plans.iter().zip(runs).filter(|(_, run)| !run.is_not_run);
    let suite = ended.map(|(plan, run)| ComparedRun {
        resolved: plan.resolved(),
        folder: &run.folder,
        kept: &run.kept,
        pictures: &run.pictures,
    });
    layout.fill(&suite.collect::<Vec<_>>())
}

/// Closes the ledger and writes the files of the suite. What breaks an invariant is left out, and
/// the rest is written all the same.
pub(crate) fn conclude(plans: &[Plan], layout: &Layout, suite: &Suite) -> SuiteOutcome {
    let Suite {
        output,
        ledger,
        earlier,
        ..
    } = *suite;
    let runs = ledger.close(plans);
    let comparison = unbroken(ledger, || compare(plans, layout, &runs)).unwrap_or_default();
    let Settled { stale, failures } = output.settle();
    let mut failures: Vec<String> = failures.iter().map(ToString::to_string).collect();
    let tables = unbroken(ledger, || report::comparison_files(&comparison));
    let tables = tables.unwrap_or_default();
    let mut files = tables.clone();
    let sweeps = draw_sweeps(&runs, suite, &mut failures);
    let sides =
        earlier.map(|earlier| unbroken(ledger, || Sides::of(earlier, plans, &runs, output.path())));
    let sides = sides.flatten().unwrap_or_default();
    let junit = || report::junit_xml(&runs, sides.outcome.judged(), None);
    files.extend(unbroken(ledger, junit).map(|text| (JUNIT.to_owned(), text)));
    let summary = SuiteReport {
        tool_version: VERSION,
        runs: &runs,
        across: &comparison,
        stale: &stale,
        against: sides.shown(),
    };
    let page = unbroken(ledger, || report::suite_page(&summary, &tables, &sweeps));
    files.extend(page.map(|text| (INDEX.to_owned(), text)));
    let beside = unbroken(ledger, || report::filters_page(VERSION, &comparison.beside));
    files.extend(beside.flatten().map(|text| (FILTERS.to_owned(), text)));
    let published = output.publish(|staged| {
        for (name, text) in &files {
            staged.write(name, text.as_bytes())?;
        }
        let written = || write_metrics(staged, output, &summary, &mut failures);
        unbroken(ledger, written).unwrap_or(Ok(()))
    });
    failures.extend(published.err().map(|error| error.to_string()));
    SuiteOutcome {
        folder: output.path().to_owned(),
        runs,
        comparison,
        broken: ledger.is_broken(),
        threads: 0,
        against: sides.outcome,
        stale,
        unwritten: ledger.is_unwritten(),
        failures,
    }
}

/// Draws the sweeps whose points have all ended and writes the pictures beside these; `failures` say what
/// could not be written.
fn draw_sweeps(
    runs: &[RunOutcome],
    suite: &Suite,
    failures: &mut Vec<String>,
) -> Vec<SweepPictures> {
    let Suite { output, ledger, .. } = *suite;
    let is_whole = |name: &str| output.is_whole_sweep(name);
    let drawn = unbroken(ledger, || report::sweep_pictures(runs, &is_whole)).unwrap_or_default();
    for sweep in &drawn {
        let files = sweep.drawn.iter();
        let files: Vec<(&str, &str)> = files.map(|[name, _, svg]| (&name[..], &svg[..])).collect();
        let written = output.put_pictures(&sweep.sweep, &files);
        failures.extend(written.err().map(|error| error.to_string()));
    }
    drawn
}

/// Writes the files that hold the metrics of every run, which are read out of the runs' folders one after
/// the other. Of a run whose metrics cannot be read there, the rest stands, and `failures` say why.
fn write_metrics(
    staged: &Staged,
    output: &SuiteOutput,
    suite: &SuiteReport,
    failures: &mut Vec<String>,
) -> Result<(), StoreError> {
    let metrics = SuiteMetrics::of(suite.runs);
    staged.write_by(METRICS, |out| {
        out.write_all(metrics.head().as_bytes())?;
        for run in suite.runs {
            let own = output.metrics_of(run).unwrap_or_else(|error| {
                failures.push(error.to_string());
                None
            });
            out.write_all(metrics.rows(run, own.as_deref()).as_bytes())?;
        }
        Ok(())
    })?;
    staged.write_by(SUMMARY, |out| {
        let metrics_of = |run: &RunOutcome| Ok(output.metrics_of(run).unwrap_or_default());
        report::write_suite_summary(out, suite, &metrics_of)
    })
}

/// What `make` makes; none, and a note in the ledger, if it breaks an invariant.
fn unbroken<T>(ledger: &Ledger, make: impl FnOnce() -> T) -> Option<T> {
    let made = catch_unwind(AssertUnwindSafe(make)).ok();
    if made.is_none() {
        ledger.note_broken();
    }
    made
}
