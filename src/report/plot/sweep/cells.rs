//! Values over several swept keys as cells, coloured by a scale.

use super::super::drawing::axis::Axis;
use super::super::drawing::panel::{LEFT, Legend, Panel, RIGHT};
use super::super::drawing::picture::{BLACK, Colour, PALE, Picture, text_width};
use super::super::drawing::series::{extent, index, real};
use super::keys::{SweptKey, TITLE_SIZE, fitting, is_log_span};
use super::names;
use super::sheet::{Channel, Layout, Sheet, lack};
use crate::gate::three_digits;
use crate::wording::{exact, to_digits};

/// Colours from low to high that rise evenly in lightness, for colour-blind readers as well (viridis,
/// van der Walt and Smith, 2015).
const SCALE: [Colour; 8] = [
    (0x44, 0x01, 0x54),
    (0x46, 0x32, 0x7e),
    (0x36, 0x5c, 0x8d),
    (0x27, 0x7f, 0x8e),
    (0x1f, 0xa1, 0x87),
    (0x4a, 0xc1, 0x6d),
    (0xa0, 0xda, 0x39),
    (0xfd, 0xe7, 0x25),
];
/// Classes below this one are dark.
const DARK_MAX: usize = 4;
const WHITE: Colour = (0xff, 0xff, 0xff);
/// Size of the values in the cells, and the room that they need around them, pixels.
const SIZE: f64 = 12.0;
const AROUND: f64 = 6.0;
/// Size of the label of a row, the least height of one, and the most room for it, pixels.
const LABEL_SIZE: f64 = 13.0;
const LABEL_HEIGHT: f64 = 17.0;
const LABEL_MAX: f64 = 320.0;
/// What stands left of the labels, and between them and the frame, pixels.
const TITLE: f64 = 34.0;
const GAP: f64 = 7.0;
/// How far the title of the rows may reach beyond their panel, and the most height that it asks for, pixels.
const BEYOND: f64 = 40.0;
const HEIGHT_MAX: f64 = 560.0;

/// Digits of the values: as many as tell the classes apart, three at least.
const DIGITS: std::ops::RangeInclusive<usize> = 3..=12;
/// Values that differ by no more than this part of them are the same but for rounding.
const ROUNDING: f64 = 1e-12;

/// The classes of a scale.
struct Classes {
    low: f64,
    high: f64,
    is_log: bool,
    digits: usize,
}

impl Classes {
    fn of(channel: &Channel) -> Self {
        let values = channel.values.iter().flatten().map(|it| it.value);
        let (low, high) = extent(values).unwrap_or((0.0, 1.0));
        let mut classes = Self {
            low,
            high,
            is_log: is_log_span((low, high)),
            digits: *DIGITS.start(),
        };
        let tells_apart = |classes: &Self| {
            let texts = (0..=SCALE.len()).map(|class| classes.text(classes.end(class)));
            let texts: Vec<String> = texts.collect();
            texts.windows(2).all(|pair| pair[0] != pair[1])
        };
        while !classes.are_one() && !tells_apart(&classes) && classes.digits < *DIGITS.end() {
            classes.digits += 1;
        }
        classes
    }

    /// Whether all values are the same: they have one colour then.
    fn are_one(&self) -> bool {
        self.high - self.low <= ROUNDING * self.high.abs().max(self.low.abs())
    }

    /// A value in as many digits as tell the classes apart.
    fn text(&self, value: f64) -> String {
        if self.digits == *DIGITS.start() {
            three_digits(value)
        } else {
            exact(to_digits(value, self.digits))
        }
    }

    /// Lower end of a class.
    fn end(&self, class: usize) -> f64 {
        let part = real(class) / real(SCALE.len());
        if self.is_log {
            self.low * (self.high / self.low).powf(part)
        } else {
            self.low + (self.high - self.low) * part
        }
    }

    fn class(&self, value: f64) -> usize {
        if self.are_one() {
            return SCALE.len() / 2;
        }
        let part = if self.is_log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        index(part * real(SCALE.len())).min(SCALE.len() - 1)
    }
}

