//! Reads recorded logs (NPY, CSV) into rate words and group means of a calibration (CSV), and writes
//! words as CSV.
//!
//! ```text
//!  input ──> transcode ──> layout ──> table ──> columns ──> stretches, timing ──> convert ──> log
//!                  npy ──────────────────────────┘
//! ```
//!
//! Invariant: a log comes out of here whole, in deg/h and equally spaced, or not at all; samples are
//! missing (NaN) only where gaps were asked for. Every complaint names the file and the place in it, and
//! what is in doubt the option by which it is said. Every command that takes numbers from a file takes
//! them through this module.

mod bounds;
mod column;
mod convert;
mod csv;
mod error;
mod facts;
mod format;
mod groups;
mod groups_heading;
mod input;
mod layout;
mod log;
mod motion;
mod npy;
mod npy_heading;
mod stamp;
mod stretches;
mod table;
mod text;
mod time_column;
mod time_unit;
mod timing;
mod transcode;
mod unit;
mod unit_text;
mod words;

pub use bounds::{
    OutOfBounds, RATE_MAX_DEG_PER_H, SAMPLE_RATE_HZ, STANDARD_ERROR_MIN_DEG_PER_H, TEMPERATURE_C,
    check_rate, check_sample_rate, check_temperature,
};
pub use column::EmptyLines;
pub use csv::csv_text;
pub use error::LogError;
pub use facts::LogFacts;
pub use format::LogFormat;
pub use groups::{GROUPS_MAX, Mounting, RecordedGroup, RecordedGroups, read_groups};
pub use layout::words::{DecimalSign, Encoding, HeadingUnits, MissingWords, Separator, WordKind};
pub use log::{
    AssemblyColumns, AssemblyLog, Log, Stretch, read_assembly_log, read_log, read_logs,
    read_stimulus,
};
pub use motion::{LogMotion, UnknownLogMotion};
pub use text::{Delimiter, Line, Lines, TextError};
pub use time_unit::TimeUnit;
pub use timing::Timing;
pub use unit::{AngleBase, AngleUnit, LogUnit, Per, Prefix, RateUnit, UnknownRateUnit};
pub use words::read_words;
