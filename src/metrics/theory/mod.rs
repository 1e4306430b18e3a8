//! What theory says a filter will do, before anything is measured.

pub(super) mod bound;
pub(super) mod claim;
pub(super) mod learning;
pub(super) mod memory;
pub(super) mod operations;
pub(super) mod prediction;
mod stretches;
