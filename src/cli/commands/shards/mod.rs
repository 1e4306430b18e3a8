//! A suite in parts: planned, looked after, put together.

pub(in crate::cli) mod merge;
pub(in crate::cli) mod plan;
pub(in crate::cli) mod status;
