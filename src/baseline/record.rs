//! What is compared: figures with what they are of.

use std::collections::BTreeMap;
use std::fmt;

use crate::metrics::Better;

/// Swept keys with their values in TOML; empty without a sweep. Points are the same by their values, not by
/// their place in the sweep.
pub type Point = BTreeMap<String, String>;

/// The point of these assignments, numbers in one spelling.
#[must_use]
pub fn point_of<'a>(assignments: impl IntoIterator<Item = (&'a str, &'a str)>) -> Point {
    let spelled = |value: &str| match value.parse::<f64>() {
        Ok(number) => format!("{number:?}"),
        Err(_) => value.to_owned(),
    };
    let assignments = assignments.into_iter();
    assignments
        .map(|(key, value)| (key.to_owned(), spelled(value)))
        .collect()
}

/// Which figure it is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Id {
    /// Name of the scenario.
    pub scenario: String,
    /// Point of its sweep.
    pub point: Point,
    /// Name of the channel; empty for a run as a whole.
    pub channel: String,
    /// Key of the metric; empty for a channel as a whole.
    pub metric: String,
}

impl Id {
    /// The run that it is of.
    pub(super) fn run(&self) -> (&str, &Point) {
        (&self.scenario, &self.point)
    }

    /// The run in words: `power` or `power(gyro.source.power_uw = 0.5)`.
    #[must_use]
    pub fn run_text(&self) -> String {
        if self.point.is_empty() {
            return self.scenario.clone();
        }
        let assignments = self.point.iter();
        let assignments = assignments.map(|(key, value)| format!("{key} = {value}"));
        format!(
            "{}({})",
            self.scenario,
            assignments.collect::<Vec<_>>().join(", ")
        )
    }
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}.{}", self.run_text(), self.channel, self.metric)
    }
}

/// How sure a figure is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interval {
    /// Ends of the 95 % interval for the mean over seeds.
    Confidence {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// No noise moves the value, or it is a fact of its record.
    Exact,
    /// One record does not tell.
    Absent,
}

/// A figure of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Which it is.
    pub id: Id,
    /// Its value.
    pub value: f64,
    /// How sure it is.
    pub interval: Interval,
    /// Degrees of freedom, for a standard deviation of independent values.
    pub degrees_of_freedom: Option<f64>,
    /// Unit as printed; `1` for a ratio.
    pub unit: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Digest of the conditions of the run.
    pub conditions: String,
    /// Values of the repeats, in order; empty for a single record.
    pub repeats: Vec<f64>,
    /// Values of equal blocks of its samples, in order; empty where there are no samples, or where blocks do
    /// not give the value.
    pub blocks: Vec<f64>,
    /// The better direction, where a file gives it.
    pub better: Option<Better>,
    /// Difference that counts for none, in the unit, where a file gives it.
    pub absolute_tolerance: Option<f64>,
    /// The same as a part of the earlier value.
    pub relative_tolerance: Option<f64>,
}

/// Why a side lacks a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Lack {
    /// The reason.
    pub reason: String,
    /// Whether a run or channel failed, so that what it had before is lost.
    pub is_failure: bool,
}

/// Limits of a gate, in the unit of its metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least accepted value.
    pub min: Option<f64>,
    /// Largest accepted value.
    pub max: Option<f64>,
}

/// One side of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Side {
    /// Version of the tool.
    pub tool_version: String,
    /// Its figures.
    pub entries: Vec<Entry>,
    /// Why others are not there: of a metric, of a whole channel, of a whole run.
    pub lacks: BTreeMap<Id, Lack>,
    /// Gates on figures of its own, which pictures show them against; none in a baseline.
    pub limits: BTreeMap<Id, Limits>,
    /// Curves that pictures lay over each other: averaging time, s, and Allan deviation, deg/h; none in a
    /// baseline.
    pub curves: BTreeMap<Id, Vec<(f64, f64)>>,
}

impl Side {
    /// Why it lacks a figure, if it says so.
    pub(super) fn lack_of(&self, id: &Id) -> Option<&Lack> {
        let channel = Id {
            metric: String::new(),
            ..id.clone()
        };
        let run = Id {
            channel: String::new(),
            ..channel.clone()
        };
        let mut all = [id, &channel, &run].into_iter();
        all.find_map(|id| self.lacks.get(id))
    }

    /// Whether it holds anything of a channel.
    pub(super) fn has_channel(&self, id: &Id) -> bool {
        let mut entries = self.entries.iter();
        entries.any(|entry| entry.id.run() == id.run() && entry.id.channel == id.channel)
    }

    /// The side without scenarios that `holds` does not name.
    #[must_use]
    pub fn of_scenarios(mut self, holds: impl Fn(&str, &Point) -> bool) -> Self {
        self.entries
            .retain(|entry| holds(&entry.id.scenario, &entry.id.point));
        self.lacks.retain(|id, _| holds(&id.scenario, &id.point));
        self.limits.retain(|id, _| holds(&id.scenario, &id.point));
        self.curves.retain(|id, _| holds(&id.scenario, &id.point));
        self
    }
}

#[cfg(test)]
impl Entry {
    /// A figure of raw without noise, for tests.
    pub(super) fn of_test(scenario: &str, metric: &str, value: f64) -> Self {
        Self {
            id: Id {
                scenario: scenario.to_owned(),
                point: Point::new(),
                channel: "raw".to_owned(),
                metric: metric.to_owned(),
            },
            value,
            interval: Interval::Exact,
            degrees_of_freedom: None,
            unit: "deg/h".to_owned(),
            seed: 1,
            conditions: "c".to_owned(),
            repeats: Vec::new(),
            blocks: Vec::new(),
            better: None,
            absolute_tolerance: None,
            relative_tolerance: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_the_same_by_their_values_however_they_are_spelled() {
        let one = point_of([("b", "0.50"), ("a", "\"x\"")]);
        let other = point_of([("a", "\"x\""), ("b", "5e-1")]);
        assert_eq!(one, other);
        assert_ne!(one, point_of([("a", "\"x\""), ("b", "0.25")]));
        assert_eq!(point_of([("n", "3")]), point_of([("n", "3.0")]));
    }
}
