//! One scenario: its repeats, their measurement, the verdicts and the files.

use std::path::Path;

use rayon::prelude::*;

use super::assembly_motion::drop_lacking;
use super::campaign;
use super::channel_filter::{ADDED_RATE_DEG_PER_H, FilterWords, FinishedFilter};
use super::motion::motion;
use super::pipeline_metrics;
use super::plan::{DIVERGED_AT, Plan};
use super::run_files;
use super::simulate::{Faults, GyroRecord, RecordLength, Simulation, simulate};
use super::suite::{Observer, SuiteError, VERSION};
use super::theory::theory;
use crate::filters::Divergence;
use crate::gate::judge;
use crate::metrics::{
    ChannelFailure, ChannelMetrics, Estimate, FilterFacts, Metric, Record, Settings, aggregate,
    measure,
};
use crate::report::{RunOutcome, RunReport};
use crate::signal::CalibrationSheet;

/// Channels of one repeat with their metrics.
type Channels = Vec<(String, ChannelMetrics)>;

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
        .map_err(|error| error.to_string())
        .and_then(|curves| Ok((curves, run_repeats(plan, observer)?)));
    let (theory, repeats) = match done {
        Ok(done) => done,
        Err(error) => {
            let (name, file) = (&scenario.name, &resolved.file);
            return Ok(RunOutcome::failed(name, &folder, file, error));
        }
    };
    let Repeats {
        simulation,
        channels,
        faults,
        calibration,
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
        calibration: calibration.as_ref(),
        verdicts: &verdicts,
        notes: &notes,
    };
    let target = output.join(&folder);
    run_files::write_folder(plan, &report, &simulation, &target).map_err(|source| {
        SuiteError::Write {
            path: target,
            source,
        }
    })?;
    observer.finished(index, &report);
    Ok(RunOutcome::from_report(&report, &folder))
}

/// What the repeats of one run come to.
struct Repeats {
    /// Of the first.
    simulation: Simulation,
    channels: Channels,
    faults: Faults,
    /// Of the first, ranking those of all; none without a campaign.
    calibration: Option<CalibrationSheet>,
}

/// Runs every repeat; the records of the first are kept for the plots and the sample files, those
/// of the others are dropped as soon as they are measured.
fn run_repeats(plan: &Plan, observer: &dyn Observer) -> Result<Repeats, String> {
    let (simulation, first, sheet) = run_repeat(plan, 0, observer)?;
    let others: Vec<(Faults, Channels, Option<CalibrationSheet>)> =
        (1..plan.resolved().scenario.repeats)
            .into_par_iter()
            .with_max_len(1)
            .map(|repeat| {
                run_repeat(plan, repeat, observer)
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
    })
}

fn run_repeat(
    plan: &Plan,
    repeat: u32,
    observer: &dyn Observer,
) -> Result<(Simulation, Channels, Option<CalibrationSheet>), String> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength::new(scenario, plan.sample_period_s());
    let simulation =
        simulate(scenario, length, repeat, observer).map_err(|error| error.to_string())?;
    let mut channels = measure_repeat(plan, &simulation, length);
    let sheet = campaign::calibrate_simulation(scenario, &simulation)
        .map_err(|error| format!("calibration: {error}"))?
        .map(|(sheet, _)| sheet);
    channels.extend(sheet.iter().flat_map(campaign::estimate_channels));
    Ok((simulation, channels, sheet))
}

fn measure_repeat(plan: &Plan, simulation: &Simulation, length: RecordLength) -> Channels {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let settings = &Settings {
        motion: motion(scenario, sample_period_s),
        bias_averaging_time_s: scenario.bias_averaging_time_s,
        fit_tau_min_s: plan.fit_tau_min_s(),
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
        campaign::drop_lacking(scenario, metrics);
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
pub(super) fn stamp_s(index: u64, sample_period_s: f64) -> f64 {
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