/// The panel of a channel: a cell for each point, the key along and the settings of the others upwards.
pub(super) fn draw(
    picture: &mut Picture,
    frame: (f64, f64),
    (sheet, channel): (&Sheet, &Channel),
    plan: &Layout,
) {
    let height = frame.1 - frame.0;
    let (rows, y, row_of) = match plan.others[..] {
        [other] => {
            let (edges, axis) = edges(other, height + BEYOND, RIGHT - LEFT);
            (edges, axis, other.value_of.clone())
        }
        _ => settings_axis(plan, height),
    };
    let left = LEFT.max(TITLE + widest(&y) + GAP);
    let (columns, mut x) = edges(plan.along, RIGHT - left, RIGHT - left);
    if !plan.along.is_number {
        x.ticks = fitting(x.ticks);
    }
    let panel = Panel::from_left(picture, left, frame, (x, y));
    let classes = Classes::of(channel);
    let mut grid = vec![vec![None; columns.len() - 1]; rows.len() - 1];
    for (point, value) in channel.values.iter().enumerate() {
        if let Some(value) = value {
            grid[row_of[point]][plan.along.value_of[point]] = Some(value.value);
        }
    }
    for (row, values) in grid.iter().enumerate() {
        let class = |column: usize| values[column].map(|value| classes.class(value));
        let mut start = 0;
        // Neighbours of one colour are one area: a picture of ten thousand points stays small.
        for column in 0..values.len() {
            if column + 1 < values.len() && class(column + 1) == class(start) {
                continue;
            }
            let corners = [
                panel.place((columns[start], rows[row])),
                panel.place((columns[column + 1], rows[row + 1])),
            ];
            let colour = class(start).map_or(PALE, |class| SCALE[class]);
            let [(left, bottom), (right, top)] = corners;
            let area = vec![(left, top), (right, top), (right, bottom), (left, bottom)];
            picture.area(area, colour, 1.0);
            start = column + 1;
        }
    }
    panel.outline(picture);
    write_values(picture, &panel, (&columns, &rows), (&grid, &classes));
    explain(picture, frame.0, (sheet, channel), &classes);
}

/// Height of a panel whose rows are named in full, as far as it may be that high.
pub(super) fn height(plan: &Layout) -> f64 {
    let title = rows_title(plan, |key| &key.short);
    (text_width(&title, TITLE_SIZE) - BEYOND).min(HEIGHT_MAX)
}

/// Width of the widest label of an axis.
fn widest(axis: &Axis) -> f64 {
    let widths = axis.ticks.iter();
    let widths = widths.map(|(_, label)| text_width(label, LABEL_SIZE));
    widths.fold(0.0, f64::max)
}

/// Edges of the cells of a key, and its axis, with room for its title and along it, pixels.
fn edges(key: &SweptKey, room: f64, length: f64) -> (Vec<f64>, Axis) {
    let (is_log, title) = (key.is_log(), key.title_within(room));
    let to = |value: f64| if is_log { value.ln() } else { value };
    let back = |value: f64| if is_log { value.exp() } else { value };
    let places: Vec<f64> = key.places.iter().map(|place| to(*place)).collect();
    let half = |at: usize| match places[..] {
        [] | [_] => 0.5,
        _ => 0.5 * (places[at.max(1)] - places[at.max(1) - 1]),
    };
    let last = places.len() - 1;
    let mut edges = vec![back(places[0] - half(0))];
    edges.extend(
        places
            .windows(2)
            .map(|pair| back(0.5 * (pair[0] + pair[1]))),
    );
    edges.push(back(places[last] + half(last)));
    let range = (edges[0], edges[edges.len() - 1]);
    let mut axis = if is_log {
        Axis::log(range, 0.0, &title)
    } else {
        Axis::linear(range, 0.0, &title)
    };
    let labels = key.places.iter().copied().zip(key.labels.iter().cloned());
    let labels: Vec<(f64, String)> = labels.collect();
    if key.is_number {
        axis = axis.labelled_at(&labels, length);
    } else {
        axis.ticks = labels;
    }
    axis.minor.clear();
    (edges, axis)
}

