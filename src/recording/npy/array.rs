//! NPY files of one dimension or two: binary64, binary32, binary16 or integers of 8 to 64 bits.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::gather::{Gather, each_word};
use super::heading::{self, ArrayHeading, HeadingError, NpyHeading};
use super::number::Missing;
use crate::recording::column::{Column, Columns};
use crate::recording::error::{LogError, Place};
use crate::recording::input::{Input, failure};
use crate::recording::layout::Fault;
use crate::recording::layout::Layout;
use crate::recording::layout::columns::{Selection, choose};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::listed;
use crate::recording::text::table::Wanted;

/// Bytes that are read at a time: whole numbers of every size.
pub(super) const CHUNK_BYTES: usize = 1 << 16;

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
    read_behind(path, &heading, input, wanted)
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
) -> Result<ArrayHeading, LogError> {
    if let Some(dtype) = format.dtype {
        let endless = NpyHeading::of_words(dtype, u64::MAX);
        let Some(length) = input.length() else {
            return Ok(endless.into());
        };
        let bytes = endless.word_bytes as u64;
        let left = length % bytes;
        if left > 0 {
            let within = LengthError::Within(endless, left);
            return Err(LogError::of_file(path, within));
        }
        return Ok(NpyHeading::of_words(dtype, length / bytes).into());
    }
    let length = input.length();
    let heading = heading::read(input).map_err(|error| match error {
        HeadingError::Io(error) => failure(path, error),
        error => LogError::of_file(path, error),
    })?;
    if let Some(length) = length {
        check_length(&heading.plain, length).map_err(|error| LogError::of_file(path, error))?;
    }
    Ok(heading)
}

/// Reads columns behind the heading.
///
/// # Errors
/// As [`read`].
pub(in crate::recording) fn read_behind(
    path: &Path,
    heading: &ArrayHeading,
    mut input: Input,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let (layout, chosen, found) = if heading.is_plain_row() {
        check_columns(path, &heading.plain, wanted)?;
        let may_end = wanted.needs_time && input.length().is_none();
        let mut words = ArrayWords::new(path, heading.plain, may_end, Missing::of(wanted));
        let mut values = Vec::new();
        while values.len() < wanted.samples_max && words.read(&mut input, &mut values)? {}
        values.truncate(wanted.samples_max);
        return Ok(words.columns(values));
    } else if heading.fields.is_empty() {
        let layout = Layout::of_array(usize::try_from(heading.plain.columns).unwrap_or(usize::MAX));
        let needs_time = wanted.needs_time && wanted.format.time.is_some();
        let chosen = choose(&layout, wanted.format, &[], &wanted.columns, needs_time);
        (layout, chosen, heading.plain.to_string())
    } else {
        let names = heading.fields.iter().map(|field| field.name.clone());
        let units = heading.fields.iter().map(|field| field.unit.clone());
        let layout = Layout::of_fields(names.collect(), units.collect());
        let (format, columns) = (wanted.format, &wanted.columns);
        let chosen = choose(&layout, format, &[], columns, wanted.needs_time);
        let found = format!("records of {}", listed(&layout.names));
        (layout, chosen, found)
    };
    let chosen = chosen.map_err(|error| Fault::from(error).of(path))?;
    let mut gather = Gather::new(path, &layout, chosen, wanted, found);
    let samples_max = u64::try_from(wanted.samples_max).unwrap_or(u64::MAX);
    each_word(path, heading, &mut input, samples_max, &mut |word| {
        gather.take(&word)
    })?;
    gather.end()
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
    if heading.columns != 1 {
        return Ok(());
    }
    let column = match &wanted.columns {
        Selection::Named(names) => names.first().map(String::as_str),
        Selection::Each(all) => all.first().map(|asked| asked.name),
    };
    let time = wanted.format.time.iter().flatten().map(String::as_str);
    let mut named = column
        .into_iter()
        .chain(time)
        .filter(|name| !matches!(*name, "1" | "none"));
    match named.next() {
        Some(name) => Err(LogError::of_file(path, NoColumns(name.to_owned()))),
        None => Ok(()),
    }
}

/// Columns of an array are asked for that has none.
#[derive(Debug, thiserror::Error)]
#[error("an NPY file of one dimension has no columns: leave `{0}` out")]
struct NoColumns(String);

/// The numbers of an array of one dimension while they are read.
pub(in crate::recording) struct ArrayWords {
    path: PathBuf,
    heading: NpyHeading,
    may_end: bool,
    missing: Missing,
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
        missing: Missing,
    ) -> Self {
        Self {
            path: path.to_owned(),
            heading,
            may_end,
            missing,
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
            let value = self.missing.number(&self.heading, word);
            let value = value.map_err(|error| {
                let row = usize::try_from(self.row).unwrap_or(usize::MAX);
                LogError::at(&self.path, Place::Index(row), error)
            })?;
            values.push(value);
            self.row += 1;
        }
        Ok(count > 0)
    }
}

/// Why a file does not hold what its heading names.
#[derive(Debug, thiserror::Error)]
pub(super) enum LengthError {
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
