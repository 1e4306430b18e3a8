//! Columns of numbers in text: `,`, `;`, tab or blanks between them.

use std::fmt::Write as _;
use std::path::Path;

use super::column::{Column, Columns};
use super::error::{LogError, Place};

/// What stands between the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delimiter {
    Character(char),
    Blanks,
}

impl Delimiter {
    /// The delimiter of the first line that is no comment.
    pub(super) fn of(line: &str) -> Self {
        let found = ['\t', ';', ','].into_iter().find(|c| line.contains(*c));
        found.map_or(Self::Blanks, Self::Character)
    }

    /// The cells of a line, without the blanks and quotation marks around them.
    pub(super) fn cells(self, line: &str) -> Vec<&str> {
        match self {
            Self::Character(character) => line.split(character).map(unquoted).collect(),
            Self::Blanks => line.split_whitespace().map(unquoted).collect(),
        }
    }
}

/// A cell without the blanks and quotation marks around it.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"')
        .and_then(|cell| cell.strip_suffix('"'))
        .unwrap_or(cell)
}

/// How the lines of a file are cut.
struct Layout {
    delimiter: Delimiter,
    cells: usize,
    /// Names of the columns; empty without a heading.
    names: Vec<String>,
}

impl Layout {
    fn of(line: &str) -> Self {
        let delimiter = Delimiter::of(line);
        let cells = delimiter.cells(line);
        let is_heading = cells.iter().all(|cell| cell.parse::<f64>().is_err());
        Self {
            delimiter,
            cells: cells.len(),
            names: if is_heading {
                cells.into_iter().map(str::to_owned).collect()
            } else {
                Vec::new()
            },
        }
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
            self.names.join(", "),
            self.cells
        )
    }

    fn name(&self, index: usize) -> Option<String> {
        let name = self.names.get(index).cloned();
        name.or_else(|| (self.cells > 1).then(|| (index + 1).to_string()))
    }
}

/// Reads one column, and that of the time where it is asked for.
///
/// Empty lines and lines that begin with `#` are passed over. The first other line is a heading if
/// none of its cells is a number. Numbers have a decimal point.
///
/// # Errors
/// Unknown columns, lines of another width, cells that are no finite number.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    column: Option<&str>,
    time_column: Option<&str>,
) -> Result<Columns, LogError> {
    let text = text_of(path, bytes, "neither NPY nor text in UTF-8")?;
    let mut reader: Option<Reader> = None;
    for (number, line) in lines(text) {
        let complain = |message: String| LogError::at(path, Place::Line(number), message);
        match &mut reader {
            Some(reader) => reader.take(line, number).map_err(complain)?,
            None => {
                let mut first = Reader::new(line, column, time_column).map_err(complain)?;
                if first.layout.names.is_empty() {
                    first.take(line, number).map_err(complain)?;
                }
                reader = Some(first);
            }
        }
    }
    Ok(reader.map(|reader| reader.columns).unwrap_or_default())
}

/// The text that bytes are, or `message` at the first line that is none.
pub(super) fn text_of<'a>(
    path: &Path,
    bytes: &'a [u8],
    message: &str,
) -> Result<&'a str, LogError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        LogError::at(path, Place::Line(line), message)
    })
}

/// The lines that are neither empty nor comments, with their numbers from 1.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    lines
        .filter(|(_, line)| !(line.trim().is_empty() || line.trim_start().starts_with('#')))
        .map(|(index, line)| (index + 1, line))
}

/// A file while it is read.
struct Reader {
    layout: Layout,
    data: usize,
    time: Option<usize>,
    columns: Columns,
}

impl Reader {
    fn new(first: &str, column: Option<&str>, time_column: Option<&str>) -> Result<Self, String> {
        let layout = Layout::of(first);
        let time = time_column.map(|wanted| layout.find(wanted)).transpose()?;
        let data = match column {
            Some(wanted) => layout.find(wanted)?,
            None => layout.only(time)?,
        };
        if time == Some(data) {
            return Err("the column of the data is that of the time".to_owned());
        }
        let named = |index| Column {
            name: layout.name(index),
            values: Vec::new(),
        };
        Ok(Self {
            columns: Columns {
                data: named(data),
                time: time.map(named),
                lines: Some(Vec::new()),
            },
            layout,
            data,
            time,
        })
    }

    fn take(&mut self, line: &str, number: usize) -> Result<(), String> {
        let cells = self.layout.delimiter.cells(line);
        if cells.len() != self.layout.cells {
            return Err(format!(
                "{} cells where the first line has {}",
                cells.len(),
                self.layout.cells
            ));
        }
        let value = |index: usize| finite(cells[index], self.layout.name(index));
        self.columns.data.values.push(value(self.data)?);
        if let (Some(index), Some(time)) = (self.time, &mut self.columns.time) {
            time.values.push(value(index)?);
        }
        if let Some(lines) = &mut self.columns.lines {
            lines.push(number);
        }
        Ok(())
    }
}

/// The number of a cell.
pub(super) fn finite(cell: &str, name: Option<String>) -> Result<f64, String> {
    let column = name.map_or_else(String::new, |name| format!("column {name}: "));
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(number) => Err(format!("{column}{number} is not a finite number")),
        Err(_) if cell.contains(',') => Err(format!(
            "{column}`{cell}` is not a number: expected a decimal point"
        )),
        Err(_) => Err(format!("{column}`{cell}` is not a number")),
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
