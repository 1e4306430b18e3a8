//! Words for people: which known name a wrong one stands for, numbers and counts in messages.
//!
//! Invariant: knows no name of any stage; whoever asks brings the known ones along.

mod likeness;
mod quantity;
mod text;

pub(crate) use likeness::{Likeness, Name, Vocabulary, is_misspelling, likeness};
pub(crate) use quantity::{conversion, words_of};
pub(crate) use text::{counted, decimals, exact, number, option_of, plain, printable, to_digits};
