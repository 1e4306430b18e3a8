//! What a report is made of, and how one run ended.

use std::collections::{BTreeMap, BTreeSet};

use crate::gate::{Verdict, VerdictKind, count_accepted, estimate_text, expects_failure};
use crate::metrics::{ChannelFailure, ChannelMetrics, Estimate, Metric, find};
use crate::report::record::columns::{DIGITS, heading_of, headline, unit_text, value_text};
use crate::report::record::sweep::{PointFigure, PointOfSweep, point_figures};
use crate::scenario::LogFacts;
use crate::scenario::{AssumedInShort, ReportedRuns, Scenario};
use crate::signal::{CalibrationSheet, CompensationSheet, GyroFacts, TheoryCurve};

/// Everything the report of one run shows.
#[derive(Clone, Debug)]
pub struct RunReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// The resolved scenario.
    pub scenario: &'a Scenario,
    /// Name of its file, without the folder.
    pub file: &'a str,
    /// Digest of the resolved scenario.
    pub digest: &'a str,
    /// Point of a sweep: its index and the keys it sets.
    pub sweep: Option<PointOfSweep>,
    /// Points of the sweep; none without one.
    pub points: usize,
    /// The gyro in closed form; none of a log.
    pub gyro: Option<&'a GyroFacts>,
    /// The log that takes the place of table and gyro.
    pub log: Option<&'a LogFacts>,
    /// What was taken out of the outputs, if anything was.
    pub compensation: Option<&'a CompensationSheet>,
    /// Lines of theory for the pictures.
    pub theory: &'a [TheoryCurve],
    /// Channels, `raw` first, then in the order of the file.
    pub channels: &'a [(String, ChannelMetrics)],
    /// What came of a calibration campaign.
    pub calibration: Option<&'a CalibrationSheet>,
    /// Judged gates, in the order of the file.
    pub verdicts: &'a [Verdict],
    /// Warnings for people, e.g. a filter that loses its digits.
    pub notes: &'a [String],
    /// What nobody set.
    pub assumed: AssumedInShort,
}

/// Most points of a sweep each of which gets a page, unless the scenario says otherwise.
const POINTS_SHOWN_MAX: usize = 100;

impl RunReport<'_> {
    /// The key that nobody set and that a metric only says again.
    #[must_use]
    pub(crate) fn assumption_behind(&self, metric: &str) -> Option<&'static str> {
        let key = find(metric)?.echoes?;
        self.assumed.names(key).then_some(key)
    }

    /// How the run ended.
    #[must_use]
    pub fn status(&self) -> RunStatus {
        let unexpected = |(name, metrics): &(String, ChannelMetrics)| {
            metrics.error.is_some() && !expects_failure(self.verdicts, name)
        };
        RunStatus::of_results(self.channels.iter().any(unexpected), self.verdicts)
    }
}

/// How a run ended, worst last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RunStatus {
    /// It ran and every gate was accepted.
    Pass,
    /// A gate was not accepted.
    GateFailed,
    /// A channel failed, and no gate expected it to.
    ChannelFailed,
    /// It has not run: the suite was stopped before its end.
    NotRun,
    /// The run itself could not finish.
    RunFailed,
}

impl RunStatus {
    /// How a run ended that has results.
    fn of_results(has_unexpected_failure: bool, verdicts: &[Verdict]) -> Self {
        if has_unexpected_failure {
            Self::ChannelFailed
        } else if count_accepted(verdicts) < verdicts.len() {
            Self::GateFailed
        } else {
            Self::Pass
        }
    }

    /// The word in files: `pass`, `gate_failed`, `channel_failed`, `not_run` or `run_failed`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::GateFailed => "gate_failed",
            Self::ChannelFailed => "channel_failed",
            Self::NotRun => "not_run",
            Self::RunFailed => "run_failed",
        }
    }
}

/// One channel, as the suite sees it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ChannelOutcome {
    /// Name.
    pub name: String,
    /// The figures that matter for this motion, formatted: title and value with unit.
    pub headline: Vec<(String, String)>,
    /// Why it failed, if it did.
    pub failure: Option<ChannelFailure>,
    /// Whether a gate on `<channel>.diverged_at_s` expects the failure.
    pub expected_failure: bool,
}

