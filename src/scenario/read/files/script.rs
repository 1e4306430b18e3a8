//! The table of a scripted motion: from a CSV file to the values of a scenario.
//!
//! The file is read where the key that names it was written, and its columns take the place of
//! that key. What is checked, hashed, recorded and repeated afterwards are the values themselves.

use crate::recording::{Delimiter, Lines, TextError};
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::input::{self, Input};
use crate::scenario::read::resolved::InputFile;

/// The key that names the file.
pub(crate) const FILE_KEY: &str = "turntable.script.file";

/// The column of times.
const TIME: &str = "time_s";

/// The columns of which a file has one.
const VALUES: [&str; 2] = ["rate_deg_per_s", "angle_deg"];

/// Most rows of a file: its values stand in the manifest of every run.
const ROWS_MAX: usize = 100_000;

/// Replaces `turntable.script.file` by the columns of that file, if it is given.
///
/// # Errors
/// A file that cannot be read or is no such table, at the line and column that is wrong.
pub(crate) fn read_into(
    root: &mut Table,
    sources: &mut Sources,
    inputs: &mut Vec<InputFile>,
) -> Result<(), ScenarioError> {
    let script = root
        .get_mut("turntable")
        .and_then(Node::as_table_mut)
        .and_then(|turntable| turntable.get_mut("script"))
        .and_then(Node::as_table_mut);
    let Some(script) = script else {
        return Ok(());
    };
    let named = script.get("file").map(|node| (node.as_text(), node.mark));
    // A value that is no text is refused with the other types.
    let Some((Some(file), Some(mark))) = named else {
        return Ok(());
    };
    let (path, label) = sources.beside(mark, file);
    let complain = |sources: &Sources, message: &str| {
        let shown = crate::scenario::document::source::shown_path(&path);
        sources.error(mark, format!("{FILE_KEY} = {shown}: {message}"))
    };
    let Input { text, digest } =
        input::read(&path).map_err(|error| complain(sources, &error.to_string()))?;
    let source = sources.add_file(
        crate::scenario::document::source::shown_path(&path),
        text.clone(),
        label.clone(),
    );
    inputs.push(InputFile {
        file: label.text(),
        digest,
    });
    let points = columns(source, &text).map_err(|TableError { start, fault }| {
        let mark = Mark { source, start };
        sources.error(mark, fault.to_string())
    })?;
    script.remove("file");
    let node = Node {
        value: points.into(),
        mark: Some(mark),
    };
    script.insert("points".to_owned(), node);
    Ok(())
}

/// Why a file is not the table of a script, and the byte at which it shows.
#[derive(Debug, thiserror::Error)]
#[error("{fault}")]
struct TableError {
    start: usize,
    fault: TableFault,
}

/// What is wrong with the table of a script.
#[derive(Debug, thiserror::Error)]
enum TableFault {
    /// What the reader of its lines says.
    #[error("{0}")]
    Text(String),
    #[error("the file is empty: expected {}", expected())]
    Empty,
    #[error("unknown column `{name}`: expected {}", expected(), name = .0)]
    UnknownColumn(String),
    #[error("wrong columns: expected {}", expected())]
    WrongColumns,
    #[error("too many rows: allowed up to {ROWS_MAX}")]
    TooManyRows,
    #[error("{0} values in the row: expected 2, one a column")]
    Width(usize),
    #[error("{column} = `{cell}` is not a number: expected one such as 0.5")]
    NotANumber { column: String, cell: String },
}

impl TableFault {
    fn at(self, start: usize) -> TableError {
        TableError { start, fault: self }
    }
}

/// A cell and the byte at which it starts.
type Cell<'a> = (usize, &'a str);

/// The cells of a line that starts at a byte; empty ones beyond a width are none.
fn cells(delimiter: Delimiter, start: usize, line: &str, width: usize) -> Vec<Cell<'_>> {
    let begin = line.as_ptr() as usize;
    let cells = delimiter.cells_up_to(line, width).into_iter();
    // Cells are parts of the line.
    cells
        .map(|cell| (start + (cell.as_ptr() as usize - begin), cell))
        .collect()
}

/// The lines that say something, with the byte at which each starts.
fn lines(text: &str) -> Result<Vec<(usize, &str)>, TableError> {
    let mut lines = Lines::new(text.as_bytes(), "the file is not UTF-8 text");
    let mut found = Vec::new();
    loop {
        match lines.next_line() {
            Ok(Some(line)) => found.push((line.start, &text[line.start..][..line.text.len()])),
            Ok(None) => return Ok(found),
            Err(TextError::Content { start, message, .. }) => {
                return Err(TableFault::Text(message).at(start));
            }
            Err(TextError::Io(error)) => return Err(TableFault::Text(error.to_string()).at(0)),
        }
    }
}

/// The columns of a table, every value marked where it stands.
fn columns(source: usize, text: &str) -> Result<Table, TableError> {
    let mut lines = lines(text)?.into_iter();
    let (start, header) = lines.next().ok_or_else(|| TableFault::Empty.at(0))?;
    let delimiter = Delimiter::of(header);
    let header = cells(delimiter, start, header, 0);
    check_header(start, &header)?;
    let mut values: [Vec<Node>; 2] = [Vec::new(), Vec::new()];
    for (start, line) in lines {
        if values[0].len() == ROWS_MAX {
            return Err(TableFault::TooManyRows.at(start));
        }
        let row = cells(delimiter, start, line, header.len());
        if row.len() != header.len() {
            return Err(TableFault::Width(row.len()).at(start));
        }
        for ((at, cell), (column, (_, name))) in row.iter().zip(values.iter_mut().zip(&header)) {
            let number: f64 = cell.parse().map_err(|_| {
                let cell = excerpt(cell).into_owned();
                let column = (*name).to_owned();
                TableFault::NotANumber { column, cell }.at(*at)
            })?;
            column.push(Node {
                value: Value::Float(number),
                mark: Some(Mark { source, start: *at }),
            });
        }
    }
    let table = header.iter().zip(values).map(|((at, name), values)| {
        let node = Node {
            value: values.into(),
            mark: Some(Mark { source, start: *at }),
        };
        ((*name).to_owned(), node)
    });
    Ok(table.collect())
}

/// What the first line must be.
fn expected() -> String {
    format!(
        "a first line `{TIME},{}` or `{TIME},{}`",
        VALUES[0], VALUES[1]
    )
}

/// Refuses a header that is not [`TIME`] and one of [`VALUES`], in any order.
fn check_header(start: usize, header: &[Cell<'_>]) -> Result<(), TableError> {
    let is_known = |name: &str| name == TIME || VALUES.contains(&name);
    if let Some((at, name)) = header.iter().find(|(_, name)| !is_known(name)) {
        return Err(TableFault::UnknownColumn(excerpt(name).into_owned()).at(*at));
    }
    let times = header.iter().filter(|(_, name)| *name == TIME).count();
    if header.len() == 2 && times == 1 {
        return Ok(());
    }
    Err(TableFault::WrongColumns.at(start))
}
