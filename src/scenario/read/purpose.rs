//! What a file is read for, which decides what of it must be right.

use crate::scenario::config::channels::LogChannels;

/// Use of a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// It is run, or its gyro is asked for.
    Run,
    /// Its filters are put behind a log that it does not name: nobody holds its gates against anything.
    Filters,
    /// Its gates are held against a log that it does not name, with these channels.
    Gates(LogChannels),
}
