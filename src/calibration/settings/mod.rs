//! Settings of calibration and compensation: tables of keys.
//!
//! Invariant: declarations, and what they say as a model; nothing here is estimated.

mod compensation;
mod estimation;
mod temperature;

pub use compensation::{CompensationConfig, CompensationParameters};
pub use estimation::CalibrationConfig;
pub use temperature::TemperatureParameters;
