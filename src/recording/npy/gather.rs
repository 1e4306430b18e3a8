//! Columns of arrays: words of a file in their order, and the columns that they belong to.

use std::io::{ErrorKind, Read};
use std::path::Path;

use super::array::{CHUNK_BYTES, LengthError};
use super::heading::{ArrayHeading, NpyHeading};
use super::number::{Missing, WordError, stamp};
use crate::recording::column::{Column, Columns};
use crate::recording::error::{LogError, Place};
use crate::recording::input::{failure, push};
use crate::recording::layout::Layout;
use crate::recording::layout::columns::Chosen;
use crate::recording::text::lines::shown;
use crate::recording::text::table::Wanted;
use crate::recording::time::column::TimeColumn;
use crate::recording::time::stamp::Stamp;

/// A word of an array.
pub(super) struct PlacedWord<'a> {
    /// Its type; none of a field that is no number.
    pub(super) kind: Option<&'a NpyHeading>,
    pub(super) bytes: &'a [u8],
    pub(super) row: u64,
    pub(super) column: usize,
}

/// Columns while they are gathered.
pub(super) struct Gather<'a> {
    path: &'a Path,
    layout: &'a Layout,
    chosen: Chosen,
    missing: Missing,
    columns: Columns,
    /// Stamps, or parts of them, by column of the time.
    parts: Vec<Vec<Stamp>>,
}

/// Why a column is not read.
#[derive(Debug, thiserror::Error)]
enum ColumnError {
    #[error("column {0} holds no numbers")]
    NoNumbers(String),
    #[error("columns {one} and {other} hold {ones} and {others} numbers: expected as many")]
    Lengths {
        one: String,
        other: String,
        ones: usize,
        others: usize,
    },
}

impl<'a> Gather<'a> {
    /// * `found`: what the file was taken for.
    pub(super) fn new(
        path: &'a Path,
        layout: &'a Layout,
        chosen: Chosen,
        wanted: &Wanted<'_>,
        found: String,
    ) -> Self {
        let name = |index: usize| layout.name(index).unwrap_or_default();
        let data = chosen.data.iter().map(|index| Column {
            name: Some(name(*index)),
            unit: layout.unit(*index),
            values: Vec::new(),
        });
        let times: Vec<String> = chosen.time.iter().map(|(index, _)| name(*index)).collect();
        let time = (!times.is_empty()).then(|| {
            let units = chosen.time.iter().map(|(_, unit)| *unit).collect();
            let mut time = TimeColumn::new(times.join(" + "), units, chosen.is_time_found);
            time.rolls_over_after(wanted.format.roll_over);
            time.note.clone_from(&chosen.time_note);
            time
        });
        Self {
            path,
            layout,
            missing: Missing::of(wanted),
            columns: Columns {
                data: data.collect(),
                time,
                layout: Some(found),
                ..Columns::default()
            },
            parts: vec![Vec::new(); chosen.time.len()],
            chosen,
        }
    }

    /// Whether a column is asked for.
    pub(super) fn wants(&self, column: usize) -> bool {
        let mut times = self.chosen.time.iter().map(|(index, _)| index);
        self.chosen.data.contains(&column) || times.any(|index| *index == column)
    }

    /// Takes a word, if its column is asked for.
    pub(super) fn take(&mut self, word: &PlacedWord<'_>) -> Result<(), LogError> {
        let path = self.path;
        let at = |error: WordError| {
            let row = usize::try_from(word.row).unwrap_or(usize::MAX);
            LogError::at(path, Place::Index(row), error)
        };
        let is_it = |index: usize| index == word.column;
        let data = self.chosen.data.iter().position(|index| is_it(*index));
        let time = self.chosen.time.iter().position(|(index, _)| is_it(*index));
        if data.is_none() && time.is_none() {
            return Ok(());
        }
        let Some(kind) = word.kind else {
            let name = self.layout.name(word.column).unwrap_or_default();
            return Err(LogError::of_file(
                path,
                ColumnError::NoNumbers(shown(&name)),
            ));
        };
        if let Some(position) = data {
            let value = self.missing.number(kind, word.bytes).map_err(at)?;
            let values = &mut self.columns.data[position].values;
            push(values, value).map_err(|error| failure(path, error))?;
        }
        if let Some(position) = time {
            let (_, unit) = self.chosen.time[position];
            let stamp = stamp(kind, word.bytes, unit).map_err(at)?;
            let part = &mut self.parts[position];
            push(part, stamp).map_err(|error| failure(path, error))?;
        }
        Ok(())
    }

