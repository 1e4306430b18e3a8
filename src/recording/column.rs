//! Columns of numbers as a file holds them, before their unit is applied.

use super::error::Place;

/// Numbers with the name of their column.
#[derive(Clone, Debug, Default)]
pub(crate) struct Column {
    /// Name in the heading, or what it was asked for by.
    pub(crate) name: Option<String>,
    /// Values, finite.
    pub(crate) values: Vec<f64>,
}

/// The columns read from one file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    /// Rates, angles and what else was asked for, in that order; all of one length.
    pub(crate) data: Vec<Column>,
    /// The time, where it was asked for.
    pub(crate) time: Option<Column>,
    /// Where each row stands; rows of an array stand at their index.
    pub(crate) lines: Option<Vec<usize>>,
}

impl Columns {
    /// Where row `row` stands in the file.
    pub(crate) fn place(&self, row: usize) -> Place {
        match self.lines.as_ref().and_then(|lines| lines.get(row)) {
            Some(line) => Place::Line(*line),
            None => Place::Index(row),
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.data.first().map_or(0, |column| column.values.len())
    }
}
