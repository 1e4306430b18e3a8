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
/// and the unit. What is `told in` an account or a budget is named there where nobody sets it; a table tells it of
/// its rows. A type `Option` may be absent, any other without default is required; tables inside
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
                    $(, told in $($told:ident)+)?
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
                    told: &[$($($crate::declare::Told::$told),+)?],
                    successor: None,
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
    (@each $name:ident () $($variant:ident)+) => {};
    (@each $name:ident ($kind:ident) $($variant:ident)+) => {
        impl $name {
            /// The alternative that stands, whichever it is.
            fn kind(&self) -> &dyn $kind {
                match self {
                    $(Self::$variant(one) => one,)+
                }
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
/// `first by default` lets the first one stand where a file gives none, `each as Trait` gives the
/// enumeration a method `kind` that takes the one that stands as a `&dyn Trait`.
macro_rules! alternatives {
    (
        $(#[doc = $about:literal])+
        pub enum $name:ident, one $noun:literal $(, first by $default:ident)? $(, each as $kind:ident)? {
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
                    told: &[],
                    successor: None,
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
        $crate::declare::table!(@each $name ($($kind)?) $($variant)+);
        $crate::declare::table!(@setting $name);
    };
}

/// Declares a key beside its former name, under which files may still give it in another unit.
///
/// The enumeration holds the value in the unit in which it was given, so that an old file keeps its
/// bits; `times` is the value of the key over that of the former one. It stands flat in its table.
///
/// ```text
/// renamed! {
///     /// Random walk of the rate.
///     pub enum RateRandomWalk, one "random walk" {
///         /// Random walk of the rate. Source of the default: assumed.
///         PerSqrtH = "walk_per_sqrt_h": 11400.0, in 6e-8..=6e10, "deg/h/sqrt(h)";
///         formerly PerSqrtS = "walk_per_sqrt_s": 190.0, in 1e-9..=1e9, "deg/h/sqrt(s)", times 60.0;
///     }
/// }
/// ```
macro_rules! renamed {
    (
        $(#[doc = $about:literal])+
        pub enum $name:ident, one $noun:literal {
            $(#[doc = $doc:literal])+
            $now:ident = $key:literal: $default:literal, in $low:literal..=$high:literal, $unit:literal;
            formerly $former:ident = $old:literal: $example:literal,
                in $old_low:literal..=$old_high:literal, $old_unit:literal, times $factor:literal;
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
        pub enum $name {
            $(#[doc = $doc])+
            #[doc = concat!("\n\n`", $key, " = ", stringify!($default), "`, ", $unit)]
            #[serde(rename = $key)]
            $now(f64),
            #[doc = concat!("The same in ", $old_unit, " under its former name `", $old, "`.")]
            #[serde(rename = $old)]
            $former(f64),
        }

        impl $name {
            /// The declaration of the key and its former name.
            pub const TABLE: $crate::declare::Table = $crate::declare::Table {
                about: &[$($about),+],
                rows: &[
                    $crate::declare::Row {
                        name: $key,
                        content: $crate::declare::table!(@content f64, of $low, $high),
                        unit: $unit,
                        presence: $crate::declare::Presence::Defaulted,
                        literal: stringify!($default),
                        doc: &[$($doc),+],
                        told: &[],
                        successor: None,
                    },
                    $crate::declare::Row {
                        name: $old,
                        content: $crate::declare::table!(@content f64, of $old_low, $old_high),
                        unit: $old_unit,
                        presence: $crate::declare::Presence::Optional,
                        literal: stringify!($example),
                        doc: &[concat!(" Former name of ", $key, ", in another unit.")],
                        told: &[],
                        successor: Some($crate::declare::Successor {
                            name: $key,
                            unit: $unit,
                            factor: $factor,
                        }),
                    },
                ],
                group: Some($crate::declare::Group {
                    table: "",
                    noun: $noun,
                    alternatives: &[$key, $old],
                    has_default: true,
                }),
                beside: "",
            };

            /// The default.
            #[must_use]
            pub fn reference() -> Self {
                Self::$now($default)
            }
        }
        $crate::declare::table!(@setting $name);
    };
}

pub(crate) use {alternatives, renamed, table};

#[cfg(test)]
#[expect(
    unreachable_pub,
    reason = "the macros declare public items, which a module of tests does not reach"
)]
mod tests {
    use crate::declare::{Content, Keys, Kind, Presence};
    use crate::vocabulary::words;

    words! {
        /// Colours of a lamp.
        pub enum Colour {
            /// Red.
            Red = "red",
            /// Green.
            Green = "green",
        }
    }

    table! {
        /// A lamp.
        pub struct Lamp {
            /// Power. Source of the default: none.
            power_w: f64 = 5.0, in 0.0..=100.0, "W";
            /// Pulses in a row,
            /// in pairs.
            pulses: u32 = 4, even in 2..=8;
            /// Colour.
            colour: Colour = "green";
            /// Where it stands.
            place: String, example "hall";
            /// Dimming, if it is dimmed.
            dimming: Option<f64>, example 0.5, in 0.0..=1.0;
            /// File it was read from.
            file: Option<String>, example "lamp.toml", apart "it has been read";
            mount: Mount;
        }
    }

    alternatives! {
        /// How it is fixed.
        pub enum Mount, one "mount", first by default {
            /// It stands.
            Foot(Foot) = "foot",
            Chain(Chain) = "chain",
        }
    }

    table! {
        /// Nothing to set.
        pub struct Foot {}
    }

    table! {
        /// A chain.
        pub struct Chain {
            /// Its lengths.
            lengths_m: Vec<f64>, example [1.0, 2.0], in 0.0..=10.0, "m";
        }
    }

    #[test]
    fn one_declaration_gives_rows_and_values() {
        let lamp = Lamp::reference();
        assert_eq!(lamp.power_w.to_bits(), 5.0_f64.to_bits());
        assert_eq!((lamp.pulses, lamp.colour), (4, Colour::Green));
        assert_eq!(lamp.place, "hall");
        assert_eq!((lamp.dimming, lamp.mount.name()), (None, "foot"));
        assert_eq!(lamp.mount, Mount::Foot(Foot {}));
        assert_eq!(Chain::reference().lengths_m, [1.0, 2.0]);
        assert!(matches!(Lamp::TABLE.rows[6].content, Content::Table(_)));
    }

    #[test]
    fn the_keys_of_a_declaration_stand_under_their_paths() {
        let found = Keys::of(&Lamp::TABLE);
        let lines: Vec<String> = found
            .keys
            .iter()
            .map(|key| format!("{} = {} | {}", key.path, key.literal, key.line()))
            .collect();
        assert_eq!(
            lines,
            [
                "power_w = 5.0 | Number [0, 100]; unit W; default.",
                "pulses = 4 | Integer even 2..=8; default.",
                "colour = \"green\" | Choice \"red\", \"green\"; default.",
                "place = \"hall\" | Text; required.",
                "dimming = 0.5 | Number [0, 1]; optional.",
                "file = \"lamp.toml\" | Text; optional.",
                "mount.foot =  | Table without keys; default.",
                "mount.chain.lengths_m = [1.0, 2.0] | Array of numbers [0, 10]; unit m; required.",
            ]
        );
        let foot = found.keys.iter().find(|key| key.path == "mount.foot");
        assert_eq!(foot.map(|key| key.summary()).as_deref(), Some("It stands"));
        assert_eq!(found.keys[0].summary(), "Power");
        assert_eq!(found.keys[1].sentence(), "Pulses in a row, in pairs.");
        let groups = found.groups.iter();
        let groups: Vec<_> = groups.map(|group| (group.table, group.default())).collect();
        assert_eq!(groups, [("mount", Some("foot"))]);
        assert!(matches!(found.keys[6].kind, Kind::EmptyTable));
        assert_eq!(found.keys[7].presence, Presence::Required);
    }
}
