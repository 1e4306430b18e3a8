//! Curves and repeats as CSV.

pub(super) mod curves;
pub(super) mod runs;
