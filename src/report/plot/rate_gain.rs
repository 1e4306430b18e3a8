//! `rate-gain.svg`: mean output over mean input of every filter against the size of a constant rate.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{
    SIDE_BY_SIDE, extent, shape_of, side_by_side, stroke_of, truth_stroke,
};
use crate::metrics::Column;
use crate::metrics::catalogue::RATE_GAIN;
use crate::metrics::columns::rate_gain::{MEAN_RATIO, MEAN_RATIO_HIGH, MEAN_RATIO_LOW, RATE};
use crate::report::RunReport;

/// A filter's points: added rate, deg/s, mean ratio, and the ends of its interval.
struct Channel<'a> {
    index: usize,
    name: &'a str,
    points: Vec<(f64, f64, f64, f64)>,
}

/// Mean ratio over rate; `None` where no channel has the curve.
pub(in crate::report) fn picture(report: &RunReport) -> Option<Picture> {
    let channels = channels(report);
    let all = || channels.iter().flat_map(|channel| &channel.points);
    let x = extent(all().map(|point| point.0))?;
    let y = extent(all().flat_map(|point| [point.2, point.3]).chain([0.0, 1.0]))?;
    let mut picture = Picture::new(WIDTH, 520.0);
    let title = format!("{}: what constant rates become", report.scenario.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let x_axis = Axis::log(x, 0.03, "rate added to what is on the axis [deg/s]");
    let y_axis = Axis::linear(y, 0.05, "mean output over mean input");
    let panel = Panel::new(&mut picture, (56.0, 460.0), x_axis, y_axis);
    panel.line(&mut picture, &[(x.0, 1.0), (x.1, 1.0)], truth_stroke());
    let mut legend = Legend::new(56.0);
    for (place, channel) in channels.iter().enumerate() {
        let aside = |x: f64| panel.beside(x, side_by_side(place, channels.len()));
        let stroke = stroke_of(channel.index);
        let bar = Stroke::solid(stroke.colour, 1.25);
        let points = channel.points.iter();
        let line: Vec<_> = points.map(|point| (aside(point.0), point.1)).collect();
        panel.line(&mut picture, &line, stroke);
        for (rate, ratio, low, high) in &channel.points {
            panel.bar(&mut picture, aside(*rate), (*low, *high), bar);
            let shape = shape_of(channel.index);
            panel.marker(&mut picture, (aside(*rate), *ratio), shape, stroke.colour);
        }
        legend.curve(&mut picture, stroke, shape_of(channel.index), channel.name);
    }
    legend.line(&mut picture, truth_stroke(), "rate as it was");
    legend.text(&mut picture, "filters free to adapt, rate present");
    legend.text(&mut picture, "from the first sample on");
    legend.text(&mut picture, "bars: 95 % intervals");
    if channels.len() > 1 {
        legend.text(&mut picture, SIDE_BY_SIDE);
    }
    Some(picture)
}

fn channels<'a>(report: &RunReport<'a>) -> Vec<Channel<'a>> {
    let channels = report.channels.iter().enumerate();
    let found = channels.filter_map(|(index, (name, metrics))| {
        let curve = metrics.curve(&RATE_GAIN)?;
        let values = |column: &Column| column.of(curve).iter().copied();
        let ends = values(&MEAN_RATIO_LOW).zip(values(&MEAN_RATIO_HIGH));
        let points = values(&RATE).zip(values(&MEAN_RATIO)).zip(ends);
        let points = points.map(|((rate, ratio), (low, high))| (rate, ratio, low, high));
        Some(Channel {
            index,
            name,
            points: points.collect(),
        })
    });
    found.collect()
}
