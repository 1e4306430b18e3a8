//! The one integration-test binary.

mod scenario_errors;
mod support;

mod report;
