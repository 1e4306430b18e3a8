//! Judges metrics against limits.
//!
//! Invariant: judges, does not compute.
