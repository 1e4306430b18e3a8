//! What `run --baseline` adds to a suite: its results compared with earlier ones.

use std::collections::{BTreeMap, BTreeSet};

use crate::baseline::{Comparison, Outcome, Side, compare};
use crate::cli::commands::compare::{exit_of, refused, side};
use crate::cli::options::arguments::RunOptions;
use crate::cli::options::baseline::FailOn;
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::output;
use crate::experiment::{Plan, SuiteOutcome, read_output};
use crate::report::{comparison_with_baseline_markdown, comparison_with_baseline_text};

/// The earlier results that a suite is compared with.
pub(super) struct Against<'a> {
    options: &'a RunOptions,
    /// Earlier results, and what fails; none if nothing is compared.
    earlier: Option<(Side, Vec<Outcome>)>,
    /// Scenarios that the suite holds whole: points of theirs that are missing are gone.
    whole: BTreeSet<String>,
}

/// What came of the comparison.
pub(super) struct Compared {
    /// How the program ends by it.
    pub(super) exit: Exit,
    /// The same in Markdown.
    pub(super) markdown: String,
}

impl Compared {
    fn nothing(exit: Exit) -> Self {
        Self {
            exit,
            markdown: String::new(),
        }
    }
}

impl<'a> Against<'a> {
    /// Reads the earlier results before anything runs, which may replace them.
    ///
    /// A refusal is printed before its exit code is returned.
    pub(super) fn read(options: &'a RunOptions, plans: &[Plan]) -> Result<Self, Exit> {
        let earlier = options.against.baseline.as_deref().map(side).transpose()?;
        let fail_on = FailOn::outcomes(&options.against.fail_on);
        let mut points: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for plan in plans {
            let resolved = plan.resolved();
            let all = resolved.sweep.as_ref().map_or(1, |point| point.count);
            let (held, count) = points.entry(&resolved.scenario.name).or_default();
            *held += 1;
            *count = all;
        }
        let whole = points.into_iter().filter(|(_, (held, all))| held == all);
        Ok(Self {
            options,
            earlier: earlier.map(|earlier| (earlier, fail_on)),
            whole: whole.map(|(name, _)| name.to_owned()).collect(),
        })
    }

    /// Compares the results of a suite, and prints what differs: on stdout where that is text.
    pub(super) fn compare(&self, suite: &SuiteOutcome) -> Compared {
        let Some((earlier, fail_on)) = &self.earlier else {
            return Compared::nothing(Exit::Success);
        };
        if suite.runs.iter().any(|run| run.is_not_run) {
            output::talk("not compared with the baseline: the suite was stopped before its end");
            return Compared::nothing(Exit::Success);
        }
        let later = match read_output(&self.options.output) {
            Ok(later) => later,
            Err(error) => return Compared::nothing(refused(&error)),
        };
        let comparison = compare(&self.asked_for(earlier, &later), &later);
        let exit = exit_of(&comparison, fail_on);
        let printed = self.print(&comparison, fail_on);
        Compared {
            exit: exit.worst(printed),
            markdown: comparison_with_baseline_markdown(&comparison),
        }
    }

    /// The earlier results of what the suite ran.
    fn asked_for(&self, earlier: &Side, later: &Side) -> Side {
        let of_later = later.entries.iter().map(|entry| &entry.id);
        let ran: BTreeSet<_> = of_later
            .chain(later.lacks.keys())
            .map(|id| (id.scenario.clone(), id.point.clone()))
            .collect();
        earlier.clone().of_scenarios(|scenario, point| {
            self.whole.contains(scenario) || ran.contains(&(scenario.to_owned(), point.clone()))
        })
    }

    fn print(&self, comparison: &Comparison, fail_on: &[Outcome]) -> Exit {
        let is_text = self.options.format == Format::Text;
        let colour = is_text && output::colour();
        let text = comparison_with_baseline_text(comparison, fail_on, colour);
        if is_text {
            return output::data(&text).map_or_else(io_failure, |()| Exit::Success);
        }
        text.lines().for_each(output::talk);
        Exit::Success
    }
}
