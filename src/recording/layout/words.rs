//! Words by which a layout is described.

use crate::vocabulary::words;

words! {
    /// What stands between the cells of a line.
    pub enum Separator {
        /// Commas.
        Comma = "comma",
        /// Semicolons.
        Semicolon = "semicolon",
        /// Tabs.
        Tab = "tab",
        /// Any number of blanks.
        Blanks = "blanks",
    }

    /// Sign before the decimals of a number.
    pub enum DecimalSign {
        /// A point.
        Point = "point",
        /// A comma.
        Comma = "comma",
    }

    /// Encoding of a text.
    pub enum Encoding {
        /// UTF-8, with a byte order mark or without.
        Utf8 = "utf-8",
        /// UTF-16, the low byte first.
        Utf16Le = "utf-16-le",
        /// UTF-16, the high byte first.
        Utf16Be = "utf-16-be",
        /// ISO 8859-1, one byte a letter.
        Latin1 = "latin-1",
    }

    /// What a number of a log is.
    pub enum WordKind {
        /// A rate.
        Rate = "rate",
        /// The angle turned in a sample.
        Increment = "increment",
        /// The angle turned since some time.
        Angle = "angle",
    }

    /// What the units in headings are worth.
    pub enum HeadingUnits {
        /// They are held against the options.
        Read = "read",
        /// They are passed over.
        Ignore = "ignore",
    }

    /// What is done with words for missing numbers.
    pub enum MissingWords {
        /// The log is refused.
        Refuse = "refuse",
        /// The sample is missing.
        Gap = "gap",
    }
}
