//! Sides of a comparison out of what stands on the disk.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde_json::Value;

use crate::baseline::{
    BaselineError, Entry, Id, Interval, Lack, Limits, Point, Side, point_of, read_baseline,
};
use crate::experiment::build::VERSION;
use crate::experiment::run::Run;
use crate::metrics::catalogue::ALLAN;
use crate::metrics::columns::allan as column;
use crate::metrics::{ChannelMetrics, IntervalKind, Metric, RepeatStatistics, find};
use crate::recording::read_stimulus;
use crate::report::{RestoredRun, RunStatus, SUITE_SUMMARY};
use crate::store::MANIFEST_FILE;

/// Why a side cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SideError {
    /// What the file system says.
    #[error("{}: {source}", path.display())]
    Unreadable {
        /// File or folder.
        path: PathBuf,
        /// What it says.
        source: io::Error,
    },
    /// A folder without results.
    #[error("{}: neither an output folder of `fogbench run` nor the folder of a run", .0.display())]
    NoResults(PathBuf),
    /// A result that is not as it was written.
    #[error("{}: not as `fogbench run` writes it", .0.display())]
    Damaged(PathBuf),
    /// A result that says nothing of its conditions.
    #[error("{}: written by a version that did not record the conditions of a run: run it again", .0.display())]
    NoConditions(PathBuf),
    /// A file that is no baseline.
    #[error("{}: {source}", path.display())]
    Baseline {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: BaselineError,
    },
}

impl SideError {
    /// Whether the file system is what failed.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. })
    }

    fn unreadable(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Unreadable {
            path: path.to_owned(),
            source,
        }
    }
}

/// The side that a path leads to: an output folder, the folder of a run, or a baseline.
///
/// # Errors
/// [`SideError`].
pub fn read_side(path: &Path) -> Result<Side, SideError> {
    let kind = fs::metadata(path).map_err(SideError::unreadable(path))?;
    if kind.is_dir() {
        read_output(path)
    } else {
        read_baseline_file(path)
    }
}

/// A baseline out of its file.
///
/// # Errors
/// [`SideError`].
pub fn read_baseline_file(path: &Path) -> Result<Side, SideError> {
    let text = fs::read_to_string(path).map_err(SideError::unreadable(path))?;
    read_baseline(&text).map_err(|source| SideError::Baseline {
        path: path.to_owned(),
        source,
    })
}

/// What the last suite wrote into an output folder, or a run into its own.
///
/// # Errors
/// [`SideError`].
pub fn read_output(folder: &Path) -> Result<Side, SideError> {
    let runs = if folder.join(MANIFEST_FILE).is_file() {
        vec![(folder.to_owned(), RunStatus::Pass.as_str().to_owned())]
    } else {
        runs_of_suite(folder)?
    };
    read_runs(&runs)
}

/// What stands in the folders of runs with these statuses.
///
/// # Errors
/// [`SideError`].
pub(super) fn read_runs(runs: &[(PathBuf, String)]) -> Result<Side, SideError> {
    let read = runs
        .par_iter()
        .map(|(folder, status)| read_run(folder, status));
    let mut side = Side::default();
    for run in read.collect::<Result<Vec<_>, _>>()? {
        side.tool_version.clone_from(&run.tool_version);
        side.entries.extend(run.entries);
        side.lacks.extend(run.lacks);
        side.limits.extend(run.limits);
        side.curves.extend(run.curves);
    }
    Ok(side)
}

/// Folder and status of every run of a suite.
fn runs_of_suite(folder: &Path) -> Result<Vec<(PathBuf, String)>, SideError> {
    let path = folder.join(SUITE_SUMMARY.name);
    let text = match fs::read_to_string(&path) {
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ) =>
        {
            return Err(SideError::NoResults(folder.to_owned()));
        }
        text => text.map_err(SideError::unreadable(&path))?,
    };
    let read = || {
        let root: Value = serde_json::from_str(&text).ok()?;
        let runs = root.get("runs")?.as_array()?.iter();
        let run = |run: &Value| {
            let text = |key: &str| run.get(key)?.as_str().map(str::to_owned);
            Some((folder.join(text("folder")?), text("status")?))
        };
        runs.map(run).collect::<Option<Vec<_>>>()
    };
    read().ok_or(SideError::Damaged(path))
}

