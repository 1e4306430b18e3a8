//! What a scenario file may hold: the declared keys under their paths, and their defaults.

pub(in crate::scenario) mod defaults;
pub(in crate::scenario) mod schema;
