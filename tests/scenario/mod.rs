//! Scenario files: what is wrong with them, ends of ranges, values that nobody set.

mod assumed_values;
mod bounds;
pub(crate) mod campaign;
mod cli_init;
pub(crate) mod extremes;
mod mutation;
mod properties;
mod scenario_errors;
