//! The table of a scripted motion: from a CSV file to the values of a scenario.
//!
//! The file is read where the key that names it was written, and its columns take the place of
//! that key. What is checked, hashed, recorded and repeated afterwards are the values themselves.

use std::io;
use std::path::Path;

use super::error::ScenarioError;
use super::resolved::InputFile;
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};
use crate::recording::{
    Delimiter, FileError, Lines, TEXT_BYTES_MAX, TextError, read_regular, text_of,
};

/// The key that names the file.
pub(crate) const FILE_KEY: &str = "turntable.script.file";

/// The column of times.
const TIME: &str = "time_s";

/// The columns of which a file has one.
const VALUES: [&str; 2] = ["rate_deg_per_s", "angle_deg"];

/// What is said of bytes that are no text.
const NO_TEXT: &str = "the file is not UTF-8 text";

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
        let shown = super::source::shown_path(&path);
        sources.error(mark, format!("{FILE_KEY} = {shown}: {message}"))
    };
    let bytes = read_bytes(&path).map_err(|message| complain(sources, &message))?;
    let digest = blake3::hash(&bytes).to_hex().to_string();
    let text = text_of(bytes, NO_TEXT).map_err(|error| complain(sources, &error.to_string()))?;
    let source = sources.add_file(
        super::source::shown_path(&path),
        text.clone(),
        label.clone(),
    );
    inputs.push(InputFile {
        file: label.text(),
        digest,
    });
    let points = columns(source, &text).map_err(|(start, message)| {
        let mark = Mark { source, start };
        sources.error(mark, message)
    })?;
    script.remove("file");
    let node = Node {
        value: Value::Table(points),
        mark: Some(mark),
    };
    script.insert("points".to_owned(), node);
    Ok(())
}

/// The bytes of a file that a scenario names, or what is wrong with it.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>, String> {
    read_regular(path, TEXT_BYTES_MAX).map_err(|error| match error {
        FileError::Io(error) if error.kind() == io::ErrorKind::NotFound => {
            "no such file".to_owned()
        }
        _ if path.is_dir() => "it is a folder, not a file".to_owned(),
        FileError::Io(error) => format!("cannot read the file: {error}"),
        other => other.to_string(),
    })
}

/// A cell and the byte at which it starts.
type Cell<'a> = (usize, &'a str);

/// The cells with their places in the text; they are parts of the line, which begins at `start`.
fn placed<'a>(start: usize, line: &'a str, cells: Vec<&'a str>) -> Vec<Cell<'a>> {
    let begin = line.as_ptr() as usize;
    let place = |cell: &'a str| (start + (cell.as_ptr() as usize - begin), cell);
    cells.into_iter().map(place).collect()
}

/// The columns of a table, every value marked where it stands.
fn columns(source: usize, text: &str) -> Result<Table, (usize, String)> {
    // The text was read once already: what it holds are lines of text.
    let fault = |error: TextError| (0, error.to_string());
    let mut lines = Lines::new(text.as_bytes(), NO_TEXT);
    let Some(first) = lines.next_line().map_err(fault)? else {
        return Err((0, format!("the file is empty: expected {}", expected())));
    };
    let delimiter = Delimiter::of(first.text);
    let names = delimiter.first_cells(first.text);
    let names = placed(first.start, first.text, names);
    check_header(first.start, &names)?;
    let header: Vec<(usize, String)> = names
        .into_iter()
        .map(|(at, name)| (at, name.to_owned()))
        .collect();
    let mut values: [Vec<Node>; 2] = [Vec::new(), Vec::new()];
    while let Some(line) = lines.next_line().map_err(fault)? {
        let start = line.start;
        if values[0].len() == ROWS_MAX {
            return Err((start, format!("too many rows: allowed up to {ROWS_MAX}")));
        }
        let row = delimiter.cells_up_to(line.text, header.len());
        if row.len() != header.len() {
            let count = row.len();
            return Err((
                start,
                format!("{count} values in the row: expected 2, one a column"),
            ));
        }
        let row = placed(start, line.text, row);
        for ((at, cell), (column, (_, name))) in row.iter().zip(values.iter_mut().zip(&header)) {
            let number: f64 = cell.parse().map_err(|_| {
                let message =
                    format!("{name} = `{cell}` is not a number: expected one such as 0.5");
                (*at, message)
            })?;
            column.push(Node {
                value: Value::Float(number),
                mark: Some(Mark { source, start: *at }),
            });
        }
    }
    let table = header.into_iter().zip(values).map(|((at, name), values)| {
        let node = Node {
            value: Value::Array(values),
            mark: Some(Mark { source, start: at }),
        };
        (name, node)
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
fn check_header(start: usize, header: &[Cell<'_>]) -> Result<(), (usize, String)> {
    let is_known = |name: &str| name == TIME || VALUES.contains(&name);
    if let Some((at, name)) = header.iter().find(|(_, name)| !is_known(name)) {
        return Err((
            *at,
            format!("unknown column `{name}`: expected {}", expected()),
        ));
    }
    let times = header.iter().filter(|(_, name)| *name == TIME).count();
    if header.len() == 2 && times == 1 {
        return Ok(());
    }
    Err((start, format!("wrong columns: expected {}", expected())))
}
