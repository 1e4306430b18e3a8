//! Columns of numbers in text.

use std::fmt::Write as _;
use std::io::BufRead;
use std::path::Path;

use super::column::{Column, Columns, EmptyLines, RowLines};
use super::error::{LogError, Place};
use super::input::{failure, push};
use super::text::{Delimiter, FirstLineError, Lines, TextError, finite, is_heading, listed, shown};

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

/// What is wrong with the first line of a file, with what is asked of it, or with the cells of a row.
#[derive(Debug, thiserror::Error)]
enum TableError {
    #[error(transparent)]
    FirstLine(#[from] FirstLineError),
    #[error("{count} columns are named `{wanted}`: name one by its number, from 1")]
    Ambiguous { wanted: String, count: usize },
    /// With what there is.
    #[error("there is no column `{wanted}`: {listed}")]
    NoColumn { wanted: String, listed: String },
    #[error("there is no column beside the time")]
    TimeAlone,
    /// With what there is.
    #[error("name one column with --column: {0}")]
    SeveralColumns(String),
    #[error("the column of the data is that of the time")]
    DataIsTime,
    #[error("column {0} is named for two quantities: expected another for each")]
    NamedTwice(String),
    #[error("{got} cells where the first line has {expected}")]
    Width { got: usize, expected: usize },
    #[error(
        "column {column} has a number where the first row has `{word}`: expected a heading without \
         numbers, or a first row like this one"
    )]
    WordInFirstRow { column: usize, word: String },
}

/// How the lines of a file are cut.
struct Layout {
    delimiter: Delimiter,
    cells: usize,
    /// Names of the columns; empty without a heading.
    names: Vec<String>,
    /// The first row, if it may be one number with a decimal comma.
    decimal_comma: Option<String>,
}

impl Layout {
    /// The layout that a first line, heading or not, has above the first row.
    fn of(line: &str, first_row: &str) -> Result<Self, TableError> {
        let delimiter = Delimiter::of(line);
        let mut cells = delimiter.first_cells(line);
        let is_heading = is_heading(&cells)?;
        // Blanks in the heading of a single column are part of its name.
        if is_heading
            && delimiter == Delimiter::Blanks
            && delimiter.first_cells(first_row).len() == 1
        {
            cells = vec![line.trim()];
        }
        let is_number = |cell: &str| cell.parse::<i64>().is_ok();
        let is_fraction =
            |cell: &str| !cell.is_empty() && cell.bytes().all(|it| it.is_ascii_digit());
        let may_be_one = !is_heading
            && matches!(line.split(',').collect::<Vec<_>>()[..], [whole, fraction]
                if is_number(whole.trim_start()) && is_fraction(fraction.trim_end()));
        Ok(Self {
            delimiter,
            decimal_comma: may_be_one.then(|| line.trim().to_owned()),
            cells: cells.len(),
            names: if is_heading {
                cells.into_iter().map(str::to_owned).collect()
            } else {
                Vec::new()
            },
        })
    }

    /// Index of the column that was asked for by name or by number from 1.
    fn find(&self, wanted: &str) -> Result<usize, TableError> {
        let same: Vec<usize> = (0..self.names.len())
            .filter(|&index| self.names[index] == wanted)
            .collect();
        match same[..] {
            [index] => return Ok(index),
            [_, _, ..] => {
                return Err(TableError::Ambiguous {
                    wanted: wanted.to_owned(),
                    count: same.len(),
                });
            }
            [] => {}
        }
        match wanted.parse::<usize>() {
            Ok(number) if (1..=self.cells).contains(&number) => Ok(number - 1),
            _ => Err(TableError::NoColumn {
                wanted: wanted.to_owned(),
                listed: self.listed(),
            }),
        }
    }

