//! Columns of numbers in text.

use std::io::{self, BufRead};
use std::path::{Path, PathBuf};

use super::first_rows::{Heads, chosen};
use super::head::{HEAD_LINES, head};
use super::lines::{Delimiter, Lines, TextError, is_missing, shown};
use super::plain::{PlainRows, Role};
use super::transcode::{as_utf8, encoding_of};
use crate::recording::column::{Column, Columns, LinesBetween, RowLines};
use crate::recording::error::{LogError, Place};
use crate::recording::input::{Input, failure, push};
use crate::recording::layout::columns::{Chosen, Selection};
use crate::recording::layout::words::{DecimalSign, MissingWords};
use crate::recording::layout::{Fault, HeadLine, Layout, LayoutError, find, finite_in, is_number};
use crate::recording::log::format::LogFormat;
use crate::recording::log::gaps::Gaps;
use crate::recording::time::column::TimeColumn;
use crate::recording::time::stamp::Stamp;

/// What is read from a file.
#[derive(Clone, Debug)]
pub(in crate::recording) struct Wanted<'a> {
    pub(in crate::recording) columns: Selection<'a>,
    /// Whether the time is looked for.
    pub(in crate::recording) needs_time: bool,
    /// What may be done about samples that are missing.
    pub(in crate::recording) gaps: Gaps,
    pub(in crate::recording) format: &'a LogFormat,
    /// Samples after which reading ends.
    pub(in crate::recording) samples_max: usize,
}

/// Reads columns, and that of the time where it is asked for or found.
///
/// # Errors
/// Bytes that are no text, a layout in doubt, unknown columns and one asked for twice, lines of another
/// width, cells that are no finite number.
pub(in crate::recording) fn read(
    path: &Path,
    input: Input,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let Some(mut rows) = Rows::open(path, input, wanted, HEAD_LINES)? else {
        return Ok(Columns::default());
    };
    rows.read_up_to(wanted.samples_max)?;
    Ok(rows.table.columns)
}

/// The rows of a text while they are read.
pub(in crate::recording) struct Rows {
    path: PathBuf,
    lines: Lines<Box<dyn BufRead + Send>>,
    /// First lines that were looked at and not read yet, the first of them last.
    head: Vec<HeadLine>,
    table: Table,
}

impl Rows {
    /// Finds the layout; nothing of a text without rows.
    ///
    /// * `head_lines`: how many lines it is found from, those above the rows by what is said of them not
    ///   counted.
    ///
    /// # Errors
    /// As [`read`].
    pub(in crate::recording) fn open(
        path: &Path,
        input: Input,
        wanted: &Wanted<'_>,
        head_lines: usize,
    ) -> Result<Option<Self>, LogError> {
        let given = wanted.format.encoding;
        let encoding = given.unwrap_or_else(|| encoding_of(input.first()));
        let expected = match wanted.needs_time {
            true => "neither NPY nor text in UTF-8: --encoding names another",
            false => "neither NPY nor text in UTF-8",
        };
        let mut lines = Lines::new(as_utf8(input, encoding), expected);
        let head = head(&mut lines, wanted.format, head_lines);
        let mut head = head.map_err(|error| fault(path, error))?;
        let Some(mut layout) = find(&head, wanted.format).map_err(|fault| fault.of(path))? else {
            return Ok(None);
        };
        layout.encoding = encoding;
        let line = Some(layout.heading_line.unwrap_or(layout.first_row_line));
        let heads = Heads::of(&layout, &head);
        let chosen = chosen(&layout, &head, &heads, wanted)
            .map_err(|error| Fault { line, error }.of(path))?;
        head.reverse();
        let table = Table::new(layout, heads, chosen, wanted);
        Ok(Some(Self {
            path: path.to_owned(),
            lines,
            head,
            table,
        }))
    }

    /// What was read and not taken.
    pub(in crate::recording) fn columns(&self) -> &Columns {
        &self.table.columns
    }

