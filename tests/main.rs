//! The one integration-test binary.

#![expect(
    clippy::needless_update,
    reason = "settings are those of the reference but for what is given, so that a new key breaks no test"
)]

mod allan;
mod calibration;
mod cli;
mod comparison;
mod filters;
mod gyro;
mod hardware;
mod house;
mod inference;
mod logs;
mod metrics;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod report;
mod scenario;
mod suite;
mod support;
mod trial;
mod turntable;
