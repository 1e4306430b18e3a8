//! The one integration-test binary.

mod architecture;
mod cli;
mod closed_loop;
mod determinism;
mod filters;
mod known_answers_allan;
mod known_answers_gyro;
mod known_answers_gyro_limits;
mod known_answers_gyro_noise;
mod known_answers_metrics;
mod known_answers_slow_noise;
mod known_answers_swing;
mod known_answers_turntable;
mod metrics_intervals;
mod metrics_records;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod readme;
mod report;
mod scenario_errors;
mod suite;
mod support;
