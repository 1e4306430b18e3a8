//! Metrics that gates, published figures and tables ask for: their names, and whether a record can
//! ever have them.

use super::checker::Checker;
use super::published::wrong_unit;
use crate::experiment::black_box;
use crate::experiment::campaign;
use crate::experiment::pipeline_metrics;
use crate::experiment::run::{assembly_motion, motion, sample_period_s};
use crate::metrics::catalogue::DIVERGED_AT;
use crate::metrics::{self, MetricKey, Unavailable};
use crate::recording::{LogFormat, LogMotion};
use crate::scenario::{ComparisonColumn, Scenario};

/// A metric that a scenario asks for.
struct Requested<'a> {
    /// The key that asks.
    key: String,
    channel: &'a str,
    metric: &'a str,
    /// Whether it only stands beside a published figure, which nothing is judged by.
    is_shown_only: bool,
}

impl Checker<'_> {
    /// Refuses metrics without a channel, and names that are no metrics, in tables as well.
    pub(crate) fn names(&mut self) {
        self.columns();
        let scenario = &self.resolved.scenario;
        let gates = scenario.gates.iter().map(|gate| &gate.metric);
        let gates = gates
            .enumerate()
            .map(|(index, metric)| ("gate", index, metric));
        let published = scenario.published.iter().map(|figure| &figure.metric);
        let published = published
            .enumerate()
            .map(|(index, metric)| ("published", index, metric));
        for (table, index, written) in gates.chain(published) {
            let key = format!("{table}[{index}].metric");
            match written.rsplit_once('.') {
                Some((channel, name)) if !channel.is_empty() && !name.is_empty() => {
                    let is_campaign = campaign::estimator_of(scenario, channel).is_some();
                    let is_filter = !scenario.raw_channels().iter().any(|raw| raw == channel);
                    if let Some(complaint) = metrics::unknown_of_channel(name, is_filter)
                        && !is_campaign
                    {
                        self.complain(&key, format!("{key}: {channel}.{name}: {complaint}"));
                    }
                }
                _ => {
                    let message = self.without_channel(&key, written);
                    self.complain(&key, message);
                }
            }
        }
    }

    /// Refuses columns of tables that are no metrics.
    fn columns(&mut self) {
        let scenario = &self.resolved.scenario;
        for (index, comparison) in scenario.comparisons.iter().enumerate() {
            let columns = comparison.columns.iter();
            for column in columns.filter_map(|text| ComparisonColumn::parse(text)) {
                if let Some(complaint) = metrics::unknown(column.metric) {
                    let key = format!("comparison[{index}].columns");
                    self.complain(&key, format!("{key}: {complaint}"));
                }
            }
        }
    }

    /// The complaint about a metric without a channel, with a channel that has it.
    fn without_channel(&self, key: &str, written: &str) -> String {
        let scenario = &self.resolved.scenario;
        let name = written.trim_matches('.');
        let known = metrics::find(name).or_else(|| metrics::meant(name));
        let filter = || scenario.filters.first();
        let as_in = match known {
            Some(metric) if metric.applies == metrics::Applies::Calibration => {
                let channels = scenario.calibration_channels();
                channels
                    .first()
                    .map(|channel| format!("{channel}.{}", metric.name))
            }
            Some(metric) if metric.filters_only => {
                let prefix = scenario.axis_prefixes()[0];
                filter().map(|filter| format!("{prefix}{}.{}", filter.name, metric.name))
            }
            Some(metric) => {
                let raw = scenario.raw_channels();
                raw.first()
                    .map(|channel| format!("{channel}.{}", metric.name))
            }
            None => None,
        };
        let as_in = as_in.unwrap_or_else(|| "raw.angle_random_walk_deg_per_sqrt_h".to_owned());
        format!(
            "{key} = \"{written}\" names no channel: expected <channel>.<metric>, as in {as_in}"
        )
    }

    /// Refuses gates that this record can never support, and says so of published figures.
    pub(crate) fn metrics(&mut self) {
        let scenario = &self.resolved.scenario;
        let sample_period_s = sample_period_s(self.resolved);
        let log = self.resolved.log.as_ref();
        let has_truth = log.is_none_or(|log| log.has_truth);
        let motion = motion(scenario, sample_period_s);
        for (index, figure) in scenario.published.iter().enumerate() {
            if let Some((_, metric)) = figure.metric.rsplit_once('.')
                && let Some((key, message)) = wrong_unit(index, metric, figure)
            {
                self.complain(&key, message);
            }
        }
        for Requested {
            key,
            channel,
            metric: name,
            is_shown_only,
        } in requested(scenario)
        {
            // The divergence of a channel may be what the gate expects.
            if name == DIVERGED_AT.name {
                continue;
            }
            if let Some(estimator) = campaign::estimator_of(scenario, channel) {
                if let Err(reason) = campaign::supports(estimator, name) {
                    self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
                }
                continue;
            }
            // A name that is no metric is refused above.
            let Some(known) = metrics::find(name) else {
                continue;
            };
            let supported = match &scenario.log {
                Some(log) if is_told_by_log(log, known) => of_log(log, known),
                _ => metrics::support(
                    name,
                    scenario.duration_s,
                    sample_period_s,
                    &motion,
                    !scenario.is_unfiltered(channel),
                    scenario.bias_averaging_time_s,
                ),
            };
            let lack = || {
                lacks(scenario, channel, known).or_else(|| {
                    let is_filter = !scenario.is_unfiltered(channel);
                    let lack = metrics::truth_lack(known, has_truth, is_filter);
                    lack.map(Unavailable::from)
                })
            };
            match supported.err().or_else(lack) {
                Some(reason) if is_shown_only => {
                    let warning =
                        format!("{key}: nothing is simulated beside {channel}.{name}: {reason}");
                    self.warnings.push(warning);
                }
                Some(reason) => {
                    self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
                }
                None => {}
            }
        }
    }
}

