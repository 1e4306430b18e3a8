//! Words that were computed elsewhere: an NPY array, or the hexadecimal words of a testbench.

use std::path::Path;

use super::read::read_stimulus;
use crate::recording::error::{LogError, Place};
use crate::recording::input::{Input, failure, push};
use crate::recording::npy::heading;
use crate::recording::text::lines::{Lines, TextError, shown};

/// End of the name of a file of hexadecimal words, as `$writememh` makes it.
const HEX: &str = "hex";

/// Reads every word of a file as it stands, and nothing else: an NPY array of one dimension, or, in a
/// file that ends in `.hex`, one word a line in the bits of binary64 or binary32.
///
/// # Errors
/// What is neither, a word that is not finite, a file without words.
pub fn read_words(path: &Path) -> Result<Vec<f64>, LogError> {
    let input = Input::open(path)?;
    let is_hex = path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case(HEX));
    let words = if input.starts_with(heading::MAGIC) {
        drop(input);
        read_stimulus(path, None, usize::MAX)?
    } else if is_hex {
        read_hex(path, input)?
    } else {
        let message = "neither an NPY array nor a .hex file of a testbench: write the words as NPY, \
                       as numpy.save does";
        return Err(LogError::of_file(path, message));
    };
    if words.is_empty() {
        return Err(LogError::of_file(path, "holds no word"));
    }
    Ok(words)
}

fn read_hex(path: &Path, input: Input) -> Result<Vec<f64>, LogError> {
    let mut lines = Lines::new(input, "no text: expected a hexadecimal word a line");
    let mut words = Vec::new();
    let mut digits = None;
    loop {
        let line = match lines.next_line() {
            Ok(Some(line)) => line,
            Ok(None) => return Ok(words),
            Err(TextError::Io(error)) => return Err(failure(path, error)),
            Err(TextError::Content { line, message, .. }) => {
                return Err(LogError::at(path, Place::Line(line), message));
            }
        };
        let text = line.text.trim();
        let width = *digits.get_or_insert(text.len());
        let word = hex_word(text, width);
        let word = word.map_err(|error| LogError::at(path, Place::Line(line.number), error))?;
        push(&mut words, word).map_err(|error| failure(path, error))?;
    }
}

/// Why a line is no hexadecimal word.
#[derive(Debug, thiserror::Error)]
enum HexError {
    #[error(
        "`{0}` is no word: expected 16 hexadecimal digits of a binary64 number, or 8 of a binary32 one"
    )]
    NotAWord(String),
    #[error("`{text}` has {} digits where the first word has {width}", text.len())]
    Width { text: String, width: usize },
    #[error("`{text}` is {value}, which is not a finite number")]
    NotFinite { text: String, value: f64 },
}

/// The number that the digits of a word are the bits of.
fn hex_word(text: &str, width: usize) -> Result<f64, HexError> {
    let is_hex = text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let bits = u64::from_str_radix(text, 16).ok().filter(|_| is_hex);
    let value = match (bits, text.len()) {
        (Some(_), length) if length != width => {
            let text = shown(text);
            return Err(HexError::Width { text, width });
        }
        (Some(bits), 16) => f64::from_bits(bits),
        (Some(bits), 8) => f64::from(f32::from_bits(u32::try_from(bits).unwrap_or(u32::MAX))),
        _ => return Err(HexError::NotAWord(shown(text))),
    };
    if value.is_finite() {
        Ok(value)
    } else {
        let text = shown(text);
        Err(HexError::NotFinite { text, value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, content: &str) -> Result<Vec<f64>, LogError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read_words(&path)
    }

    /// What is said of a file, without its folder.
    fn message(name: &str, content: &str) -> String {
        let said = read(name, content).unwrap_err().to_string();
        said[said.find(name).unwrap()..].to_owned()
    }

    #[test]
    fn hexadecimal_words_are_the_bits_of_numbers() {
        let doubles = read("y.hex", "3ff8000000000000\nc01e000000000000\n");
        assert_eq!(doubles.unwrap(), [1.5, -7.5]);
        assert_eq!(read("y.HEX", "3fc00000\n").unwrap(), [1.5]);
    }

    #[test]
    fn what_is_no_word_is_refused_with_its_line() {
        let message = |content| super::tests::message("y.hex", content);
        assert_eq!(message(""), "y.hex: holds no word");
        let end = "expected 16 hexadecimal digits of a binary64 number, or 8 of a binary32 one";
        let first = message("3ff8000000000000\n3ff800000000000x\n");
        assert_eq!(
            first,
            format!("y.hex:2: `3ff800000000000x` is no word: {end}")
        );
        assert_eq!(
            message("3ff\n"),
            format!("y.hex:1: `3ff` is no word: {end}")
        );
        assert_eq!(
            message("3ff8000000000000\n3fc00000\n"),
            "y.hex:2: `3fc00000` has 8 digits where the first word has 16"
        );
        assert_eq!(
            message("7ff8000000000000\n"),
            "y.hex:1: `7ff8000000000000` is NaN, which is not a finite number"
        );
        let text = super::tests::message("y.txt", "1.5\n");
        assert!(text.starts_with("y.txt: neither an NPY array"), "{text}");
    }
}
