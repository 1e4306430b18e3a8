//! A table over several scenarios as a picture: intervals beside published figures.

use super::drawing::axis::Axis;
use super::drawing::panel::{LEFT, Legend, Panel, RIGHT, WIDTH};
use super::drawing::picture::{Anchor, GREY, Picture, Shape, Stroke, text_width};
use super::drawing::series::{extent, real, stroke_of};
use crate::comparison::{ComparedCell, ComparedColumn, ComparedTable};
use crate::report::layout::text::with_unit;
use crate::report::record::columns::{heading_of, unit_text};

/// Height of one panel with its titles, pixels.
const PANEL: f64 = 300.0;
/// Part of a row's room over which its columns are spread.
const SPREAD: f64 = 0.6;
/// Distance of a published figure from the simulated one, so that neither hides the other.
const BESIDE: f64 = 0.05;

/// One panel for each metric and for its ratios: rows along, a colour for each column.
pub(super) fn picture(table: &ComparedTable) -> Picture {
    let panels = panels(table);
    let mut picture = Picture::new(WIDTH, 60.0 + PANEL * real(panels.len().max(1)));
    let heading = format!("{}: {}", table.name, table.title);
    picture.heading((90.0, 28.0), &heading, 18.0);
    for (index, columns) in panels.iter().enumerate() {
        let top = 56.0 + PANEL * real(index);
        panel(&mut picture, table, columns, top);
    }
    picture
}

/// Columns that share a unit and a metric stand in one panel.
fn panels(table: &ComparedTable) -> Vec<Vec<usize>> {
    let mut panels = Vec::new();
    for (_, columns) in table.metrics() {
        let is_ratio = |column: &usize| table.columns[*column].relative_to.is_some();
        let (ratios, values): (Vec<usize>, Vec<usize>) = columns.into_iter().partition(is_ratio);
        panels.extend(
            [values, ratios]
                .into_iter()
                .filter(|columns| !columns.is_empty()),
        );
    }
    panels
}

/// Number of a column's channel among the channels of the table: one colour in every panel.
fn ordinal(table: &ComparedTable, column: usize) -> usize {
    // Grey stands for raw in every picture.
    let mut seen = vec!["raw".to_owned()];
    for channels in table.columns.iter().map(ComparedColumn::channels) {
        if !seen.contains(&channels) {
            seen.push(channels);
        }
    }
    let own = table.columns[column].channels();
    let mut places = seen.iter();
    places.position(|name| *name == own).unwrap_or(0)
}

fn panel(picture: &mut Picture, table: &ComparedTable, columns: &[usize], top: f64) {
    let cells = || {
        let rows = table.rows.iter();
        rows.flat_map(|row| {
            columns
                .iter()
                .filter_map(|column| row.cells[*column].as_ref())
        })
    };
    let ends = |cell: &ComparedCell| {
        let estimate = cell.simulated.estimate;
        let published = cell.published.as_ref().map(|(value, _)| *value);
        [
            Some(estimate.value),
            Some(estimate.low),
            Some(estimate.high),
            published,
        ]
    };
    let Some(range) = extent(cells().flat_map(ends).flatten()) else {
        return;
    };
    let count = table.rows.len();
    // The labels are written below: an axis has one line for them.
    let labels = labels(table);
    let mut x = Axis::linear((-0.5, real(count) - 0.5), 0.0, "");
    x.ticks.clear();
    x.minor = labels.iter().map(|(place, _)| *place).collect();
    let y = Axis::linear(range, 0.08, &title(table, columns[0]));
    let bottom = top + PANEL - 62.0;
    let panel = Panel::new(picture, (top, bottom), x, y);
    write_labels(picture, bottom, &panel, &labels);
    let mut legend = Legend::new(top);
    let mut has_published = false;
    for (place, column) in columns.iter().enumerate() {
        let stroke = Stroke {
            dash: super::drawing::picture::Dash::Solid,
            ..stroke_of(ordinal(table, *column))
        };
        let part = (real(place) + 0.5) / real(columns.len()) - 0.5;
        for (index, row) in table.rows.iter().enumerate() {
            let Some(cell) = &row.cells[*column] else {
                continue;
            };
            let at = real(index) + SPREAD * part;
            let estimate = cell.simulated.estimate;
            panel.line(picture, &[(at, estimate.low), (at, estimate.high)], stroke);
            panel.marker(picture, (at, estimate.value), Shape::Circle, stroke.colour);
            if let Some((value, _)) = &cell.published {
                has_published = true;
                let beside = at + BESIDE;
                panel.marker(picture, (beside, *value), Shape::Square, stroke.colour);
            }
        }
        let name = table.columns[*column].channels();
        legend.marker(picture, (Shape::Circle, stroke.colour), &name);
    }
    if has_published {
        let text = "published, in the colour of its column";
        legend.marker(picture, (Shape::Square, GREY), text);
    }
    let is_open = |cell: &ComparedCell| {
        let estimate = cell.simulated.estimate;
        estimate.low < estimate.high
    };
    if cells().any(is_open) {
        legend.text(picture, "bars: 95 % interval");
    }
}

