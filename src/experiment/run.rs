//! One scenario: its repeats, their measurement, the verdicts and the files.

use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::allan_settings::allan_options;
use super::assembly_motion::drop_lacking;
use super::channel_filter::{ADDED_RATE_DEG_PER_H, FilterWords, FinishedFilter};
use super::comparison::Layout;
use super::motion::motion;
use super::pipeline_metrics;
use super::plan::{DIVERGED_AT, Plan};
use super::simulate::{Faults, GyroRecord, RecordLength, Simulation, simulate};
use super::suite::{Observer, SuiteError, VERSION};
use super::theory::theory;
use crate::filters::Divergence;
use crate::gate::judge;
use crate::gyro::{GyroError, temperature_record};
use crate::metrics::{
    ChannelFailure, ChannelMetrics, Estimate, FilterFacts, Metric, Record, Settings, aggregate,
    measure,
};
use crate::report::{self, FolderWriter, RunOutcome, RunReport};
use crate::scenario::{SamplesFormat, manifest_toml};
use crate::signal::RunSignals;
use crate::units::rad_to_arcsec;

/// Channels of one repeat with their metrics.
type Channels = Vec<(String, ChannelMetrics)>;

/// Runs `plan`, judges it and writes its folder under `output`.
pub(super) fn run_scenario(
    plan: &Plan,
    index: usize,
    layout: &Layout,
    output: &Path,
    observer: &dyn Observer,
) -> Result<RunOutcome, SuiteError> {
    let resolved = plan.resolved();
    let scenario = &resolved.scenario;
    let folder = resolved.folder();
    let done = theory(scenario).and_then(|curves| Ok((curves, run_repeats(plan, observer)?)));
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
        theory: &theory,
        channels: &channels,
        verdicts: &verdicts,
        notes: &notes,
    };
    let target = output.join(&folder);
    let written = write_folder(plan, &report, &simulation, &target);
    let pictures = written.map_err(|source| SuiteError::Write {
        path: target,
        source,
    })?;
    observer.finished(index, &report);
    let outcome = RunOutcome::from_report(&report, &folder);
    let outcome = outcome.keeping(&report, layout.metrics_of(&scenario.name));
    Ok(RunOutcome {
        pictures,
        ..outcome
    })
}

