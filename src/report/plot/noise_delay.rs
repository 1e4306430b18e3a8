//! `noise-delay.svg`: what every filter leaves of the noise against what it delays, each beside the
//! least noise that its taps allow with unit DC gain.

use super::drawing::axis::Axis;
use super::drawing::labels::Labels;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Colour, Dash, GREY, Picture, Stroke};
use super::drawing::series::{extent, real, shape_of, stroke_of};
use crate::gate::estimate_text;
use crate::metrics::catalogue::NOISE_DELAY_BOUND;
use crate::metrics::columns::noise_delay::{DELAY, LEAST_NOISE_GAIN, LEAST_WHITE_NOISE_GAIN};
use crate::metrics::{AgainstOne, Column, Estimate, FilterVerdict, filter_verdict};
use crate::report::record::measured::Measured;

/// How far above the highest point the bounds are shown: they rise without end on both sides.
const ROOM_ABOVE: f64 = 3.0;

/// A filter on the plane.
struct Point<'a> {
    index: usize,
    name: &'a str,
    verdict: FilterVerdict,
    delay_ms: Estimate,
    noise_gain: Estimate,
    /// Least noise gain over the delay, ms, for the measured colour of the noise.
    bound: Vec<(f64, f64)>,
    /// The same for white noise.
    white: Vec<(f64, f64)>,
}

/// Noise power gain over delay; `None` where no filter has both.
pub(in crate::report) fn picture(measured: &Measured) -> Option<Picture> {
    let points = points(measured);
    let ends = |pick: fn(&Point) -> Estimate| {
        let each = points.iter().map(pick);
        extent(each.flat_map(|estimate| [estimate.low, estimate.high]))
    };
    let delays = ends(|point| point.delay_ms)?;
    let gains = ends(|point| point.noise_gain)?;
    let (low, high) = (gains.0.min(1.0), gains.1.max(1.0));
    // A bound may lie below its point, but never so far that the points no longer fill the frame.
    let bounds = points.iter().flat_map(|point| &point.bound);
    let lowest = bounds.map(|(_, gain)| *gain).fold(low, f64::min);
    let rows = points.len().max(4);
    let height = 200.0 + 72.0 * real(rows);
    let mut picture = Picture::new(WIDTH, height);
    let title = format!("{}: noise against delay", measured.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let x = Axis::linear((delays.0.min(0.0), delays.1), 0.15, "delay behind raw [ms]");
    let y = (lowest.max(low / 10.0) / 1.3, high * ROOM_ABOVE);
    let y = Axis::log(y, 0.0, "noise power over that of raw");
    let panel = Panel::new(&mut picture, (56.0, height - 60.0), x, y);
    for point in &points {
        draw_bounds(&mut picture, &panel, point);
    }
    let mut legend = Legend::new(56.0);
    panel.marker(&mut picture, (0.0, 1.0), shape_of(0), stroke_of(0).colour);
    legend.marker(
        &mut picture,
        (shape_of(0), stroke_of(0).colour),
        "raw: no delay, all of its noise",
    );
    let mut labels = Labels::default();
    labels.keep_clear(panel.place((0.0, 1.0)));
    for point in &points {
        let at = (point.delay_ms.value, point.noise_gain.value);
        labels.keep_clear(panel.place(at));
    }
    for point in &points {
        draw_point(&mut picture, &panel, point, &mut labels);
        describe(&mut picture, &mut legend, point);
    }
    explain(&mut picture, &mut legend, &points);
    Some(picture)
}

/// What the lines, numbers and bars are, of those that are drawn.
fn explain(picture: &mut Picture, legend: &mut Legend, points: &[Point]) {
    legend.space();
    if points.iter().any(|point| point.bound.len() > 1) {
        let text = "bound: least noise of as many weights in a row with unit DC gain";
        legend.line(picture, bound_stroke(GREY), text);
    }
    if points.iter().any(|point| point.white.len() > 1) {
        legend.line(picture, white_stroke(GREY), "the same in white noise");
    }
    if points.iter().any(|point| point.verdict.dc_gain.is_some()) {
        legend.text(picture, "numbers at the points: DC gain");
    }
    let is_open = |it: Estimate| it.low < it.high;
    if points
        .iter()
        .any(|point| is_open(point.delay_ms) || is_open(point.noise_gain))
    {
        legend.text(picture, "bars: 95 % intervals");
    }
}

/// The filters that have a place on a logarithmic plane.
fn points<'a>(measured: &Measured<'a>) -> Vec<Point<'a>> {
    let channels = measured.channels.iter().enumerate();
    let points = channels.filter_map(|(index, (name, metrics))| {
        let verdict = filter_verdict(metrics)?;
        let curve = metrics.curve(&NOISE_DELAY_BOUND);
        let line = |column: &Column| -> Vec<(f64, f64)> {
            let values = |column: &Column| curve.map_or(&[][..], |curve| column.of(curve));
            let delays_ms = values(&DELAY).iter().copied();
            delays_ms.zip(values(column).iter().copied()).collect()
        };
        let noise_gain = verdict.fast_noise?.estimate;
        (noise_gain.low > 0.0).then_some(Point {
            index,
            name,
            verdict,
            delay_ms: verdict.delay_ms?,
            noise_gain,
            bound: line(&LEAST_NOISE_GAIN),
            white: line(&LEAST_WHITE_NOISE_GAIN),
        })
    });
    points.collect()
}

