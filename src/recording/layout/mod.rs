//! How the lines of a text hold a table: found from its first lines, or given.
//!
//! ```text
//!  first lines ──> find: separator, decimal sign, width, first row ──> heading: names, units, preamble
//!                                                                       └──> columns: which is what,
//!                                                                            times: which is the time
//! ```
//!
//! Invariant: nothing is passed over in silence. A line above the rows is a comment, a heading, a row of
//! units or free text, and what it was taken for is said; what could be two things is an error that names
//! the option by which it is said.

mod cells;
pub(super) mod columns;
mod error;
mod explain;
mod find;
mod heading;
mod times;
pub(super) mod words;

pub(super) use cells::{finite_in, is_number, plain_spelling};
pub(super) use error::{Asked, Fault, LayoutError};
pub(super) use find::{find, last_line_above};
pub(super) use heading::HeadLine;

use crate::recording::text::lines::Delimiter;
use crate::recording::unit::spelling::{Spelled, unit_of_heading};
use words::{DecimalSign, Encoding, Separator};

/// How a text holds a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    pub(super) encoding: Encoding,
    /// Lines at its start that were passed over because that was asked for.
    pub(super) skip_lines: usize,
    /// Lines of free text above the heading or the first row.
    pub(super) preamble: usize,
    /// Marks of lines that are passed over.
    pub(super) marks: Vec<String>,
    /// Comments above the first row.
    pub(super) comments: usize,
    /// Line of the heading, from 1.
    pub(super) heading_line: Option<usize>,
    /// Line of the units, from 1.
    pub(super) units_line: Option<usize>,
    /// Line of the first row, from 1.
    pub(super) first_row_line: usize,
    pub(super) separator: Separator,
    pub(super) decimal: DecimalSign,
    /// Cells of a row.
    pub(super) cells: usize,
    /// Fewest cells of a row: the last columns may be empty, as one for comments.
    pub(super) cells_least: usize,
    /// Names of the columns; empty without a heading.
    pub(super) names: Vec<String>,
    /// What the row of units says of each column; empty without one.
    pub(super) units: Vec<String>,
    /// Columns of a record whose values are read row by row.
    pub(super) wrapped: Option<usize>,
    /// The first row, if it may be one number with a decimal comma.
    pub(super) decimal_comma: Option<String>,
}

impl From<Separator> for Delimiter {
    fn from(separator: Separator) -> Self {
        match separator {
            Separator::Comma => Self::Character(','),
            Separator::Semicolon => Self::Character(';'),
            Separator::Tab => Self::Character('\t'),
            Separator::Blanks => Self::Blanks,
        }
    }
}

impl Layout {
    /// That of an array of so many columns, which has no heading.
    pub(super) fn of_array(columns: usize) -> Self {
        Self {
            encoding: Encoding::Utf8,
            skip_lines: 0,
            preamble: 0,
            marks: Vec::new(),
            comments: 0,
            heading_line: None,
            units_line: None,
            first_row_line: 0,
            separator: Separator::Blanks,
            decimal: DecimalSign::Point,
            cells: columns,
            cells_least: columns,
            names: Vec::new(),
            units: Vec::new(),
            wrapped: None,
            decimal_comma: None,
        }
    }

    /// That of arrays, or of fields of their records, under names, with what is said of their units.
    pub(super) fn of_fields(names: Vec<String>, units: Vec<String>) -> Self {
        Self {
            units,
            cells: names.len(),
            cells_least: names.len(),
            names,
            ..Self::of_array(0)
        }
    }

    /// Quantities of a record.
    pub(super) fn width(&self) -> usize {
        self.wrapped.unwrap_or(self.cells)
    }

    pub(super) fn delimiter(&self) -> Delimiter {
        self.separator.into()
    }

    /// What a complaint about a cell that is no number says of a separator that would cut it, if one would.
    pub(super) fn other_cut(&self, cell: &str) -> String {
        let is_word = cell.contains(|it: char| it.is_alphabetic() && !matches!(it, 'e' | 'E'));
        let cuts = |other: &Separator| match Delimiter::from(*other) {
            Delimiter::Character(',') if self.decimal == DecimalSign::Comma => false,
            Delimiter::Character(character) => cell.contains(character),
            Delimiter::Blanks => false,
        };
        let mut others = cells::CHARACTERS.into_iter().filter(|_| !is_word);
        let other = others.find(|other| *other != self.separator && cuts(other));
        other.map_or_else(String::new, |other| {
            let own = self.separator;
            format!("; cells were cut by --separator {own}: --separator {other} cuts this one too")
        })
    }

    /// Whether a line, without blanks around it, is a comment.
    pub(super) fn is_comment(&self, text: &str) -> bool {
        // Most lines are rows, and begin as numbers do.
        if text.starts_with(|first: char| matches!(first, '0'..='9' | '-' | '+' | '.')) {
            return false;
        }
        let mut marks = self.marks.iter();
        marks.any(|mark| crate::recording::text::lines::is_comment(text, &[mark]))
    }

    /// Name of a column; its number where there is no heading but several columns.
    pub(super) fn name(&self, index: usize) -> Option<String> {
        let name = self.names.get(index).filter(|name| !name.is_empty());
        name.cloned()
            .or_else(|| (self.width() > 1).then(|| (index + 1).to_string()))
    }

    /// What the row of units, or the heading, says of the numbers of a column.
    pub(super) fn unit(&self, index: usize) -> Option<Spelled> {
        let below = self
            .units
            .get(index)
            .and_then(|unit| crate::recording::unit::spelling::spelled(unit));
        below.or_else(|| unit_of_heading(self.names.get(index)?))
    }
}
