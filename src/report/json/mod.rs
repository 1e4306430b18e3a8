//! `summary.json` of a run, of a suite and of a run that failed.

pub(super) mod channel;
pub(super) mod compensation;
pub(super) mod failed;
pub(super) mod suite;
pub(super) mod summary;