fn draw_bounds(picture: &mut Picture, panel: &Panel, point: &Point) {
    let colour = stroke_of(point.index).colour;
    panel.line(picture, &point.bound, bound_stroke(colour));
    panel.line(picture, &point.white, white_stroke(colour));
}

/// The line of a bound.
fn bound_stroke(colour: Colour) -> Stroke {
    Stroke {
        opacity: 0.8,
        ..Stroke::solid(colour, 1.25)
    }
}

/// The line of a bound in white noise.
fn white_stroke(colour: Colour) -> Stroke {
    Stroke {
        opacity: 0.5,
        dash: Dash::Dotted,
        ..bound_stroke(colour)
    }
}

/// Marker, bars, name and DC gain.
fn draw_point(picture: &mut Picture, panel: &Panel, point: &Point, labels: &mut Labels) {
    let colour = stroke_of(point.index).colour;
    let bar = Stroke::solid(colour, 1.5);
    let (delay, gain) = (point.delay_ms, point.noise_gain);
    let upright = [(delay.value, gain.low), (delay.value, gain.high)];
    let level = [(delay.low, gain.value), (delay.high, gain.value)];
    panel.line(picture, &upright, bar);
    panel.line(picture, &level, bar);
    let at = (delay.value, gain.value);
    panel.marker(picture, at, shape_of(point.index), colour);
    if let Some(dc_gain) = point.verdict.dc_gain {
        let text = format!("{} {:.2}", point.name, dc_gain.estimate.value);
        labels.place(picture, panel.place(at), &text);
    }
}

/// What the legend says of a filter.
fn describe(picture: &mut Picture, legend: &mut Legend, point: &Point) {
    let (shape, colour) = (shape_of(point.index), stroke_of(point.index).colour);
    if point.bound.len() > 1 {
        legend.curve(picture, bound_stroke(colour), shape, point.name);
    } else {
        legend.marker(picture, (shape, colour), point.name);
    }
    let noise = estimate_text(&point.noise_gain, 2);
    legend.detail(picture, &format!("noise {noise}"));
    let is_below = |finding: Option<crate::metrics::Finding>| {
        finding.is_some_and(|finding| finding.against_one == AgainstOne::Below)
    };
    let remark = match (
        is_below(point.verdict.over_bound),
        is_below(point.verdict.level()),
    ) {
        (true, true) => "below its bound: signal removed",
        (true, false) => "below its bound: weights adapt",
        (false, true) => "attenuates the signal",
        (false, false) => return,
    };
    legend.detail(picture, remark);
}
