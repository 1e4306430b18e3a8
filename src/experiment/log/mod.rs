//! Recorded logs in place of table and gyro.

mod compensation;
mod filters;
mod trial;

pub use compensation::{CompensatedLog, LogCompensation, compensate_log, load_log_compensation};
pub use filters::{LogFilters, load_log_filters};
pub use trial::{LogInput, LogMotion, LogSettings, LogTrial, LogTrialError, try_log};
