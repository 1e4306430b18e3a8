//! A run in memory: channels, metrics, samples and verdicts by name.

use std::ops::Index;

use super::progress::{Progress, Unfinished};
use super::records::stamp_s;
use super::results::{Results, run_plan};
use super::simulate::GyroRecord;
use crate::experiment::plan::Plan;
use crate::gate::{Verdict, expects_failure};
use crate::metrics::ChannelMetrics;
use crate::scenario::ScenarioErrors;
use crate::signal::{CalibrationSheet, RateRecord, TheoryCurve};

/// Why a scenario gives no run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The scenario is not sound.
    #[error(transparent)]
    Scenario(#[from] ScenarioErrors),
    /// It is a sweep.
    #[error("the scenario is a sweep of {0} points: run each of Scenario::points()")]
    SeveralPoints(usize),
    /// It cannot be computed to its end.
    #[error("the run failed: {0}")]
    Failed(String),
    /// The listener has stopped it.
    #[error("the run was stopped before its end")]
    Stopped,
}

impl From<Unfinished> for RunError {
    fn from(unfinished: Unfinished) -> Self {
        match unfinished {
            Unfinished::Stopped => Self::Stopped,
            Unfinished::Failed(reason) => Self::Failed(reason),
        }
    }
}

impl Plan {
    /// Runs the plan in memory.
    ///
    /// # Errors
    /// [`RunError::Failed`] if it cannot be computed to its end.
    pub fn run(&self) -> Result<Run, RunError> {
        self.run_with(&())
    }

    /// Runs the plan in memory; `progress` hears of it and can stop it.
    ///
    /// # Errors
    /// [`RunError::Failed`] if it cannot be computed to its end, [`RunError::Stopped`].
    pub fn run_with(&self, progress: &dyn Progress) -> Result<Run, RunError> {
        self.clone().into_run(progress)
    }

    pub(crate) fn into_run(self, progress: &dyn Progress) -> Result<Run, RunError> {
        let results = run_plan(&self, progress)?;
        Ok(Run {
            plan: self,
            results,
        })
    }
}

/// A run and everything it came to: samples, metrics, curves and verdicts, in memory.
///
/// `run["rls"]` is the [`ChannelMetrics`] of a channel.
pub struct Run {
    pub(crate) plan: Plan,
    pub(crate) results: Results,
}

impl Run {
    /// The plan that was run, with the resolved scenario and the gyro in closed form.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Channels in order, raw ones first, each with its metrics.
    pub fn channels(&self) -> impl Iterator<Item = (&str, &ChannelMetrics)> {
        let channels = self.results.channels.iter();
        channels.map(|(name, metrics)| (name.as_str(), metrics))
    }

    /// Metrics, curves and reasons for absence of one channel.
    ///
    /// # Errors
    /// [`UnknownName`] with the channels there are.
    pub fn channel(&self, name: &str) -> Result<&ChannelMetrics, UnknownName> {
        let mut channels = self.channels();
        let found = channels.find(|(known, _)| *known == name);
        found.map(|(_, metrics)| metrics).ok_or_else(|| {
            let names = self.channels().map(|(known, _)| known);
            UnknownName::new("channel", name, names)
        })
    }

