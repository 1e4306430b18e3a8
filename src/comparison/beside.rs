//! Filters side by side: the runs of a suite that try the same filters, whatever the table does in each.

use std::collections::BTreeMap;

use crate::metrics::catalogue::{
    LOOK_AHEAD, MEMORY_1_PERCENT, NOISE_AT_EQUAL_DELAY, OPERATIONS_PER_WORD,
};
use crate::metrics::{ChannelMetrics, Estimate, Finding, Metric, MetricKey, filter_verdict};
use crate::scenario::{MotionConfig, Scenario};

/// Runs of the same filters on words of the same rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The runs, in the order of the suite.
    pub runs: Vec<BesideRun>,
    /// The filters, in the order of their files.
    pub filters: Vec<BesideFilter>,
}

/// One run of them.
#[derive(Clone, Debug, PartialEq)]
pub struct BesideRun {
    /// Folder below the output folder.
    pub folder: String,
    /// What the scenario says it is.
    pub description: Option<String>,
    /// What the table does.
    pub motion: MotionConfig,
    /// Metrics by channel, of `raw` and of the filters.
    pub channels: Vec<(String, ChannelMetrics)>,
}

/// One filter over all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct BesideFilter {
    /// Name of the channel.
    pub name: String,
    /// Least DC gain of all runs.
    pub dc_gain: Option<Finding>,
    /// Longest look-ahead of all runs, in samples.
    pub look_ahead_samples: Option<Metric>,
    /// Longest memory to 1 % of all runs, s.
    pub memory_s: Option<Metric>,
    /// Noise at equal delay, by run.
    pub noise: Vec<Option<Estimate>>,
    /// Operations for a word.
    pub operations: Option<Metric>,
}

/// A run of the suite, as the table sees it.
pub(super) struct Standing<'a> {
    /// Its scenario.
    pub(super) scenario: &'a Scenario,
    /// Folder below the output folder.
    pub(super) folder: &'a str,
    /// Its metrics, by channel and key.
    pub(super) kept: &'a [(String, BTreeMap<String, Metric>)],
}

/// Whether a run of the scenario stands side by side with others: twins tell of two filters or more.
pub(super) fn stands(scenario: &Scenario) -> bool {
    scenario.trial.black_box.is_some() && scenario.filters.len() > 1
}

/// The runs that try the same filters, each set once, in the order of the suite.
pub(super) fn beside(suite: &[Standing]) -> Vec<Beside> {
    let mut sets: Vec<Vec<&Standing>> = Vec::new();
    for run in suite.iter().filter(|run| stands(run.scenario)) {
        let own = run.scenario;
        let is_same = |set: &&mut Vec<&Standing>| {
            let first = set[0].scenario;
            first.filters == own.filters && first.gyro.output == own.gyro.output
        };
        match sets.iter_mut().find(is_same) {
            Some(set) => set.push(run),
            None => sets.push(vec![run]),
        }
    }
    let sets = sets.into_iter().map(|set| of_runs(&set));
    sets.filter(|set| set.filters.iter().any(BesideFilter::is_told))
        .collect()
}

fn of_runs(set: &[&Standing]) -> Beside {
    let runs: Vec<BesideRun> = set.iter().map(|run| of_run(run)).collect();
    let filters = set[0].scenario.filters.iter();
    let filters = filters.map(|filter| BesideFilter::of(&filter.name, &runs));
    Beside {
        filters: filters.collect(),
        runs,
    }
}

fn of_run(run: &Standing) -> BesideRun {
    let scenario = run.scenario;
    let channels = run.kept.iter().map(|(name, kept)| {
        let metrics = ChannelMetrics {
            metrics: kept.clone(),
            ..ChannelMetrics::default()
        };
        (name.clone(), metrics)
    });
    let by_name: BTreeMap<String, ChannelMetrics> = channels.collect();
    let names = scenario.filters.iter().map(|filter| filter.name.as_str());
    let names = std::iter::once("raw").chain(names);
    BesideRun {
        folder: run.folder.to_owned(),
        description: scenario.description.clone(),
        motion: scenario.measured_motion().into_owned(),
        channels: names
            .map(|name| {
                (
                    name.to_owned(),
                    by_name.get(name).cloned().unwrap_or_default(),
                )
            })
            .collect(),
    }
}

impl BesideFilter {
    fn of(name: &str, runs: &[BesideRun]) -> Self {
        let own: Vec<&ChannelMetrics> = runs
            .iter()
            .flat_map(|run| run.channels.iter().filter(|(channel, _)| channel == name))
            .map(|(_, metrics)| metrics)
            .collect();
        let gains = own
            .iter()
            .filter_map(|metrics| filter_verdict(metrics)?.dc_gain);
        let least = gains.min_by(|one, other| one.estimate.high.total_cmp(&other.estimate.high));
        let most = |key: &MetricKey| {
            let all = own.iter().filter_map(|metrics| metrics.get(key));
            let most = all.max_by(|one, other| one.estimate.value.total_cmp(&other.estimate.value));
            most.cloned()
        };
        let noise = |metrics: &&ChannelMetrics| Some(metrics.get(&NOISE_AT_EQUAL_DELAY)?.estimate);
        Self {
            name: name.to_owned(),
            dc_gain: least,
            look_ahead_samples: most(&LOOK_AHEAD),
            memory_s: most(&MEMORY_1_PERCENT),
            noise: own.iter().map(noise).collect(),
            operations: most(&OPERATIONS_PER_WORD),
        }
    }

    /// Whether any run tells something of it.
    fn is_told(&self) -> bool {
        self.dc_gain.is_some() || self.look_ahead_samples.is_some()
    }
}
