//! The files of a suite's tables: CSV and SVG beside the suite's summary.

use crate::comparison::{ComparedTable, Comparison, file_stem};
use crate::report::layout::csv::push_row;
use crate::report::plot::comparison_svg;
use crate::scenario::ComparisonKind;

/// Name and text of every file: `published-<table>.csv` and `.svg`, `sensitivity-<table>.…`;
/// a picture that would be too large is left out, as the CSV holds all of it.
#[must_use]
pub fn comparison_files(across: &Comparison) -> Vec<(String, String)> {
    let files = across.tables.iter().flat_map(|table| {
        let [csv_name, svg_name] = comparison_file_names(table.kind, &table.slug);
        let svg = comparison_svg(table).map(|svg| (svg_name, svg));
        std::iter::once((csv_name, csv(table))).chain(svg)
    });
    files.collect()
}

/// Names of the files of a table.
#[must_use]
pub fn comparison_file_names(kind: ComparisonKind, slug: &str) -> [String; 2] {
    let stem = file_stem(kind, slug);
    [format!("{stem}.csv"), format!("{stem}.svg")]
}

fn csv(table: &ComparedTable) -> String {
    let mut text =
        String::from("row,base,metric,unit,published,value,low,high,confidence,folder\n");
    for row in &table.rows {
        for (cell, column) in row.cells.iter().zip(&table.columns) {
            let Some(cell) = cell else {
                continue;
            };
            let estimate = cell.simulated.estimate;
            let published = cell.published.as_ref();
            let fields = [
                row.label.clone(),
                row.is_base.to_string(),
                column.text(),
                cell.simulated.unit.to_owned(),
                published.map_or_else(String::new, |(value, _)| value.to_string()),
                estimate.value.to_string(),
                estimate.low.to_string(),
                estimate.high.to_string(),
                estimate.confidence.to_string(),
                cell.folder.clone(),
            ];
            push_row(&mut text, fields);
        }
    }
    for (column, change) in table.changes() {
        let fields = [
            table.change_heading().unwrap_or_default(),
            false.to_string(),
            column.text(),
            change.unit.clone(),
            String::new(),
            change.estimate.value.to_string(),
            change.estimate.low.to_string(),
            change.estimate.high.to_string(),
            change.estimate.confidence.to_string(),
            change.folder.clone(),
        ];
        push_row(&mut text, fields);
    }
    text
}
