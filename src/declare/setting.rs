//! What the types of configurations are in a file.

use super::kind::{Content, Kind, Shape};
use crate::vocabulary::Word;

/// A type that a key or a table can have.
pub trait Setting: Sized {
    /// What it is in a file.
    const SHAPE: Shape;
    /// What a list of them is.
    const LIST: Shape;
    /// Whether it may be absent.
    const IS_OPTIONAL: bool = false;
}

/// A value that is made of what a declaration states as its default or example.
pub trait FromLiteral<L> {
    /// The value.
    fn from_literal(literal: L) -> Self;
}

/// A value that needs no default: that of a table, or none.
#[diagnostic::on_unimplemented(
    message = "a key of type `{Self}` needs a default, `= value`, or an example, `, example value`"
)]
pub trait Reference {
    /// As the reference shows it: every default, and the examples of what is required.
    fn reference() -> Self;
}

impl Setting for f64 {
    const SHAPE: Shape = Shape::Float;
    const LIST: Shape = Shape::Floats;
}

impl Setting for [f64; 3] {
    const SHAPE: Shape = Shape::Triple;
    const LIST: Shape = Shape::Impossible;
}

impl Setting for u32 {
    const SHAPE: Shape = Shape::Integer;
    const LIST: Shape = Shape::Impossible;
}

impl Setting for u64 {
    const SHAPE: Shape = Shape::Integer;
    const LIST: Shape = Shape::Impossible;
}

impl Setting for bool {
    const SHAPE: Shape = Shape::Plain(Content::Value(Kind::Boolean));
    const LIST: Shape = Shape::Impossible;
}

impl Setting for String {
    const SHAPE: Shape = Shape::Plain(Content::Value(Kind::Text));
    const LIST: Shape = Shape::Plain(Content::Value(Kind::Texts));
}

impl<W: Word> Setting for W {
    const SHAPE: Shape = Shape::Plain(Content::Value(Kind::Choice(W::WORDS)));
    const LIST: Shape = Shape::Plain(Content::Value(Kind::Choices(W::WORDS)));
}

impl<T: Setting> Setting for Vec<T> {
    const SHAPE: Shape = T::LIST;
    const LIST: Shape = Shape::Impossible;
}

impl<T: Setting> Setting for Option<T> {
    const SHAPE: Shape = T::SHAPE;
    const LIST: Shape = Shape::Impossible;
    const IS_OPTIONAL: bool = true;
}

macro_rules! as_written {
    ($($type:ty)+) => {$(
        impl FromLiteral<$type> for $type {
            fn from_literal(literal: $type) -> Self {
                literal
            }
        }
    )+};
}
as_written!(f64 [f64; 3] u32 u64 bool);

/// Gives a type that has a form as text, by `FromStr` and `Display`, what a key of a file needs.
macro_rules! spelled {
    ($type:ty) => {
        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = String::deserialize(deserializer)?;
                text.parse().map_err(serde::de::Error::custom)
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl $crate::declare::Setting for $type {
            const SHAPE: $crate::declare::Shape = $crate::declare::Shape::Plain(
                $crate::declare::Content::Value($crate::declare::Kind::Spelled(|text| {
                    text.parse::<Self>().err().map(|error| error.to_string())
                })),
            );
            const LIST: $crate::declare::Shape = $crate::declare::Shape::Impossible;
        }

        impl $crate::declare::FromLiteral<&str> for $type {
            fn from_literal(literal: &str) -> Self {
                literal
                    .parse()
                    .expect("an example has the form of its type")
            }
        }
    };
}
pub(crate) use spelled;

impl FromLiteral<&str> for String {
    fn from_literal(literal: &str) -> Self {
        literal.to_owned()
    }
}

impl<W: Word> FromLiteral<&str> for W {
    fn from_literal(literal: &str) -> Self {
        let index = W::WORDS.iter().position(|word| *word == literal);
        W::ALL[index.expect("a default is one of its words, which a test asserts")]
    }
}

impl<L, T: FromLiteral<L>, const N: usize> FromLiteral<[L; N]> for Vec<T> {
    fn from_literal(literal: [L; N]) -> Self {
        literal.map(T::from_literal).into()
    }
}

/// The example of what may be absent is no default: it is absent.
impl<L, T: FromLiteral<L>> FromLiteral<L> for Option<T> {
    fn from_literal(_: L) -> Self {
        None
    }
}

impl<T> Reference for Option<T> {
    fn reference() -> Self {
        None
    }
}

/// No table of an array stands by default.
impl<T> Reference for Vec<T> {
    fn reference() -> Self {
        Self::new()
    }
}
