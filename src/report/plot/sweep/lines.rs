//! Values over a swept key as lines with intervals.

use super::super::drawing::panel::{Legend, NAME_ROOM, NAME_SIZE, Panel};
use super::super::drawing::picture::{Dash, Picture, Stroke, text_width};
use super::super::drawing::series::{SIDE_BY_SIDE, real, shape_of, stroke_of};
use super::keys::TITLE_SIZE;
use super::names;
use super::sheet::{Channel, Layout, Sheet, lack};
use crate::metrics::Estimate;

/// Most points of a line that have markers and intervals: more would be a band of ink.
const MARKED_MAX: usize = 60;
/// Part of the room between two values over which what stands at each is spread, and the most between
/// neighbours, pixels: lines that coincide then lie side by side.
const SPREAD: f64 = 0.5;
const BESIDE: f64 = 8.0;

/// How far the title of an axis may reach beyond its panel, pixels.
const BEYOND: f64 = 40.0;
/// Most lines that the name of a setting takes in the legend.
const LINES: f64 = 1.8;

/// A line of a panel.
struct Line<'a> {
    /// Number of its colour.
    index: usize,
    name: &'a str,
    /// Place and value of every point of it, in the order of the places.
    points: Vec<(f64, Option<Estimate>)>,
}

/// One panel with a line for each channel.
pub(super) fn channels(picture: &mut Picture, frame: (f64, f64), sheet: &Sheet, plan: &Layout) {
    let y = sheet.axis(sheet.channels.iter(), &sheet.title);
    let panel = Panel::new(picture, frame, plan.along.axis(), y);
    let mut legend = Legend::new(frame.0);
    let lines: Vec<Line> = sheet
        .channels
        .iter()
        .map(|channel| Line {
            index: channel.index,
            name: &channel.name,
            points: points(channel, plan, |_| true),
        })
        .collect();
    for (place, line) in lines.iter().enumerate() {
        let aside = beside(plan, &panel, &lines, place);
        draw(picture, &panel, line, aside, plan);
    }
    for (line, channel) in lines.iter().zip(&sheet.channels) {
        name(picture, &mut legend, line, plan);
        if let Some(lack) = lack(channel) {
            legend.detail(picture, &lack);
        }
    }
    explain(picture, &mut legend, &lines);
}

/// The panel of a channel with a line for each setting of the other keys.
pub(super) fn settings(
    picture: &mut Picture,
    frame: (f64, f64),
    (sheet, channel): (&Sheet, &Channel),
    plan: &Layout,
) {
    let title = format!("{}: {}", channel.name, sheet.title);
    let room = frame.1 - frame.0 + BEYOND;
    let is_named = text_width(&title, TITLE_SIZE) <= room;
    let title = names::fitting(&[title, sheet.title.clone()], TITLE_SIZE, room);
    let y = sheet.axis(std::iter::once(channel), &title);
    let panel = Panel::new(picture, frame, plan.along.axis(), y);
    let mut legend = Legend::new(frame.0);
    if !is_named {
        legend.text(picture, &channel.name);
    }
    let headings = keys_heading(plan);
    for heading in &headings {
        legend.text(picture, heading);
    }
    let names = if headings.is_empty() {
        &plan.settings
    } else {
        &plan.values
    };
    let lines: Vec<Line> = names
        .iter()
        .enumerate()
        .map(|(index, name)| Line {
            // Grey stands for raw.
            index: index + 1,
            name,
            points: points(channel, plan, |point| plan.setting_of[point] == index),
        })
        .collect();
    for (place, line) in lines.iter().enumerate() {
        let aside = beside(plan, &panel, &lines, place);
        draw(picture, &panel, line, aside, plan);
    }
    for line in &lines {
        name(picture, &mut legend, line, plan);
    }
    if let Some(lack) = lack(channel) {
        legend.text(picture, &lack);
    }
    explain(picture, &mut legend, &lines);
}

