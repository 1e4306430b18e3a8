//! Reads recorded logs (NPY, CSV) into rate words and group means of a calibration (CSV), and writes
//! words as CSV.
//!
//! ```text
//!  input ──> transcode ──> layout ──> table ──> columns ──> stretches, timing ──> convert ──> log
//!                  npy ──────────────────────────┘
//! ```
//!
//! | room | subject |
//! |---|---|
//! | `text` | lines and cells, encodings, columns of numbers, words written |
//! | `layout` | how the lines of a text hold a table |
//! | `npy` | arrays |
//! | `time` | stamps, clocks that begin again, equal spacing |
//! | `unit` | units, how they are spelled, rates from numbers |
//! | `log` | what is said of a log, its parts, its words |
//! | `groups` | group means of a calibration |
//! | `points` | rates and outputs of a scale factor test |
//!
//! Invariant: a log comes out of here whole, in deg/h and equally spaced, or not at all; samples are
//! missing (NaN) only where gaps were asked for. Every complaint names the file and the place in it, and
//! what is in doubt the option by which it is said. Every command that takes numbers from a file takes
//! them through this module.

mod ahead;
mod bounds;
mod column;
mod error;
mod groups;
mod input;
mod layout;
mod log;
mod npy;
mod points;
mod text;
mod time;
mod unit;

pub use bounds::{
    OutOfBounds, RATE_MAX_DEG_PER_H, SAMPLE_RATE_HZ, STANDARD_ERROR_MIN_DEG_PER_H, TEMPERATURE_C,
    check_rate, check_sample_rate, check_temperature,
};
pub use column::{CountedLines, LinesBetween};
pub use error::LogError;
pub use groups::read::{GROUPS_MAX, Mounting, RecordedGroup, RecordedGroups, read_groups};
pub use layout::words::{
    DecimalSign, Encoding, HeadingUnits, MissingWords, Separator, WordKind, WordType,
};
pub use log::facts::LogFacts;
pub use log::format::LogFormat;
pub use log::motion::{LogMotion, UnknownLogMotion};
pub use log::read::{
    AssemblyColumns, AssemblyLog, read_assembly_log, read_log, read_logs, read_stimulus,
    read_unbroken_log, read_unbroken_logs,
};
pub use log::record::{Log, Stretch};
pub use log::rows::{LogRows, UnknownLogRows};
pub use log::stream::{LogSource, LogStream, open_live_log, open_log};
pub use log::words::read_words;
pub use points::{PointsFormat, RecordedPoints, read_points};
pub use text::csv::csv_text;
pub use text::lines::{Delimiter, Line, Lines, TextError};
pub use time::timing::Timing;
pub use time::unit::TimeUnit;
pub use unit::kinds::{AngleBase, AngleUnit, LogUnit, Per, Prefix, RateUnit, UnknownRateUnit};
