//! One-dimensional NPY files of binary64, binary32 or integers of 8 to 64 bits.

use std::io::Read;
use std::path::Path;

use super::column::{Column, Columns};
use super::error::{LogError, Place};
use super::input::{Input, failure, push};
use super::npy_heading::{self, HeadingError, NpyHeading, Word};

/// Largest integer that binary64 holds with all below it.
const INTEGER_MAX: u64 = 1 << 53;
/// Bytes that are read at a time: whole numbers of every size.
const CHUNK_BYTES: usize = 1 << 16;

/// Reads the array of a file, at most `samples_max` numbers of it.
///
/// # Errors
/// Another shape or number type, a file with less or more bytes than its heading says, a number that
/// is not finite, an integer beyond binary64.
pub(super) fn read(path: &Path, mut input: Input, samples_max: usize) -> Result<Columns, LogError> {
    let heading = npy_heading::read(&mut input).map_err(|error| match error {
        HeadingError::Io(error) => failure(path, error),
        error => LogError::of_file(path, error),
    })?;
    if let Some(length) = input.length() {
        check_length(&heading, length).map_err(|error| LogError::of_file(path, error))?;
    }
    let mut values = Vec::new();
    let mut chunk = vec![0; CHUNK_BYTES];
    let wanted = heading
        .count
        .min(u64::try_from(samples_max).unwrap_or(u64::MAX));
    let per_chunk = CHUNK_BYTES / heading.word_bytes;
    while (values.len() as u64) < wanted {
        let left = usize::try_from(wanted - values.len() as u64).unwrap_or(usize::MAX);
        let bytes = &mut chunk[..left.min(per_chunk) * heading.word_bytes];
        input
            .read_exact(bytes)
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::UnexpectedEof => {
                    LogError::of_file(path, LengthError::CutShort(heading))
                }
                _ => failure(path, error),
            })?;
        for word in bytes.chunks_exact(heading.word_bytes) {
            let value = number(&heading, word)
                .map_err(|error| LogError::at(path, Place::Index(values.len()), error))?;
            push(&mut values, value).map_err(|error| failure(path, error))?;
        }
    }
    if wanted == heading.count {
        let more = input.read(&mut [0]).map_err(|error| failure(path, error))?;
        if more > 0 {
            let there_is_more = LengthError::More(heading, None);
            return Err(LogError::of_file(path, there_is_more));
        }
    }
    Ok(Columns {
        data: vec![Column { name: None, values }],
        ..Columns::default()
    })
}

/// Why a file does not hold what its heading names.
#[derive(Debug, thiserror::Error)]
enum LengthError {
    /// With the bytes behind the heading.
    #[error(
        "not a whole NPY file: its {}, the file has {there} bytes for them",
        named(heading)
    )]
    TooShort { heading: NpyHeading, there: u64 },
    #[error("not a whole NPY file: its {}, and it ends before them", named(.0))]
    CutShort(NpyHeading),
    /// With the number of bytes where it is known.
    #[error(
        "its NPY {}, and {}more bytes follow them: expected one array and nothing behind it",
        named(.0),
        .1.map(|left| format!("{left} ")).unwrap_or_default()
    )]
    More(NpyHeading, Option<u64>),
}

fn named(heading: &NpyHeading) -> String {
    let NpyHeading {
        count, word_bytes, ..
    } = heading;
    format!("heading names {count} numbers of {word_bytes} bytes")
}

/// Holds the bytes of a file against those its heading asks for.
fn check_length(heading: &NpyHeading, length: u64) -> Result<(), LengthError> {
    let there = length.saturating_sub(heading.bytes);
    match heading.count.checked_mul(heading.word_bytes as u64) {
        Some(expected) if expected == there => Ok(()),
        Some(expected) if expected < there => {
            Err(LengthError::More(*heading, Some(there - expected)))
        }
        _ => Err(LengthError::TooShort {
            heading: *heading,
            there,
        }),
    }
}

/// Why a word is no number of a record.
#[derive(Debug, thiserror::Error)]
enum WordError {
    #[error("{0} is not a finite number")]
    NotFinite(f64),
    #[error("{0} lies beyond 2^53, the largest count that is kept exactly")]
    Inexact(i128),
}

/// The number that the bytes of a word are.
fn number(heading: &NpyHeading, bytes: &[u8]) -> Result<f64, WordError> {
    let mut word = [0; 8];
    for (position, byte) in bytes.iter().enumerate() {
        // From the least significant byte on.
        let place = if heading.is_big_endian {
            bytes.len() - 1 - position
        } else {
            position
        };
        word[place] = *byte;
    }
    let [b0, b1, b2, b3, ..] = word;
    let value = match heading.word {
        Word::F4 => f64::from(f32::from_le_bytes([b0, b1, b2, b3])),
        Word::F8 => f64::from_le_bytes(word),
        Word::I1 => f64::from(i8::from_le_bytes([b0])),
        Word::I2 => f64::from(i16::from_le_bytes([b0, b1])),
        Word::I4 => f64::from(i32::from_le_bytes([b0, b1, b2, b3])),
        Word::I8 => integer(i64::from_le_bytes(word))?,
        Word::U1 => f64::from(b0),
        Word::U2 => f64::from(u16::from_le_bytes([b0, b1])),
        Word::U4 => f64::from(u32::from_le_bytes([b0, b1, b2, b3])),
        Word::U8 => integer(u64::from_le_bytes(word))?,
    };
    if value.is_finite() {
        Ok(value)
    } else {
        Err(WordError::NotFinite(value))
    }
}

/// An integer that binary64 holds exactly.
fn integer(word: impl Into<i128>) -> Result<f64, WordError> {
    let word = word.into();
    if word.unsigned_abs() > u128::from(INTEGER_MAX) {
        return Err(WordError::Inexact(word));
    }
    #[expect(clippy::cast_precision_loss, reason = "checked to lie within 2^53")]
    let value = word as f64;
    Ok(value)
}
