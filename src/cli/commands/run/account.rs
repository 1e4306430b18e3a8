//! What `run` prints of its runs, in the order of the plan.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::cli::options::arguments::RunOptions;
use crate::cli::options::format::Format;
use crate::cli::terminal::output;
use crate::experiment::{Plan, SuiteOutcome};
use crate::report::{self, RunOutcome, RunReport, SuiteStyle};

/// How much is printed of each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Detail {
    /// Everything that is known of it.
    Full,
    /// A line for each scenario.
    Line,
    /// The one scenario is a sweep: a line for each of its first points.
    Points,
    /// What failed.
    Failures,
}

/// What is printed, and what waits for its turn.
pub(super) struct Account {
    format: Format,
    detail: Detail,
    style: SuiteStyle,
    folders: Vec<String>,
    /// Runs that are told of together: those of a scenario, or each by itself.
    turns: Vec<Range<usize>>,
    /// Next turn.
    next: usize,
    outcomes: BTreeMap<usize, RunOutcome>,
    texts: BTreeMap<usize, String>,
}

impl Account {
    pub(super) fn new(plans: &[Plan], options: &RunOptions) -> Self {
        let scenarios = scenarios(plans);
        let detail = if options.account.quiet {
            Detail::Failures
        } else if options.account.verbose || plans.len() == 1 {
            Detail::Full
        } else if scenarios.len() == 1 {
            Detail::Points
        } else {
            Detail::Line
        };
        let is_told_at_once = options.account.format != Format::Text || detail == Detail::Full;
        let names = plans
            .iter()
            .map(|plan| plan.resolved().scenario.name.as_str());
        Self {
            format: options.account.format,
            detail,
            style: SuiteStyle::new(names, output::width(), output::colour()),
            folders: plans.iter().map(|plan| plan.resolved().folder()).collect(),
            turns: if is_told_at_once {
                (0..plans.len()).map(|index| index..index + 1).collect()
            } else {
                scenarios
            },
            next: 0,
            outcomes: BTreeMap::new(),
            texts: BTreeMap::new(),
        }
    }

    /// Takes in a run that finished.
    pub(super) fn finished(&mut self, index: usize, report: &RunReport) {
        let text = match (self.format, self.detail) {
            (Format::Text, Detail::Full) => {
                report::table_text(report, self.style.width, self.style.colour) + "\n"
            }
            (Format::Text | Format::Json, _) => String::new(),
            (Format::Jsonl, _) => {
                let document = report::run_summary_json(report);
                document.lines().map(str::trim_start).collect::<String>() + "\n"
            }
        };
        self.texts.insert(index, text);
        let outcome = RunOutcome::from_report(report, &self.folders[index]);
        self.outcomes.insert(index, outcome);
    }

    /// Takes in a run that did not finish.
    pub(super) fn failed(&mut self, index: usize, outcome: &RunOutcome) {
        self.texts.insert(index, String::new());
        self.outcomes.insert(index, outcome.clone());
    }

    /// The texts of all runs whose turn has come: those before them and those of their scenario have ended.
    ///
    /// * `aside`: what is said of some runs at the end of their line.
    pub(super) fn ready(&mut self, aside: impl Fn(Range<usize>) -> String) -> String {
        let mut text = String::new();
        while let Some(runs) = self.turns.get(self.next).cloned() {
            if runs
                .clone()
                .any(|index| !self.outcomes.contains_key(&index))
            {
                break;
            }
            self.next += 1;
            text.push_str(&self.scenario(runs, &aside));
        }
        text
    }

    /// The texts of what has ended and still waits for its turn.
    pub(super) fn rest(&mut self) -> String {
        let left = self.turns.split_off(self.next.min(self.turns.len()));
        let texts = left.into_iter();
        texts
            .map(|runs| self.scenario(runs, &|_| String::new()))
            .collect()
    }

    fn scenario(&mut self, runs: Range<usize>, aside: &dyn Fn(Range<usize>) -> String) -> String {
        let indices = runs.clone();
        let texts: String = indices
            .filter_map(|index| self.texts.remove(&index))
            .collect();
        let indices = runs.clone();
        let outcomes: Vec<RunOutcome> = indices
            .filter_map(|index| self.outcomes.remove(&index))
            .collect();
        if self.format != Format::Text {
            return texts;
        }
        match self.detail {
            Detail::Full => texts,
            Detail::Line => report::scenario_text(&outcomes, self.style, &aside(runs)),
            Detail::Points => report::sweep_text(&outcomes, self.style),
            Detail::Failures => String::new(),
        }
    }

    /// The end of the suite: tables over its scenarios, what failed, the verdict.
    pub(super) fn closing(&self, suite: &SuiteOutcome) -> String {
        let (runs, across) = (&suite.runs, &suite.comparison);
        let SuiteStyle { width, colour, .. } = self.style;
        match self.format {
            Format::Text => {
                let tables = match self.detail {
                    Detail::Full => report::comparison_text(across, width, colour),
                    Detail::Line | Detail::Points => report::comparison_lines(across, colour),
                    Detail::Failures => String::new(),
                };
                let end = report::closing_text(runs, self.style);
                // The account of one run ends with an empty line of its own.
                let is_apart = end.starts_with('\n')
                    || self.detail == Detail::Failures
                    || (self.detail == Detail::Full && tables.is_empty());
                let gap = if is_apart { "" } else { "\n" };
                format!("{tables}{gap}{end}")
            }
            // What could not be written is told as a failure of the suite.
            Format::Json => suite.summary_json().unwrap_or_default(),
            // Every run has been printed on its own line.
            Format::Jsonl => String::new(),
        }
    }
}

/// The runs of each scenario.
fn scenarios(plans: &[Plan]) -> Vec<Range<usize>> {
    let name = |plan: &Plan| plan.resolved().scenario.name.clone();
    let mut next = 0;
    let mut scenarios = Vec::new();
    for runs in plans.chunk_by(|one, other| name(one) == name(other)) {
        scenarios.push(next..next + runs.len());
        next += runs.len();
    }
    scenarios
}
