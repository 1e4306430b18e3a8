//! Columns of numbers in text.

use std::fmt::Write as _;
use std::io::BufRead;
use std::path::Path;

use super::column::{Column, Columns, RowLines};
use super::error::{LogError, Place};
use super::input::{failure, push};
use super::text::{Delimiter, Lines, TextError, finite, is_heading, listed, shown};

/// What is read from a file.
#[derive(Clone, Debug)]
pub(super) struct Wanted<'a> {
    /// Columns by name or number from 1; none: the only one beside the time.
    pub(super) columns: Vec<Option<&'a str>>,
    /// Column of the time, likewise.
    pub(super) time: Option<&'a str>,
    /// Samples after which reading ends.
    pub(super) samples_max: usize,
}

/// How the lines of a file are cut.
struct Layout {
    delimiter: Delimiter,
    cells: usize,
    /// Names of the columns; empty without a heading.
    names: Vec<String>,
}

impl Layout {
    fn of(line: &str) -> Result<Self, String> {
        let delimiter = Delimiter::of(line);
        let cells = delimiter.first_cells(line);
        Ok(Self {
            delimiter,
            cells: cells.len(),
            names: if is_heading(&cells)? {
                cells.into_iter().map(str::to_owned).collect()
            } else {
                Vec::new()
            },
        })
    }

    /// Index of the column that was asked for by name or by number from 1.
    fn find(&self, wanted: &str) -> Result<usize, String> {
        let same: Vec<usize> = (0..self.names.len())
            .filter(|&index| self.names[index] == wanted)
            .collect();
        match same[..] {
            [index] => return Ok(index),
            [_, _, ..] => {
                return Err(format!(
                    "{} columns are named `{wanted}`: name one by its number, from 1",
                    same.len()
                ));
            }
            [] => {}
        }
        match wanted.parse::<usize>() {
            Ok(number) if (1..=self.cells).contains(&number) => Ok(number - 1),
            _ => Err(format!("there is no column `{wanted}`: {}", self.listed())),
        }
    }

    /// The column of the data where none was named: the only one beside the time.
    fn only(&self, time: Option<usize>) -> Result<usize, String> {
        let mut others = (0..self.cells).filter(|index| Some(*index) != time);
        match (others.next(), others.next()) {
            (Some(index), None) => Ok(index),
            (None, _) => Err("there is no column beside the time".to_owned()),
            _ => Err(format!("name one column with --column: {}", self.listed())),
        }
    }

    fn listed(&self) -> String {
        if self.names.is_empty() {
            return format!(
                "expected a number from 1 to {}, as there is no heading",
                self.cells
            );
        }
        format!(
            "expected one of {}, or a number from 1 to {}",
            listed(&self.names),
            self.cells
        )
    }

    fn name(&self, index: usize) -> Option<String> {
        let name = self.names.get(index).cloned();
        name.or_else(|| (self.cells > 1).then(|| (index + 1).to_string()))
    }
}

/// Reads columns, and that of the time where it is asked for.
///
/// The first line is a heading if none of its cells is a number. Numbers have a decimal point.
///
/// # Errors
/// Bytes that are no text, unknown columns and one asked for twice, lines of another width, cells
/// that are no finite number; a first line that is neither a heading nor a row of numbers.
pub(super) fn read(
    path: &Path,
    reader: impl BufRead,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let mut lines = Lines::new(reader, "neither NPY nor text in UTF-8");
    let mut table: Option<Table> = None;
    while let Some(line) = lines.next_line().map_err(|error| fault(path, error))? {
        let complain = |message: String| LogError::at(path, Place::Line(line.number), message);
        let cells = match &mut table {
            Some(table) => table.row(line.text).map_err(complain)?,
            None => {
                let first = Table::new(line.text, wanted).map_err(complain)?;
                let is_heading = !first.layout.names.is_empty();
                let first = table.insert(first);
                if is_heading {
                    continue;
                }
                first.first_row(line.text)
            }
        };
        let Some(table) = &mut table else { continue };
        table.take(path, &cells, line.number)?;
        if table.columns.rows() >= wanted.samples_max {
            break;
        }
    }
    Ok(table.map(|table| table.columns).unwrap_or_default())
}

/// An error of a text at its line.
pub(super) fn fault(path: &Path, error: TextError) -> LogError {
    match error {
        TextError::Io(error) => failure(path, error),
        TextError::Content { line, message, .. } => LogError::at(path, Place::Line(line), message),
    }
}