/// Whether it is the log that tells whether it has a metric: one of logs, or of dwells that are found in it.
fn is_told_by_log(log: &LogFormat, key: &MetricKey) -> bool {
    let has_dwells = log.motion == Some(LogMotion::Dwells);
    key.applies == metrics::Applies::Log || (has_dwells && key.applies == metrics::Applies::Steps)
}

/// Whether a log, by what is said of it, can have a metric of logs.
fn of_log(log: &LogFormat, key: &MetricKey) -> Result<(), Unavailable> {
    if metrics::TEMPERATURE_METRICS.contains(&key) && log.temperature_column.is_none() {
        return Err("it takes a column of the temperature: log.temperature_column names it".into());
    }
    Ok(())
}

/// Every metric that gates and published figures ask for.
fn requested(scenario: &Scenario) -> Vec<Requested<'_>> {
    let mut requested = Vec::new();
    for (index, gate) in scenario.gates.iter().enumerate() {
        let Some((channel, metric)) = gate.metric.rsplit_once('.') else {
            continue;
        };
        let mut ask = |key: &str, channel| {
            requested.push(Requested {
                key: format!("gate[{index}].{key}"),
                channel,
                metric,
                is_shown_only: false,
            });
        };
        ask("metric", channel);
        if let Some(reference) = &gate.relative_to {
            ask("relative_to", reference);
        }
    }
    for (index, figure) in scenario.published.iter().enumerate() {
        if let Some((channel, metric)) = figure.metric.rsplit_once('.') {
            requested.push(Requested {
                key: format!("published[{index}].metric"),
                channel,
                metric,
                is_shown_only: true,
            });
            if let Some(reference) = &figure.relative_to {
                requested.push(Requested {
                    key: format!("published[{index}].relative_to"),
                    channel: reference,
                    metric,
                    is_shown_only: true,
                });
            }
        }
    }
    requested
}

/// Why a channel of this scenario can never have a metric, whatever the length of its record.
fn lacks(scenario: &Scenario, channel: &str, key: &MetricKey) -> Option<Unavailable> {
    let has_encoder = scenario.turntable.encoder.resolution_arcsec.is_some();
    let repeats = usize::try_from(scenario.repeats).unwrap_or(usize::MAX);
    pipeline_metrics::lacks(scenario, channel, key)
        .or_else(|| black_box::lacks(scenario, key))
        .or_else(|| assembly_motion::lacks(scenario, channel, key))
        .or_else(|| campaign::lacks(scenario, key))
        .or_else(|| metrics::encoder_lack(key, has_encoder))
        .map(Unavailable::from)
        .or_else(|| metrics::repeats_lack(key, repeats))
}