/// Names of the keys whose settings are the rows.
fn rows_title(plan: &Layout, name: fn(&SweptKey) -> &str) -> String {
    let names = plan.others.iter().map(|key| name(key));
    names.collect::<Vec<_>>().join(", ")
}

/// Rows for the settings of several keys: edges, axis and the row of every point.
fn settings_axis(plan: &Layout, height: f64) -> (Vec<f64>, Axis, Vec<usize>) {
    let count = plan.settings.len();
    let titles = [
        rows_title(plan, |key| &key.name),
        rows_title(plan, |key| &key.short),
    ];
    let title = names::fitting(&titles, TITLE_SIZE, height + BEYOND);
    let mut axis = Axis::linear((-0.5, real(count) - 0.5), 0.0, &title);
    let most = index(height / LABEL_HEIGHT).max(1);
    // The axis names the keys: their values alone say which.
    let labels = row_labels(&plan.values).into_iter().enumerate();
    let labels = labels.step_by(count.div_ceil(most).max(1));
    axis.ticks = labels.map(|(row, label)| (real(row), label)).collect();
    let edges = (0..=count).map(|edge| real(edge) - 0.5).collect();
    (edges, axis, plan.setting_of.clone())
}

/// Labels of rows: with one that is too long all have their number before them, so that those that are cut
/// still differ.
fn row_labels(texts: &[String]) -> Vec<String> {
    let fits = |text: &String| text_width(text, LABEL_SIZE) <= LABEL_MAX;
    if texts.iter().all(fits) {
        return texts.to_vec();
    }
    let numbered = texts.iter().enumerate();
    numbered
        .map(|(row, text)| names::start(&format!("{}: {text}", row + 1), LABEL_SIZE, LABEL_MAX))
        .collect()
}

/// The values in their cells, where every one has room.
fn write_values(
    picture: &mut Picture,
    panel: &Panel,
    (columns, rows): (&[f64], &[f64]),
    (grid, classes): (&[Vec<Option<f64>>], &Classes),
) {
    let mut texts = Vec::new();
    for (row, values) in grid.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            let Some(value) = value else { continue };
            let (left, bottom) = panel.place((columns[column], rows[row]));
            let (right, top) = panel.place((columns[column + 1], rows[row + 1]));
            let text = classes.text(*value);
            let has_room = right - left >= text_width(&text, SIZE) + AROUND
                && (bottom - top).abs() >= SIZE + AROUND;
            if !has_room {
                return;
            }
            let colour = if classes.class(*value) < DARK_MAX {
                WHITE
            } else {
                BLACK
            };
            texts.push(((0.5 * (left + right), 0.5 * (top + bottom)), text, colour));
        }
    }
    for (at, text, colour) in texts {
        picture.centred_text(at, &text, SIZE, colour);
    }
}

/// What the colours mean.
fn explain(
    picture: &mut Picture,
    top: f64,
    (sheet, channel): (&Sheet, &Channel),
    classes: &Classes,
) {
    let mut legend = Legend::new(top);
    legend.text(picture, &format!("{}: {}", channel.name, sheet.title));
    if classes.are_one() {
        let text = format!("{} everywhere", classes.text(classes.low));
        legend.area(picture, (SCALE[classes.class(classes.low)], 1.0), &text);
    } else {
        for class in (0..SCALE.len()).rev() {
            let [low, high] = [class, class + 1].map(|end| classes.text(classes.end(end)));
            legend.area(picture, (SCALE[class], 1.0), &format!("{low} to {high}"));
        }
    }
    if let Some(lack) = lack(channel) {
        legend.area(picture, (PALE, 1.0), &lack);
    }
    legend.text(picture, "intervals: in metrics.csv");
}
