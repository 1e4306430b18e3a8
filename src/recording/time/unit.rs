//! Units of columns of time.

use crate::units::SECONDS_PER_HOUR;
use crate::vocabulary::words;

words! {
    /// Unit of a column of time.
    pub enum TimeUnit {
        /// Seconds.
        Seconds = "s",
        /// Milliseconds.
        Milliseconds = "ms",
        /// Microseconds.
        Microseconds = "us",
        /// Nanoseconds.
        Nanoseconds = "ns",
        /// Minutes.
        Minutes = "min",
        /// Hours.
        Hours = "h",
        /// Days.
        Days = "day",
        /// Weeks, beside the seconds of the week.
        Weeks = "week",
        /// Dates and times of day as ISO 8601 writes them.
        Iso = "iso",
        /// Sample periods: a counter of samples.
        Samples = "sample",
    }
}

/// Other spellings, in small letters.
const SPELLINGS: [(&str, TimeUnit); 27] = [
    ("sec", TimeUnit::Seconds),
    ("secs", TimeUnit::Seconds),
    ("second", TimeUnit::Seconds),
    ("seconds", TimeUnit::Seconds),
    ("msec", TimeUnit::Milliseconds),
    ("msecs", TimeUnit::Milliseconds),
    ("millis", TimeUnit::Milliseconds),
    ("millisec", TimeUnit::Milliseconds),
    ("millisecond", TimeUnit::Milliseconds),
    ("milliseconds", TimeUnit::Milliseconds),
    ("usec", TimeUnit::Microseconds),
    ("usecs", TimeUnit::Microseconds),
    ("micros", TimeUnit::Microseconds),
    ("microsec", TimeUnit::Microseconds),
    ("microsecond", TimeUnit::Microseconds),
    ("microseconds", TimeUnit::Microseconds),
    ("nsec", TimeUnit::Nanoseconds),
    ("nsecs", TimeUnit::Nanoseconds),
    ("nanos", TimeUnit::Nanoseconds),
    ("nanosec", TimeUnit::Nanoseconds),
    ("nanosecond", TimeUnit::Nanoseconds),
    ("nanoseconds", TimeUnit::Nanoseconds),
    ("minutes", TimeUnit::Minutes),
    ("hours", TimeUnit::Hours),
    ("days", TimeUnit::Days),
    ("weeks", TimeUnit::Weeks),
    ("samples", TimeUnit::Samples),
];

impl TimeUnit {
    /// The unit that a text in small letters is.
    pub(crate) fn spelled(text: &str) -> Option<Self> {
        text.parse().ok().or_else(|| {
            let known = SPELLINGS.iter().find(|(word, _)| *word == text);
            known.map(|(_, unit)| *unit)
        })
    }

    /// The unit in s; none of a counter of samples, which has no time of its own.
    #[must_use]
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::Seconds | Self::Iso => Some(1.0),
            Self::Milliseconds => Some(crate::units::MILLI),
            Self::Microseconds => Some(crate::units::MICRO),
            Self::Nanoseconds => Some(crate::units::NANO),
            Self::Minutes => Some(60.0),
            Self::Hours => Some(SECONDS_PER_HOUR),
            Self::Days => Some(24.0 * SECONDS_PER_HOUR),
            Self::Weeks => Some(7.0 * 24.0 * SECONDS_PER_HOUR),
            Self::Samples => None,
        }
    }

    /// Nanoseconds of the unit; none of a counter of samples.
    pub(crate) fn nanoseconds(self) -> Option<i128> {
        match self {
            Self::Nanoseconds => Some(1),
            Self::Microseconds => Some(1_000),
            Self::Milliseconds => Some(1_000_000),
            Self::Seconds | Self::Iso => Some(1_000_000_000),
            Self::Minutes => Some(60_000_000_000),
            Self::Hours => Some(3_600_000_000_000),
            Self::Days => Some(86_400_000_000_000),
            Self::Weeks => Some(604_800_000_000_000),
            Self::Samples => None,
        }
    }
}