    /// What was read, the parts of the time put together.
    pub(super) fn end(mut self) -> Result<Columns, LogError> {
        let path = self.path;
        self.check_lengths()
            .map_err(|error| LogError::of_file(path, error))?;
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

    /// Refuses columns of several lengths, as several arrays can have.
    fn check_lengths(&self) -> Result<(), ColumnError> {
        let data = self.chosen.data.iter().zip(&self.columns.data);
        let data = data.map(|(index, column)| (*index, column.values.len()));
        let times = self.chosen.time.iter().zip(&self.parts);
        let times = times.map(|((index, _), part)| (*index, part.len()));
        let all: Vec<(usize, usize)> = data.chain(times).collect();
        let name = |index: usize| shown(&self.layout.name(index).unwrap_or_default());
        match all.windows(2).find(|two| two[0].1 != two[1].1) {
            Some(two) => Err(ColumnError::Lengths {
                one: name(two[0].0),
                other: name(two[1].0),
                ones: two[0].1,
                others: two[1].1,
            }),
            None => Ok(()),
        }
    }
}

/// Gives the words of an array, those of rows before the `samples_max`th, in the order of the file.
///
/// # Errors
/// A file that ends too soon or goes on behind the last word; what `take` says.
pub(super) fn each_word(
    path: &Path,
    heading: &ArrayHeading,
    input: &mut impl Read,
    samples_max: u64,
    take: &mut impl FnMut(PlacedWord<'_>) -> Result<(), LogError>,
) -> Result<(), LogError> {
    let NpyHeading {
        word_bytes,
        rows,
        columns,
        is_by_column,
        ..
    } = heading.plain;
    let wanted = match is_by_column {
        false => rows.min(samples_max) * columns,
        true => rows * columns,
    };
    let per_chunk = (CHUNK_BYTES / word_bytes).max(1);
    let mut chunk = vec![0; per_chunk * word_bytes];
    let (mut row, mut column, mut left) = (0, 0, wanted);
    while left > 0 {
        let count = usize::try_from(left).unwrap_or(usize::MAX).min(per_chunk);
        let bytes = &mut chunk[..count * word_bytes];
        input
            .read_exact(bytes)
            .map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => {
                    LogError::of_file(path, LengthError::CutShort(heading.plain))
                }
                _ => failure(path, error),
            })?;
        for word in bytes.chunks_exact(word_bytes) {
            if row < samples_max {
                give(heading, word, (row, column), take)?;
            }
            if is_by_column {
                row += 1;
                if row == rows {
                    (row, column) = (0, column + 1);
                }
            } else {
                column += 1;
                if column as u64 == columns {
                    (row, column) = (row + 1, 0);
                }
            }
        }
        left -= count as u64;
    }
    if wanted == heading.plain.count() {
        let more = input.read(&mut [0]).map_err(|error| failure(path, error))?;
        if more > 0 {
            let there_is_more = LengthError::More(heading.plain, None);
            return Err(LogError::of_file(path, there_is_more));
        }
    }
    Ok(())
}

/// Gives a word, or the fields of a record.
fn give(
    heading: &ArrayHeading,
    word: &[u8],
    (row, column): (u64, usize),
    take: &mut impl FnMut(PlacedWord<'_>) -> Result<(), LogError>,
) -> Result<(), LogError> {
    if heading.fields.is_empty() {
        return take(PlacedWord {
            kind: Some(&heading.plain),
            bytes: word,
            row,
            column,
        });
    }
    for (column, field) in heading.fields.iter().enumerate() {
        take(PlacedWord {
            kind: field.kind.as_ref(),
            bytes: &word[field.bytes.clone()],
            row,
            column,
        })?;
    }
    Ok(())
}