/// A file while it is read.
struct Table {
    layout: Layout,
    data: Vec<usize>,
    time: Option<usize>,
    columns: Columns,
    /// Cells of a first row that are no numbers; none once the second row was held against it.
    words: Option<Vec<(usize, String)>>,
}

impl Table {
    fn new(first: &str, wanted: &Wanted<'_>) -> Result<Self, String> {
        let layout = Layout::of(first)?;
        let time = wanted.time.map(|name| layout.find(name)).transpose()?;
        let columns = wanted.columns.iter();
        let data = columns.map(|column| match column {
            Some(name) => layout.find(name),
            None => layout.only(time),
        });
        let data = data.collect::<Result<Vec<usize>, String>>()?;
        for (position, index) in data.iter().enumerate() {
            if time == Some(*index) {
                return Err("the column of the data is that of the time".to_owned());
            }
            if data[..position].contains(index) {
                let name = layout.name(*index).unwrap_or_default();
                return Err(format!(
                    "column {} is named for two quantities: expected another for each",
                    shown(&name)
                ));
            }
        }
        let named = |index: usize| Column {
            name: layout.name(index),
            values: Vec::new(),
        };
        Ok(Self {
            columns: Columns {
                data: data.iter().copied().map(named).collect(),
                time: time.map(named),
                lines: Some(RowLines::default()),
            },
            layout,
            data,
            time,
            words: None,
        })
    }

    /// The cells of a first line that is a row of numbers.
    fn first_row<'a>(&mut self, line: &'a str) -> Vec<&'a str> {
        let cells = self.layout.delimiter.first_cells(line);
        let is_word = |cell: &str| cell.parse::<f64>().is_err();
        let words = cells.iter().enumerate().filter(|(_, cell)| is_word(cell));
        let words: Vec<(usize, String)> = words.map(|(index, cell)| (index, shown(cell))).collect();
        self.words = (!words.is_empty()).then_some(words);
        cells
    }

    /// The cells of any other line, as many as the first has.
    fn row<'a>(&mut self, line: &'a str) -> Result<Vec<&'a str>, String> {
        let width = self.layout.cells;
        let cells = self.layout.delimiter.cells_up_to(line, width);
        if cells.len() != width {
            let got = cells.len();
            return Err(format!("{got} cells where the first line has {width}"));
        }
        // A heading some of whose names are numbers would be taken for a sample.
        let words = self.words.take().unwrap_or_default();
        let is_number = |index: usize| cells[index].parse::<f64>().is_ok();
        if let Some((index, word)) = words.into_iter().find(|(index, _)| is_number(*index)) {
            let first = match self.columns.place(0) {
                Place::Line(line) => line,
                Place::Index(_) => 1,
            };
            return Err(format!(
                "column {} has a number where line {first} has `{word}`: expected a heading without \
                 numbers or a first row like this one",
                index + 1,
            ));
        }
        Ok(cells)
    }

    /// Takes the numbers of a row.
    fn take(&mut self, path: &Path, cells: &[&str], line: usize) -> Result<(), LogError> {
        let row = self.columns.rows();
        let indices = self.data.iter().chain(&self.time);
        let columns = self.columns.data.iter_mut().chain(&mut self.columns.time);
        for (index, column) in indices.zip(columns) {
            let value = finite(cells[*index], None)
                .or_else(|_| finite(cells[*index], column.name.as_deref()))
                .map_err(|message| LogError::at(path, Place::Line(line), message))?;
            push(&mut column.values, value).map_err(|error| failure(path, error))?;
        }
        match &mut self.columns.lines {
            Some(lines) => lines.take(row, line).map_err(|error| failure(path, error)),
            None => Ok(()),
        }
    }
}

/// Rate words as text: a heading, then time (s) and rate (deg/h) of each, exact to the last bit.
///
/// Sample `k` is stamped `(k + 1)` sample periods after the start of the record.
#[must_use]
pub fn csv_text(rate_deg_per_h: &[f64], sample_period_s: f64) -> String {
    let mut text = String::from("time_s,rate_deg_per_h\n");
    let mut ordinal = 0.0;
    for rate in rate_deg_per_h {
        ordinal += 1.0;
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{:?},{rate:?}", ordinal * sample_period_s);
    }
    text
}