/// The side of runs in memory, as of an output folder that holds them.
#[must_use]
pub fn side_of_runs(runs: &[Run]) -> Side {
    let mut side = Side {
        tool_version: VERSION.to_owned(),
        ..Side::default()
    };
    for run in runs {
        let resolved = run.plan().resolved();
        let assignments = resolved.sweep.iter().flat_map(|point| &point.assignments);
        let origin = Origin {
            tool_version: VERSION.to_owned(),
            scenario: resolved.scenario.name.clone(),
            point: point_of(assignments.map(|(key, value)| (key.as_str(), value.as_str()))),
            seed: resolved.scenario.seed,
            conditions: None,
            measured_part: 1.0,
            gates: Vec::new(),
        };
        let conditions = resolved.conditions();
        for (name, channel) in run.channels() {
            side.entries
                .extend(entries(&origin, &conditions, name, channel));
            side.lacks.extend(lacks(&origin, name, channel));
        }
    }
    side
}

/// What a manifest says of a run.
struct Origin {
    tool_version: String,
    scenario: String,
    point: Point,
    seed: u64,
    conditions: Option<String>,
    /// Part of the samples that lies behind the warm-up.
    measured_part: f64,
    /// Gates on figures that are not relative to another channel, by channel and metric.
    gates: Vec<((String, String), Limits)>,
}

impl Origin {
    fn of_manifest(text: &str) -> Option<Self> {
        let root: toml::Table = text.parse().ok()?;
        let number = |table: &toml::Value, key: &str| table.get(key)?.as_float();
        let text = |table: &toml::Value, key: &str| Some(table.get(key)?.as_str()?.to_owned());
        let (origin, scenario) = (root.get("origin")?, root.get("scenario")?);
        let sweep = origin
            .get("sweep")
            .and_then(|sweep| sweep.get("assignment"));
        let assignments = sweep.and_then(toml::Value::as_array).into_iter().flatten();
        let assignments = assignments.map(|it| Some((text(it, "key")?, text(it, "value")?)));
        let assignments: Vec<(String, String)> = assignments.collect::<Option<_>>()?;
        let assignments = assignments.iter();
        Some(Self {
            tool_version: text(root.get("tool")?, "version")?,
            scenario: text(scenario, "name")?,
            point: point_of(assignments.map(|(key, value)| (key.as_str(), value.as_str()))),
            seed: u64::try_from(scenario.get("seed")?.as_integer()?).ok()?,
            conditions: text(origin, "conditions"),
            measured_part: number(scenario, "duration_s")?
                / (number(scenario, "duration_s")? + number(scenario, "warm_up_s")?),
            gates: gates(scenario),
        })
    }

    fn id(&self, channel: &str, metric: &str) -> Id {
        Id {
            scenario: self.scenario.clone(),
            point: self.point.clone(),
            channel: channel.to_owned(),
            metric: metric.to_owned(),
        }
    }
}

/// Limits of the gates of a scenario, but of those relative to another channel.
fn gates(scenario: &toml::Value) -> Vec<((String, String), Limits)> {
    let gates = scenario.get("gate").and_then(toml::Value::as_array);
    let gates = gates.into_iter().flatten();
    let gates = gates.filter(|gate| gate.get("relative_to").is_none());
    let limits = gates.filter_map(|gate| {
        let (channel, metric) = gate.get("metric")?.as_str()?.split_once('.')?;
        let limit = |key: &str| gate.get(key).and_then(toml::Value::as_float);
        let limits = Limits {
            min: limit("min"),
            max: limit("max"),
        };
        Some(((channel.to_owned(), metric.to_owned()), limits))
    });
    limits.collect()
}

/// What stands in the folder of a run.
fn read_run(folder: &Path, status: &str) -> Result<Side, SideError> {
    let path = folder.join(MANIFEST_FILE);
    let has_ended = [RunStatus::NotRun, RunStatus::RunFailed]
        .iter()
        .all(|failed| failed.as_str() != status);
    let text = match fs::read_to_string(&path) {
        // A run that a stopped suite has not run need not have a folder.
        Err(_) if !has_ended => return Ok(Side::default()),
        text => text.map_err(SideError::unreadable(&path))?,
    };
    let Some(origin) = Origin::of_manifest(&text) else {
        return Err(SideError::Damaged(path));
    };
    let mut side = Side {
        tool_version: origin.tool_version.clone(),
        ..Side::default()
    };
    if !has_ended {
        let lack = Lack {
            reason: format!("the run has the status {status}"),
            is_failure: true,
        };
        side.lacks.insert(origin.id("", ""), lack);
        return Ok(side);
    }
    let Some(conditions) = &origin.conditions else {
        return Err(SideError::NoConditions(path));
    };
    let path = folder.join(SUITE_SUMMARY.name);
    let text = fs::read_to_string(&path).map_err(SideError::unreadable(&path))?;
    let Some(restored) = RestoredRun::of_summary(&text) else {
        return Err(SideError::Damaged(path));
    };
    let limits = origin.gates.iter();
    let limits = limits.map(|((channel, metric), limits)| (origin.id(channel, metric), *limits));
    side.limits.extend(limits);
    for (name, channel) in &restored.channels {
        if let Some(curve) = allan_curve(channel) {
            side.curves.insert(origin.id(name, ALLAN.name), curve);
        }
        let words = measured_words(folder, name, origin.measured_part);
        let own = entries(&origin, conditions, name, channel);
        side.entries.extend(own.map(|entry| match &words {
            Some(words) => with_blocks(entry, words),
            None => entry,
        }));
        side.lacks.extend(lacks(&origin, name, channel));
    }
    Ok(side)
}

