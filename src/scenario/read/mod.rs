//! From files, arguments and manifests to resolved runs.

pub(in crate::scenario) mod assumed;
pub(in crate::scenario) mod chain;
pub(in crate::scenario) mod clashes;
pub(in crate::scenario) mod compensation_source;
pub(in crate::scenario) mod conditions;
pub(in crate::scenario) mod discover;
pub(in crate::scenario) mod draft;
pub(in crate::scenario) mod input;
pub(in crate::scenario) mod log_format;
pub(in crate::scenario) mod log_source;
pub(in crate::scenario) mod manifest;
pub(in crate::scenario) mod matrix;
pub(in crate::scenario) mod moved;
pub(in crate::scenario) mod named_files;
pub(in crate::scenario) mod problem;
pub(in crate::scenario) mod range;
pub(in crate::scenario) mod resolve;
pub(in crate::scenario) mod resolved;
pub(in crate::scenario) mod script;
pub(in crate::scenario) mod suite;
pub(in crate::scenario) mod template;
pub(in crate::scenario) mod unresolved;
