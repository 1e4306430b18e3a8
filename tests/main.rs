//! The one integration-test binary.

mod filters;
mod known_answers_turntable;
mod support;
