//! What stands above the rows: heading, units, free text.

use super::cells::is_number;
use super::find::Rows;
use super::words::Separator;
use super::{Fault, LayoutError};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::{Delimiter, is_comment, is_heading, shown};
use crate::recording::unit::spelling::{Spelled, spelled};
use crate::wording::counted;

/// Most comments above the rows that are looked at for a heading.
const COMMENTS_MAX: usize = 3;

/// A line at the start of a text.
#[derive(Clone, Debug)]
pub(in crate::recording) struct HeadLine {
    /// From 1.
    pub(in crate::recording) number: usize,
    pub(in crate::recording) text: String,
    /// The first empty line between the one before and it.
    pub(in crate::recording) empty_before: Option<usize>,
}

/// A line with the cells it was cut into.
type Named = (usize, Vec<String>);

/// Marks of comments.
struct Marks<'a>(&'a [String]);

impl Marks<'_> {
    /// The mark that a line begins with.
    fn of(&self, line: &HeadLine) -> Option<&str> {
        let text = line.text.trim();
        let mut marks = self.0.iter().map(String::as_str);
        marks.find(|mark| is_comment(text, &[mark]))
    }

    /// A line without the mark that it begins with.
    fn without<'a>(&self, line: &'a HeadLine) -> &'a str {
        match self.of(line) {
            // A tab behind it is an empty cell.
            Some(mark) => {
                let text = line.text.trim_start().trim_start_matches(mark);
                text.trim_matches(' ')
            }
            None => &line.text,
        }
    }
}

/// What the lines above the rows were taken for.
#[derive(Default)]
pub(super) struct Above {
    pub(super) heading: Option<Named>,
    pub(super) units: Option<Named>,
    /// Lines of free text.
    pub(super) preamble: usize,
}

/// Takes the lines above the first row apart.
///
/// # Errors
/// A line that is neither heading, units nor free text.
pub(super) fn above_rows(
    before: &[&HeadLine],
    marks: &[String],
    rows: &Rows,
    format: &LogFormat,
) -> Result<Above, Fault> {
    let marks = Marks(marks);
    if format.heading_line.is_some() || format.units_line.is_some() {
        return given(before, &marks, rows, format);
    }
    let (comments, texts): (Vec<&HeadLine>, Vec<&HeadLine>) =
        before.iter().partition(|line| marks.of(line).is_some());
    let Some((last, others)) = texts.split_last() else {
        return Ok(commented(&comments, &marks, rows));
    };
    let cut = |line: &HeadLine| names_in(&line.text, rows);
    let Some(cells) = cut(last) else {
        return without_heading(last, others, &comments, &marks, rows);
    };
    let quoted: Vec<&str> = cells.iter().map(String::as_str).collect();
    let is_named = is_heading(&quoted).map_err(|error| Fault {
        line: Some(last.number),
        error: match others {
            [] => error.into(),
            _ => LayoutError::AbovePassable(error, last.number),
        },
    })?;
    if !is_named {
        return Err(words_in_first_row(last, rows));
    }
    let mut above = Above::default();
    let mut free = others;
    let higher = others
        .last()
        .and_then(|line| Some((line.number, cut(line)?)));
    let commented = commented(&comments, &marks, rows).heading;
    match higher.or(commented) {
        Some(heading) if is_units(&cells) => {
            free = match others.split_last() {
                Some((line, rest)) if line.number == heading.0 => rest,
                _ => others,
            };
            above.heading = Some(heading);
            above.units = Some((last.number, cells));
        }
        _ => above.heading = Some((last.number, cells)),
    }
    for line in free {
        check_free(line, rows)?;
    }
    above.preamble = free.len();
    Ok(above)
}

/// Takes the lines that options name.
fn given(
    before: &[&HeadLine],
    marks: &Marks<'_>,
    rows: &Rows,
    format: &LogFormat,
) -> Result<Above, Fault> {
    let line = |number: Option<u32>, key: &'static str| -> Result<Option<Named>, Fault> {
        let Some(number) = number.filter(|number| *number > 0) else {
            return Ok(None);
        };
        let line = number as usize;
        let fault = |error| Fault { line: None, error };
        let found = before.iter().find(|it| it.number == line);
        let found = found.ok_or_else(|| fault(LayoutError::NoLine { line, key }))?;
        let text = marks.without(found);
        let cells = names_in(text, rows).ok_or_else(|| {
            let got = counted(
                Delimiter::from(rows.separator).first_cells(text).len(),
                "name",
            );
            fault(LayoutError::Heading {
                line,
                got,
                expected: rows.cells,
            })
        })?;
        Ok(Some((line, cells)))
    };
    let heading = line(format.heading_line, "heading_line")?;
    let units = line(format.units_line, "units_line")?;
    let named = usize::from(heading.is_some()) + usize::from(units.is_some());
    Ok(Above {
        heading,
        units,
        preamble: before.len() - named.min(before.len()),
    })
}

/// The heading, and the units, in comments directly above the rows.
fn commented(comments: &[&HeadLine], marks: &Marks<'_>, rows: &Rows) -> Above {
    let mut above = Above::default();
    for line in comments.iter().rev().take(COMMENTS_MAX) {
        let text = marks.without(line);
        let Some(cells) = names_in(text, rows) else {
            continue;
        };
        let names: Vec<&str> = cells.iter().map(String::as_str).collect();
        // A comment of several words above a single column is prose.
        let is_prose = rows.cells == 1 && text.contains(char::is_whitespace);
        if is_prose || !is_heading(&names).unwrap_or(false) {
            continue;
        }
        if above.heading.is_none() && !is_units(&cells) {
            above.heading = Some((line.number, cells));
            break;
        }
        if above.units.is_some() {
            break;
        }
        above.units = Some((line.number, cells));
    }
    // Units without names are names.
    if above.heading.is_none() {
        above.heading = above.units.take();
    }
    above
}