    /// All that was read.
    pub(in crate::recording) fn into_columns(self) -> Columns {
        self.table.columns
    }

    /// Takes what was read, but for the last stamp: rows count from there on.
    pub(in crate::recording) fn take(&mut self) -> Columns {
        let columns = &mut self.table.columns;
        self.table.taken += columns.rows();
        let data = columns.data.iter().map(|column| Column {
            name: column.name.clone(),
            unit: column.unit,
            values: Vec::new(),
        });
        let next = Columns {
            data: data.collect(),
            time: columns.time.as_mut().map(TimeColumn::going_on),
            lines: Some(RowLines::default()),
            lines_between: columns.lines_between,
            ..Columns::default()
        };
        std::mem::replace(columns, next)
    }

    /// Exchanges the numbers of the first column for an empty buffer.
    pub(in crate::recording) fn take_values(&mut self, values: &mut Vec<f64>) {
        let columns = &mut self.table.columns;
        self.table.taken += columns.rows();
        if let Some(column) = columns.data.first_mut() {
            std::mem::swap(&mut column.values, values);
        }
    }

    /// Forgets what was read, but for the last stamp: rows count from there on.
    pub(in crate::recording) fn clear(&mut self) {
        let columns = &mut self.table.columns;
        self.table.taken += columns.rows();
        for column in &mut columns.data {
            column.values.clear();
        }
        columns.lines = Some(RowLines::default());
        if let Some(time) = &mut columns.time {
            let last = time.stamps.pop();
            time.stamps = last.into_iter().collect();
        }
    }

    /// Reads the rows among the lines from which the layout was found, so many at most.
    ///
    /// # Errors
    /// As [`read`].
    pub(in crate::recording) fn read_head(&mut self, rows: usize) -> Result<(), LogError> {
        let Self {
            path, head, table, ..
        } = self;
        let mut empty = None;
        while table.columns.rows() < rows
            && let Some(line) = head.pop()
        {
            empty = empty.or(line.empty_before);
            let is_above = line.number < table.layout.first_row_line;
            if is_above || table.layout.is_comment(line.text.trim()) {
                continue;
            }
            table.line(path, &line.text, line.number, empty.take())?;
        }
        Ok(())
    }

    /// Reads on until there are so many rows; whether the text goes on.
    ///
    /// # Errors
    /// As [`read`].
    pub(in crate::recording) fn read_up_to(&mut self, rows: usize) -> Result<bool, LogError> {
        self.read_head(rows)?;
        let Self {
            path, lines, table, ..
        } = self;
        while table.columns.rows() < rows {
            let most = rows - table.columns.rows();
            let passed = lines.pass(|bytes, number| table.plain_rows(bytes, number, most));
            passed.map_err(|error| failure(path, error))?;
            if table.columns.rows() >= rows {
                break;
            }
            let layout = &table.layout;
            let line = lines.next_unless(|text| layout.is_comment(text));
            let Some(line) = line.map_err(|error| fault(path, error))? else {
                table.check_end(path)?;
                return Ok(false);
            };
            table.line(path, line.text, line.number, line.empty_before)?;
        }
        Ok(true)
    }
}

/// An error of a text at its line.
pub(in crate::recording) fn fault(path: &Path, error: TextError) -> LogError {
    match error {
        TextError::Io(error) => failure(path, error),
        TextError::Content { line, message, .. } => LogError::at(path, Place::Line(line), message),
    }
}

/// Fewest bytes in which rows of plain numbers are looked for at once.
const PLAIN_BYTES_MIN: usize = 1 << 9;

