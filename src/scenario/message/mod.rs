//! Complaints: what they say, where they point, what was meant.

pub(in crate::scenario) mod complaints;
pub(in crate::scenario) mod error;
pub(in crate::scenario) mod excerpt;
pub(in crate::scenario) mod suggest;
pub(in crate::scenario) mod synonyms;
