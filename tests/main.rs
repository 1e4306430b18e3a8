//! The one integration-test binary.

mod known_answers_metrics;
mod support;