/// A file while it is read.
struct Table {
    layout: Layout,
    roles: Vec<Role>,
    columns: Columns,
    is_gap: bool,
    gaps: Gaps,
    /// Cells of a first row that are no numbers; none once the second row was held against it.
    words: Vec<(usize, String)>,
    /// Values of a record that is spread over lines.
    record: Vec<String>,
    /// Heading and row of units.
    heads: Heads,
    /// Rows that were read and taken away.
    taken: usize,
    /// What stands between plain numbers, if it is one byte; a blank stands for any number of them.
    plain_separator: Option<u8>,
    /// Bytes in which rows of plain numbers are looked for at once.
    plain_bytes: usize,
}

/// What is wrong with a row.
enum RowError {
    Layout(LayoutError),
    /// A cell of a column.
    Cell(usize, String),
    Memory(std::io::Error),
}

impl Table {
    fn new(layout: Layout, heads: Heads, chosen: Chosen, wanted: &Wanted<'_>) -> Self {
        let mut roles = vec![Role::Nothing; layout.width()];
        for (position, index) in chosen.data.iter().enumerate() {
            roles[*index] = Role::Data(position);
        }
        for (index, unit) in &chosen.time {
            roles[*index] = Role::Time(*unit);
        }
        let line = layout.line(&chosen);
        let found = layout.format(&chosen, wanted.format);
        let data = chosen.data.iter().map(|index| Column {
            name: layout.name(*index),
            unit: layout.unit(*index),
            values: Vec::new(),
        });
        let names = chosen.time.iter().map(|(index, _)| layout.name(*index));
        let names: Vec<String> = names.map(Option::unwrap_or_default).collect();
        let units: Vec<_> = chosen.time.iter().map(|(_, unit)| *unit).collect();
        let time = (!units.is_empty()).then(|| {
            let mut time = TimeColumn::new(names.join(" + "), units, chosen.is_time_found);
            time.rolls_over_after(wanted.format.roll_over);
            time.note.clone_from(&chosen.time_note);
            time
        });
        let missing = wanted.format.missing;
        let plain_separator = match layout.delimiter() {
            Delimiter::Character(separator) => u8::try_from(separator).ok(),
            Delimiter::Blanks => Some(b' '),
        };
        let is_plain = layout.decimal == DecimalSign::Point && layout.wrapped.is_none();
        Self {
            plain_separator: plain_separator.filter(|_| is_plain),
            plain_bytes: PLAIN_BYTES_MIN,
            columns: Columns {
                data: data.collect(),
                time,
                layout: Some(line),
                found: Some(found),
                note: None,
                unread_time: chosen.unread_time.clone(),
                lines: Some(RowLines::default()),
                lines_between: LinesBetween::default(),
            },
            layout,
            roles,
            is_gap: missing == Some(MissingWords::Gap),
            gaps: wanted.gaps,
            words: Vec::new(),
            record: Vec::new(),
            heads,
            taken: 0,
        }
    }

    /// Rows that were read.
    fn seen(&self) -> usize {
        self.taken + self.columns.rows()
    }

    /// Takes a line.
    fn line(
        &mut self,
        path: &Path,
        text: &str,
        number: usize,
        empty_before: Option<usize>,
    ) -> Result<(), LogError> {
        if self.seen() > 0 {
            let between = &mut self.columns.lines_between;
            between.empty.extend(empty_before);
            if self.heads.hold(&self.layout, text) {
                between.headings.extend(Some(number));
                return Ok(());
            }
        }
        let taken = match self.layout.wrapped {
            Some(columns) => self.wrapped(text, columns),
            None => self.row(text),
        };
        taken.map_err(|error| self.complaint(path, number, error))?;
        let row = self.columns.rows().saturating_sub(1);
        match &mut self.columns.lines {
            Some(lines) if self.columns.data[0].values.len() > row => lines
                .take(row, number)
                .map_err(|error| failure(path, error)),
            _ => Ok(()),
        }
    }

