//! What is wrong with a scenario: single values, presence, contradictions, keys without effect.

pub(in crate::scenario) mod cross;
pub(in crate::scenario) mod faults;
pub(in crate::scenario) mod inert;
pub(in crate::scenario) mod inert_rules;
pub(in crate::scenario) mod leaf;
pub(in crate::scenario) mod numbers;
pub(in crate::scenario) mod presence;
pub(in crate::scenario) mod stand_in;
pub(in crate::scenario) mod values;

#[cfg(test)]
mod inert_tests;
#[cfg(test)]
mod wish_tests;
