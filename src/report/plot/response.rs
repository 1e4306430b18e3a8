//! `response.svg`: output and error of every dwell of a staircase against its input.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{
    SIDE_BY_SIDE, extent, shape_of, side_by_side, stroke_of, truth_stroke,
};
use super::drawing::theory::{curves, draw, legend_of};
use crate::gate::estimate_text;
use crate::metrics::catalogue::{
    RESPONSE, SCALE_FACTOR_ASYMMETRY, SCALE_FACTOR_ERROR, SCALE_FACTOR_NONLINEARITY,
};
use crate::metrics::columns::staircase::{ERROR, ERROR_HIGH, ERROR_LOW, INPUT, OUTPUT};
use crate::metrics::{ChannelMetrics, Curve};
use crate::report::RunReport;
use crate::signal::TheoryQuantity;
use crate::units::deg_per_h_to_deg_per_s;

/// Dwells below which there is no curve to see.
const POINTS_MIN: usize = 3;
/// Input from which rates are shown in deg/s, deg/h.
const FAST_DEG_PER_H: f64 = 36_000.0;

/// One dwell: input, output, and error with the ends of its interval, deg/h.
struct Point {
    input: f64,
    output: f64,
    error: [f64; 3],
}

/// How rates are written along the axes.
struct Scale {
    convert: fn(f64) -> f64,
    unit: &'static str,
}

/// A channel with its dwells by input.
struct Channel<'a> {
    index: usize,
    name: &'a str,
    metrics: &'a ChannelMetrics,
    points: Vec<Point>,
}

/// Output against input above, error against input below; the latter is the dead band at small
/// rates.
pub(in crate::report) fn picture(report: &RunReport) -> Option<Picture> {
    let channels: Vec<Channel> = report
        .channels
        .iter()
        .enumerate()
        .filter_map(|(index, (name, metrics))| {
            let points = points(metrics.curve(&RESPONSE)?)?;
            (points.len() >= POINTS_MIN).then_some(Channel {
                index,
                name,
                metrics,
                points,
            })
        })
        .collect();
    let inputs = extent(dwells(&channels).map(|point| point.input))?;
    let scale = if inputs.0.abs().max(inputs.1.abs()) < FAST_DEG_PER_H {
        Scale {
            convert: std::convert::identity,
            unit: "deg/h",
        }
    } else {
        Scale {
            convert: deg_per_h_to_deg_per_s,
            unit: "deg/s",
        }
    };
    let mut picture = Picture::new(WIDTH, 870.0);
    let title = format!("{}: response to constant rates", report.scenario.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let x = ((scale.convert)(inputs.0), (scale.convert)(inputs.1));
    outputs(&mut picture, &channels, &scale, x)?;
    errors(&mut picture, report, &channels, &scale, x)?;
    let mut legend = Legend::new(56.0);
    for channel in &channels {
        let stroke = stroke_of(channel.index);
        legend.curve(&mut picture, stroke, shape_of(channel.index), channel.name);
        for text in remarks(channel.metrics) {
            legend.detail(&mut picture, &text);
        }
    }
    legend.line(&mut picture, truth_stroke(), "output = true rate");
    let mut legend = Legend::below(&legend, 466.0);
    legend_of(
        &mut picture,
        &mut legend,
        report,
        TheoryQuantity::RateErrorDegPerH,
    );
    legend.text(&mut picture, "bars: 95 % interval of the mean");
    if channels.len() > 1 {
        legend.text(&mut picture, SIDE_BY_SIDE);
    }
    Some(picture)
}

/// Every dwell of every channel.
fn dwells<'a>(channels: &'a [Channel]) -> impl Iterator<Item = &'a Point> {
    channels.iter().flat_map(|channel| &channel.points)
}

fn x_axis(scale: &Scale, x: (f64, f64)) -> Axis {
    Axis::linear(x, 0.03, &format!("true rate [{}]", scale.unit))
}

