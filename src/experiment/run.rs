//! One scenario: its repeats, their measurement, the verdicts and the files.

use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::compensation::RunError;
use super::measurement::{Channels, measure_repeat, stamp_s};
use super::pipeline_metrics;
use super::plan::Plan;
use super::simulate::{Faults, RecordLength, Simulation, count, simulate};
use super::suite::{Observer, SuiteError, VERSION};
use super::theory::theory;
use crate::gate::judge;
use crate::gyro::temperature_record;
use crate::metrics::{ChannelMetrics, aggregate};
use crate::report::{self, FolderWriter, RunOutcome, RunReport};
use crate::scenario::{SamplesFormat, manifest_toml};
use crate::signal::RunSignals;
use crate::units::rad_to_arcsec;

/// Runs `plan`, judges it and writes its folder under `output`.
pub(super) fn run_scenario(
    plan: &Plan,
    index: usize,
    output: &Path,
    observer: &dyn Observer,
) -> Result<RunOutcome, SuiteError> {
    let resolved = plan.resolved();
    let scenario = &resolved.scenario;
    let folder = resolved.folder();
    let done = theory(scenario)
        .map_err(RunError::from)
        .and_then(|curves| Ok((curves, run_repeats(plan, observer)?)));
    let (theory, (simulation, channels, faults)) = match done {
        Ok(done) => done,
        Err(error) => {
            let (name, file) = (&scenario.name, &resolved.file);
            return Ok(RunOutcome::failed(name, &folder, file, error.to_string()));
        }
    };
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
    let compensation = plan
        .compensation()
        .map(|parameters| parameters.sheet(mean_true_rates(plan, &simulation)));
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
        verdicts: &verdicts,
        notes: &notes,
    };
    let target = output.join(&folder);
    write_folder(plan, &report, &simulation, &target).map_err(|source| SuiteError::Write {
        path: target,
        source,
    })?;
    observer.finished(index, &report);
    Ok(RunOutcome::from_report(&report, &folder))
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

/// Runs every repeat; the records of the first are kept for the plots and the sample files, those
/// of the others are dropped as soon as they are measured.
fn run_repeats(
    plan: &Plan,
    observer: &dyn Observer,
) -> Result<(Simulation, Channels, Faults), RunError> {
    let (simulation, first) = run_repeat(plan, 0, observer)?;
    let others: Vec<(Faults, Channels)> = (1..plan.resolved().scenario.repeats)
        .into_par_iter()
        .with_max_len(1)
        .map(|repeat| {
            run_repeat(plan, repeat, observer)
                .map(|(simulation, channels)| (simulation.faults, channels))
        })
        .collect::<Result<_, _>>()?;
    let faults = others
        .iter()
        .fold(simulation.faults, |sum, (faults, _)| sum.plus(*faults));
    let others = others.into_iter().map(|(_, channels)| channels).collect();
    Ok((simulation, combine(first, others), faults))
}

/// Writes everything of one run beside its place and swaps it in whole.
fn write_folder(
    plan: &Plan,
    report: &RunReport,
    simulation: &Simulation,
    target: &Path,
) -> io::Result<()> {
    let folder = FolderWriter::create(target)?;
    folder.write("summary.json", report::run_summary_json(report).as_bytes())?;
    folder.write(
        "manifest.toml",
        manifest_toml(plan.resolved(), VERSION).as_bytes(),
    )?;
    if let Some(csv) = report::allan_csv(report) {
        folder.write("allan.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::runs_csv(report) {
        folder.write("runs.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::psd_csv(report) {
        folder.write("psd.csv", csv.as_bytes())?;
    }
    let raw_names = report.scenario.raw_channels();
    let compensated_names = report.scenario.compensated_channels();
    let gyros = signals(plan, simulation, (&raw_names, &compensated_names));
    for signals in &gyros {
        for (name, svg) in report::plots(report, signals) {
            folder.write(&name, svg.as_bytes())?;
        }
    }
    if report.scenario.output.samples == SamplesFormat::Npy {
        write_samples(&folder, &gyros)?;
    }
    folder.commit()
}

/// The samples of each gyro.
fn signals<'a>(
    plan: &Plan,
    simulation: &'a Simulation,
    (raw_names, compensated_names): (&'a [String], &'a [String]),
) -> Vec<RunSignals<'a>> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let first_measured = RecordLength::new(scenario, sample_period_s).warm_up;
    let end_s = scenario.warm_up_s + scenario.duration_s;
    let gyros = simulation.gyros.iter().enumerate();
    let named = gyros.zip(scenario.axis_prefixes().iter().zip(raw_names));
    let signals = named.map(|((gyro, record), (prefix, raw_name))| {
        let raw = (raw_name.as_str(), record.raw_deg_per_h.as_slice());
        let compensated = record.compensated_deg_per_h.as_deref();
        let compensated = compensated_names
            .get(gyro)
            .map(String::as_str)
            .zip(compensated);
        let filters = simulation.filters.iter().filter_map(|(of, filter)| {
            let words = filter.words.as_ref().ok().filter(|_| *of == gyro)?;
            Some((filter.name.as_str(), words.output_deg_per_h.as_slice()))
        });
        RunSignals {
            sample_period_s,
            first_measured,
            prefix,
            truth_deg_per_h: &record.truth_deg_per_h,
            encoder_rad: simulation.encoder_rad.as_deref(),
            channels: std::iter::once(raw)
                .chain(compensated)
                .chain(filters)
                .collect(),
            temperature: temperature_record(&scenario.gyro, scenario.warm_up_s, end_s),
        }
    });
    signals.collect()
}

fn write_samples(folder: &FolderWriter, gyros: &[RunSignals]) -> io::Result<()> {
    for signals in gyros {
        for (name, words) in &signals.channels {
            folder.write_npy(&format!("samples/{name}.npy"), words)?;
        }
        let truth = format!("samples/{}truth.npy", signals.prefix);
        folder.write_npy(&truth, signals.truth_deg_per_h)?;
    }
    let Some(first) = gyros.first() else {
        return Ok(());
    };
    if let Some(readings) = first.encoder_rad {
        let angles: Vec<f64> = readings.iter().copied().map(rad_to_arcsec).collect();
        folder.write_npy("samples/encoder_arcsec.npy", &angles)?;
    }
    let samples = first.truth_deg_per_h.len() as u64;
    let time_s: Vec<f64> = (0..samples)
        .map(|index| stamp_s(index, first.sample_period_s))
        .collect();
    folder.write_npy("samples/time_s.npy", &time_s)
}

fn run_repeat(
    plan: &Plan,
    repeat: u32,
    observer: &dyn Observer,
) -> Result<(Simulation, Channels), RunError> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength::new(scenario, plan.sample_period_s());
    let simulation = simulate(scenario, length, repeat, plan.compensation(), observer)?;
    let channels = measure_repeat(plan, &simulation, length);
    Ok((simulation, channels))
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
    combined.collect()
}
