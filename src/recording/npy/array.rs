//! NPY files of one dimension or two: binary64, binary32, binary16 or integers of 8 to 64 bits.

use std::io::Read;
use std::path::Path;

use super::heading::{self, HeadingError, NpyHeading, Word};
use crate::recording::column::{Column, Columns};
use crate::recording::error::{LogError, Place};
use crate::recording::input::{failure, push};
use crate::recording::layout::columns::{Chosen, Selection, choose};
use crate::recording::layout::words::MissingWords;
use crate::recording::layout::{Layout, LayoutError};
use crate::recording::log::format::LogFormat;
use crate::recording::text::table::Wanted;
use crate::recording::time::column::TimeColumn;
use crate::recording::time::stamp::Stamp;

/// Largest integer that binary64 holds with all below it.
const INTEGER_MAX: u64 = 1 << 53;
/// Bytes that are read at a time: whole numbers of every size.
const CHUNK_BYTES: usize = 1 << 16;

/// An array while it is read.
struct Array<'a> {
    path: &'a Path,
    heading: NpyHeading,
    chosen: Chosen,
    is_gap: bool,
    samples_max: u64,
    columns: Columns,
    /// Stamps, or parts of them, by column of the time.
    parts: Vec<Vec<Stamp>>,
}

/// Reads columns of the array of a file.
///
/// * `length`: bytes of the file, where they are known before it is read.
///
/// # Errors
/// Another shape or number type, a file with less or more bytes than its heading says, a number that
/// is not finite, an integer beyond binary64.
pub(in crate::recording) fn read(
    path: &Path,
    mut input: impl Read,
    length: Option<u64>,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let heading = heading::read(&mut input).map_err(|error| match error {
        HeadingError::Io(error) => failure(path, error),
        error => LogError::of_file(path, error),
    })?;
    if let Some(length) = length {
        check_length(&heading, length).map_err(|error| LogError::of_file(path, error))?;
    }
    let chosen = chosen(&heading, wanted).map_err(|error| LogError::of_file(path, error))?;
    let mut array = Array::new(path, heading, chosen, wanted);
    array.read(&mut input)?;
    array.end()
}

/// Why columns of an array are not known.
#[derive(Debug, thiserror::Error)]
enum ColumnError {
    #[error("an NPY file of one dimension has no columns: leave `{0}` out")]
    NoColumns(String),
    #[error(transparent)]
    Layout(#[from] LayoutError),
}

/// The columns to read: by number, as an array has no headings.
fn chosen(heading: &NpyHeading, wanted: &Wanted<'_>) -> Result<Chosen, ColumnError> {
    let width = usize::try_from(heading.columns).unwrap_or(usize::MAX);
    if width == 1 {
        let column = match &wanted.columns {
            Selection::Named(names) => names.first().map(String::as_str),
            Selection::Each(names) => names.first().copied(),
        };
        let time = wanted.format.time.iter().flatten().map(String::as_str);
        let mut named = column
            .into_iter()
            .chain(time)
            .filter(|name| !matches!(*name, "1" | "none"));
        if let Some(name) = named.next() {
            return Err(ColumnError::NoColumns(name.to_owned()));
        }
        return Ok(Chosen {
            data: vec![0],
            ..Chosen::default()
        });
    }
    let layout = Layout::of_array(width);
    let needs_time = wanted.needs_time && wanted.format.time.is_some();
    Ok(choose(
        &layout,
        wanted.format,
        &[],
        &wanted.columns,
        needs_time,
    )?)
}

impl<'a> Array<'a> {
    fn new(path: &'a Path, heading: NpyHeading, chosen: Chosen, wanted: &Wanted<'_>) -> Self {
        let is_table = heading.columns > 1;
        let name = |index: usize| is_table.then(|| (index + 1).to_string());
        let data = chosen.data.iter().map(|index| Column {
            name: name(*index),
            ..Column::default()
        });
        let times: Vec<String> = chosen
            .time
            .iter()
            .filter_map(|(index, _)| name(*index))
            .collect();
        let time = (!times.is_empty()).then(|| {
            let units = chosen.time.iter().map(|(_, unit)| *unit).collect();
            let mut time = TimeColumn::new(times.join(" + "), units, false);
            time.rolls_over_after(wanted.format.roll_over);
            time
        });
        let columns = Columns {
            data: data.collect(),
            time,
            layout: is_table.then(|| heading.to_string()),
            ..Columns::default()
        };
        let parts = vec![Vec::new(); chosen.time.len()];
        let LogFormat { missing, .. } = wanted.format;
        Self {
            path,
            heading,
            chosen,
            is_gap: *missing == Some(MissingWords::Gap),
            samples_max: u64::try_from(wanted.samples_max).unwrap_or(u64::MAX),
            columns,
            parts,
        }
    }

