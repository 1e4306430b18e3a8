//! Finding the layout of a table: separator, decimal sign, width, the columns of numbers, the first row.

use super::cells::{DecimalFound, cuts, decimal_of, is_value, separator_of};
use super::error::Cut;
use super::heading::{Above, HeadLine, above_rows};
use super::words::{DecimalSign, Separator};
use super::{Fault, Layout, LayoutError};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::{Delimiter, is_comment, is_heading, is_missing, shown};

/// Lines at the end of the first ones that tell how rows look.
const TAIL: usize = 40;
/// Lines of which all are looked at.
const FEW: usize = 6;
/// Marks of comments, but for that which may separate.
const MARKS: [&str; 3] = ["#", "//", "%"];

/// How rows look.
pub(super) struct Rows {
    pub(super) separator: Separator,
    pub(super) decimal: DecimalSign,
    /// Cells of most rows, empty ones behind the others not counted.
    pub(super) cells: usize,
    /// The same, those counted: a last column may be empty in most rows.
    pub(super) cells_most: usize,
    /// Cells of the row that has most of them, no more than that.
    cells_used: usize,
    /// Whether the first cells of rows count them.
    pub(super) is_counted: bool,
    /// Columns that hold numbers or dates in most rows.
    numeric: Vec<usize>,
}

/// Finds the layout of a text from its first lines; nothing if they hold no row.
///
/// # Errors
/// A line above the rows that is neither comment, heading, units nor free text; what may be two things.
pub(in crate::recording) fn find(
    head: &[HeadLine],
    format: &LogFormat,
) -> Result<Option<Layout>, Fault> {
    let skip_lines = format.skip_lines.unwrap_or(0) as usize;
    let head: Vec<&HeadLine> = head.iter().filter(|it| it.number > skip_lines).collect();
    let last_above = last_line_above(format);
    if head.last().is_some_and(|last| last.number <= last_above) {
        return Err(Fault {
            line: None,
            error: LayoutError::NoRowBelow {
                line: last_above,
                key: match format.heading_line.map(|line| line as usize) == Some(last_above) {
                    true => "heading_line",
                    false => "units_line",
                },
            },
        });
    }
    let (rows, marks) = match rows(&head, format)? {
        Some(found) => found,
        None => return Ok(None),
    };
    let is_passed = |line: &HeadLine| is_comment(line.text.trim(), &as_strs(&marks));
    let below = |line: &&&HeadLine| line.number > last_above && !is_passed(line);
    let first = head
        .iter()
        .filter(below)
        .find(|line| rows.fits(&line.text))
        .copied();
    let first = match first {
        Some(first) => first,
        // Nothing looks like a row: what follows a heading is said to be none.
        None => match first_without_fit(&head, &marks, &rows, last_above)? {
            Some(first) => first,
            None => return Ok(None),
        },
    };
    let before: Vec<&HeadLine> = head
        .iter()
        .copied()
        .take_while(|line| line.number < first.number)
        .collect();
    let above = above_rows(&before, &marks, &rows, format)?;
    let is_named = |line: &HeadLine| {
        let mut named = [&above.heading, &above.units].into_iter().flatten();
        named.any(|(number, _)| *number == line.number)
    };
    let comments = before
        .iter()
        .filter(|line| is_passed(line) && !is_named(line))
        .count();
    Ok(Some(layout(above, first, rows, marks, comments, format)))
}

fn layout(
    above: Above,
    first: &HeadLine,
    rows: Rows,
    marks: Vec<String>,
    comments: usize,
    format: &LogFormat,
) -> Layout {
    let (heading_line, names) = above.heading.unzip();
    let (units_line, units) = above.units.unzip();
    let names = names.unwrap_or_default();
    Layout {
        encoding: format.encoding.unwrap_or(super::words::Encoding::Utf8),
        skip_lines: format.skip_lines.unwrap_or(0) as usize,
        preamble: above.preamble,
        marks,
        comments,
        decimal_comma: names
            .is_empty()
            .then(|| one_with_decimal_comma(&first.text))
            .flatten(),
        heading_line,
        units_line,
        first_row_line: first.number,
        separator: rows.separator,
        decimal: rows.decimal,
        cells: match names.len() {
            0 => rows.cells_used,
            named => named.max(rows.cells),
        },
        cells_least: rows.cells,
        names,
        units: units.unwrap_or_default(),
        wrapped: format.wrapped_columns.map(|columns| columns as usize),
    }
}