/// The upper panel.
fn outputs(
    picture: &mut Picture,
    channels: &[Channel],
    scale: &Scale,
    x: (f64, f64),
) -> Option<()> {
    let convert = scale.convert;
    let y = extent(dwells(channels).map(|point| convert(point.output)))?;
    let y = Axis::linear(y, 0.05, &format!("mean output [{}]", scale.unit));
    let panel = Panel::new(picture, (56.0, 400.0), x_axis(scale, x), y);
    panel.line(picture, &[(x.0, x.0), (x.1, x.1)], truth_stroke());
    for (place, channel) in channels.iter().enumerate() {
        let aside = side_by_side(place, channels.len());
        let points = channel.points.iter();
        let line: Vec<(f64, f64)> = points
            .map(|point| {
                (
                    panel.beside(convert(point.input), aside),
                    convert(point.output),
                )
            })
            .collect();
        draw_line(picture, &panel, &line, channel.index);
    }
    Some(())
}

/// The lower panel.
fn errors(
    picture: &mut Picture,
    report: &RunReport,
    channels: &[Channel],
    scale: &Scale,
    x: (f64, f64),
) -> Option<()> {
    let theory = curves(report, TheoryQuantity::RateErrorDegPerH);
    let ends = dwells(channels).flat_map(|point| point.error);
    let lines = theory.iter().flat_map(|curve| curve.y.iter().copied());
    let y = extent(ends.chain(lines))?;
    let y = Axis::linear(y, 0.06, "output minus true rate [deg/h]");
    let panel = Panel::new(picture, (466.0, 810.0), x_axis(scale, x), y);
    panel.line(picture, &[(x.0, 0.0), (x.1, 0.0)], truth_stroke());
    draw(picture, &panel, &theory, scale.convert);
    for (place, channel) in channels.iter().enumerate() {
        let aside = side_by_side(place, channels.len());
        let bar = Stroke::solid(stroke_of(channel.index).colour, 1.25);
        let mut line = Vec::with_capacity(channel.points.len());
        for point in &channel.points {
            let x = panel.beside((scale.convert)(point.input), aside);
            let [error, low, high] = point.error;
            panel.bar(picture, x, (low, high), bar);
            line.push((x, error));
        }
        draw_line(picture, &panel, &line, channel.index);
    }
    Some(())
}

fn draw_line(picture: &mut Picture, panel: &Panel, line: &[(f64, f64)], index: usize) {
    let stroke = stroke_of(index);
    panel.line(picture, line, stroke);
    for point in line {
        panel.marker(picture, *point, shape_of(index), stroke.colour);
    }
}

/// The dwells of a curve by input.
fn points(curve: &Curve) -> Option<Vec<Point>> {
    let (input, output) = (INPUT.get(curve)?, OUTPUT.get(curve)?);
    let error = [
        ERROR.get(curve)?,
        ERROR_LOW.get(curve)?,
        ERROR_HIGH.get(curve)?,
    ];
    let at = |index: usize| {
        Some(Point {
            input: *input.get(index)?,
            output: *output.get(index)?,
            error: [
                *error[0].get(index)?,
                *error[1].get(index)?,
                *error[2].get(index)?,
            ],
        })
    };
    let mut points: Vec<Point> = (0..input.len()).filter_map(at).collect();
    points.sort_by(|a, b| a.input.total_cmp(&b.input));
    Some(points)
}

/// The scale factor metrics of a channel.
fn remarks(metrics: &ChannelMetrics) -> Vec<String> {
    let titles = [
        (&SCALE_FACTOR_ERROR, "K - 1"),
        (&SCALE_FACTOR_NONLINEARITY, "nonlinearity"),
        (&SCALE_FACTOR_ASYMMETRY, "asymmetry"),
    ];
    titles
        .into_iter()
        .filter_map(|(key, title)| {
            let estimate = metrics.get(key)?.estimate;
            Some(format!("{title}: {} ppm", estimate_text(&estimate, 2)))
        })
        .collect()
}