/// The lines above rows of which the last is no heading of theirs.
fn without_heading(
    last: &HeadLine,
    others: &[&HeadLine],
    comments: &[&HeadLine],
    marks: &Marks<'_>,
    rows: &Rows,
) -> Result<Above, Fault> {
    let got = Delimiter::from(rows.separator)
        .first_cells(&last.text)
        .len();
    if got > 1 && rows.separator != Separator::Blanks {
        return Err(Fault {
            line: Some(last.number),
            error: LayoutError::Width {
                got,
                reference: "first row",
                expected: rows.cells,
                way_out: "; if this is no heading, --heading-line 0 takes the rows to have none"
                    .to_owned(),
            },
        });
    }
    for line in others.iter().chain([&last]) {
        check_free(line, rows)?;
    }
    Ok(Above {
        preamble: others.len() + 1,
        ..commented(comments, marks, rows)
    })
}

/// Names of as many columns as rows have: cut as rows are, else by another separator, else with brackets
/// kept together.
fn names_in(line: &str, rows: &Rows) -> Option<Vec<String>> {
    let own = Delimiter::from(rows.separator);
    // Behind the last name cells may be empty, as of a column without a unit.
    let cells = own.cells_up_to(line, rows.cells);
    let owned = |cells: Vec<&str>| Some(cells.into_iter().map(str::to_owned).collect());
    if (rows.cells..=rows.cells_most).contains(&cells.len()) || is_but_for_comments(&cells, rows) {
        return owned(cells);
    }
    // Names of all columns but that of the rows' own names, as R and pandas write them.
    if rows.is_counted && cells.len() + 1 == rows.cells && is_heading(&cells).unwrap_or(false) {
        return owned(std::iter::once("").chain(cells).collect());
    }
    if rows.cells == 1 && rows.separator == Separator::Blanks {
        return owned(vec![line.trim()]);
    }
    let others = [
        Separator::Tab,
        Separator::Semicolon,
        Separator::Comma,
        Separator::Blanks,
    ];
    let by_other = others.into_iter().find_map(|separator| {
        let cells = Delimiter::from(separator).first_cells(line);
        (rows.cells > 1 && cells.len() == rows.cells).then_some(cells)
    });
    by_other
        .map(|cells| cells.into_iter().map(str::to_owned).collect())
        .or_else(|| {
            let cells = words_with_brackets(line);
            (rows.cells > 1 && cells.len() == rows.cells).then_some(cells)
        })
}

/// Names of a last column for comments, which rows leave out.
const COMMENTS: [&str; 6] = ["comment", "comments", "note", "notes", "remark", "remarks"];

/// Whether some names are as many as rows have cells and one of a last column for comments.
fn is_but_for_comments(names: &[&str], rows: &Rows) -> bool {
    let last = names.last().map(|name| name.to_lowercase());
    names.len() == rows.cells + 1
        && rows.separator != Separator::Blanks
        && last.is_some_and(|last| COMMENTS.contains(&last.as_str()))
}

/// Words between blanks, each with the brackets behind it.
fn words_with_brackets(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut depth = 0_usize;
    for word in line.split_whitespace() {
        let is_behind = depth > 0 || word.starts_with(['[', '(']);
        match words.last_mut() {
            Some(last) if is_behind => {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
        depth += word.matches(['[', '(']).count();
        depth = depth.saturating_sub(word.matches([']', ')']).count());
    }
    words
}

/// Whether cells are units: each a unit or nothing, one at least of time, rate, angle or counts.
fn is_units(cells: &[String]) -> bool {
    let mut units = cells
        .iter()
        .filter(|cell| !cell.is_empty())
        .map(|cell| spelled(cell));
    let known = units.clone().flatten();
    let mut telling = known.filter(|unit| *unit != Spelled::Other);
    telling.next().is_some() && units.all(|unit| unit.is_some())
}

/// Refuses a line above the heading that begins like a row.
fn check_free(line: &HeadLine, rows: &Rows) -> Result<(), Fault> {
    let cells = Delimiter::from(rows.separator).first_cells(&line.text);
    let first = [*cells.first().unwrap_or(&"")];
    match is_heading(&first) {
        Ok(true) => Ok(()),
        Ok(false) => Err(words_in_first_row(line, rows)),
        Err(error) => Err(Fault {
            line: Some(line.number),
            error: LayoutError::AbovePassable(error, line.number),
        }),
    }
}

/// A line above the rows that has numbers, and words where they have numbers.
fn words_in_first_row(line: &HeadLine, rows: &Rows) -> Fault {
    let cells = Delimiter::from(rows.separator).cells_up_to(&line.text, rows.cells);
    let mut cells = cells.iter().enumerate();
    let word = cells.find(|(_, cell)| !is_number(cell, rows.decimal));
    let (column, word) = word.map_or((1, String::new()), |(index, cell)| (index + 1, shown(cell)));
    Fault {
        line: Some(line.number + 1),
        error: LayoutError::WordInFirstRow {
            column,
            word,
            line: line.number,
        },
    }
}
