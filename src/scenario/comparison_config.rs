//! Tables over several scenarios, and what a publication leaves open.

use serde::Deserialize;

/// A table that closes the suite.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparisonConfig {
    /// Name, as a publication calls it.
    pub name: String,
    /// What it compares.
    pub title: String,
    /// What it is for.
    pub kind: ComparisonKind,
    /// `<channel>.<metric>`, or `<channel>.<metric> / <channel>`.
    pub columns: Vec<String>,
    /// Key of the scenarios per unit of which the columns' largest changes close the table.
    pub per_change_of: Option<String>,
}

/// What a table is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComparisonKind {
    /// Simulated against published figures.
    Published,
    /// How results move with an assumption.
    Sensitivity,
}

/// A row of such a table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparisonRowConfig {
    /// Name of the table.
    pub comparison: String,
    /// What the row stands for.
    pub label: String,
    /// Scenarios whose metrics fill it, in order of preference.
    pub scenarios: Vec<String>,
}

/// What a publication leaves open.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AssumptionConfig {
    /// Key of the scenario that settles it.
    pub key: String,
    /// How it is read.
    pub statement: String,
    /// Value of the key for which the statement holds, as TOML writes it.
    pub reading: Option<String>,
    /// Where the publication is silent.
    pub silence: String,
    /// Other readings.
    pub alternatives: String,
    /// Table that shows how results move with it.
    pub comparison: Option<String>,
}

/// A published figure that is drawn again.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FigureConfig {
    /// Name.
    pub name: String,
    /// Scenario that draws it.
    pub scenario: String,
    /// File in the scenario's folder.
    pub file: String,
    /// What it shows.
    pub shows: String,
}

/// A column of a table, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComparisonColumn<'a> {
    /// Channel.
    pub channel: &'a str,
    /// Metric key.
    pub metric: &'a str,
    /// Channel whose same metric divides this one.
    pub relative_to: Option<&'a str>,
}

impl<'a> ComparisonColumn<'a> {
    /// Takes `<channel>.<metric>` or `<channel>.<metric> / <channel>` apart; `None` if it is
    /// neither.
    #[must_use]
    pub fn parse(text: &'a str) -> Option<Self> {
        let (left, relative_to) = match text.split_once('/') {
            Some((left, right)) => (left.trim(), Some(right.trim())),
            None => (text.trim(), None),
        };
        let (channel, metric) = left.rsplit_once('.')?;
        let is_whole = !channel.is_empty() && !metric.is_empty();
        let is_named =
            relative_to.is_none_or(|name| !name.is_empty() && !name.contains(['/', '.']));
        (is_whole && is_named).then_some(Self {
            channel,
            metric,
            relative_to,
        })
    }
}
