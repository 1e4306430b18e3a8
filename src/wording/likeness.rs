//! Whether a wrong name can stand for a known one.
//!
//! A name of another quantity is never taken for a slip of the pen, however few letters lie between:
//! a word that is a word of its own (`rate`) is no misspelling of another (`angle`).

use std::collections::BTreeSet;

use super::quantity::{Quantity, words_of, written_words};

/// Every word of the known names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Vocabulary(BTreeSet<String>);

impl<'a> FromIterator<&'a str> for Vocabulary {
    fn from_iter<T: IntoIterator<Item = &'a str>>(names: T) -> Self {
        let words = |name| written_words(name).into_iter().chain(words_of(name));
        Self(names.into_iter().flat_map(words).collect())
    }
}

impl Vocabulary {
    /// Whether a word is one of a known name.
    pub(crate) fn holds(&self, word: &str) -> bool {
        self.0.contains(word)
    }
}

/// How a wrong name resembles a known one, the likest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Likeness {
    /// The same words in another order, number or spelling, and the same unit.
    Same,
    /// The same words; the unit is left out or another one of the same kind.
    OtherUnit,
    /// So many letters apart.
    Misspelt(usize),
}

/// A name taken apart, once for many comparisons.
#[derive(Clone, Debug)]
pub(crate) struct Name {
    text: String,
    quantity: Quantity,
    written: Vec<String>,
    /// The written words without what stands between them.
    letters: String,
}

impl Name {
    pub(crate) fn of(text: &str) -> Self {
        let written = written_words(text);
        Self {
            text: text.to_owned(),
            quantity: Quantity::of(text),
            letters: written.concat(),
            written,
        }
    }

    /// The words that another name does not have.
    fn foreign<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = &'a String> {
        let words = self.written.iter();
        words.filter(|word| !other.written.contains(word))
    }
}

/// How `written` resembles `known`; none if it cannot stand for it.
pub(crate) fn likeness(written: &Name, known: &Name, vocabulary: &Vocabulary) -> Option<Likeness> {
    if written.text == known.text {
        return Some(Likeness::Same);
    }
    let (own, other) = (&written.quantity, &known.quantity);
    if own.words == other.words {
        return match (&own.unit, &other.unit) {
            (one, two) if one == two => Some(Likeness::Same),
            (None, Some(_)) => Some(Likeness::OtherUnit),
            (Some(one), Some(two)) if one.dimension == two.dimension => Some(Likeness::OtherUnit),
            _ => None,
        };
    }
    // A word of its own is no misspelling, nor is a number one of another; and where nothing is
    // misspelt, a word is missing.
    let is_known = |word: &String| vocabulary.holds(word) || has_digit(word);
    if written.foreign(known).next().is_none()
        || written.foreign(known).any(is_known)
        || known.foreign(written).any(|word| has_digit(word))
    {
        return None;
    }
    abbreviated(&written.written, &known.written).or_else(|| {
        let distance = distance(&written.letters, &known.letters)?;
        Some(Likeness::Misspelt(distance))
    })
}

fn has_digit(word: &str) -> bool {
    word.contains(|c: char| c.is_ascii_digit())
}

/// Whether every word begins the word of the same place, with three letters at least.
fn abbreviated(own: &[String], other: &[String]) -> Option<Likeness> {
    const LETTERS_MIN: usize = 3;
    let begins = |(short, long): (&String, &String)| {
        short == long || (short.len() >= LETTERS_MIN && long.starts_with(short.as_str()))
    };
    let is_short = own.len() == other.len() && own.iter().zip(other).all(begins);
    is_short.then_some(Likeness::Misspelt(1))
}

/// Letters between two words, none if they are more than a slip of the pen: one in a short word, two
/// from eight letters on, and none but a swap, an omission or an addition in three letters.
fn distance(own: &str, other: &str) -> Option<usize> {
    let (short, long) = (own.len().min(other.len()), own.len().max(other.len()));
    let allowed = match long {
        0..=2 => return None,
        3..=7 => 1,
        _ => 2,
    };
    if long - short > allowed {
        return None;
    }
    let distance = strsim::osa_distance(own, other);
    let is_swap = || {
        let sorted = |word: &str| {
            let mut letters: Vec<char> = word.chars().collect();
            letters.sort_unstable();
            letters
        };
        sorted(own) == sorted(other)
    };
    let is_slip = long > 3 || short != long || is_swap();
    (distance <= allowed && is_slip).then_some(distance)
}

/// Whether a free word, such as a choice or the name of a channel, can stand for a known one.
pub(crate) fn is_misspelling(written: &str, known: &str) -> bool {
    let squashed = |word: &str| -> String {
        let letters = word.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    let (own, other) = (squashed(written), squashed(known));
    !own.is_empty() && (own == other || distance(&own, &other).is_some())
}
