//! The one integration-test binary.

mod known_answers_gyro;
mod known_answers_gyro_noise;
mod known_answers_slow_noise;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod support;
