//! Plans and runs scenarios: the only module that knows every stage.
//!
//! Invariant: wiring only; what a stage does stands in the stage. Checks that need physics live in
//! `plan`, so that `check` and `run` refuse the same files.

mod channel_filter;
mod plan;
mod run;
mod simulate;
mod suite;

pub use plan::{Plan, plan_suite};
pub use suite::{Observer, SuiteError, SuiteOptions, SuiteOutcome, run_suite};
