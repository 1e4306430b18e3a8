//! The one integration-test binary.

mod known_answers_turntable;
mod support;

mod architecture;