impl ChannelOutcome {
    /// Why it failed, in a sentence; none if it did not.
    pub(in crate::report) fn failure_text(&self) -> Option<String> {
        let failure = self.failure.as_ref()?;
        Some(format!(
            "channel {} failed at sample {}: {}",
            self.name, failure.sample, failure.message
        ))
    }
}

/// One run, as the suite sees it: small enough to keep for every run of a large sweep.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RunOutcome {
    /// Scenario name.
    pub name: String,
    /// Folder below the output folder, `/` between parts: `swing-5hz` or `power/0003`.
    pub folder: String,
    /// Name of the scenario file, without the folder.
    pub file: String,
    /// Point of a sweep: its index and the keys it sets.
    pub sweep: Option<PointOfSweep>,
    /// What the scenario says it is.
    pub description: Option<String>,
    /// Whether the folder has a page.
    pub has_page: bool,
    /// Channels, `raw` first.
    pub channels: Vec<ChannelOutcome>,
    /// Judged gates.
    pub verdicts: Vec<Verdict>,
    /// The one or two figures that its gates or published rows are about, in words: channel, heading and
    /// value with unit.
    pub figures: Vec<String>,
    /// Metrics that a table of the suite asks for, by channel and key.
    pub kept: Vec<(String, BTreeMap<String, Metric>)>,
    /// Headline metrics of a point of a sweep.
    pub swept: Vec<PointFigure>,
    /// Pictures in the folder of the run.
    pub pictures: Vec<String>,
    /// Why the run could not finish, if it could not.
    pub error: Option<String>,
    /// Whether the suite was stopped before the end of the run.
    pub is_not_run: bool,
}

impl RunOutcome {
    /// The outcome of a run that finished.
    #[must_use]
    pub fn from_report(report: &RunReport, folder: &str) -> Self {
        let expects = |channel: &str| expects_failure(report.verdicts, channel);
        let channels = report
            .channels
            .iter()
            .map(|(name, metrics)| ChannelOutcome {
                name: name.clone(),
                headline: headline(&report.scenario.measured_motion(), metrics),
                failure: metrics.error.clone(),
                expected_failure: metrics.error.is_some() && expects(name),
            })
            .collect();
        let outcome = Self {
            name: report.scenario.name.clone(),
            folder: folder.to_owned(),
            file: report.file.to_owned(),
            sweep: report.sweep.clone(),
            description: report.scenario.description.clone(),
            has_page: false,
            channels,
            verdicts: report.verdicts.to_vec(),
            figures: figures(report),
            kept: Vec::new(),
            swept: point_figures(report),
            pictures: Vec::new(),
            error: None,
            is_not_run: false,
        };
        let has_page = outcome.is_shown(report);
        Self {
            has_page,
            ..outcome
        }
    }

    /// Whether the run gets a page.
    fn is_shown(&self, report: &RunReport) -> bool {
        match report.scenario.output.report {
            Some(ReportedRuns::All) => true,
            None if report.points <= POINTS_SHOWN_MAX => true,
            _ => self.status() != RunStatus::Pass,
        }
    }

    /// The outcome of a run that could not finish.
    #[must_use]
    pub fn failed(name: &str, folder: &str, file: &str, error: String) -> Self {
        Self {
            name: name.to_owned(),
            folder: folder.to_owned(),
            file: file.to_owned(),
            sweep: None,
            description: None,
            has_page: false,
            channels: Vec::new(),
            verdicts: Vec::new(),
            figures: Vec::new(),
            kept: Vec::new(),
            swept: Vec::new(),
            pictures: Vec::new(),
            error: Some(error),
            is_not_run: false,
        }
    }

    /// The outcome of a run that a suite was stopped before or in the middle of.
    #[must_use]
    pub fn not_run(name: &str, folder: &str, file: &str) -> Self {
        Self {
            error: None,
            is_not_run: true,
            ..Self::failed(name, folder, file, String::new())
        }
    }