/// Places and labels of the rows.
fn labels(table: &ComparedTable) -> Vec<(f64, String)> {
    let rows = table.rows.iter().enumerate();
    rows.map(|(index, row)| {
        let mark = if row.is_base { " (as read)" } else { "" };
        // What the points of a sweep have in common, the title says.
        let label = row.label.rsplit(": ").next().unwrap_or(&row.label);
        (real(index), format!("{label}{mark}"))
    })
    .collect()
}

/// Metric and unit of a column.
fn title(table: &ComparedTable, column: usize) -> String {
    let definition = &table.columns[column];
    let unit = table.sample(column).map_or_else(String::new, unit_text);
    let ratio = if definition.relative_to.is_some() {
        ", ratio"
    } else {
        ""
    };
    with_unit(&format!("{}{ratio}", heading_of(&definition.metric)), &unit)
}

/// Labels of the rows below a frame, in as many lines as each needs so that none meets its neighbours.
fn write_labels(picture: &mut Picture, bottom: f64, panel: &Panel, labels: &[(f64, String)]) {
    const SIZE: f64 = 12.0;
    const LINES_MAX: usize = 3;
    let room = (RIGHT - LEFT) / real(labels.len().max(1)) - 8.0;
    for (place, label) in labels {
        let x = panel.place((*place, 1.0)).0;
        for (index, line) in wrapped(label, SIZE, room, LINES_MAX).iter().enumerate() {
            let at = (x, bottom + 14.0 + (SIZE + 2.0) * real(index));
            picture.text(at, line, SIZE, Anchor::Middle);
        }
    }
}

/// A text in lines of at most a width, pixels, the last of them cut short where it is too long.
fn wrapped(text: &str, size: f64, width: f64, lines_max: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer {
            Some(longer) if text_width(&longer, size) <= width => {
                lines.pop();
                lines.push(longer);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    if lines.len() > lines_max {
        let rest = lines.split_off(lines_max - 1).join(" ");
        lines.push(rest);
    }
    for line in &mut lines {
        if text_width(line, size) > width {
            while !line.is_empty() && text_width(line, size) > width - size {
                line.pop();
            }
            line.push('\u{2026}');
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_side_by_side_stay_within_their_room() {
        let lines = wrapped("5 Hz, 1 deg/s (as read)", 12.0, 70.0, 3);
        assert!(
            lines.len() > 1 && lines.join(" ") == "5 Hz, 1 deg/s (as read)",
            "{lines:?}"
        );
        for text in [
            "one-word-that-is-far-too-long",
            "a b c d e f g h i j k l m n o p q r s t",
        ] {
            let lines = wrapped(text, 12.0, 40.0, 3);
            assert!(lines.len() <= 3 && lines.iter().all(|line| text_width(line, 12.0) <= 40.0));
        }
    }
}