/// A row that may be one number with a decimal comma.
fn one_with_decimal_comma(row: &str) -> Option<String> {
    let is_number = |cell: &str| cell.parse::<i64>().is_ok();
    let is_fraction = |cell: &str| !cell.is_empty() && cell.bytes().all(|it| it.is_ascii_digit());
    let is_one = matches!(row.split(',').collect::<Vec<_>>()[..], [whole, fraction]
        if is_number(whole.trim_start()) && is_fraction(fraction.trim_end()));
    is_one.then(|| row.trim().to_owned())
}

fn as_strs(marks: &[String]) -> Vec<&str> {
    marks.iter().map(String::as_str).collect()
}

/// The last line that is said to stand above the rows.
pub(in crate::recording) fn last_line_above(format: &LogFormat) -> usize {
    let given = [format.heading_line, format.units_line];
    given.into_iter().flatten().max().unwrap_or(0) as usize
}

/// How the rows of the first lines look, and the marks of comments between them; nothing without a line
/// that says something.
fn rows(head: &[&HeadLine], format: &LogFormat) -> Result<Option<(Rows, Vec<String>)>, Fault> {
    let mut marks: Vec<String> = MARKS.map(str::to_owned).into();
    marks.extend(format.comment.clone());
    let last_above = last_line_above(format);
    let said = |marks: &[String]| -> Vec<&str> {
        let marks = as_strs(marks);
        let lines = head
            .iter()
            .filter(|line| line.number > last_above && !is_comment(line.text.trim(), &marks));
        lines.map(|line| line.text.as_str()).collect()
    };
    let lines = said(&marks);
    // A line that begins with a semicolon says nothing of what separates.
    let plain: Vec<&str> = lines
        .iter()
        .copied()
        .filter(|it| !it.trim().starts_with(';'))
        .collect();
    let is_comment_mark = !plain.is_empty();
    let Some(sample) = tail(if is_comment_mark { &plain } else { &lines }) else {
        return Ok(None);
    };
    let separator = format
        .separator
        .unwrap_or_else(|| separator_of(sample, format.decimal));
    if separator != Separator::Semicolon {
        marks.push(";".to_owned());
    }
    let lines = said(&marks);
    let Some(sample) = tail(&lines) else {
        return Ok(None);
    };
    let decimal = match format.decimal {
        Some(given) => given,
        None => match decimal_of(sample, separator) {
            DecimalFound::Sure(sign) => sign,
            DecimalFound::Doubt(cell) => {
                let line = head.iter().find(|line| line.text.contains(&cell));
                return Err(Fault {
                    line: line.map(|line| line.number),
                    error: LayoutError::Thousands(cell),
                });
            }
        },
    };
    let rows = Rows::of(sample, separator, decimal);
    check_given(&rows, sample, head, format)?;
    Ok(Some((rows, marks)))
}

/// Refuses a separator or a decimal sign that was given where it leaves no numbers, or cells that are none, and
/// what the lines themselves say does not.
fn check_given(
    rows: &Rows,
    sample: &[&str],
    head: &[&HeadLine],
    format: &LogFormat,
) -> Result<(), Fault> {
    let is_whole =
        |rows: &Rows| !rows.numeric.is_empty() && (rows.cells == 1 || cuts(rows.separator, sample));
    let is_given = format.separator.is_some() || format.decimal.is_some();
    if !is_given || is_whole(rows) {
        return Ok(());
    }
    let separator = separator_of(sample, None);
    let DecimalFound::Sure(decimal) = decimal_of(sample, separator) else {
        return Ok(());
    };
    let found = Rows::of(sample, separator, decimal);
    let is_other = (found.separator, found.decimal) != (rows.separator, rows.decimal);
    // Blanks within the cells of a line that is cut are no other way to cut it.
    let is_cut = found.separator == Separator::Blanks
        && rows.separator != Separator::Blanks
        && rows.cells > 1;
    let row = head.iter().find(|line| found.fits(&line.text));
    let Some(row) = row.filter(|_| is_other && !is_cut && is_whole(&found)) else {
        return Ok(());
    };
    Err(Fault {
        line: Some(row.number),
        error: LayoutError::Given {
            row: shown(row.text.trim()),
            given: Cut {
                separator: format.separator,
                decimal: format.decimal,
            },
            found: Cut {
                separator: Some(separator).filter(|it| *it != rows.separator),
                decimal: Some(decimal).filter(|it| *it != rows.decimal),
            },
            cells: found.cells,
        },
    })
}

