//! Settings of calibration and compensation: tables of keys.
//!
//! Invariant: declarations only; nothing here computes.

mod compensation;
mod estimation;

pub use compensation::{CompensationConfig, CompensationParameters};
pub use estimation::CalibrationConfig;
