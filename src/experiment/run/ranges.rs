//! Some of the repeats of a run, to be pooled with the others elsewhere.

use std::ops::Range;

use rayon::prelude::*;

use super::progress::{Progress, Unfinished};
use super::repeat_pool::Repeat;
use super::results::{filter_notes, run_repeat};
use super::simulate::Simulation;
use crate::experiment::plan::Plan;

/// Runs some repeats of a plan that neither is a campaign nor applies one; `keep_first` is given the records
/// of the first repeat of all and what its filters have to say.
///
/// # Errors
/// Why it cannot be run to its end, or that the listener has stopped it.
pub(crate) fn run_range(
    plan: &Plan,
    repeats: Range<u32>,
    keep_first: &(dyn Fn(&Simulation, Vec<String>) + Sync),
    progress: &dyn Progress,
) -> Result<Vec<Repeat>, Unfinished> {
    let repeats = repeats.into_par_iter().with_max_len(1);
    let run = |repeat| {
        let (simulation, channels, _) = run_repeat(plan, repeat, None, progress)?;
        if repeat == 0 {
            keep_first(&simulation, filter_notes(plan, &simulation));
        }
        let faults = simulation.faults;
        Ok(Repeat { faults, channels })
    };
    // In order, so that of several failures the first counts.
    let ended: Vec<Result<Repeat, Unfinished>> = repeats.map(run).collect();
    ended.into_iter().collect()
}