/// The last of some lines, half of them at most unless they are few: what stands above the rows is none;
/// nothing of none.
fn tail<'a, 'b>(lines: &'b [&'a str]) -> Option<&'b [&'a str]> {
    let most = match lines.len() {
        few @ ..FEW => few,
        many => TAIL.min(many.div_ceil(2)),
    };
    (!lines.is_empty()).then(|| &lines[lines.len() - most..])
}

impl Rows {
    fn of(sample: &[&str], separator: Separator, decimal: DecimalSign) -> Self {
        let delimiter = Delimiter::from(separator);
        let cut: Vec<Vec<&str>> = sample
            .iter()
            .map(|line| delimiter.first_cells(line))
            .collect();
        let cells = most_frequent(cut.iter().map(Vec::len));
        let all = sample.iter().map(|line| delimiter.cells(line).len());
        let cells_most = most_frequent(all).max(cells);
        let used = cut.iter().map(Vec::len).filter(|used| *used <= cells_most);
        let cells_used = used.max().unwrap_or(cells);
        let whole: Vec<&Vec<&str>> = cut.iter().filter(|row| row.len() == cells).collect();
        let is_numeric = |column: &usize| {
            let values = whole.iter().filter(|row| is_value(row[*column], decimal));
            2 * values.count() >= whole.len()
        };
        Self {
            separator,
            decimal,
            cells,
            cells_most,
            cells_used,
            is_counted: are_counted(&whole),
            numeric: (0..cells).filter(is_numeric).collect(),
        }
    }

    /// Whether a line looks as most rows do.
    fn fits(&self, line: &str) -> bool {
        let cells = Delimiter::from(self.separator).cells_up_to(line, self.cells);
        let is_in_place =
            |column: &usize| is_value(cells[*column], self.decimal) || is_missing(cells[*column]);
        (self.cells..=self.cells_most).contains(&cells.len())
            && !self.numeric.is_empty()
            && self.numeric.iter().all(is_in_place)
    }
}

/// Whether the first cells of rows are whole numbers one after the other.
fn are_counted(rows: &[&Vec<&str>]) -> bool {
    let numbers = rows.iter().map(|row| row.first()?.parse::<i64>().ok());
    let Some(numbers) = numbers.collect::<Option<Vec<i64>>>() else {
        return false;
    };
    numbers.len() > 1
        && numbers
            .windows(2)
            .all(|two| two[0].checked_add(1) == Some(two[1]))
}

/// The most frequent of some counts; of several the largest.
fn most_frequent(counts: impl Iterator<Item = usize>) -> usize {
    let mut found = std::collections::BTreeMap::new();
    for count in counts {
        *found.entry(count).or_insert(0) += 1;
    }
    let most = found
        .into_iter()
        .max_by_key(|(count, times)| (*times, *count));
    most.map_or(0, |(count, _)| count)
}

/// The line that stands for the first row where none looks like one: that below a heading.
fn first_without_fit<'a>(
    head: &[&'a HeadLine],
    marks: &[String],
    rows: &Rows,
    last_above: usize,
) -> Result<Option<&'a HeadLine>, Fault> {
    let marks = as_strs(marks);
    let mut lines = head
        .iter()
        .filter(|line| line.number > last_above && !is_comment(line.text.trim(), &marks));
    let Some(first) = lines.next() else {
        return Ok(None);
    };
    if last_above > 0 {
        return Ok(Some(first));
    }
    let cells = Delimiter::from(rows.separator).first_cells(&first.text);
    match is_heading(&cells) {
        Ok(true) => Ok(lines.next().copied()),
        Ok(false) => Ok(Some(first)),
        Err(error) => Err(Fault {
            line: Some(first.number),
            error: error.into(),
        }),
    }
}
