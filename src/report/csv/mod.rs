//! Metrics, curves and repeats as CSV.

pub(super) mod curves;
pub(super) mod metrics;
pub(super) mod runs;
