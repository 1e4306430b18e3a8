//! What is wrong with a table, or doubtful.

use crate::recording::text::lines::FirstLineError;

/// A complaint about a line.
#[derive(Debug)]
pub(in crate::recording) struct Fault {
    /// The line, from 1; none if the file as a whole is meant.
    pub(in crate::recording) line: Option<usize>,
    pub(in crate::recording) error: LayoutError,
}

/// What is wrong with the first lines of a text, with what is asked of it, or with the cells of a row.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum LayoutError {
    #[error(transparent)]
    FirstLine(#[from] FirstLineError),
    #[error("{0}; --skip-lines {1} passes over it and what stands above")]
    AbovePassable(FirstLineError, usize),
    #[error("{count} columns are named `{wanted}`: name one by its number, from 1")]
    Ambiguous { wanted: String, count: usize },
    /// With their names.
    #[error(
        "{count} columns have `{wanted}` in their names, {listed}: name one of them, or `*` where letters \
         may stand for all"
    )]
    AmbiguousPart {
        wanted: String,
        count: usize,
        listed: String,
    },
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
    /// With their names.
    #[error("{0} may all be the time: name one with --time, or `--time none`")]
    SeveralTimes(String),
    #[error("--time-unit names {units} units of {columns} columns of --time: expected one of each")]
    TimeUnits { units: usize, columns: usize },
    #[error("{got} cells where the {reference} has {expected}{way_out}")]
    Width {
        got: usize,
        reference: &'static str,
        expected: usize,
        way_out: &'static str,
    },
    #[error(
        "column {column} has a number where the first row has `{word}`: expected a heading without \
         numbers, or a first row like this one; --heading-line {line} takes it for the heading, \
         --skip-lines {line} passes over it"
    )]
    WordInFirstRow {
        column: usize,
        word: String,
        line: usize,
    },
    #[error(
        "`{0}` has a decimal comma, or one between thousands: say --decimal comma, or write it without"
    )]
    Thousands(String),
    #[error("the file ends before line {line}, which {option} names")]
    NoLine { line: usize, option: &'static str },
    #[error("{got} in line {line}, which an option names, where the rows have {expected} cells")]
    Heading {
        line: usize,
        got: String,
        expected: usize,
    },
    #[error("no row stands below line {0}, which --heading-line or --units-line names")]
    NoRowBelow(usize),
    #[error(
        "the file ends within a record: {got} of {expected} values, which --wrapped-columns names"
    )]
    WrappedEnd { got: usize, expected: usize },
}
