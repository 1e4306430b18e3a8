//! The one integration-test binary.

mod architecture;
mod cli;
mod closed_loop;
mod determinism;
mod filters;
mod known_answers_gyro;
mod known_answers_metrics;
mod known_answers_turntable;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod support;
