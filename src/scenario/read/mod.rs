//! From files, arguments and manifests to resolved runs.

pub(in crate::scenario) mod assumed;
pub(in crate::scenario) mod chain;
pub(in crate::scenario) mod clashes;
pub(in crate::scenario) mod conditions;
pub(in crate::scenario) mod discover;
pub(in crate::scenario) mod draft;
pub(in crate::scenario) mod files;
pub(in crate::scenario) mod input;
pub(in crate::scenario) mod moved;
pub(in crate::scenario) mod purpose;
pub(in crate::scenario) mod resolve;
pub(in crate::scenario) mod resolved;
pub(in crate::scenario) mod suite;
pub(in crate::scenario) mod sweep;
pub(in crate::scenario) mod unresolved;
