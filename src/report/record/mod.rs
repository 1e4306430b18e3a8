//! What a report is made of, and which metrics it shows.

pub(super) mod columns;
pub(super) mod measured;
pub(super) mod run;
pub(super) mod sweep;
