//! Two results, and what a figure that was published can be.

pub(in crate::cli) mod baseline;
pub(in crate::cli) mod claim;
pub(in crate::cli) mod compare;
