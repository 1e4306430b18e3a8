//! From scenario files to checked plans: all runs of a suite, and what is wrong with any of them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::checked::Plan;
use super::checker::{Checker, SoundCampaigns, plan};
use crate::comparison::contradictions;
use crate::scenario::{
    Reading, Resolved, ScenarioError, UnsoundReading, in_both, in_order, read_suite,
};

/// Most scenarios of a suite that are not sound and are checked further: nobody reads on.
const UNSOUND_MAX: usize = 100;

/// Reads and checks everything under `paths`, `--set` overrides applied.
///
/// # Errors
/// Every complaint about every file; then nothing may run.
pub fn plan_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    gather_plans(&|take| read_suite(paths, sets, take))
}

/// Hands over each run that was read, sound or not; returns the complaints of the reader.
pub(crate) type Read<'a> = dyn Fn(&mut dyn FnMut(Reading)) -> Vec<ScenarioError> + 'a;

/// Checks everything that `read` reads.
///
/// # Errors
/// Every complaint about every run.
pub(crate) fn gather_plans(read: &Read) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    let mut plans = Vec::new();
    let errors = visit_plans(read, &mut |plan| plans.push(plan));
    compared(plans, errors)
}

/// The plans of a suite in their order, if they do not contradict one another and nothing was wrong
/// before.
pub(crate) fn compared(
    mut plans: Vec<Plan>,
    mut errors: Vec<ScenarioError>,
) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    // By folder, so that the order of the arguments leaves no trace in the results.
    plans.sort_by_cached_key(|plan: &Plan| plan.resolved.folder());
    let suite: Vec<&Resolved> = plans.iter().map(Plan::resolved).collect();
    errors.extend(contradictions(&suite));
    if errors.is_empty() {
        Ok(plans)
    } else {
        Err(in_order(errors))
    }
}

/// Hands over each run that `read` reads and that passes its own checks; returns the complaints about
/// the others.
pub(crate) fn visit_plans(read: &Read, visit: &mut dyn FnMut(Plan)) -> Vec<ScenarioError> {
    let (mut found, mut known) = (Vec::new(), BTreeSet::new());
    let mut campaigns = SoundCampaigns::default();
    let mut unsound_count = 0;
    let mut errors = read(&mut |reading| {
        let more = match reading {
            Ok(resolved) => match plan(resolved, &mut campaigns) {
                Ok(plan) => return visit(plan),
                Err(more) => more,
            },
            Err(reading) => {
                unsound_count += 1;
                if unsound_count > UNSOUND_MAX {
                    return;
                }
                unsound(reading, &mut campaigns)
            }
        };
        // The points of a sweep share most of what is wrong with them.
        found.extend(more.into_iter().filter(|error| known.insert(error.clone())));
    });
    errors.extend(found);
    errors
}

/// What else is wrong with a scenario that is not sound: the complaints that all its variants give.
fn unsound(reading: UnsoundReading, campaigns: &mut SoundCampaigns) -> Vec<ScenarioError> {
    let mut variants = reading.variants.into_iter().map(|resolved| {
        if reading.is_contradictory {
            let mut checker = Checker::new(&resolved);
            checker.names();
            checker.errors
        } else {
            plan(resolved, campaigns).err().unwrap_or_default()
        }
    });
    let first = variants.next().unwrap_or_default();
    variants.fold(first, |common, found| in_both(common, &found))
}