    fn complaint(&self, path: &Path, line: usize, error: RowError) -> LogError {
        let at = |message: String| LogError::at(path, Place::Line(line), message);
        match error {
            RowError::Memory(error) => failure(path, error),
            RowError::Layout(error) => {
                let line = Some(line);
                Fault { line, error }.of(path)
            }
            RowError::Cell(index, message) => {
                let name = self.layout.name(index);
                let column = name.map(|name| format!("column {}: ", shown(&name)));
                at(column.unwrap_or_default() + &message)
            }
        }
    }

    /// Takes the rows of plain numbers at the beginning of some bytes, so many at most: how many, and their bytes.
    ///
    /// * `number`: of the first line.
    fn plain_rows(
        &mut self,
        bytes: &[u8],
        number: usize,
        most: usize,
    ) -> io::Result<(usize, usize)> {
        let Some(separator) = self.plain_separator.filter(|_| self.seen() > 1) else {
            return Ok((0, 0));
        };
        let Columns { data, time, .. } = &mut self.columns;
        let rows = PlainRows {
            roles: &self.roles,
            origin: time.as_ref().map(TimeColumn::origin),
            separator,
        };
        let first = data.first().map_or(0, |column| column.values.len());
        let (mut count, mut length) = (0, 0);
        while count < most && length < bytes.len() {
            let rest = &bytes[length..];
            let part = &rest[..self.plain_bytes.min(rest.len())];
            let (more, taken) = rows.append(part, most - count, data, time.as_mut())?;
            count += more;
            length += taken;
            // Another line that is no such row is likely to come as soon as this one did: what is prepared for
            // the rows behind it is lost.
            if memchr::memchr(b'\n', &part[taken..]).is_some() {
                self.plain_bytes = (2 * taken).max(PLAIN_BYTES_MIN);
                break;
            }
            if part.len() == rest.len() {
                break;
            }
            self.plain_bytes *= 2;
        }
        // The lines of the others follow.
        if let Some(lines) = self.columns.lines.as_mut().filter(|_| count > 0) {
            lines.take(first, number)?;
        }
        Ok((count, length))
    }

    /// Takes a line that is a row.
    fn row(&mut self, text: &str) -> Result<(), RowError> {
        if self.seen() < 2 && self.layout.names.is_empty() {
            let cells = self.layout.delimiter().cells_up_to(text, self.layout.cells);
            self.hold_against_first(&cells).map_err(RowError::Layout)?;
        }
        let is_quoted = text.contains('"');
        match self.layout.delimiter() {
            Delimiter::Character(separator) if !is_quoted => {
                self.take(text.split(separator).map(str::trim))
            }
            Delimiter::Blanks if !is_quoted => self.take(text.split_whitespace()),
            delimiter => self.take(delimiter.cells(text).into_iter()),
        }
    }

