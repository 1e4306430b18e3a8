//! NPY files of one dimension or two: binary64, binary32, binary16 or integers of 8 to 64 bits.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::heading::{self, HeadingError, NpyHeading, Word};
use crate::recording::column::{Column, Columns};
use crate::recording::error::{LogError, Place};
use crate::recording::input::{Input, failure, push};
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

/// An array of two dimensions while it is read.
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
/// # Errors
/// Another shape or number type, a file with less or more bytes than its heading says, a number that
/// is not finite, an integer beyond binary64.
pub(in crate::recording) fn read(
    path: &Path,
    mut input: Input,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let heading = read_heading(path, &mut input, wanted.format)?;
    read_behind(path, heading, input, wanted)
}

/// Whether a file is an array: by its first bytes, or because that is said.
pub(in crate::recording) fn is_array(input: &Input, format: &LogFormat) -> bool {
    format.dtype.is_some() || input.starts_with(heading::MAGIC)
}

/// Reads the heading, or makes up that of words that stand alone.
///
/// # Errors
/// Another shape or number type, a file with less or more bytes than its heading says.
pub(in crate::recording) fn read_heading(
    path: &Path,
    input: &mut Input,
    format: &LogFormat,
) -> Result<NpyHeading, LogError> {
    if let Some(dtype) = format.dtype {
        let endless = NpyHeading::of_words(dtype, u64::MAX);
        let Some(length) = input.length() else {
            return Ok(endless);
        };
        let bytes = endless.word_bytes as u64;
        let left = length % bytes;
        if left > 0 {
            let within = LengthError::Within(endless, left);
            return Err(LogError::of_file(path, within));
        }
        return Ok(NpyHeading::of_words(dtype, length / bytes));
    }
    let length = input.length();
    let heading = heading::read(input).map_err(|error| match error {
        HeadingError::Io(error) => failure(path, error),
        error => LogError::of_file(path, error),
    })?;
    if let Some(length) = length {
        check_length(&heading, length).map_err(|error| LogError::of_file(path, error))?;
    }
    Ok(heading)
}

/// Reads columns behind the heading.
///
/// # Errors
/// As [`read`].
pub(in crate::recording) fn read_behind(
    path: &Path,
    heading: NpyHeading,
    mut input: Input,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let chosen = chosen(&heading, wanted).map_err(|error| LogError::of_file(path, error))?;
    if heading.columns == 1 {
        let is_gap = wanted.format.missing == Some(MissingWords::Gap);
        let may_end = wanted.needs_time && input.length().is_none();
        let mut words = ArrayWords::new(path, heading, may_end, is_gap);
        let mut values = Vec::new();
        while values.len() < wanted.samples_max && words.read(&mut input, &mut values)? {}
        values.truncate(wanted.samples_max);
        return Ok(words.columns(values));
    }
    let mut array = Array::new(path, heading, chosen, wanted);
    array.read(&mut input)?;
    array.end()
}

/// Checks that an array of one dimension has the columns that are asked for.
///
/// # Errors
/// Names of columns that it has not.
pub(in crate::recording) fn check_columns(
    path: &Path,
    heading: &NpyHeading,
    wanted: &Wanted<'_>,
) -> Result<(), LogError> {
    let chosen = chosen(heading, wanted);
    chosen
        .map(|_| ())
        .map_err(|error| LogError::of_file(path, error))
}

/// The numbers of an array of one dimension while they are read.
pub(in crate::recording) struct ArrayWords {
    path: PathBuf,
    heading: NpyHeading,
    may_end: bool,
    is_gap: bool,
    /// Numbers read.
    row: u64,
    /// Most numbers that are read at a time.
    at_a_time: usize,
    chunk: Vec<u8>,
}

impl ArrayWords {
    /// Begins behind the heading.
    ///
    /// * `may_end`: whether the numbers that the heading names are as many as there may be at most.
    pub(in crate::recording) fn new(
        path: &Path,
        heading: NpyHeading,
        may_end: bool,
        is_gap: bool,
    ) -> Self {
        Self {
            path: path.to_owned(),
            heading,
            may_end,
            is_gap,
            row: 0,
            at_a_time: CHUNK_BYTES / heading.word_bytes,
            chunk: Vec::with_capacity(CHUNK_BYTES),
        }
    }

