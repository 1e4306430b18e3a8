//! Columns of numbers as a file holds them, before their unit is applied.

use std::io;

use super::error::Place;
use super::input::push;
use super::log::format::LogFormat;
use super::time::column::TimeColumn;
use super::unit::spelling::Spelled;

/// Numbers with the name of their column.
#[derive(Clone, Debug, Default)]
pub(crate) struct Column {
    /// Name in the heading, or what it was asked for by.
    pub(crate) name: Option<String>,
    /// What the heading, or a row of units, says of the numbers.
    pub(super) unit: Option<Spelled>,
    /// Values, finite; NaN where a number is missing and that is a gap.
    pub(crate) values: Vec<f64>,
}

/// The columns read from one file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    /// Rates, angles and what else was asked for, in that order; all of one length.
    pub(crate) data: Vec<Column>,
    /// The time, where it was asked for or found.
    pub(super) time: Option<TimeColumn>,
    /// What the file was taken for, in a line.
    pub(crate) layout: Option<String>,
    /// The same as it could have been given; none of an array.
    pub(super) found: Option<LogFormat>,
    /// What is worth saying of how the file ended.
    pub(super) note: Option<String>,
    /// What is said of a column that is the time by its heading and not by its cells, if there is no other.
    pub(super) unread_time: Option<String>,
    /// Empty lines between the rows.
    pub(crate) lines_between: LinesBetween,
    /// Where each row stands; rows of an array stand at their index.
    pub(crate) lines: Option<RowLines>,
}

/// Lines of one sort between the samples of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CountedLines {
    /// How many.
    pub count: usize,
    /// The first, from 1; 0 where there is none.
    pub first: usize,
}

impl CountedLines {
    /// Counts a line.
    pub(crate) fn extend(&mut self, line: Option<usize>) {
        if let Some(line) = line {
            self.count += 1;
            self.first = if self.count == 1 { line } else { self.first };
        }
    }
}

/// Lines between the samples of a text that hold none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinesBetween {
    /// Empty ones, several in a row as one: each may stand for samples that are missing.
    pub empty: CountedLines,
    /// The heading, or the row of units, once more: files may have been joined there.
    pub headings: CountedLines,
}

/// The lines that rows stand in. Most rows stand in the line after that of the row before.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowLines {
    /// Rows that do not, with their lines.
    jumps: Vec<(usize, usize)>,
}

impl RowLines {
    /// Takes the line of the next row; an error says that memory is used up.
    pub(crate) fn take(&mut self, row: usize, line: usize) -> io::Result<()> {
        if self.line(row) == Some(line) {
            return Ok(());
        }
        push(&mut self.jumps, (row, line))
    }

    /// Line of a row, as if all rows behind the last one taken stood in lines that follow.
    fn line(&self, row: usize) -> Option<usize> {
        let behind = self.jumps.partition_point(|(first, _)| *first <= row);
        let (first, line) = self.jumps.get(behind.checked_sub(1)?)?;
        Some(line + (row - first))
    }
}

impl Columns {
    /// Where row `row` stands in the file.
    pub(crate) fn place(&self, row: usize) -> Place {
        match self.lines.as_ref().and_then(|lines| lines.line(row)) {
            Some(line) => Place::Line(line),
            None => Place::Index(row),
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.data.first().map_or(0, |column| column.values.len())
    }
}
