//! Picture of a search for word lengths: what bits cost in noise, delay and life.

use super::Pictures;
use super::drawing::axis::Axis;
use super::drawing::labels::Labels;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Colour, Picture, Shape, stamped};
use super::drawing::series::{extent, real, stroke_of, truth_stroke};

/// File of the picture.
const PICTURE: &str = "pareto.svg";

/// Height of one panel with its title, pixels.
const PANEL: f64 = 250.0;
/// Most limits of a figure that its axis reaches.
const LIMITS_SHOWN: f64 = 3.0;
/// Colours of the words that were found, of those that nothing beats, and of others.
const BEST: usize = 1;
const PARETO: usize = 2;
const OTHER: usize = 0;

/// A trial of word lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WordLengthPoint {
    /// Bits of all signals together.
    pub bits: u32,
    /// Whether all signals have the same number of bits.
    pub is_uniform: bool,
    /// Noise over that in binary64; none of a filter that failed.
    pub arw_ratio: Option<f64>,
    /// Delay minus that in binary64, us; none without a swing and of a filter that failed.
    pub delay_change_us: Option<f64>,
    /// When the filter failed, s; none of one that lives.
    pub diverged_at_s: Option<f64>,
    /// Whether no other trial is as good in all and better in something.
    pub is_pareto: bool,
    /// Whether these are the words that were found.
    pub is_best: bool,
}

/// A search to show.
#[derive(Clone, Debug, PartialEq)]
pub struct WordLengthSheet {
    /// Scenario and filter.
    pub title: String,
    /// Trials in the order in which they were made.
    pub points: Vec<WordLengthPoint>,
    /// Ratios of the noise to that in binary64 that words may have.
    pub arw_ratios: [f64; 2],
    /// Largest change of the delay, us.
    pub delay_change_max_us: f64,
    /// Time that every trial filtered, s.
    pub filtered_s: f64,
}

/// The picture of a search, or the note that it is too large; nothing without a trial.
#[must_use]
pub fn word_length_pictures(sheet: &WordLengthSheet) -> Pictures {
    let mut pictures = Pictures::default();
    if let Some(picture) = picture(sheet) {
        let svg = picture.svg();
        let svg = svg.map(|svg| stamped(&svg, env!("CARGO_PKG_VERSION"), None));
        pictures.add_svg(PICTURE.to_owned(), svg);
    }
    pictures
}

/// What a panel shows of a trial.
type Figure<'a> = &'a dyn Fn(&WordLengthPoint) -> Option<f64>;

/// One panel: what it shows, over which range, and the lines of its limits.
struct Part<'a> {
    figure: Figure<'a>,
    y: Axis,
    range: (f64, f64),
    limits: Vec<f64>,
}

fn picture(sheet: &WordLengthSheet) -> Option<Picture> {
    let bits = extent(sheet.points.iter().map(|point| f64::from(point.bits)))?;
    let life = |point: &WordLengthPoint| Some(point.diverged_at_s.unwrap_or(sheet.filtered_s));
    let mut parts = vec![noise(sheet)];
    if sheet.points.iter().any(|it| it.delay_change_us.is_some()) {
        parts.push(delay(sheet));
    }
    let shortest = sheet.points.iter().filter_map(life);
    let shortest = shortest.fold(0.5 * sheet.filtered_s, f64::min);
    // Room for a label above those that live.
    let range = (shortest / 1.5, sheet.filtered_s * 2.0);
    parts.push(Part {
        figure: &life,
        y: Axis::log(range, 0.0, "life [s]"),
        range,
        limits: vec![sheet.filtered_s],
    });
    let mut picture = Picture::new(WIDTH, 60.0 + PANEL * real(parts.len()));
    picture.heading((90.0, 28.0), &sheet.title, 18.0);
    let mut beyond = 0;
    for (place, part) in parts.into_iter().enumerate() {
        let top = 56.0 + PANEL * real(place);
        let x = Axis::linear(bits, 0.05, "bits of all signals together");
        let frame = (top, top + PANEL - 66.0);
        let panel = Panel::new(&mut picture, frame, x, part.y.clone());
        beyond += draw(&mut picture, &panel, sheet, &part);
    }
    explain(&mut picture, sheet, beyond);
    Some(picture)
}

