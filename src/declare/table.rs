//! The macros that declare tables of keys.

/// Declares a table of keys: a configuration struct, how it is read, and its rows.
///
/// ```text
/// table! {
///     /// Fibre coil.
///     pub struct CoilConfig {
///         /// Fibre length. Source of the default: the paper.
///         length_m: f64 = 800.0, in 1.0..=50000.0, "m";
///     }
/// }
/// ```
///
/// A row is `name: type = default`, or without default `name: type, example value`, then where they
/// apply the range `in low..=high` (`even in` for even numbers), another `kind` than that of the type,
/// and the unit. A type `Option` may be absent, any other without default is required; tables inside
/// stand by their type. A row that is `apart` is read before the struct is made and not part of it.
macro_rules! table {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:ident),+)])?
        pub struct $name:ident
        $(, one $noun:literal of $($alternative:ident)|+)?
        $(, beside $beside:literal)?
        {
            $(
                $(#[doc = $doc:literal])*
                $(#[serde($flatten:ident)])?
                $field:ident $(as $array:literal)?: $type:ty
                    $(= $default:expr)?
                    $(, example $example:expr)?
                    $(, in $low:literal..=$high:literal)?
                    $(, even in $even_low:literal..=$even_high:literal)?
                    $(, kind $kind:ident)?
                    $(, $unit:literal)?
                    $(, apart $why:literal)?;
            )*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq, $($($derive,)+)? serde::Deserialize)]
        pub struct $name {
            $(
                $(#[doc = $doc])*
                #[doc = concat!("\n\n`", stringify!($field), $(" = ", stringify!($default),)? "`"
                    $(, ", in ", stringify!($low), " ..= ", stringify!($high))? $(, " ", $unit)?)]
                $(#[serde($flatten)])?
                $(#[serde(rename = $array, default)])?
                $(#[cfg(any())] #[doc = $why])?
                pub $field: $type,
            )*
        }

        impl $name {
            /// The declaration of its keys.
            pub const TABLE: $crate::declare::Table = $crate::declare::Table {
                about: &[$($about),+],
                rows: &[$($crate::declare::Row {
                    name: $crate::declare::table!(@name $field $($array)? $(; $flatten)?),
                    content: $crate::declare::table!(@content $type $(, kind $kind)?
                        $(, of $low, $high)? $(, even $even_low, $even_high)?),
                    unit: concat!($($unit)?),
                    presence: $crate::declare::table!(@presence $type $(, $default)?),
                    literal: concat!($(stringify!($default))? $(stringify!($example))?),
                    doc: &[$($doc),*],
                }),*],
                group: $crate::declare::table!(@group $($noun $($alternative)+)?),
                beside: concat!($($beside)?),
            };

            /// The settings as the reference shows them: every default, and the examples of what is
            /// required.
            #[must_use]
            pub fn reference() -> Self {
                Self {
                    $(
                        $(#[cfg(any())] #[doc = $why])?
                        $field: $crate::declare::table!(@value $type $(, $default)? $(, $example)?),
                    )*
                }
            }
        }
        $crate::declare::table!(@setting $name);
    };
    (@setting $name:ident) => {
        impl $crate::declare::Setting for $name {
            const SHAPE: $crate::declare::Shape =
                $crate::declare::Shape::Plain($crate::declare::Content::Table(&Self::TABLE));
            const LIST: $crate::declare::Shape =
                $crate::declare::Shape::Plain($crate::declare::Content::Tables(&Self::TABLE));
        }

        impl $crate::declare::Reference for $name {
            fn reference() -> Self {
                Self::reference()
            }
        }
    };
    (@name $field:ident; $flatten:ident) => { "" };
    (@name $field:ident) => { stringify!($field) };
    (@name $field:ident $array:literal) => { $array };
    (@content $type:ty) => { <$type as $crate::declare::Setting>::SHAPE.unlimited() };
    (@content $type:ty, kind $kind:ident) => {
        $crate::declare::Content::Value($crate::declare::Kind::$kind)
    };
    (@content $type:ty, $of:ident $low:literal, $high:literal) => {
        $crate::declare::Limits { low: $low, high: $high }
            .$of(<$type as $crate::declare::Setting>::SHAPE)
    };
    (@presence $type:ty) => {
        $crate::declare::Presence::without_default(
            <$type as $crate::declare::Setting>::IS_OPTIONAL,
        )
    };
    (@presence $type:ty, $default:expr) => { $crate::declare::Presence::Defaulted };
    (@group) => { None };
    (@group $noun:literal $($alternative:ident)+) => {
        Some($crate::declare::Group {
            table: "",
            noun: $noun,
            alternatives: &[$(stringify!($alternative)),+],
            has_default: false,
        })
    };
    (@value $type:ty) => { <$type as $crate::declare::Reference>::reference() };
    (@value $type:ty, $literal:expr) => {
        <$type as $crate::declare::FromLiteral<_>>::from_literal($literal)
    };
}

/// Declares tables of which exactly one stands: an enumeration of their configurations.
///
/// `first by default` lets the first one stand where a file gives none.
macro_rules! alternatives {
    (
        $(#[doc = $about:literal])+
        pub enum $name:ident, one $noun:literal $(, first by $default:ident)? {
            $(
                $(#[doc = $doc:literal])*
                $variant:ident($type:ty) = $word:literal,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
        pub enum $name {
            $(
                $(#[doc = $doc])*
                #[doc = concat!("\n\n`", $word, "`")]
                #[serde(rename = $word)]
                $variant($type),
            )+
        }

        impl $name {
            /// The declaration of its alternatives.
            pub const TABLE: $crate::declare::Table = $crate::declare::Table {
                about: &[$($about),+],
                rows: &[$($crate::declare::Row {
                    name: $word,
                    content: <$type as $crate::declare::Setting>::SHAPE.unlimited(),
                    unit: "",
                    presence: $crate::declare::Presence::Defaulted,
                    literal: "",
                    doc: &[$($doc),*],
                }),+],
                group: Some($crate::declare::Group {
                    table: "",
                    noun: $noun,
                    alternatives: &[$($word),+],
                    has_default: <[&str]>::len(&[$(stringify!($default))?]) == 1,
                }),
                beside: "",
            };

            /// Name of the alternative in a file.
            #[must_use]
            pub const fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $word,)+
                }
            }

            /// The first alternative as the reference shows it.
            #[must_use]
            pub fn reference() -> Self {
                let all: &[fn() -> Self] =
                    &[$(|| Self::$variant(<$type as $crate::declare::Reference>::reference())),+];
                all[0]()
            }
        }
        $crate::declare::table!(@setting $name);
    };
}

pub(crate) use {alternatives, table};