/// Names of the keys above the lines, where name and value of each have no room beside a line: the lines then
/// have the values alone.
fn keys_heading(plan: &Layout) -> Vec<String> {
    let width = |text: &str| text_width(text, NAME_SIZE);
    let is_wide = |text: &String| {
        let mut settings = text.split(", ");
        settings.any(|setting| width(setting) > NAME_ROOM) || width(text) > LINES * NAME_ROOM
    };
    if !plan.settings.iter().any(is_wide) {
        return Vec::new();
    }
    let names = plan.others.iter();
    let names =
        names.map(|key| names::fitting(std::slice::from_ref(&key.short), NAME_SIZE, NAME_ROOM));
    names.collect()
}

/// The chosen points of a channel, in the order of their places.
fn points(
    channel: &Channel,
    plan: &Layout,
    is_chosen: impl Fn(usize) -> bool,
) -> Vec<(f64, Option<Estimate>)> {
    let values = channel.values.iter().enumerate();
    let chosen = values.filter(|(point, _)| is_chosen(*point));
    let mut points: Vec<(f64, Option<Estimate>)> = chosen
        .map(|(point, value)| (plan.along.place(point), *value))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// How far beside its place the line `place` of `count` stands, pixels; without markers nothing would show
/// that it does.
fn beside(plan: &Layout, panel: &Panel, lines: &[Line], place: usize) -> f64 {
    if !lines.iter().all(is_marked) {
        return 0.0;
    }
    let places = plan.along.places.iter();
    let pixels: Vec<f64> = places.map(|x| panel.place((*x, 1.0)).0).collect();
    let gaps = pixels.windows(2).map(|pair| pair[1] - pair[0]);
    let room = SPREAD * gaps.fold(f64::INFINITY, f64::min);
    let step = (room / real(lines.len())).min(BESIDE);
    step * (real(place) - 0.5 * real(lines.len() - 1))
}

fn is_marked(line: &Line) -> bool {
    line.points.len() <= MARKED_MAX
}

fn stroke(line: &Line) -> Stroke {
    Stroke {
        dash: Dash::Solid,
        width: if is_marked(line) { 1.75 } else { 1.0 },
        ..stroke_of(line.index)
    }
}

/// Lines from point to point, which end where a value is lacking; markers and intervals where there is
/// room for them, and markers where a point stands alone.
fn draw(picture: &mut Picture, panel: &Panel, line: &Line, aside: f64, plan: &Layout) {
    let stroke = stroke(line);
    let bar = Stroke {
        width: 1.25,
        ..stroke
    };
    let shape = shape_of(line.index);
    for piece in line.points.split(|(_, value)| value.is_none()) {
        let place = |at: &(f64, Option<Estimate>)| Some((panel.beside(at.0, aside), at.1?));
        let piece: Vec<(f64, Estimate)> = piece.iter().filter_map(place).collect();
        if plan.along.is_number {
            let values: Vec<(f64, f64)> = piece.iter().map(|(x, it)| (*x, it.value)).collect();
            panel.line(picture, &values, stroke);
        }
        if !is_marked(line) && piece.len() > 1 {
            continue;
        }
        for (x, it) in piece {
            panel.bar(picture, x, (it.low, it.high), bar);
            panel.marker(picture, (x, it.value), shape, stroke.colour);
        }
    }
}

fn name(picture: &mut Picture, legend: &mut Legend, line: &Line, plan: &Layout) {
    let (stroke, shape) = (stroke(line), shape_of(line.index));
    match (plan.along.is_number, is_marked(line)) {
        (true, true) => legend.curve(picture, stroke, shape, line.name),
        (true, false) => legend.line(picture, stroke, line.name),
        (false, _) => legend.marker(picture, (shape, stroke.colour), line.name),
    }
}

/// What stands for the uncertainty, if anything has one, and that marks stand beside their places.
fn explain(picture: &mut Picture, legend: &mut Legend, lines: &[Line]) {
    let mut values = lines.iter().flat_map(|line| &line.points);
    let has_interval = values.any(|(_, value)| value.is_some_and(|it| it.low < it.high));
    let are_drawn = lines.iter().all(is_marked);
    legend.space();
    if are_drawn && lines.len() > 1 {
        legend.text(picture, SIDE_BY_SIDE);
    }
    if has_interval {
        legend.text(
            picture,
            if are_drawn {
                "bars: 95 % intervals"
            } else {
                "95 % intervals: in metrics.csv"
            },
        );
    }
}
