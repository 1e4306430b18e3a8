//! A closed list of words: the macro that declares one, and what all of them can do.

use thiserror::Error;

/// A choice out of a closed list of words.
pub trait Word: Copy + 'static {
    /// The choices in the order in which they are listed.
    const ALL: &'static [Self];
    /// Their spellings, in the same order.
    const WORDS: &'static [&'static str];

    /// The first line of the choice's documentation, without its full stop.
    fn about(self) -> &'static str;
}

/// A text that is none of a list of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected one of {}", .expected.join(", "))]
pub struct UnknownWord {
    /// The words of the list.
    pub expected: &'static [&'static str],
}

/// Declares an enumeration of words: each variant with its documentation and its spelling.
macro_rules! words {
    ($(
        $(#[$attribute:meta])*
        pub enum $name:ident {
            $(#[doc = $about:literal] $(#[doc = $more:literal])* $variant:ident = $word:literal,)+
        }
    )+) => {$(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
        pub enum $name {
            $(
                #[doc = $about]
                $(#[doc = $more])*
                #[serde(rename = $word)]
                $variant,
            )+
        }

        impl $name {
            /// The spelling in files and on the command line.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }

        impl $crate::vocabulary::Word for $name {
            const ALL: &'static [Self] = &[$(Self::$variant),+];
            const WORDS: &'static [&'static str] = &[$($word),+];

            fn about(self) -> &'static str {
                let line = match self {
                    $(Self::$variant => $about,)+
                };
                line.trim().trim_end_matches('.')
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::vocabulary::UnknownWord;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                match text {
                    $($word => Ok(Self::$variant),)+
                    _ => Err($crate::vocabulary::UnknownWord {
                        expected: <Self as $crate::vocabulary::Word>::WORDS,
                    }),
                }
            }
        }
    )+};
}
pub(crate) use words;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::NumberFormat;

    #[test]
    fn a_word_is_read_as_it_is_written() {
        for (format, word) in NumberFormat::ALL.iter().zip(NumberFormat::WORDS) {
            assert_eq!(format.to_string(), *word);
            assert_eq!(word.parse::<NumberFormat>().as_ref(), Ok(format));
            let quoted = format!("\"{word}\"");
            assert_eq!(
                serde_json::from_str::<NumberFormat>(&quoted).unwrap(),
                *format
            );
            assert!(!format.about().is_empty() && !format.about().ends_with('.'));
        }
        let refused = "double".parse::<NumberFormat>().unwrap_err();
        assert_eq!(
            refused.to_string(),
            "expected one of binary64, binary32, binary64-ftz, binary32-ftz"
        );
    }
}
