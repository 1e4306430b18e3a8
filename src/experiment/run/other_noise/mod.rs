//! Filters that run again on the same motion and other noise.

mod figures;
mod two_runs;
mod weights;

pub(super) use figures::figures_of_other_runs;
pub(super) use two_runs::two_runs;
pub(super) use weights::runs_that_differ;