/// Runs every repeat; the records of the first are kept for the plots and the sample files, those
/// of the others are dropped as soon as they are measured.
fn run_repeats(
    plan: &Plan,
    observer: &dyn Observer,
) -> Result<(Simulation, Channels, Faults), GyroError> {
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

/// Writes everything of one run beside its place and swaps it in whole; names its pictures.
fn write_folder(
    plan: &Plan,
    report: &RunReport,
    simulation: &Simulation,
    target: &Path,
) -> io::Result<Vec<String>> {
    let folder = FolderWriter::create(target)?;
    folder.write("summary.json", report::run_summary_json(report).as_bytes())?;
    folder.write(
        "manifest.toml",
        manifest_toml(plan.resolved(), VERSION).as_bytes(),
    )?;
    if let Some(csv) = report::allan_csv(report) {
        folder.write("allan.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::autocovariance_csv(report) {
        folder.write("autocovariance.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::psd_csv(report) {
        folder.write("psd.csv", csv.as_bytes())?;
    }
    let raw_names = report.scenario.raw_channels();
    let gyros = signals(plan, simulation, &raw_names);
    let mut pictures = Vec::new();
    for signals in &gyros {
        for (name, svg) in report::plots(report, signals) {
            folder.write(&name, svg.as_bytes())?;
            pictures.push(name);
        }
    }
    if report.scenario.output.samples == SamplesFormat::Npy {
        write_samples(&folder, &gyros)?;
    }
    folder.commit()?;
    Ok(pictures)
}

/// The samples of each gyro.
fn signals<'a>(
    plan: &Plan,
    simulation: &'a Simulation,
    raw_names: &'a [String],
) -> Vec<RunSignals<'a>> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let first_measured = RecordLength::new(scenario, sample_period_s).warm_up;
    let end_s = scenario.warm_up_s + scenario.duration_s;
    let gyros = simulation.gyros.iter().enumerate();
    let named = gyros.zip(scenario.axis_prefixes().iter().zip(raw_names));
    let signals = named.map(|((gyro, record), (prefix, raw_name))| {
        let raw = (raw_name.as_str(), record.raw_deg_per_h.as_slice());
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
            channels: std::iter::once(raw).chain(filters).collect(),
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
) -> Result<(Simulation, Channels), GyroError> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength::new(scenario, plan.sample_period_s());
    let simulation = simulate(scenario, length, repeat, observer)?;
    let channels = measure_repeat(plan, &simulation, length);
    Ok((simulation, channels))
}

fn measure_repeat(plan: &Plan, simulation: &Simulation, length: RecordLength) -> Channels {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let settings = &Settings {
        motion: motion(scenario, sample_period_s),
        bias_averaging_time_s: scenario.bias_averaging_time_s,
        fit_tau_min_s: plan.fit_tau_min_s(),
        allan: allan_options(scenario.allan),
    };
    let gyros = simulation.gyros.iter();
    let cuts: Vec<Cut> = gyros
        .map(|record| Cut {
            record,
            encoder_rad: simulation.encoder_rad.as_deref(),
            length,
            sample_period_s,
            settings,
        })
        .collect();
    let (raw, filters): (Channels, Channels) = rayon::join(
        || {
            let named = cuts.par_iter().zip(scenario.raw_channels());
            named.map(|(cut, name)| (name, cut.measure_raw())).collect()
        },
        || {
            let filters = simulation.filters.par_iter();
            filters
                .map(|(gyro, filter)| (filter.name.clone(), cuts[*gyro].measure_filter(filter)))
                .collect()
        },
    );
    let mut channels: Channels = raw.into_iter().chain(filters).collect();
    for (name, metrics) in &mut channels {
        drop_lacking(scenario, name, metrics);
    }
    channels
}

/// The measured part of one gyro's record and how to measure it.
pub(super) struct Cut<'a> {
    pub(super) record: &'a GyroRecord,
    pub(super) encoder_rad: Option<&'a [f64]>,
    pub(super) length: RecordLength,
    pub(super) sample_period_s: f64,
    pub(super) settings: &'a Settings,
}

impl Cut<'_> {
    pub(super) fn measure_raw(&self) -> ChannelMetrics {
        let words = &self.record.raw_deg_per_h;
        match words.iter().position(|word| !word.is_finite()) {
            Some(sample) => failed(
                "not finite",
                sample as u64,
                format!("the word of the gyro is {}", words[sample]),
                self.sample_period_s,
            ),
            None => self.measure(words, None),
        }
    }

    fn measure(&self, channel_deg_per_h: &[f64], filter: Option<&FilterFacts>) -> ChannelMetrics {
        let first = self.length.warm_up;
        let record = Record {
            channel_deg_per_h: &channel_deg_per_h[first..],
            raw_deg_per_h: &self.record.raw_deg_per_h[first..],
            // A recorded log has none.
            truth_deg_per_h: self.record.truth_deg_per_h.get(first..).unwrap_or(&[]),
            encoder_rad: self.encoder_rad.map(|readings| &readings[first..]),
            sample_period_s: self.sample_period_s,
            first_stamp_s: stamp_s(first as u64, self.sample_period_s),
        };
        measure(&record, self.settings, filter)
    }

    pub(super) fn measure_filter(&self, filter: &FinishedFilter) -> ChannelMetrics {
        let mut metrics = match &filter.words {
            Ok(words) => {
                let facts = filter_facts(filter, words);
                self.measure(&words.output_deg_per_h, Some(&facts))
            }
            Err(divergence) => diverged(divergence, self.sample_period_s),
        };
        if let Some(pipeline) = &filter.pipeline {
            pipeline_metrics::enter(pipeline, self.sample_period_s, &mut metrics);
        }
        metrics
    }
}

fn filter_facts(filter: &FinishedFilter, words: &FilterWords) -> FilterFacts {
    FilterFacts {
        shape: filter.shape.clone(),
        dc_gain: words.dc_gain,
        dc_gain_adapted: words.dc_gain_adapted,
        mean_weights: words.mean_weights.clone(),
        added_rate_deg_per_h: ADDED_RATE_DEG_PER_H,
        rate_gains: words.rate_gains.clone(),
        latency_s: pipeline_metrics::latency_s(filter.pipeline.as_ref()),
    }
}

/// A channel that failed has no numbers of its record but the instant of its failure.
fn diverged(divergence: &Divergence, sample_period_s: f64) -> ChannelMetrics {
    let (sample, message) = (divergence.sample, divergence.to_string());
    failed("diverged", sample, message, sample_period_s)
}

fn failed(kind: &str, sample: u64, message: String, sample_period_s: f64) -> ChannelMetrics {
    let mut channel = ChannelMetrics::default();
    let at_s = stamp_s(sample, sample_period_s);
    channel.metrics.insert(
        DIVERGED_AT.to_owned(),
        Metric::new(Estimate::exact(at_s), "s"),
    );
    channel.error = Some(ChannelFailure {
        kind: kind.to_owned(),
        sample,
        message,
    });
    channel
}

/// Stamp of sample `index`, s from the start of the warm-up.
fn stamp_s(index: u64, sample_period_s: f64) -> f64 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    let ordinal = (index + 1) as f64;
    ordinal * sample_period_s
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