    /// Takes the cells of a row in one pass: as many as the first row has, and empty ones behind.
    fn take<'a>(&mut self, cells: impl Iterator<Item = &'a str>) -> Result<(), RowError> {
        let (mut count, mut beyond) = (0, 0);
        let mut fault = None;
        let mut stamp = Stamp::NOTHING;
        for (index, cell) in cells.enumerate() {
            match self.roles.get(index) {
                Some(role) if fault.is_none() => {
                    fault = self
                        .cell(*role, cell, &mut stamp)
                        .err()
                        .map(|it| (index, it));
                }
                Some(_) => {}
                None if cell.is_empty() => {
                    beyond += 1;
                    continue;
                }
                None => {
                    count += beyond;
                    beyond = 0;
                }
            }
            count += 1;
        }
        if !self.is_whole(count) {
            return Err(RowError::Layout(self.other_width(count)));
        }
        match fault {
            None => {}
            Some((_, CellFault::Memory(error))) => return Err(RowError::Memory(error)),
            Some((index, CellFault::Content(message))) => {
                return Err(RowError::Cell(index, message));
            }
        }
        match &mut self.columns.time {
            Some(time) => time.take(stamp).map_err(RowError::Memory),
            None => Ok(()),
        }
    }

    /// Whether a row of so many cells has one in every column that is read.
    fn is_whole(&self, count: usize) -> bool {
        let expected = self.layout.width();
        if count == expected {
            return true;
        }
        let least = match self.layout.wrapped {
            Some(_) => expected,
            None => self.layout.cells_least,
        };
        let mut left_out = self.roles.iter().skip(count);
        (least..expected).contains(&count) && left_out.all(|role| matches!(role, Role::Nothing))
    }

    fn other_width(&self, got: usize) -> LayoutError {
        let way_out = match self.seen() {
            0 => String::new(),
            rows => format!("; --rows :{rows} takes those above alone"),
        };
        LayoutError::Width {
            got,
            reference: match self.layout.names.is_empty() {
                true => "first row",
                false => "first line",
            },
            expected: self.layout.width(),
            way_out,
        }
    }

    fn cell(&mut self, role: Role, cell: &str, stamp: &mut Stamp) -> Result<(), CellFault> {
        let decimal = self.layout.decimal;
        match role {
            Role::Nothing => Ok(()),
            Role::Data(position) => {
                let value = match finite_in(cell, decimal) {
                    Ok(value) => value,
                    Err(_) if self.is_gap && is_missing(cell) => f64::NAN,
                    Err(error) => {
                        let way_out = match is_missing(cell) {
                            true => self.gaps.at_number().to_owned(),
                            false => self.layout.other_cut(cell),
                        };
                        return Err(CellFault::Content(format!("{error}{way_out}")));
                    }
                };
                let values = &mut self.columns.data[position].values;
                push(values, value).map_err(CellFault::Memory)
            }
            Role::Time(unit) => {
                let part = Stamp::read(cell, unit, decimal);
                let part = part.map_err(|error| {
                    let way_out = self.layout.other_cut(cell);
                    CellFault::Content(format!("{error}{way_out}"))
                })?;
                *stamp = stamp.plus(part);
                Ok(())
            }
        }
    }

    /// Takes the values of a line as parts of records of so many.
    fn wrapped(&mut self, text: &str, columns: usize) -> Result<(), RowError> {
        let cells = self.layout.delimiter().first_cells(text);
        let cells: Vec<String> = cells.into_iter().map(str::to_owned).collect();
        for cell in cells {
            self.record.push(cell);
            if self.record.len() == columns {
                let record = std::mem::take(&mut self.record);
                self.take(record.iter().map(String::as_str))?;
            }
        }
        Ok(())
    }

    /// Refuses the end of a file within a record.
    fn check_end(&self, path: &Path) -> Result<(), LogError> {
        if self.record.is_empty() {
            return Ok(());
        }
        let error = LayoutError::WrappedEnd {
            got: self.record.len(),
            expected: self.layout.width(),
        };
        Err(Fault::from(error).of(path))
    }

    /// Refuses a first row that may be a heading some of whose names are numbers: one that has words
    /// where the second has numbers. It would be taken for a sample.
    fn hold_against_first(&mut self, cells: &[&str]) -> Result<(), LayoutError> {
        let decimal = self.layout.decimal;
        if self.seen() == 0 {
            let words = cells.iter().enumerate();
            let words = words.filter(|(_, cell)| !is_number(cell, decimal));
            self.words = words.map(|(index, cell)| (index, shown(cell))).collect();
            return Ok(());
        }
        let mut words = std::mem::take(&mut self.words).into_iter();
        let became_number = |(index, _): &(usize, String)| {
            cells
                .get(*index)
                .is_some_and(|cell| is_number(cell, decimal))
        };
        match words.find(became_number) {
            Some((index, word)) => Err(LayoutError::WordInFirstRow {
                column: index + 1,
                word,
                line: self.layout.first_row_line,
            }),
            None => Ok(()),
        }
    }
}

/// What is wrong with a cell.
enum CellFault {
    Content(String),
    Memory(std::io::Error),
}
