//! Points of a sweep: their values and how they are named.

pub(in crate::scenario) mod matrix;
pub(in crate::scenario) mod range;
pub(in crate::scenario) mod template;
