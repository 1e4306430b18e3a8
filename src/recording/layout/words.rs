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

    /// Type of words that stand alone in a file.
    pub enum WordType {
        /// Whole numbers of 8 bits with a sign.
        I1 = "i1",
        /// Whole numbers of 16 bits with a sign, the low byte first.
        I2 = "i2",
        /// Whole numbers of 16 bits with a sign, the high byte first.
        I2Be = "i2-be",
        /// Whole numbers of 32 bits with a sign, the low byte first.
        I4 = "i4",
        /// Whole numbers of 32 bits with a sign, the high byte first.
        I4Be = "i4-be",
        /// Whole numbers of 64 bits with a sign, the low byte first.
        I8 = "i8",
        /// Whole numbers of 64 bits with a sign, the high byte first.
        I8Be = "i8-be",
        /// Whole numbers of 8 bits without a sign.
        U1 = "u1",
        /// Whole numbers of 16 bits without a sign, the low byte first.
        U2 = "u2",
        /// Whole numbers of 16 bits without a sign, the high byte first.
        U2Be = "u2-be",
        /// Whole numbers of 32 bits without a sign, the low byte first.
        U4 = "u4",
        /// Whole numbers of 32 bits without a sign, the high byte first.
        U4Be = "u4-be",
        /// Whole numbers of 64 bits without a sign, the low byte first.
        U8 = "u8",
        /// Whole numbers of 64 bits without a sign, the high byte first.
        U8Be = "u8-be",
        /// binary16, the low byte first.
        F2 = "f2",
        /// binary16, the high byte first.
        F2Be = "f2-be",
        /// binary32, the low byte first.
        F4 = "f4",
        /// binary32, the high byte first.
        F4Be = "f4-be",
        /// binary64, the low byte first.
        F8 = "f8",
        /// binary64, the high byte first.
        F8Be = "f8-be",
    }
}