    /// The outcome of a run at a point of a sweep.
    #[must_use]
    pub fn at(self, sweep: Option<PointOfSweep>) -> Self {
        Self { sweep, ..self }
    }

    /// The outcome with the metrics `keys` of every channel that has one of them.
    #[must_use]
    pub fn keeping(mut self, report: &RunReport, keys: &BTreeSet<&str>) -> Self {
        let channels = report.channels.iter().map(|(name, metrics)| {
            let kept = metrics.metrics.iter();
            let kept = kept.filter(|(key, _)| keys.contains(key.as_str()));
            let kept = kept.map(|(key, metric)| (key.clone(), metric.clone()));
            (name.clone(), kept.collect::<BTreeMap<_, _>>())
        });
        self.kept = channels.filter(|(_, kept)| !kept.is_empty()).collect();
        self
    }

    /// Whether it ran to its end, so that its folder holds its result.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.error.is_none() && !self.is_not_run
    }

    /// How the run ended.
    #[must_use]
    pub fn status(&self) -> RunStatus {
        let unexpected =
            |channel: &ChannelOutcome| channel.failure.is_some() && !channel.expected_failure;
        if self.error.is_some() {
            RunStatus::RunFailed
        } else if self.is_not_run {
            RunStatus::NotRun
        } else {
            RunStatus::of_results(self.channels.iter().any(unexpected), &self.verdicts)
        }
    }

    /// Whether the run was not accepted; one that a stopped suite has not run is neither.
    #[must_use]
    pub fn has_failed(&self) -> bool {
        !matches!(self.status(), RunStatus::Pass | RunStatus::NotRun)
    }

    /// Number of gates with the verdict `kind`.
    #[must_use]
    pub fn count(&self, kind: VerdictKind) -> usize {
        self.verdicts
            .iter()
            .filter(|verdict| verdict.kind == kind)
            .count()
    }
}

/// Most figures that stand for a run in one line.
const FIGURES_MAX: usize = 2;

/// What the gates of a run judge, else what its publication prints, else the head of its last channel.
fn figures(report: &RunReport) -> Vec<String> {
    let judged = report.verdicts.iter().filter_map(judged_figure);
    let published = report.scenario.published.iter();
    let published = published.filter_map(|figure| {
        let (channel, key) = figure.metric.rsplit_once('.')?;
        let (_, metrics) = report.channels.iter().find(|(name, _)| name == channel)?;
        let metric = metrics.metrics.get(key)?;
        let value = format!("{} {}", value_text(metric), unit_text(metric));
        Some(format!(
            "{channel} {} {}",
            heading_of(key),
            value.trim_end()
        ))
    });
    let motion = report.scenario.measured_motion();
    let last = report.channels.iter().rev();
    let head = last.flat_map(|(name, metrics)| {
        let line = headline(&motion, metrics).into_iter().take(1);
        line.map(move |(title, value)| format!("{name} {title} {value}"))
    });
    let mut shown: Vec<String> = Vec::new();
    for figure in judged.chain(published).chain(head.take(1)) {
        if shown.len() < FIGURES_MAX && !shown.contains(&figure) {
            shown.push(figure);
        }
    }
    shown
}

/// Channel, heading, value and unit of what a gate judged; none where there was no value.
fn judged_figure(verdict: &Verdict) -> Option<String> {
    let value = verdict.value?;
    let estimate = match (verdict.low, verdict.high) {
        (Some(low), Some(high)) => Estimate::with_interval(value, low, high),
        _ => Estimate::exact(value),
    };
    let unit = if verdict.unit == "1" {
        ""
    } else {
        &verdict.unit
    };
    let (channel, key) = verdict.metric.rsplit_once('.')?;
    let over = verdict.relative_to.as_ref();
    let over = over.map_or_else(String::new, |other| format!(" / {other}"));
    let text = format!(
        "{channel}{over} {} {} {unit}",
        heading_of(key),
        estimate_text(&estimate, DIGITS)
    );
    Some(text.trim_end().to_owned())
}
