//! The one integration-test binary.

mod architecture;
mod bit_exact;
mod cli;
mod cli_fpga;
mod closed_loop;
mod comparison_filters;
mod cycle_exact;
mod determinism;
mod filters;
mod fpga_health;
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
mod pipeline;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod readme;
mod report;
mod rtl;
mod scenario_errors;
mod suite;
mod support;
mod timing;
mod waveform;