/// Noise over that in binary64, to some limits on both sides.
fn noise(sheet: &WordLengthSheet) -> Part<'_> {
    let room = (sheet.arw_ratios[1] - 1.0).abs().max(1e-3);
    let range = (1.0 - LIMITS_SHOWN * room, 1.0 + LIMITS_SHOWN * room);
    Part {
        figure: &|point| point.arw_ratio,
        y: Axis::linear(range, 0.0, "ARW over binary64"),
        range,
        limits: sheet.arw_ratios.into(),
    }
}

/// Change of the delay, to some limits on both sides.
fn delay(sheet: &WordLengthSheet) -> Part<'_> {
    let limit = sheet.delay_change_max_us;
    let range = (-LIMITS_SHOWN * limit, LIMITS_SHOWN * limit);
    Part {
        figure: &|point| point.delay_change_us,
        y: Axis::linear(range, 0.0, "delay - binary64 [us]"),
        range,
        limits: vec![-limit, limit],
    }
}

/// Limits and trials of a panel, the best trial last; how many lie beyond its edges.
fn draw(picture: &mut Picture, panel: &Panel, sheet: &WordLengthSheet, part: &Part) -> usize {
    for limit in &part.limits {
        let (left, right) = panel.x_range();
        panel.line(picture, &[(left, *limit), (right, *limit)], truth_stroke());
    }
    let mut ordered: Vec<&WordLengthPoint> = sheet.points.iter().collect();
    ordered.sort_by_key(|point| (point.is_best, point.is_pareto));
    let (low, high) = part.range;
    let mut labels = Labels::default();
    let mut beyond = 0;
    let mut drawn = Vec::new();
    for point in ordered {
        let Some(value) = (part.figure)(point) else {
            continue;
        };
        let at = (f64::from(point.bits), value.clamp(low, high));
        let shape = match (value > high, value < low) {
            (true, _) => Shape::Triangle,
            (_, true) => Shape::Wedge,
            _ => shape_of(point),
        };
        beyond += usize::from(value > high || value < low);
        panel.marker(picture, at, shape, colour_of(point));
        labels.keep_clear(panel.place(at));
        drawn.push((point, at));
    }
    if let Some((best, at)) = drawn.last().filter(|(point, _)| point.is_best) {
        labels.place(picture, panel.place(*at), &format!("{} bits", best.bits));
    }
    beyond
}

fn shape_of(point: &WordLengthPoint) -> Shape {
    match (point.is_best, point.is_uniform) {
        (true, _) => Shape::Diamond,
        (_, true) => Shape::Circle,
        _ => Shape::Square,
    }
}

fn colour_of(point: &WordLengthPoint) -> Colour {
    let index = match (point.is_best, point.is_pareto) {
        (true, _) => BEST,
        (_, true) => PARETO,
        _ => OTHER,
    };
    stroke_of(index).colour
}

/// What marks and lines are, and which trials have none.
fn explain(picture: &mut Picture, sheet: &WordLengthSheet, beyond: usize) {
    let mut legend = Legend::new(56.0);
    let has = |is_so: &dyn Fn(&WordLengthPoint) -> bool| sheet.points.iter().any(is_so);
    let grey = stroke_of(OTHER).colour;
    legend.marker(picture, (Shape::Circle, grey), "one length for all signals");
    if has(&|point| !point.is_uniform) {
        legend.marker(picture, (Shape::Square, grey), "signal by signal");
    }
    legend.space();
    if has(&|point| point.is_best) {
        let best = stroke_of(BEST).colour;
        legend.marker(picture, (Shape::Diamond, best), "the words that were found");
    }
    legend.marker(
        picture,
        (Shape::Circle, stroke_of(PARETO).colour),
        "no other words are better in bits, noise, delay and life at once",
    );
    if has(&|point| !point.is_pareto && !point.is_best) {
        legend.marker(picture, (Shape::Circle, grey), "other words are better");
    }
    legend.space();
    legend.line(picture, truth_stroke(), "limit, or end of the words");
    if beyond > 0 {
        legend.marker(picture, (Shape::Triangle, grey), "beyond the edge");
    }
    let failed = sheet.points.iter().filter(|it| it.arw_ratio.is_none());
    let failed = failed.count();
    if failed > 0 {
        let all = sheet.points.len();
        let text = format!("{failed} of {all} trials failed: no noise and no delay");
        legend.text(picture, &text);
    }
}