/// Averaging times, s, and Allan deviations, deg/h.
fn allan_curve(channel: &ChannelMetrics) -> Option<Vec<(f64, f64)>> {
    let curve = channel.curve(&ALLAN)?;
    let times = column::TAU.get(curve)?.iter().copied();
    Some(
        times
            .zip(column::DEVIATION.get(curve)?.iter().copied())
            .collect(),
    )
}

/// Words of a channel behind the warm-up; none if the run kept no samples.
fn measured_words(folder: &Path, channel: &str, part: f64) -> Option<Vec<f64>> {
    let path = folder.join("samples").join(format!("{channel}.npy"));
    let words = path
        .is_file()
        .then(|| read_stimulus(&path, None, usize::MAX));
    let mut words = words?.ok()?;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a part of a count, which is positive and fits"
    )]
    let first = ((1.0 - part) * words.len() as f64).ceil() as usize;
    Some(words.split_off(first.min(words.len())))
}

/// Blocks of a record that are compared pair by pair.
const BLOCKS: usize = 20;

/// The entry with the figures of blocks, where these give its value within its interval.
fn with_blocks(entry: Entry, words: &[f64]) -> Entry {
    let of_blocks = find(&entry.id.metric).and_then(|key| key.of_blocks);
    let length = words.len() / BLOCKS;
    let Some(of_blocks) = of_blocks.filter(|_| length > 1 && entry.repeats.is_empty()) else {
        return entry;
    };
    let blocks = words.chunks_exact(length).take(BLOCKS);
    let blocks: Vec<f64> = blocks.map(|block| of_blocks.of(block)).collect();
    let whole = of_blocks.whole(&blocks);
    let is_given = match entry.interval {
        Interval::Confidence { low, high } => low <= whole && whole <= high,
        Interval::Exact | Interval::Absent => false,
    };
    Entry {
        blocks: if is_given { blocks } else { Vec::new() },
        ..entry
    }
}

fn entries<'a>(
    origin: &'a Origin,
    conditions: &'a str,
    name: &'a str,
    channel: &'a ChannelMetrics,
) -> impl Iterator<Item = Entry> + 'a {
    let finite = channel.metrics.iter();
    let finite = finite.filter(|(_, metric)| metric.estimate.value.is_finite());
    finite.map(move |(key, metric)| Entry {
        id: origin.id(name, key),
        value: metric.estimate.value,
        interval: interval(metric),
        degrees_of_freedom: metric.degrees_of_freedom(),
        unit: metric.unit.to_owned(),
        seed: origin.seed,
        conditions: conditions.to_owned(),
        repeats: channel
            .repeats
            .get(key)
            .map_or_else(Vec::new, finite_values),
        blocks: Vec::new(),
        better: None,
        absolute_tolerance: None,
        relative_tolerance: None,
    })
}

fn finite_values(statistics: &RepeatStatistics) -> Vec<f64> {
    let is_finite = statistics.values.iter().all(|value| value.is_finite());
    if is_finite {
        statistics.values.clone()
    } else {
        Vec::new()
    }
}

fn interval(metric: &Metric) -> Interval {
    let estimate = &metric.estimate;
    match estimate.interval {
        IntervalKind::Exact => Interval::Exact,
        IntervalKind::Confidence if estimate.low.is_finite() && estimate.high.is_finite() => {
            Interval::Confidence {
                low: estimate.low,
                high: estimate.high,
            }
        }
        IntervalKind::Confidence | IntervalKind::Absent(_) => Interval::Absent,
    }
}

fn lacks(origin: &Origin, name: &str, channel: &ChannelMetrics) -> BTreeMap<Id, Lack> {
    let unavailable = channel.unavailable.iter().map(|(key, reason)| {
        let lack = Lack {
            reason: reason.to_string(),
            is_failure: false,
        };
        (origin.id(name, key), lack)
    });
    let failed = channel.error.iter().map(|failure| {
        let lack = Lack {
            reason: format!("the channel failed: {}", failure.message),
            is_failure: true,
        };
        (origin.id(name, ""), lack)
    });
    unavailable.chain(failed).collect()
}
