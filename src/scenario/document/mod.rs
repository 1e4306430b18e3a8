//! A scenario as a document: a tree of values, each of which knows where it was written.

pub(in crate::scenario) mod address;
pub(in crate::scenario) mod deserialize;
pub(in crate::scenario) mod emit;
pub(in crate::scenario) mod setting;
pub(in crate::scenario) mod source;
pub(in crate::scenario) mod tree;
pub(in crate::scenario) mod weight;
