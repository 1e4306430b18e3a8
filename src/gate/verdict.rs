//! What a gate says.

/// Outcome of one gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum VerdictKind {
    /// The interval lies inside the limits.
    Pass,
    /// The interval lies outside the limits, or there is no number to judge.
    Fail,
    /// The interval straddles a limit: the record is too short to tell.
    Inconclusive,
}

impl VerdictKind {
    /// The word used in every file: `pass`, `fail` or `inconclusive`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
        }
    }
}

/// One gate, judged.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Verdict {
    /// `<channel>.<metric>`, as the scenario names it.
    pub metric: String,
    /// Outcome.
    pub kind: VerdictKind,
    /// Whether the run may go on as good: a pass, or inconclusive where the gate allows it.
    pub accepted: bool,
    /// Value judged (a ratio with `relative_to`); absent where there was none.
    pub value: Option<f64>,
    /// Lower end of its interval; absent where the interval is unbounded.
    pub low: Option<f64>,
    /// Upper end of its interval.
    pub high: Option<f64>,
    /// Lower limit.
    pub min: Option<f64>,
    /// Upper limit.
    pub max: Option<f64>,
    /// Unit of value and limits; `1` for a ratio, empty where the metric is unknown.
    pub unit: String,
    /// Channel whose same metric divided the value.
    pub relative_to: Option<String>,
    /// The verdict in words: value, interval, limits, unit.
    pub reason: String,
    /// Where the gate stands, `file:line`.
    pub location: Option<String>,
}

impl Verdict {
    /// The metric without its channel.
    pub(crate) fn metric_name(&self) -> &str {
        let metric = self.metric.as_str();
        metric.rsplit_once('.').map_or(metric, |(_, name)| name)
    }
}

/// Number of gates that let the run go on as good.
pub(crate) fn count_accepted(verdicts: &[Verdict]) -> usize {
    verdicts.iter().filter(|verdict| verdict.accepted).count()
}