    /// Samples of one channel in the first repeat; of the true rate by the name `truth`, in an
    /// assembly `x_truth`, `y_truth` and `z_truth`.
    ///
    /// # Errors
    /// [`UnknownName`] with the records there are: a filter that failed has none.
    pub fn samples(&self, name: &str) -> Result<Samples<'_>, UnknownName> {
        let (records, truths) = (self.records(), self.truths());
        let found = records.iter().find(|(known, _)| known == name);
        let found = found.map(|(_, words)| *words).or_else(|| {
            let truth = truths.iter().find(|(known, _)| known == name);
            truth.map(|(_, rates)| rates.words())
        });
        match found {
            Some(values) => Ok(self.stamped(values, "deg/h")),
            None => {
                let names = records.iter().map(|(known, _)| known.as_str());
                let truths = truths.iter().map(|(known, _)| known.as_str());
                Err(UnknownName::new("record", name, names.chain(truths)))
            }
        }
    }

    /// Readings of the table's encoder; none if the table has none.
    #[must_use]
    pub fn encoder(&self) -> Option<Samples<'_>> {
        let readings = self.results.simulation.encoder_rad.as_deref()?;
        Some(self.stamped(readings, "rad"))
    }

    /// Judged gates, in the order of the file.
    #[must_use]
    pub fn verdicts(&self) -> &[Verdict] {
        &self.results.verdicts
    }

    /// Whether every gate was accepted and no channel failed but those that a gate expects to.
    #[must_use]
    pub fn is_accepted(&self) -> bool {
        let verdicts = &self.results.verdicts;
        let mut channels = self.channels();
        verdicts.iter().all(|verdict| verdict.accepted)
            && channels
                .all(|(name, metrics)| metrics.error.is_none() || expects_failure(verdicts, name))
    }

    /// What the reader of the results must know: doubts of the plan, limits that the gyro reached.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.results.notes
    }

    /// What came of a calibration campaign; none without one.
    #[must_use]
    pub fn calibration(&self) -> Option<&CalibrationSheet> {
        self.results.calibration.as_ref()
    }

    /// Closed forms to draw beside the measured points; empty for a motion without one.
    #[must_use]
    pub fn theory(&self) -> &[TheoryCurve] {
        &self.results.theory
    }

    /// The true rates by name.
    fn truths(&self) -> Vec<(String, &RateRecord)> {
        let prefixes = self.plan.resolved().scenario.axis_prefixes();
        let truths = prefixes.iter().map(|prefix| format!("{prefix}truth"));
        let gyros = self.results.simulation.gyros.iter();
        truths
            .zip(gyros.map(|record| &record.truth_deg_per_h))
            .collect()
    }

    /// Every channel's words by name.
    fn records(&self) -> Vec<(String, &[f64])> {
        let scenario = &self.plan.resolved().scenario;
        let simulation = &self.results.simulation;
        let gyros = &simulation.gyros;
        let named = |names: Vec<String>, words: fn(&GyroRecord) -> Option<&[f64]>| {
            let records = names.into_iter().zip(gyros);
            records.filter_map(move |(name, record)| Some((name, words(record)?)))
        };
        let filters = simulation.filters.iter().filter_map(|(_, filter)| {
            let words = filter.words.as_ref().ok()?;
            Some((filter.name.clone(), words.output_deg_per_h.as_slice()))
        });
        named(scenario.raw_channels(), |record| {
            Some(&record.raw_deg_per_h)
        })
        .chain(named(scenario.compensated_channels(), |record| {
            record.compensated_deg_per_h.as_deref()
        }))
        .chain(filters)
        .collect()
    }

    fn stamped<'a>(&self, values: &'a [f64], unit: &'static str) -> Samples<'a> {
        let period_s = self.plan.sample_period_s();
        Samples {
            values,
            unit,
            period_s,
            warm_up: self.plan.record_length().warm_up,
        }
    }
}

impl Index<&str> for Run {
    type Output = ChannelMetrics;

    /// # Panics
    /// If there is no such channel; [`Run::channel`] says so without a panic.
    fn index(&self, name: &str) -> &ChannelMetrics {
        self.channel(name).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Equally spaced samples of one record, warm-up included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Samples<'a> {
    /// Values from the first sample of the warm-up on, in `unit`.
    pub values: &'a [f64],
    /// Unit of the values.
    pub unit: &'static str,
    /// Sample period, s.
    pub period_s: f64,
    /// Samples of the warm-up, which metrics leave out.
    pub warm_up: usize,
}

impl<'a> Samples<'a> {
    /// Samples that metrics use.
    #[must_use]
    pub fn measured(&self) -> &'a [f64] {
        self.values.get(self.warm_up..).unwrap_or_default()
    }

    /// Stamp of sample `index`, s from the start of the warm-up: the end of its interval.
    #[must_use]
    pub fn time_s(&self, index: usize) -> f64 {
        stamp_s(index as u64, self.period_s)
    }
}

/// A channel or record that the run does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {kind} `{name}`: there are {}", known.join(", "))]
#[non_exhaustive]
pub struct UnknownName {
    /// `channel` or `record`.
    pub kind: &'static str,
    /// The name that was asked for.
    pub name: String,
    /// The names there are.
    pub known: Vec<String>,
}

impl UnknownName {
    fn new<'a>(kind: &'static str, name: &str, known: impl Iterator<Item = &'a str>) -> Self {
        Self {
            kind,
            name: name.to_owned(),
            known: known.map(str::to_owned).collect(),
        }
    }
}
