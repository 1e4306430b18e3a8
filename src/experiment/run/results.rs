//! One run in memory: its repeats, their measurement and the verdicts.

use rayon::prelude::*;

use super::measure::{Channels, measure_repeat};
use super::progress::{Progress, Unfinished};
use super::records::RecordLength;
use super::repeat_pool::{Repeat, RepeatPool, keep_finite};
use super::simulate::{Faults, Simulation, simulate};
use super::theory::theory;
use crate::experiment::campaign;
use crate::experiment::campaign::Parameters;
use crate::experiment::log::run_log;
use crate::experiment::outside;
use crate::experiment::pipeline_metrics;
use crate::experiment::plan::Plan;
use crate::gate::{Verdict, judge};
use crate::signal::{CalibrationSheet, CompensationSheet, TheoryCurve};

/// What a run comes to.
pub(crate) struct Results {
    /// Records of the first repeat.
    pub(crate) simulation: Simulation,
    /// Metrics of all repeats by channel, `raw` first.
    pub(crate) channels: Channels,
    /// Judged gates, in the order of the file.
    pub(crate) verdicts: Vec<Verdict>,
    /// What the reader of the results must know.
    pub(crate) notes: Vec<String>,
    /// What came of a calibration campaign.
    pub(crate) calibration: Option<CalibrationSheet>,
    /// What was taken out of the outputs.
    pub(crate) compensation: Option<CompensationSheet>,
    /// Lines of theory beside the measured points.
    pub(crate) theory: Vec<TheoryCurve>,
}

/// Runs every repeat of `plan`, measures and judges.
///
/// # Errors
/// Why it cannot be run to its end, or that the listener has stopped it.
pub(crate) fn run_plan(plan: &Plan, progress: &dyn Progress) -> Result<Results, Unfinished> {
    let resolved = plan.resolved();
    if let Some((file, format)) = resolved.log_source() {
        let mut results = run_log(plan, (file, &format), progress)?;
        keep_finite(&mut results.channels);
        results.verdicts = verdicts(plan, &results.channels);
        return Ok(results);
    }
    let theory = theory(&resolved.scenario)?;
    let Repeats {
        simulation,
        channels,
        faults,
        calibration,
        parameters,
    } = run_repeats(plan, progress)?;
    let verdicts = verdicts(plan, &channels);
    let notes = notes(plan, faults, &filter_notes(plan, &simulation));
    let compensation = parameters.map(|known| known.sheet(mean_true_rates(plan, &simulation)));
    Ok(Results {
        simulation,
        channels,
        verdicts,
        notes,
        calibration,
        compensation,
        theory,
    })
}

/// The gates of a plan, judged in the order of the file.
pub(crate) fn verdicts(plan: &Plan, channels: &Channels) -> Vec<Verdict> {
    let resolved = plan.resolved();
    let gates = resolved.scenario.gates.iter().enumerate();
    gates
        .map(|(index, gate)| judge(gate, channels, Some(resolved.gate_place(index))))
        .collect()
}

/// What the reader of the results must know.
///
/// * `of_filters`: what the filters of the first repeat have to say.
pub(crate) fn notes(plan: &Plan, faults: Faults, of_filters: &[String]) -> Vec<String> {
    [plan.warnings(), &faults.notes(), of_filters].concat()
}

/// What the filters of a repeat have to say.
pub(super) fn filter_notes(plan: &Plan, simulation: &Simulation) -> Vec<String> {
    let sample_period_s = plan.sample_period_s();
    let filters = simulation.filters.iter();
    let notes = filters.flat_map(|(_, filter)| {
        let pipeline = pipeline_metrics::notes(filter, sample_period_s);
        pipeline.into_iter().chain(outside::note(filter))
    });
    notes.collect()
}

/// Means of the true rates about the case axes over the first record, deg/h.
fn mean_true_rates(plan: &Plan, simulation: &Simulation) -> [f64; 3] {
    let scenario = &plan.resolved().scenario;
    let first = RecordLength::new(scenario, plan.sample_period_s()).warm_up;
    let mut means = [0.0; 3];
    for (mean, gyro) in means.iter_mut().zip(&simulation.gyros) {
        *mean = gyro.truth_deg_per_h.rates().from(first).mean();
    }
    means
}

/// Repeats that a thread runs before those of all are pooled.
const REPEATS_TOGETHER: usize = 64;

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
fn run_repeats(plan: &Plan, progress: &dyn Progress) -> Result<Repeats, Unfinished> {
    let parameters = plan
        .compensation()
        .map(|plan| plan.parameters(progress))
        .transpose()?;
    let known = parameters.as_ref();
    let (simulation, first, sheet) = run_repeat(plan, 0, known, progress)?;
    let mut sheets = Vec::from_iter(sheet);
    let mut pool = RepeatPool::default();
    pool.add(Repeat {
        faults: simulation.faults,
        channels: first,
    });
    let repeats = plan.resolved().scenario.repeats;
    // Some at a time, so that of many repeats no more wait to be pooled in their order.
    let together = u32::try_from(REPEATS_TOGETHER * rayon::current_num_threads());
    let together = together.unwrap_or(u32::MAX);
    for begin in (1..repeats).step_by(together as usize) {
        let others = begin..repeats.min(begin.saturating_add(together));
        let others: Vec<(Repeat, Option<CalibrationSheet>)> = others
            .into_par_iter()
            .with_max_len(1)
            .map(|repeat| {
                let (simulation, channels, sheet) = run_repeat(plan, repeat, known, progress)?;
                let faults = simulation.faults;
                Ok((Repeat { faults, channels }, sheet))
            })
            .collect::<Result<_, Unfinished>>()?;
        for (repeat, sheet) in others {
            pool.add(repeat);
            sheets.extend(sheet);
        }
    }
    let (faults, channels) = pool.pooled().unwrap_or_default();
    Ok(Repeats {
        simulation,
        channels,
        faults,
        calibration: campaign::ranked(sheets),
        parameters,
    })
}

pub(super) fn run_repeat(
    plan: &Plan,
    repeat: u32,
    parameters: Option<&Parameters>,
    progress: &dyn Progress,
) -> Result<(Simulation, Channels, Option<CalibrationSheet>), Unfinished> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength::new(scenario, plan.sample_period_s());
    let mut simulation = simulate(scenario, length, repeat, parameters, progress)?;
    outside::complete(&mut simulation, plan.resolved(), length, progress)?;
    let mut channels = measure_repeat(plan, &simulation, length, progress)?;
    let sheet = campaign::calibrate_simulation(scenario, &simulation)
        .map_err(|error| Unfinished::Failed(format!("calibration: {error}")))?
        .map(|(sheet, _)| sheet);
    channels.extend(sheet.iter().flat_map(campaign::estimate_channels));
    keep_finite(&mut channels);
    Ok((simulation, channels, sheet))
}