    /// Reads the numbers in the order of the file.
    fn read(&mut self, input: &mut impl Read) -> Result<(), LogError> {
        let NpyHeading {
            word_bytes,
            rows,
            columns,
            is_by_column,
            ..
        } = self.heading;
        let wanted = match is_by_column {
            false => rows.min(self.samples_max) * columns,
            true => rows * columns,
        };
        let per_chunk = (CHUNK_BYTES / word_bytes) as u64;
        let mut chunk = vec![0; CHUNK_BYTES];
        let (mut row, mut column, mut left) = (0, 0, wanted);
        while left > 0 {
            let count = usize::try_from(left.min(per_chunk)).unwrap_or(0);
            let bytes = &mut chunk[..count * word_bytes];
            input
                .read_exact(bytes)
                .map_err(|error| match error.kind() {
                    std::io::ErrorKind::UnexpectedEof => {
                        LogError::of_file(self.path, LengthError::CutShort(self.heading))
                    }
                    _ => failure(self.path, error),
                })?;
            for word in bytes.chunks_exact(word_bytes) {
                self.take(word, row, column)?;
                if is_by_column {
                    row += 1;
                    if row == rows {
                        (row, column) = (0, column + 1);
                    }
                } else {
                    column += 1;
                    if column == columns {
                        (row, column) = (row + 1, 0);
                    }
                }
            }
            left -= count as u64;
        }
        if wanted == self.heading.count() {
            let more = input
                .read(&mut [0])
                .map_err(|error| failure(self.path, error))?;
            if more > 0 {
                let there_is_more = LengthError::More(self.heading, None);
                return Err(LogError::of_file(self.path, there_is_more));
            }
        }
        Ok(())
    }

    /// Takes a number, if its column is asked for.
    fn take(&mut self, word: &[u8], row: u64, column: u64) -> Result<(), LogError> {
        if row >= self.samples_max {
            return Ok(());
        }
        let at = |error: WordError| {
            LogError::at(
                self.path,
                Place::Index(usize::try_from(row).unwrap_or(usize::MAX)),
                error,
            )
        };
        let is_it = |index: usize| index as u64 == column;
        if let Some(position) = self.chosen.data.iter().position(|index| is_it(*index)) {
            let value = match number(&self.heading, word) {
                Err(WordError::NotFinite(value)) if self.is_gap && value.is_nan() => value,
                value => value.map_err(at)?,
            };
            let values = &mut self.columns.data[position].values;
            return push(values, value).map_err(|error| failure(self.path, error));
        }
        let time = self.chosen.time.iter().position(|(index, _)| is_it(*index));
        if let Some(position) = time {
            let (_, unit) = self.chosen.time[position];
            let stamp = match whole(&self.heading, word) {
                Some(whole) => Stamp::of_whole(whole, unit),
                None => Stamp::of_number(number(&self.heading, word).map_err(at)?, unit),
            };
            let stamp = stamp.ok_or_else(|| {
                let value = number(&self.heading, word).unwrap_or(f64::INFINITY);
                at(WordError::NoTime(value))
            })?;
            return push(&mut self.parts[position], stamp)
                .map_err(|error| failure(self.path, error));
        }
        Ok(())
    }

    /// What was read, the parts of the time put together.
    fn end(mut self) -> Result<Columns, LogError> {
        let path = self.path;
        if let Some(time) = &mut self.columns.time {
            let rows = self.parts.first().map_or(0, Vec::len);
            for row in 0..rows {
                let parts = self.parts.iter().map(|part| part[row]);
                let sum = parts.reduce(Stamp::plus);
                if let Some(stamp) = sum {
                    time.take(stamp).map_err(|error| failure(path, error))?;
                }
            }
        }
        Ok(self.columns)
    }
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
    format!(
        "heading names {} numbers of {} bytes",
        heading.count(),
        heading.word_bytes
    )
}

/// Holds the bytes of a file against those its heading asks for.
fn check_length(heading: &NpyHeading, length: u64) -> Result<(), LengthError> {
    let there = length.saturating_sub(heading.bytes);
    match heading.count().checked_mul(heading.word_bytes as u64) {
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
        Err(WordError::NotFinite(value))
    }
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
