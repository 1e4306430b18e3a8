//! One scenario: its repeats, their measurement, the verdicts and the files.

use rayon::prelude::*;

use super::campaign;
use super::comparison::Layout;
use super::compensation::Parameters;
use super::measurement::{Channels, measure_repeat};
use super::pipeline_metrics;
use super::plan::Plan;
use super::resume::take_over;
use super::run_files;
use super::simulate::{Faults, RecordLength, Simulation, count, simulate};
use super::stop::Unfinished;
use super::suite::{Observer, Suite, SuiteError, VERSION};
use super::theory::theory;
use crate::gate::judge;
use crate::metrics::{ChannelMetrics, aggregate};
use crate::report::{RunOutcome, RunReport};
use crate::signal::CalibrationSheet;

/// Runs `plan`, judges it, puts its folder in place and enters it in the ledger, or takes over the
/// result that stands there; none if it was stopped before that. A run that fails is left to the
/// caller to enter.
pub(super) fn run_scenario(
    plan: &Plan,
    index: usize,
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, SuiteError> {
    let kept = (suite.output, suite.resume);
    if let Some(outcome) = take_over(plan, index, layout, kept, observer) {
        suite.ledger.enter(index, &outcome);
        return Ok(Some(outcome));
    }
    let resolved = plan.resolved();
    let scenario = &resolved.scenario;
    let done = theory(scenario)
        .map_err(Unfinished::from)
        .and_then(|curves| Ok((curves, run_repeats(plan, observer)?)));
    let (theory, repeats) = match done {
        Ok(done) => done,
        Err(Unfinished::Stopped) => return Ok(None),
        Err(Unfinished::Failed(error)) => {
            let (name, file) = (&scenario.name, &resolved.file);
            return Ok(Some(RunOutcome::failed(
                name,
                &resolved.folder(),
                file,
                error,
            )));
        }
    };
    let Repeats {
        simulation,
        channels,
        faults,
        calibration,
        parameters,
    } = repeats;
    let gates = scenario.gates.iter().enumerate();
    let verdicts: Vec<_> = gates
        .map(|(index, gate)| judge(gate, &channels, Some(resolved.gate_place(index))))
        .collect();
    let sample_period_s = plan.sample_period_s();
    let filters = simulation.filters.iter();
    let pipelines: Vec<String> = filters
        .flat_map(|(_, filter)| pipeline_metrics::notes(filter, sample_period_s))
        .collect();
    let notes = [plan.warnings().to_vec(), faults.notes(), pipelines].concat();
    let compensation = parameters.map(|known| known.sheet(mean_true_rates(plan, &simulation)));
    let report = RunReport {
        tool_version: VERSION,
        scenario,
        file: &resolved.file,
        digest: &resolved.digest,
        sweep: resolved
            .sweep
            .as_ref()
            .map(|point| (point.index, point.assignments.clone())),
        gyro: plan.facts(),
        compensation: compensation.as_ref(),
        theory: &theory,
        channels: &channels,
        calibration: calibration.as_ref(),
        verdicts: &verdicts,
        notes: &notes,
    };
    enter_result((plan, index), &report, &simulation, layout, suite, observer)
}

/// Draws and writes a result, puts its folder in place and enters it in the ledger; none if the suite
/// has come to its end before that.
fn enter_result(
    (plan, index): (&Plan, usize),
    report: &RunReport,
    simulation: &Simulation,
    layout: &Layout,
    suite: &Suite,
    observer: &dyn Observer,
) -> Result<Option<RunOutcome>, SuiteError> {
    let output = suite.output;
    let pictures = run_files::draw(plan, report, simulation);
    let notes = [report.notes, &pictures.notes].concat();
    let report = &RunReport {
        notes: &notes,
        ..report.clone()
    };
    let written = run_files::write_folder(plan, report, simulation, &pictures, output)?;
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

/// Means of the true rates about the case axes over the first record, deg/h.
fn mean_true_rates(plan: &Plan, simulation: &Simulation) -> [f64; 3] {
    let scenario = &plan.resolved().scenario;
    let first = RecordLength::new(scenario, plan.sample_period_s()).warm_up;
    let mut means = [0.0; 3];
    for (mean, gyro) in means.iter_mut().zip(&simulation.gyros) {
        let truth = &gyro.truth_deg_per_h[first..];
        *mean = truth.iter().sum::<f64>() / count(truth.len());
    }
    means
}

/// What the repeats of one run come to.
struct Repeats {
    /// Of the first.
    simulation: Simulation,
    channels: Channels,
    faults: Faults,
    /// Of the first, ranking those of all; none without a campaign.
    calibration: Option<CalibrationSheet>,
    /// What was taken out of the outputs.
    parameters: Option<Parameters>,
}

/// Runs every repeat; the records of the first are kept for the plots and the sample files, those
/// of the others are dropped as soon as they are measured.
fn run_repeats(plan: &Plan, observer: &dyn Observer) -> Result<Repeats, Unfinished> {
    let parameters = plan
        .compensation()
        .map(|plan| plan.parameters(observer))
        .transpose()?;
    let known = parameters.as_ref();
    let (simulation, first, sheet) = run_repeat(plan, 0, known, observer)?;
    let others: Vec<(Faults, Channels, Option<CalibrationSheet>)> =
        (1..plan.resolved().scenario.repeats)
            .into_par_iter()
            .with_max_len(1)
            .map(|repeat| {
                run_repeat(plan, repeat, known, observer)
                    .map(|(simulation, channels, sheet)| (simulation.faults, channels, sheet))
            })
            .collect::<Result<_, _>>()?;
    let mut faults = simulation.faults;
    let (mut channels, mut sheets) = (Vec::new(), Vec::from_iter(sheet));
    for (more, other, sheet) in others {
        faults = faults.plus(more);
        channels.push(other);
        sheets.extend(sheet);
    }
    Ok(Repeats {
        simulation,
        channels: combine(first, channels),
        faults,
        calibration: campaign::ranked(sheets),
        parameters,
    })
}

fn run_repeat(
    plan: &Plan,
    repeat: u32,
    parameters: Option<&Parameters>,
    observer: &dyn Observer,
) -> Result<(Simulation, Channels, Option<CalibrationSheet>), Unfinished> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength::new(scenario, plan.sample_period_s());
    let simulation = simulate(scenario, length, repeat, parameters, observer)?;
    let mut channels = measure_repeat(plan, &simulation, length, observer)?;
    let sheet = campaign::calibrate_simulation(scenario, &simulation)
        .map_err(|error| Unfinished::Failed(format!("calibration: {error}")))?
        .map(|(sheet, _)| sheet);
    channels.extend(sheet.iter().flat_map(campaign::estimate_channels));
    keep_finite(&mut channels);
    Ok((simulation, channels, sheet))
}

/// One table from the tables of all repeats; a channel that failed once has failed.
fn combine(first: Channels, others: Vec<Channels>) -> Channels {
    if others.is_empty() {
        return first;
    }
    let mut repeats = vec![first];
    repeats.extend(others);
    let names: Vec<String> = repeats[0].iter().map(|(name, _)| name.clone()).collect();
    let combined = names.into_iter().enumerate().map(|(index, name)| {
        let tables: Vec<ChannelMetrics> = repeats
            .iter()
            .map(|channels| channels[index].1.clone())
            .collect();
        let failed = tables.iter().find(|table| table.error.is_some());
        let table = failed.cloned().unwrap_or_else(|| aggregate(&tables));
        (name, table)
    });
    let mut combined = combined.collect();
    keep_finite(&mut combined);
    combined
}

/// Leaves only finite numbers in the tables; see [`ChannelMetrics::keep_finite`].
fn keep_finite(channels: &mut Channels) {
    for (_, metrics) in channels {
        metrics.keep_finite();
    }
}
