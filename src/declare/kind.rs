//! Types and allowed values of keys.

use std::fmt;

use super::row::Table;

/// Type and allowed values of a key.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Binary64; whole numbers are accepted and converted.
    Float(Range),
    /// Whole number.
    Integer(Integers),
    /// `true` or `false`.
    Boolean,
    /// Any text.
    Text,
    /// Text of a form of its own, with what a text lacks for it.
    Spelled(fn(&str) -> Option<String>),
    /// Any text, also none.
    FreeText,
    /// Name of a scenario or channel.
    Name,
    /// One of a list of words.
    Choice(&'static [&'static str]),
    /// Non-empty array of words of a list.
    Choices(&'static [&'static str]),
    /// Non-empty array of binary64.
    Floats(Range),
    /// Non-empty array of texts, none of them empty.
    Texts,
    /// Path of a file, relative to the file that names it.
    File,
    /// Paths of files, likewise.
    Files,
    /// Program and arguments, of which those that begin with `./` or `../` are paths of files, likewise.
    Command,
    /// Table of settings that the bench passes on and does not know.
    Parameters,
    /// BLAKE3 digest in small hexadecimal digits.
    Digest,
    /// Array of three binary64, one for each case axis x, y, z.
    Triple(Range),
    /// A table that holds no keys (an alternative with nothing to set).
    EmptyTable,
    /// The table of swept keys.
    Matrix,
}

impl Kind {
    /// Whether it names files, which are found when the scenario is read.
    #[must_use]
    pub fn names_files(self) -> bool {
        matches!(self, Self::File | Self::Files | Self::Command)
    }
}

/// Digits of a [`Kind::Digest`].
pub const DIGEST_DIGITS: usize = 64;

/// Closed interval of finite binary64 values.
///
/// No end is open: just above an open 0 lie numbers, as 5e-324, whose reciprocals and squares are no
/// numbers any more. Each least value is one of the physics or of the arithmetic behind the key.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

impl Range {
    /// Whether a value is finite and inside.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        value.is_finite() && (self.low..=self.high).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", number(self.low), number(self.high))
    }
}

/// A bound without a trailing `.0`.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// Closed interval of whole numbers.
#[derive(Clone, Copy, Debug)]
pub struct Integers {
    /// Least value.
    pub min: i64,
    /// Greatest value.
    pub max: i64,
    /// Whether odd values are refused.
    pub is_even: bool,
}

impl Integers {
    /// Whether a value is inside (and even, if asked).
    #[must_use]
    pub fn contains(&self, value: i64) -> bool {
        (self.min..=self.max).contains(&value) && !(self.is_even && value % 2 != 0)
    }
}

impl fmt::Display for Integers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let even = if self.is_even { "even " } else { "" };
        write!(f, "{even}{}..={}", self.min, self.max)
    }
}

/// What stands under a name of a table.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// A value.
    Value(Kind),
    /// A table.
    Table(&'static Table),
    /// An array of tables.
    Tables(&'static Table),
}

/// What a type of the configuration is in a file, but for the range of its numbers.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Binary64.
    Float,
    /// Non-empty array of binary64.
    Floats,
    /// Three binary64.
    Triple,
    /// Whole number.
    Integer,
    /// What needs no range.
    Plain(Content),
    /// What no key is.
    Impossible,
}

impl Shape {
    /// The content of a row that states no range.
    ///
    /// # Panics
    /// If it is a number, when the declaration is compiled.
    #[must_use]
    pub const fn unlimited(self) -> Content {
        match self {
            Self::Plain(content) => content,
            _ => panic!("a number needs a range: in low..=high"),
        }
    }
}

/// Range of a key as its declaration states it: of binary64 or of whole numbers.
#[derive(Clone, Copy, Debug)]
pub struct Limits<T> {
    /// Least value.
    pub low: T,
    /// Greatest value.
    pub high: T,
}

impl Limits<f64> {
    /// The content of a row with this range.
    ///
    /// # Panics
    /// If its type is none of binary64, when the declaration is compiled.
    #[must_use]
    pub const fn of(self, shape: Shape) -> Content {
        let Self { low, high } = self;
        let range = Range { low, high };
        Content::Value(match shape {
            Shape::Float => Kind::Float(range),
            Shape::Floats => Kind::Floats(range),
            Shape::Triple => Kind::Triple(range),
            _ => panic!("the range of this type has no fraction"),
        })
    }
}

impl Limits<i64> {
    /// The content of a row with this range.
    ///
    /// # Panics
    /// If its type is no whole number, when the declaration is compiled.
    #[must_use]
    pub const fn of(self, shape: Shape) -> Content {
        self.whole(shape, false)
    }

    /// The content of a row with the even numbers of this range.
    ///
    /// # Panics
    /// If its type is no whole number, when the declaration is compiled.
    #[must_use]
    pub const fn even(self, shape: Shape) -> Content {
        self.whole(shape, true)
    }

    const fn whole(self, shape: Shape, is_even: bool) -> Content {
        let Self {
            low: min,
            high: max,
        } = self;
        match shape {
            Shape::Integer => Content::Value(Kind::Integer(Integers { min, max, is_even })),
            _ => panic!("the range of binary64 is written with fractions"),
        }
    }
}
