//! `metrics.csv`: one row for each run, point, channel and metric, as RFC 4180 has it with plain line
//! feeds.
//!
//! The file of a suite is made of those of its runs, one after the other, so that a sweep of any size
//! takes the memory of one run.

use std::collections::BTreeSet;

use crate::metrics::{ChannelMetrics, Metric, find};
use crate::report::layout::csv::push_row;
use crate::report::record::sweep::{PointOfSweep, swept_text};
use crate::report::{RunOutcome, RunReport, RunStatus};

/// Columns before those of the swept keys.
const COLUMNS: [&str; 10] = [
    "scenario",
    "point",
    "channel",
    "metric",
    "value",
    "low",
    "high",
    "confidence",
    "unit",
    "status",
];

const OK: &str = "ok";
const UNAVAILABLE: &str = "unavailable";
const FAILED: &str = "failed";
const NOT_RUN: &str = "not_run";

/// `metrics.csv` of a run.
#[must_use]
pub(in crate::report) fn metrics_csv(report: &RunReport) -> String {
    let (sweep, name) = (report.sweep.as_ref(), report.scenario.name.as_str());
    let keys = swept_keys([sweep]);
    let mut text = head(&keys);
    let of_channel = |(_, channel): &'_ (String, ChannelMetrics)| {
        let missing = channel.unavailable.keys().cloned();
        let all: Vec<String> = channel.metrics.keys().cloned().chain(missing).collect();
        all
    };
    let of_all: BTreeSet<String> = report.channels.iter().flat_map(of_channel).collect();
    for (channel_name, channel) in report.channels {
        for metric_name in &of_all {
            let cells = match (channel.metrics.get(metric_name), &channel.error) {
                (Some(metric), _) => measured(metric),
                // What the other channels have, this one failed to give.
                (None, Some(_)) => lacking(metric_name, FAILED),
                (None, None) if channel.unavailable.contains_key(metric_name) => {
                    lacking(metric_name, UNAVAILABLE)
                }
                (None, None) => None,
            };
            if let Some(cells) = cells {
                let first = [channel_name.clone(), metric_name.clone()];
                let first = start(name, sweep).into_iter().chain(first);
                push_row(&mut text, first.chain(cells).chain(swept(&keys, sweep)));
            }
        }
    }
    text
}

/// Cells of a metric from `value` to `status`.
fn measured(metric: &Metric) -> Option<[String; 6]> {
    let estimate = &metric.estimate;
    let number = |value: f64| Some(format!("{value:?}")).filter(|_| value.is_finite());
    let value = number(estimate.value)?;
    // An exact value is its own interval; a value without one has no ends.
    let is_bare = matches!(estimate.interval, crate::metrics::IntervalKind::Absent(_));
    let end = |end: f64| number(end).filter(|_| !is_bare).unwrap_or_default();
    Some([
        value,
        end(estimate.low),
        end(estimate.high),
        end(estimate.confidence),
        metric.unit.to_owned(),
        OK.to_owned(),
    ])
}

/// The same of a metric that is missing; none for what is no metric, as a curve.
fn lacking(name: &str, status: &str) -> Option<[String; 6]> {
    let unit = find(name)?.unit.to_owned();
    let [value, low, high, confidence] = [const { String::new() }; 4];
    Some([value, low, high, confidence, unit, status.to_owned()])
}

/// The row of a run that has no metrics: it failed, or was stopped.
fn row_without_metrics(run: &RunOutcome, keys: &[String]) -> String {
    let status = match run.status() {
        RunStatus::NotRun => NOT_RUN,
        _ => FAILED,
    };
    let cells = [const { String::new() }; 7].into_iter();
    let cells = cells.chain([status.to_owned()]);
    let sweep = run.sweep.as_ref();
    let mut text = String::new();
    let first = start(&run.name, sweep).into_iter();
    push_row(&mut text, first.chain(cells).chain(swept(keys, sweep)));
    text
}

/// Scenario and point.
fn start(name: &str, sweep: Option<&PointOfSweep>) -> [String; 2] {
    let point = sweep.map_or_else(String::new, |(index, _)| index.to_string());
    [name.to_owned(), point]
}

/// Cells of the swept keys; empty where the run does not set one.
fn swept<'a>(
    keys: &'a [String],
    sweep: Option<&'a PointOfSweep>,
) -> impl Iterator<Item = String> + 'a {
    keys.iter().map(move |key| {
        let mut set = sweep.iter().flat_map(|(_, assignments)| assignments);
        let value = set.find(|(set, _)| set == key);
        value.map_or_else(String::new, |(_, toml)| swept_text(toml))
    })
}

/// Keys that points set, in the order in which they first appear.
fn swept_keys<'a>(points: impl IntoIterator<Item = Option<&'a PointOfSweep>>) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for (key, _) in points.into_iter().flatten().flat_map(|(_, set)| set) {
        if !keys.contains(key) {
            keys.push(key.clone());
        }
    }
    keys
}

fn head(keys: &[String]) -> String {
    let mut text = String::new();
    let columns = COLUMNS.iter().map(|column| (*column).to_owned());
    push_row(&mut text, columns.chain(keys.iter().cloned()));
    text
}

