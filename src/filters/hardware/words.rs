//! From the words of a scenario to formats of signals.

use crate::filters::words::FixedWords;
use crate::fpga::fixed::{Format, SignalName};

/// The format of a signal, whose table has its name in small letters.
pub(super) fn format(words: &FixedWords, signal: SignalName) -> Format {
    let word = words.word(&signal.name().to_lowercase());
    Format {
        integer_bits: word.integer_bits,
        // More integer bits than bits are refused before.
        fraction_bits: word.word_bits.saturating_sub(word.integer_bits),
        rounding: word.rounding,
        overflow: word.overflow,
    }
}
