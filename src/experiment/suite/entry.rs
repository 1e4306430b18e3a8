//! One run of a suite: its result or an earlier one, its files and its entry in the ledger.

use super::files::{self, Names};
use super::ledger::Ledger;
use super::options::{Earlier, Resume};
use super::outcome::Observer;
use super::output::{SUMMARY, SuiteOutput};
use super::resume::{take_over, with_restored};
use crate::comparison::Layout;
use crate::experiment::output_file::bytes_of;
use crate::experiment::plan::Plan;
use crate::experiment::run::{Results, Unfinished, run_plan};
use crate::report::{RestoredRun, RunOutcome, RunReport, RunStatus, run_pictures};
use crate::signal::RunSignals;
use crate::store::StoreError;

/// What the runs of a suite share.
pub(crate) struct Suite<'a> {
    /// Where their folders go.
    pub(crate) output: &'a SuiteOutput,
    /// Whose results are taken over.
    pub(crate) resume: Resume,
    /// Earlier results that they are compared with.
    pub(crate) earlier: Option<&'a Earlier>,
    /// Which of them have ended.
    pub(crate) ledger: &'a Ledger,
}

/// Runs `plan`, judges it, puts its folder in place and enters it in the ledger, or takes over the
/// result that stands there; none if it was stopped before that. A run that fails is left to the
/// caller to enter.
pub(crate) fn run_scenario(
    plan: &Plan,
    index: usize,
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, StoreError> {
    let kept = (suite.output, suite.resume);
    if let Some(outcome) = take_over(plan, index, layout, kept, observer) {
        suite.ledger.enter(index, &outcome);
        return Ok(Some(outcome));
    }
    match run_plan(plan, observer) {
        Ok(results) => enter_result((plan, index), &results, layout, suite, observer),
        Err(Unfinished::Stopped) => Ok(None),
        Err(Unfinished::Failed(error)) => Ok(Some(files::failed(plan, error))),
    }
}

/// What the report of a run shows.
fn report<'a>(plan: &'a Plan, results: &'a Results) -> RunReport<'a> {
    RunReport {
        compensation: results.compensation.as_ref(),
        theory: &results.theory,
        channels: &results.channels,
        calibration: results.calibration.as_ref(),
        verdicts: &results.verdicts,
        notes: &results.notes,
        ..files::report_of_plan(plan)
    }
}

/// The files of a result, name and contents, as its folder has them but for the manifest, and whether it
/// failed.
pub(crate) fn files_of_result(plan: &Plan, results: &Results) -> (Vec<(String, Vec<u8>)>, bool) {
    let report = report(plan, results);
    let names = Names::of(&report);
    let signals = files::signals(plan, &results.simulation, &names);
    let pictures = run_pictures(&report, &signals);
    let notes = [report.notes, &pictures.notes].concat();
    let report = &RunReport {
        notes: &notes,
        ..report
    };
    let files = files::run_folder((plan, report), &signals, &pictures).into_iter();
    let files = files.map(|file| {
        let bytes = bytes_of(&file);
        (file.name, bytes)
    });
    let has_failed = report.status() >= RunStatus::ChannelFailed;
    (files.collect(), has_failed)
}

/// Puts the folder of a result in place whose files were made elsewhere, and enters it in the ledger; none if
/// the suite has come to its end before that. A result that cannot be read back has failed.
pub(crate) fn enter_files(
    (plan, index): (&Plan, usize),
    files: &[(String, Vec<u8>)],
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, StoreError> {
    let output = suite.output;
    let staged = output.stage()?;
    for (name, bytes) in files {
        staged.write(name, bytes)?;
    }
    let summary = files.iter().find(|(name, _)| name == SUMMARY);
    let summary = summary.and_then(|(_, bytes)| std::str::from_utf8(bytes).ok());
    let entered = summary.and_then(|summary| {
        let restored = RestoredRun::of_summary(summary)?;
        with_restored(plan, (summary, &restored), |report| {
            let outcome = RunOutcome::from_report(report, &plan.resolved().folder());
            let names = files.iter().map(|(name, _)| name.clone());
            let outcome = RunOutcome {
                pictures: names.filter(|name| name.ends_with(".svg")).collect(),
                ..outcome.keeping(report, layout.metrics_of(&report.scenario.name))
            };
            let swap = || output.put_in_place(staged, plan);
            if !suite.ledger.commit(index, &outcome, swap)? {
                return Ok(None);
            }
            observer.advanced(plan.simulated_s());
            observer.finished(index, report);
            Ok(Some(outcome))
        })
    });
    entered.unwrap_or_else(|| {
        let reason = "the result that its shard holds cannot be read back".to_owned();
        Ok(Some(files::failed(plan, reason)))
    })
}

/// Draws and writes a result, puts its folder in place and enters it in the ledger; none if the suite
/// has come to its end before that.
pub(crate) fn enter_result(
    (plan, index): (&Plan, usize),
    results: &Results,
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, StoreError> {
    let report = report(plan, results);
    let names = Names::of(&report);
    let signals = files::signals(plan, &results.simulation, &names);
    enter_report((plan, index), &report, &signals, layout, suite, observer)
}

/// Does what [`enter_result`] does with the report of a result and its samples.
pub(crate) fn enter_report(
    (plan, index): (&Plan, usize),
    report: &RunReport,
    signals: &[RunSignals],
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, StoreError> {
    let output = suite.output;
    let pictures = run_pictures(report, signals);
    let notes = [report.notes, &pictures.notes].concat();
    let report = &RunReport {
        notes: &notes,
        ..report.clone()
    };
    let written = files::write_folder((plan, report), signals, &pictures, output)?;
    let outcome = RunOutcome::from_report(report, &plan.resolved().folder());
    let pictures = pictures.drawn.into_iter().map(|(name, _)| name).collect();
    let outcome = RunOutcome {
        pictures,
        ..outcome.keeping(report, layout.metrics_of(&report.scenario.name))
    };
    let swap = || output.put_in_place(written, plan);
    if !suite.ledger.commit(index, &outcome, swap)? {
        return Ok(None);
    }
    observer.finished(index, report);
    Ok(Some(outcome))
}
