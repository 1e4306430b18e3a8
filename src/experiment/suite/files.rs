//! The files of one run.

use super::output::SuiteOutput;
use crate::experiment::build::VERSION;
use crate::experiment::output_file::write_file;
use crate::experiment::plan::Plan;
use crate::experiment::run::Simulation;
use crate::gyro::temperature_record;
use crate::report::{self, Contents, OutputFile, Pictures, PointOfSweep, RunOutcome, RunReport};
use crate::scenario::SamplesFormat;
use crate::seal::digest_of_words;
use crate::signal::RunSignals;
use crate::store::{Staged, StoreError};

/// What the report of a run shows of its plan, before anything is measured.
pub(crate) fn report_of_plan(plan: &Plan) -> RunReport<'_> {
    let resolved = plan.resolved();
    RunReport {
        tool_version: VERSION,
        scenario: &resolved.scenario,
        file: &resolved.file,
        digest: &resolved.digest,
        sweep: point_of(plan),
        points: resolved.sweep.as_ref().map_or(0, |point| point.count),
        gyro: plan.facts(),
        log: plan.log(),
        compensation: None,
        theory: &[],
        channels: &[],
        calibration: None,
        verdicts: &[],
        assumed: resolved.assumed_in_short(),
        notes: &[],
    }
}

/// The point of a sweep that a plan is.
pub(super) fn point_of(plan: &Plan) -> Option<PointOfSweep> {
    let point = plan.resolved().sweep.as_ref();
    point.map(|point| (point.index, point.assignments.clone()))
}

/// The outcome of a plan that gave no result.
pub(crate) fn failed(plan: &Plan, reason: String) -> RunOutcome {
    let resolved = plan.resolved();
    let (name, file) = (&resolved.scenario.name, &resolved.file);
    RunOutcome::failed(name, &resolved.folder(), file, reason).at(point_of(plan))
}

/// Writes everything of one run beside its place, to be swapped in whole.
pub(crate) fn write_folder<'a>(
    (plan, report): (&Plan, &RunReport),
    signals: &[RunSignals],
    pictures: &Pictures,
    output: &'a SuiteOutput,
) -> Result<Staged<'a>, StoreError> {
    let folder = output.stage()?;
    for file in run_folder((plan, report), signals, pictures) {
        write_file(&folder, &file)?;
    }
    Ok(folder)
}

/// Everything of one run but its manifest.
pub(super) fn run_folder<'a>(
    (plan, report): (&Plan, &RunReport),
    signals: &[RunSignals<'a>],
    pictures: &Pictures,
) -> Vec<OutputFile<'a>> {
    let text = |name: &str, text: String| OutputFile {
        name: name.to_owned(),
        contents: Contents::Text(text),
    };
    let drawn = pictures.drawn.iter();
    let drawn = drawn.map(|(name, svg)| text(name, svg.clone()));
    let assumed = plan.resolved().assumed();
    let pages = report::run_pages(report, pictures, &assumed).into_iter();
    let pages = pages.map(|(name, page)| text(name, page));
    let files = report::run_files(report, signals).into_iter();
    files.chain(drawn).chain(pages).collect()
}

/// Names of the channels of the gyros.
pub(crate) struct Names {
    raw: Vec<String>,
    compensated: Vec<String>,
}

impl Names {
    pub(crate) fn of(report: &RunReport) -> Self {
        Self {
            raw: report.scenario.raw_channels(),
            compensated: report.scenario.compensated_channels(),
        }
    }
}

/// The samples of each gyro.
pub(crate) fn signals<'a>(
    plan: &Plan,
    simulation: &'a Simulation,
    names: &'a Names,
) -> Vec<RunSignals<'a>> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let first_measured = plan.record_length().warm_up;
    let end_s = scenario.warm_up_s + scenario.duration_s;
    let is_written = scenario.output.samples == SamplesFormat::Npy;
    let has_digest = is_written && simulation.gyros.len() == 1;
    let gyros = simulation.gyros.iter().enumerate();
    let named = gyros.zip(scenario.axis_prefixes().iter().zip(&names.raw));
    let signals = named.map(|((gyro, record), (prefix, raw_name))| {
        let raw = (raw_name.as_str(), record.raw_deg_per_h.as_slice());
        let compensated = record.compensated_deg_per_h.as_deref();
        let name = names.compensated.get(gyro).map(String::as_str);
        let compensated = name.zip(compensated);
        let filters = simulation.filters.iter().filter_map(|(of, filter)| {
            let words = filter.words.as_ref().ok().filter(|_| *of == gyro)?;
            Some((filter.name.as_str(), words.output_deg_per_h.as_slice()))
        });
        RunSignals {
            sample_period_s,
            first_measured,
            prefix,
            truth_deg_per_h: record.truth_deg_per_h.rates(),
            encoder_rad: simulation.encoder_rad.as_deref(),
            input_digest: has_digest.then(|| digest_of_words(record.filter_input_deg_per_h())),
            channels: std::iter::once(raw)
                .chain(compensated)
                .chain(filters)
                .collect(),
            temperature: match plan.log() {
                Some(_) => None,
                None => temperature_record(&scenario.gyro, scenario.warm_up_s, end_s),
            },
        }
    });
    signals.collect()
}
