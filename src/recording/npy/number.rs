//! What the bytes of a word are: a number, a stamp.

use super::heading::{NpyHeading, Word};
use crate::recording::layout::words::MissingWords;
use crate::recording::log::gaps::Gaps;
use crate::recording::text::table::Wanted;
use crate::recording::time::stamp::Stamp;
use crate::recording::time::unit::TimeUnit;

/// Largest integer that binary64 holds with all below it.
const INTEGER_MAX: u64 = 1 << 53;

/// Why a word is no number of a record.
#[derive(Debug, thiserror::Error)]
pub(super) enum WordError {
    #[error("{0} is not a finite number{1}")]
    NotFinite(f64, &'static str),
    #[error("{0} lies beyond 2^53, the largest count that is kept exactly")]
    Inexact(i128),
    #[error("{0} is beyond the times that a clock shows")]
    NoTime(f64),
}

/// The number that the bytes of a word are.
fn number(heading: &NpyHeading, bytes: &[u8]) -> Result<f64, WordError> {
    let word = word(heading, bytes);
    let [b0, b1, b2, b3, ..] = word;
    let value = match heading.word {
        Word::F2 => half(u16::from_le_bytes([b0, b1])),
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
        Err(WordError::NotFinite(value, ""))
    }
}

/// What is done with words that are no number.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Missing {
    /// Whether the sample is missing.
    is_gap: bool,
    /// What may be done about it.
    gaps: Gaps,
}

impl Missing {
    pub(in crate::recording) fn of(wanted: &Wanted<'_>) -> Self {
        Self {
            is_gap: wanted.format.missing == Some(MissingWords::Gap),
            gaps: wanted.gaps,
        }
    }

    /// The number that the bytes of a word are, NaN where one is missing.
    pub(super) fn number(self, heading: &NpyHeading, bytes: &[u8]) -> Result<f64, WordError> {
        match number(heading, bytes) {
            Err(WordError::NotFinite(value, _)) if value.is_nan() => match self.is_gap {
                true => Ok(value),
                false => Err(WordError::NotFinite(value, self.gaps.at_number())),
            },
            found => found,
        }
    }
}

/// The stamp that the bytes of a word are.
pub(super) fn stamp(
    heading: &NpyHeading,
    bytes: &[u8],
    unit: TimeUnit,
) -> Result<Stamp, WordError> {
    let stamp = match whole(heading, bytes) {
        Some(whole) => Stamp::of_whole(whole, unit),
        None => Stamp::of_number(number(heading, bytes)?, unit),
    };
    stamp.ok_or_else(|| WordError::NoTime(number(heading, bytes).unwrap_or(f64::INFINITY)))
}

/// The bytes of a word from the least significant one on.
fn word(heading: &NpyHeading, bytes: &[u8]) -> [u8; 8] {
    let mut word = [0; 8];
    word[..bytes.len()].copy_from_slice(bytes);
    if heading.is_big_endian {
        word[..bytes.len()].reverse();
    }
    word
}

/// The whole number that a word of 64 bits is, with all of its digits.
fn whole(heading: &NpyHeading, bytes: &[u8]) -> Option<i128> {
    let word = word(heading, bytes);
    match heading.word {
        Word::I8 => Some(i64::from_le_bytes(word).into()),
        Word::U8 => Some(u64::from_le_bytes(word).into()),
        _ => None,
    }
}

/// The number that the bits of binary16 are.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    let magnitude = match (bits >> 10) & 0x1f {
        0 => fraction * 2_f64.powi(-14),
        0x1f if bits & 0x3ff == 0 => f64::INFINITY,
        0x1f => f64::NAN,
        exponent => (1.0 + fraction) * 2_f64.powi(i32::from(exponent) - 15),
    };
    sign * magnitude
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
