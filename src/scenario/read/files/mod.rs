//! Files that a scenario names, and the manifest.

pub(in crate::scenario) mod compensation_source;
pub(in crate::scenario) mod log_format;
pub(in crate::scenario) mod log_source;
pub(in crate::scenario) mod manifest;
pub(in crate::scenario) mod named_files;
pub(in crate::scenario) mod problem;
pub(in crate::scenario) mod script;
pub(in crate::scenario) mod temperature_source;
