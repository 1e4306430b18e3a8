//! What the first rows of a text say of its columns.

use super::lines::is_missing;
use super::table::Wanted;
use crate::recording::layout::columns::{Chosen, choose};
use crate::recording::layout::{HeadLine, Layout, LayoutError, is_number};

/// Rows by which columns are told apart.
const SAMPLE_ROWS: usize = 50;

/// Cells of the heading and of the row of units, unless they could be samples.
#[derive(Clone, Debug)]
pub(super) struct Heads(Vec<Vec<String>>);

impl Heads {
    pub(super) fn of(layout: &Layout, head: &[HeadLine]) -> Self {
        let is_word = |cell: &&str| !is_number(cell, layout.decimal) && !is_missing(cell);
        let lines = [layout.heading_line, layout.units_line];
        let lines = head
            .iter()
            .filter(|line| lines.contains(&Some(line.number)));
        let cells = lines.map(|line| layout.delimiter().first_cells(&line.text));
        let cells = cells.filter(|cells| cells.iter().any(is_word));
        Self(
            cells
                .map(|cells| cells.into_iter().map(str::to_owned).collect())
                .collect(),
        )
    }

    /// Whether a line is one of them again, whatever blanks, quotation marks and empty cells stand about its cells.
    pub(super) fn hold(&self, layout: &Layout, text: &str) -> bool {
        let begin = text.trim_start().trim_start_matches('"').trim_start();
        let is_again = |head: &Vec<String>| {
            // Most lines begin otherwise, and need not be cut.
            head.first().is_some_and(|first| begin.starts_with(first))
                && layout.delimiter().cells_up_to(text, head.len()) == *head
        };
        self.0.iter().any(is_again)
    }
}

/// The columns to read, by the names of the layout and its first rows.
pub(super) fn chosen(
    layout: &Layout,
    head: &[HeadLine],
    heads: &Heads,
    wanted: &Wanted<'_>,
) -> Result<Chosen, LayoutError> {
    let rows = head.iter().filter(|line| {
        let text = line.text.trim();
        let is_row = !layout.is_comment(text) && !heads.hold(layout, text);
        line.number >= layout.first_row_line && is_row
    });
    let cut = rows.take(SAMPLE_ROWS).map(|line| {
        let cells = layout.delimiter().cells_up_to(&line.text, layout.cells);
        cells.into_iter().map(str::to_owned).collect::<Vec<_>>()
    });
    let mut records: Vec<Vec<String>> = cut.collect();
    match layout.wrapped {
        Some(columns) => {
            let cells = records.concat();
            records = cells
                .chunks_exact(columns)
                .map(<[String]>::to_vec)
                .collect();
        }
        // What a row leaves out at its end is empty.
        None => {
            for record in &mut records {
                record.resize(layout.cells, String::new());
            }
        }
    }
    choose(
        layout,
        wanted.format,
        &records,
        &wanted.columns,
        wanted.needs_time,
    )
}
