//! What the first rows of a text say of its columns.

use super::lines::is_missing;
use super::table::Wanted;
use crate::recording::layout::columns::{Chosen, choose};
use crate::recording::layout::{HeadLine, Layout, LayoutError, is_number};

/// Rows by which columns are told apart.
const SAMPLE_ROWS: usize = 50;

/// Heading and row of units as they stand there, unless they could be samples.
pub(super) fn heads(layout: &Layout, head: &[HeadLine]) -> Vec<String> {
    let are_words = |text: &str| {
        let cells = layout.delimiter().cells(text);
        let is_word = |cell: &str| !is_number(cell, layout.decimal) && !is_missing(cell);
        cells.into_iter().any(is_word)
    };
    let lines = [layout.heading_line, layout.units_line];
    head.iter()
        .filter(|line| lines.contains(&Some(line.number)))
        .map(|line| line.text.trim().to_owned())
        .filter(|text| are_words(text))
        .collect()
}

/// The columns to read, by the names of the layout and its first rows.
pub(super) fn chosen(
    layout: &Layout,
    head: &[HeadLine],
    heads: &[String],
    wanted: &Wanted<'_>,
) -> Result<Chosen, LayoutError> {
    let rows = head.iter().filter(|line| {
        let text = line.text.trim();
        let is_row = !layout.is_comment(text) && heads.iter().all(|head| head != text);
        line.number >= layout.first_row_line && is_row
    });
    let cells = rows.take(SAMPLE_ROWS).flat_map(|line| {
        let cells = layout.delimiter().cells_up_to(&line.text, layout.cells);
        cells.into_iter().map(str::to_owned).collect::<Vec<_>>()
    });
    let cells: Vec<String> = cells.collect();
    let records: Vec<Vec<String>> = match layout.wrapped {
        Some(columns) => cells
            .chunks_exact(columns)
            .map(<[String]>::to_vec)
            .collect(),
        None => cells
            .chunks_exact(layout.cells.max(1))
            .map(<[String]>::to_vec)
            .collect(),
    };
    choose(
        layout,
        wanted.format,
        &records,
        &wanted.columns,
        wanted.needs_time,
    )
}
