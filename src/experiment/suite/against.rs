//! The results of a suite beside earlier ones.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use super::options::Earlier;
use crate::baseline::{Comparison, Judged, Outcome, Side, compare};
use crate::experiment::baseline::{SideError, read_runs};
use crate::experiment::plan::Plan;
use crate::report::{ComparedSides, RunOutcome};

/// How the results of a suite compare with earlier ones.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub enum Against {
    /// It was not asked, or the suite broke an invariant.
    #[default]
    Nothing,
    /// The suite was stopped before its end: what is missing says nothing.
    Stopped,
    /// Figure by figure, with the outcomes that fail.
    Compared(Arc<Comparison>, Vec<Outcome>),
    /// The results cannot be read back.
    Unreadable(Arc<SideError>),
}

impl Against {
    /// The comparison, if there is one.
    #[must_use]
    pub fn judged(&self) -> Option<Judged<'_>> {
        match self {
            Self::Compared(comparison, fail_on) => Some(comparison.judged(fail_on)),
            Self::Nothing | Self::Stopped | Self::Unreadable(_) => None,
        }
    }
}

/// What was compared, and what came of it.
#[derive(Default)]
pub(super) struct Sides {
    old: Side,
    new: Side,
    pub(super) outcome: Against,
}

impl Sides {
    /// Of runs whose folders stand in `output`, with what `earlier` has of the same scenarios.
    pub(super) fn of(
        earlier: &Earlier,
        plans: &[Plan],
        runs: &[RunOutcome],
        output: &Path,
    ) -> Self {
        if runs.iter().any(|run| run.is_not_run) {
            return Self {
                outcome: Against::Stopped,
                ..Self::default()
            };
        }
        let place = |run: &RunOutcome| {
            let status = run.status().as_str().to_owned();
            (output.join(&run.folder), status)
        };
        let places: Vec<_> = runs.iter().map(place).collect();
        match read_runs(&places) {
            Ok(new) => {
                let old = asked_for(earlier, &new, plans);
                let comparison = Arc::new(compare(&old, &new));
                let outcome = Against::Compared(comparison, earlier.fail_on.clone());
                Self { old, new, outcome }
            }
            Err(error) => Self {
                outcome: Against::Unreadable(Arc::new(error)),
                ..Self::default()
            },
        }
    }

    /// What the page of the suite shows; nothing without a comparison.
    pub(super) fn shown(&self) -> Option<ComparedSides<'_>> {
        self.outcome.judged().map(|judged| ComparedSides {
            judged,
            old: &self.old,
            new: &self.new,
        })
    }
}

/// The earlier results of what the suite ran: of a scenario that it holds whole, points that are missing
/// are gone; of a suite that is whole, scenarios are.
fn asked_for(earlier: &Earlier, later: &Side, plans: &[Plan]) -> Side {
    let mut points: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for plan in plans {
        let resolved = plan.resolved();
        let all = resolved.sweep.as_ref().map_or(1, |point| point.count);
        let (held, count) = points.entry(&resolved.scenario.name).or_default();
        *held += 1;
        *count = all;
    }
    let is_whole = |scenario: &str| match points.get(scenario) {
        Some((held, all)) => held == all,
        None => earlier.is_whole,
    };
    let of_later = later.entries.iter().map(|entry| &entry.id);
    let ran: BTreeSet<_> = of_later
        .chain(later.lacks.keys())
        .map(|id| (id.scenario.clone(), id.point.clone()))
        .collect();
    earlier.side.clone().of_scenarios(|scenario, point| {
        is_whole(scenario) || ran.contains(&(scenario.to_owned(), point.clone()))
    })
}
