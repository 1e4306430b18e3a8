//! Reads recorded logs (NPY, CSV) into rate words and group means of a calibration (CSV), and writes
//! words as CSV.
//!
//! Invariant: a log comes out of here whole, finite, equally spaced and in deg/h, or not at all;
//! every complaint names the file and the place in it.

mod bounds;
mod column;
mod csv;
mod error;
mod groups;
mod groups_heading;
mod log;
mod npy;
mod timing;
mod unit;

pub use bounds::{
    RATE_MAX_DEG_PER_H, SAMPLE_RATE_HZ, STANDARD_ERROR_MIN_DEG_PER_H, TEMPERATURE_C, check_rate,
    check_sample_rate, check_temperature,
};
pub use csv::csv_text;
pub use error::LogError;
pub use groups::{Mounting, RecordedGroup, RecordedGroups, read_groups};
pub use log::{Log, LogFormat, read_column, read_log};
pub use timing::{TimeUnit, Timing};
pub use unit::RateUnit;
