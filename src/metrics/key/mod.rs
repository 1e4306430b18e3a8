//! Declarations of metrics: one row each, read by all that shows, pools, checks or documents one.

pub(super) mod curve;
pub(super) mod metric;