    /// The column of the data where none was named: the only one beside the time.
    fn only(&self, time: Option<usize>) -> Result<usize, TableError> {
        let mut others = (0..self.cells).filter(|index| Some(*index) != time);
        match (others.next(), others.next()) {
            (Some(index), None) => Ok(index),
            (None, _) => Err(TableError::TimeAlone),
            _ => {
                let comma = self.decimal_comma.as_deref().map(|row| {
                    format!(
                        "; if `{}` is one number, write its decimal comma as a point",
                        shown(row)
                    )
                });
                let listed = self.listed() + &comma.unwrap_or_default();
                Err(TableError::SeveralColumns(listed))
            }
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
    let mut heading: Option<(String, usize)> = None;
    let mut table: Option<Table> = None;
    while let Some(line) = lines.next_line().map_err(|error| fault(path, error))? {
        let at =
            |number: usize| move |error: TableError| LogError::at(path, Place::Line(number), error);
        let table = match &mut table {
            Some(table) => table,
            None => {
                let first = heading.take();
                let (first, number) = match &first {
                    Some((text, number)) => (text.as_str(), *number),
                    None => (line.text, line.number),
                };
                let layout = Layout::of(first, line.text).map_err(at(number))?;
                if !layout.names.is_empty() && number == line.number {
                    heading = Some((line.text.to_owned(), line.number));
                    continue;
                }
                table.insert(Table::new(layout, wanted).map_err(at(number))?)
            }
        };
        if table.columns.rows() > 0 {
            table.columns.empty_lines.extend(line.empty_before);
        }
        let cells = table.row(line.text).map_err(at(line.number))?;
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
    words: Vec<(usize, String)>,
}

impl Table {
    fn new(layout: Layout, wanted: &Wanted<'_>) -> Result<Self, TableError> {
        let time = wanted.time.map(|name| layout.find(name)).transpose()?;
        let columns = wanted.columns.iter();
        let data = columns.map(|column| match column {
            Some(name) => layout.find(name),
            None => layout.only(time),
        });
        let data = data.collect::<Result<Vec<usize>, TableError>>()?;
        for (position, index) in data.iter().enumerate() {
            if time == Some(*index) {
                return Err(TableError::DataIsTime);
            }
            if data[..position].contains(index) {
                let name = layout.name(*index).unwrap_or_default();
                return Err(TableError::NamedTwice(shown(&name)));
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
                empty_lines: EmptyLines::default(),
            },
            layout,
            data,
            time,
            words: Vec::new(),
        })
    }

    /// The cells of a row, as many as the first line has.
    fn row<'a>(&mut self, line: &'a str) -> Result<Vec<&'a str>, TableError> {
        let width = self.layout.cells;
        let cells = self.layout.delimiter.cells_up_to(line, width);
        if cells.len() != width {
            return Err(TableError::Width {
                got: cells.len(),
                expected: width,
            });
        }
        if self.layout.names.is_empty() && self.columns.rows() < 2 {
            self.hold_against_first(&cells)?;
        }
        Ok(cells)
    }

    /// Refuses a first row that may be a heading some of whose names are numbers: one that has words
    /// where the second has numbers. It would be taken for a sample.
    fn hold_against_first(&mut self, cells: &[&str]) -> Result<(), TableError> {
        let is_number = |cell: &str| cell.parse::<f64>().is_ok();
        if self.columns.rows() == 0 {
            let words = cells.iter().enumerate();
            let words = words.filter(|(_, cell)| !is_number(cell));
            self.words = words.map(|(index, cell)| (index, shown(cell))).collect();
            return Ok(());
        }
        let words = std::mem::take(&mut self.words);
        let found = words
            .into_iter()
            .find(|(index, _)| is_number(cells[*index]));
        found.map_or(Ok(()), |(index, word)| {
            Err(TableError::WordInFirstRow {
                column: index + 1,
                word,
            })
        })
    }

    /// Takes the numbers of a row.
    fn take(&mut self, path: &Path, cells: &[&str], line: usize) -> Result<(), LogError> {
        let row = self.columns.rows();
        let indices = self.data.iter().chain(&self.time);
        let columns = self.columns.data.iter_mut().chain(&mut self.columns.time);
        for (index, column) in indices.zip(columns) {
            let value = finite(cells[*index]).map_err(|error| {
                let name = column.name.as_deref();
                let column = name.map(|name| format!("column {}: ", shown(name)));
                let message = column.unwrap_or_default() + &error.to_string();
                LogError::at(path, Place::Line(line), message)
            })?;
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
///
/// ```
/// use fogbench::recording::csv_text;
///
/// assert_eq!(csv_text(&[1.5, -2.0], 0.5), "time_s,rate_deg_per_h\n0.5,1.5\n1.0,-2.0\n");
/// ```
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