    /// The same, so many numbers at a time at most: more are not waited for.
    pub(in crate::recording) fn at_a_time(self, count: usize) -> Self {
        Self {
            at_a_time: count.min(self.at_a_time),
            ..self
        }
    }

    /// Numbers that were read, as columns, with a note of those that are not there.
    pub(in crate::recording) fn columns(&self, values: Vec<f64>) -> Columns {
        let column = Column {
            values,
            ..Column::default()
        };
        Columns {
            data: vec![column],
            note: self.early_end(),
            ..Columns::default()
        }
    }

    /// What is said of an input that ended before all numbers that its heading names, if it did.
    pub(in crate::recording) fn early_end(&self) -> Option<String> {
        let most = self.heading.rows;
        // Words that stand alone have no heading that would name a number.
        (self.may_end && self.row < most && most < u64::MAX).then(|| {
            format!(
                "the input ended behind {} of the {most} numbers that its heading names",
                self.row
            )
        })
    }

    /// Appends the next numbers; whether there were any.
    ///
    /// # Errors
    /// An input that ends too soon or within a number, or goes on behind the last; a number that is not
    /// finite, an integer beyond binary64.
    pub(in crate::recording) fn read(
        &mut self,
        input: &mut impl Read,
        values: &mut Vec<f64>,
    ) -> Result<bool, LogError> {
        let word_bytes = self.heading.word_bytes;
        let wanted = (self.heading.rows - self.row).min(self.at_a_time as u64);
        let wanted = usize::try_from(wanted).unwrap_or(0) * word_bytes;
        let failed = |error| failure(&self.path, error);
        self.chunk.clear();
        let mut coming = input.by_ref().take(wanted as u64);
        let filled = coming.read_to_end(&mut self.chunk).map_err(failed)?;
        if filled < wanted {
            let is_whole = filled.is_multiple_of(word_bytes);
            if !self.may_end {
                return Err(LogError::of_file(
                    &self.path,
                    LengthError::CutShort(self.heading),
                ));
            }
            if !is_whole {
                let left = (filled % word_bytes) as u64;
                return Err(LogError::of_file(
                    &self.path,
                    LengthError::Within(self.heading, left),
                ));
            }
        } else if wanted == 0 {
            let more = input.by_ref().take(1).read_to_end(&mut self.chunk);
            let more = more.map_err(failed)?;
            if more > 0 {
                let there_is_more = LengthError::More(self.heading, None);
                return Err(LogError::of_file(&self.path, there_is_more));
            }
        }
        let count = filled / word_bytes;
        let reserved = values.try_reserve(count);
        reserved
            .map_err(|error| failed(std::io::Error::new(std::io::ErrorKind::OutOfMemory, error)))?;
        for word in self.chunk[..filled].chunks_exact(word_bytes) {
            let value = match number(&self.heading, word) {
                Err(WordError::NotFinite(value)) if self.is_gap && value.is_nan() => value,
                value => value.map_err(|error| {
                    let row = usize::try_from(self.row).unwrap_or(usize::MAX);
                    LogError::at(&self.path, Place::Index(row), error)
                })?,
            };
            values.push(value);
            self.row += 1;
        }
        Ok(count > 0)
    }
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
        let name = |index: usize| (index + 1).to_string();
        let data = chosen.data.iter().map(|index| Column {
            name: Some(name(*index)),
            ..Column::default()
        });
        let times: Vec<String> = chosen.time.iter().map(|(index, _)| name(*index)).collect();
        let time = (!times.is_empty()).then(|| {
            let units = chosen.time.iter().map(|(_, unit)| *unit).collect();
            let mut time = TimeColumn::new(times.join(" + "), units, false);
            time.rolls_over_after(wanted.format.roll_over);
            time
        });
        let columns = Columns {
            data: data.collect(),
            time,
            layout: Some(heading.to_string()),
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
    /// With the bytes of the number that is not whole.
    #[error("ends within a number: {1} of its {bytes} bytes are there", bytes = .0.word_bytes)]
    Within(NpyHeading, u64),
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
