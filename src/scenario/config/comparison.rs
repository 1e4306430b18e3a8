//! Tables over several scenarios, and what a publication leaves open.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Tables over several scenarios: printed at the end of the suite, beside the published figures of
    /// the scenarios that they name, with what a publication leaves open and how results move with it.
    /// They stand in a base that the scenarios extend; cells of scenarios that did not run are left out.
    /// None by default.
    pub struct ComparisonConfig {
        /// Name of a table that closes the suite, as a publication calls it.
        name: String, example "Table 2";
        /// What it compares, one line.
        title: String, example "static tests";
        /// Whether it holds simulated against published figures, or how results move.
        kind: ComparisonKind = "published";
        /// Channel and metric, split at the last dot; behind a slash the channel that divides it.
        columns: Vec<String>, example ["raw.bias_stability_deg_per_h", "rls.bias_stability_deg_per_h / lms"];
        /// Key in which the rows differ: the largest change of each column per unit of it closes the table.
        /// It is counted from the base point of a sweep, else from the middle value; of the error of a scale
        /// factor it is relative to the scale factor there, as in GJB 2426A and IEEE Std 952.
        per_change_of: Option<String>, example "gyro.temperature.soak.temperature_c";
    }
}

words! {
    /// What a table is for.
    pub enum ComparisonKind {
        /// Simulated against published figures.
        Published = "published",
        /// How results move with an assumption.
        Sensitivity = "sensitivity",
    }
}

table! {
    /// A row of such a table.
    pub struct ComparisonRowConfig, beside "[[comparison]]" {
        /// Name of the table that the row belongs to.
        comparison: String, example "Table 2";
        /// What the row stands for; a sweep makes a row of each point, its values behind the label.
        label: String, example "25 C";
        /// Scenarios whose metrics fill the row, the first that has one first.
        scenarios: Vec<String>, example ["static-25c", "scale-factor-25c"];
    }
}

table! {
    /// What a publication leaves open, and how it is read here.
    pub struct AssumptionConfig, beside "[[comparison]]" {
        /// Key of the scenario that settles what a publication leaves open.
        key: String, example "turntable.site.latitude_deg";
        /// How it is read here.
        statement: String, example "the latitude of Xi'an";
        /// Value of the key for which the statement holds, written as in a scenario.
        reading: Option<String>, example "34.27";
        /// Where the publication is silent or ambiguous.
        silence: String, example "the paper names no site";
        /// Other readings.
        alternatives: String, example "Guiyang, 26.65";
        /// Name of the table that shows how results move with it.
        comparison: Option<String>, example "Table 2";
    }
}

table! {
    /// A published figure that is drawn again.
    pub struct FigureConfig, beside "[[comparison]]" {
        /// Name of a published figure.
        name: String, example "Fig. 5";
        /// Scenario that draws it again.
        scenario: String, example "static-25c", kind Name;
        /// File in the folder of that scenario.
        file: String, example "rate.svg";
        /// What it shows.
        shows: String, example "rate at rest, raw and filtered";
    }
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