/// Rows of a text, the head among them.
fn rows(text: &str) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let (mut cells, mut cell) = (Vec::new(), String::new());
    let mut is_quoted = false;
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cell.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
            '\n' if !is_quoted => {
                cells.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut cells));
            }
            other => cell.push(other),
        }
    }
    rows
}

/// `metrics.csv` of a suite, run by run.
#[derive(Debug)]
pub struct SuiteMetrics {
    keys: Vec<String>,
}

impl SuiteMetrics {
    /// The file of these runs.
    #[must_use]
    pub fn of(runs: &[RunOutcome]) -> Self {
        Self {
            keys: swept_keys(runs.iter().map(|run| run.sweep.as_ref())),
        }
    }

    /// First line.
    #[must_use]
    pub fn head(&self) -> String {
        head(&self.keys)
    }

    /// Lines of a run.
    ///
    /// * `own`: its own `metrics.csv`; none if it failed or was stopped.
    #[must_use]
    pub fn rows(&self, run: &RunOutcome, own: Option<&str>) -> String {
        let Some(own) = own else {
            return row_without_metrics(run, &self.keys);
        };
        let sweep = run.sweep.as_ref();
        let keys = swept_keys([sweep]);
        if keys == self.keys {
            return own.split_once('\n').map_or("", |(_, rest)| rest).to_owned();
        }
        let mut text = String::new();
        for cells in rows(own).into_iter().skip(1) {
            let first = cells.into_iter().take(COLUMNS.len());
            push_row(&mut text, first.chain(swept(&self.keys, sweep)));
        }
        text
    }
}

/// A row of a run's own file that has a value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::report) struct MetricRow {
    pub(in crate::report) channel: String,
    pub(in crate::report) metric: String,
    pub(in crate::report) value: f64,
    /// Ends and confidence of the interval; none where there is no interval.
    pub(in crate::report) interval: Option<[f64; 3]>,
    pub(in crate::report) unit: String,
}

/// The rows of a run's own file that have a value.
pub(in crate::report) fn metric_rows(own: &str) -> Vec<MetricRow> {
    let read = |cells: Vec<String>| {
        let number = |place: usize| cells.get(place)?.parse::<f64>().ok();
        Some(MetricRow {
            channel: cells.get(2)?.clone(),
            metric: cells.get(3)?.clone(),
            value: number(4)?,
            interval: (|| Some([number(5)?, number(6)?, number(7)?]))(),
            unit: cells.get(8)?.clone(),
        })
    };
    rows(own).into_iter().skip(1).filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;
    use crate::metrics::catalogue::BIAS_INSTABILITY;

    fn run(name: &str, sweep: Option<PointOfSweep>) -> RunOutcome {
        RunOutcome {
            sweep,
            ..RunOutcome::not_run(name, name, "a.toml")
        }
    }

    #[test]
    fn cells_come_back_as_they_were() {
        let cells = ["plain", "a,b", "say \"so\"", "two\nlines", ""].map(str::to_owned);
        let mut text = String::new();
        push_row(&mut text, cells.clone());
        push_row(&mut text, cells.clone());
        assert_eq!(rows(&text), [cells.to_vec(), cells.to_vec()]);
    }

    #[test]
    fn a_suite_has_a_column_for_every_key_that_one_of_its_sweeps_sets() {
        let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let runs = [
            run("a", Some((0, vec![set("p", "1.0")]))),
            run("b", Some((3, vec![set("q", "\"x,y\""), set("p", "2.0")]))),
            run("c", None),
        ];
        let suite = SuiteMetrics::of(&runs);
        assert!(suite.head().ends_with(",unit,status,p,q\n"));
        let own = format!("{}a,0,raw,m,1.0,,,,s,ok,1.0\n", head(&["p".to_owned()]));
        assert_eq!(
            suite.rows(&runs[0], Some(&own)),
            "a,0,raw,m,1.0,,,,s,ok,1.0,\n"
        );
        assert_eq!(
            suite.rows(&runs[1], None),
            "b,3,,,,,,,,not_run,2.0,\"x,y\"\n"
        );
        assert_eq!(suite.rows(&runs[2], None), "c,,,,,,,,,not_run,,\n");
    }

    #[test]
    fn a_value_without_an_interval_has_no_ends() {
        let metric = |estimate| Metric::new(estimate, "deg/h");
        let cells = |metric| measured(&metric).expect("finite").join(",");
        let bare = Estimate::without_interval(2.0, "one record gives none");
        assert_eq!(cells(metric(bare)), "2.0,,,,deg/h,ok");
        assert_eq!(
            cells(metric(Estimate::with_interval(2.0, 1.0, 3.0))),
            "2.0,1.0,3.0,0.95,deg/h,ok"
        );
        assert_eq!(measured(&metric(Estimate::exact(f64::NAN))), None);
    }

    #[test]
    fn what_is_missing_keeps_its_unit_and_says_why() {
        let name = BIAS_INSTABILITY.name;
        let cells = lacking(name, UNAVAILABLE).expect("a metric").join(",");
        assert_eq!(cells, format!(",,,,{},unavailable", BIAS_INSTABILITY.unit));
        assert_eq!(lacking("curves.allan", UNAVAILABLE), None);
    }
}
