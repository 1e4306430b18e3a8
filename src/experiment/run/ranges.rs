//! Some of the repeats of a run, to be pooled with the others elsewhere.

use std::ops::Range;

use rayon::prelude::*;

use super::measure::Channels;
use super::progress::{Progress, Unfinished};
use super::results::{combine, filter_notes, run_repeat};
use super::simulate::{Faults, Simulation};
use crate::experiment::plan::Plan;

/// What one repeat of a run comes to, to be pooled with the others later.
pub(crate) struct Repeat {
    pub(crate) faults: Faults,
    pub(crate) channels: Channels,
}

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

/// One table and the sum of the faults from all repeats, in their order.
pub(crate) fn pool(repeats: Vec<Repeat>) -> Option<(Faults, Channels)> {
    let mut repeats = repeats.into_iter();
    let Repeat {
        mut faults,
        channels: first,
    } = repeats.next()?;
    let mut others = Vec::new();
    for repeat in repeats {
        faults = faults.plus(repeat.faults);
        others.push(repeat.channels);
    }
    Some((faults, combine(first, others)))
}
