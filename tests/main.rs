//! The one integration-test binary.

mod known_answers_gyro;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod support;
