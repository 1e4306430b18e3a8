//! The rows of a log that are taken, in a word.

use std::fmt;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::str::FromStr;

use crate::declare::spelled;

/// Rows `first:last` from 1 on, either of which may be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogRows {
    first: Option<NonZeroUsize>,
    last: Option<NonZeroUsize>,
}

/// What names no rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected two rows from 1 on with a colon between them, the last no smaller than the first, as 1001:5000; \
     either may be left out"
)]
pub struct UnknownLogRows;

impl LogRows {
    /// The last row, from 1; none if all behind the first are taken.
    pub(in crate::recording) fn last(self) -> Option<usize> {
        self.last.map(NonZeroUsize::get)
    }

    /// The indices of the rows in a log of so many; nothing where it has none of them.
    pub(in crate::recording) fn within(self, count: usize) -> Option<Range<usize>> {
        let first = self.first.map_or(0, |first| first.get() - 1);
        let end = self.last.map_or(count, |last| last.get().min(count));
        (first < end).then_some(first..end)
    }
}

impl FromStr for LogRows {
    type Err = UnknownLogRows;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (first, last) = text.split_once(':').ok_or(UnknownLogRows)?;
        let row = |text: &str| match text.trim() {
            "" => Ok(None),
            text => text.parse().map(Some).map_err(|_| UnknownLogRows),
        };
        let rows = Self {
            first: row(first)?,
            last: row(last)?,
        };
        match rows {
            Self {
                first: Some(first),
                last: Some(last),
            } if last < first => Err(UnknownLogRows),
            _ => Ok(rows),
        }
    }
}

impl fmt::Display for LogRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = |f: &mut fmt::Formatter<'_>, row: Option<NonZeroUsize>| {
            row.map_or(Ok(()), |row| write!(f, "{row}"))
        };
        row(f, self.first)?;
        f.write_str(":")?;
        row(f, self.last)
    }
}

spelled!(LogRows);

#[cfg(test)]
mod tests {
    use super::LogRows;

    #[test]
    fn rows_are_two_numbers_from_one_on_of_which_either_may_be_left_out() {
        let within = |text: &str, count| text.parse::<LogRows>().ok()?.within(count);
        assert_eq!(within("2:3", 9), Some(1..3));
        assert_eq!(within(":3", 9), Some(0..3));
        assert_eq!(within("8:", 9), Some(7..9));
        assert_eq!(within("8:20", 9), Some(7..9));
        assert_eq!(within("9:9", 9), Some(8..9));
        assert_eq!(within("10:", 9), None);
        assert_eq!(within(":", 0), None);
        for text in [
            "1-2000", "3", "0:4", "5:2", "a:b", "-1:4", "1:2:3", "1.5:4", "",
        ] {
            assert!(text.parse::<LogRows>().is_err(), "{text}");
        }
        for text in ["1001:5000", ":5", "5:", ":"] {
            assert_eq!(text.parse::<LogRows>().expect(text).to_string(), text);
        }
    }
}
