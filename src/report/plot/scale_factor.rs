//! `scale-factor.svg`: how far every rate of a staircase lies from the line through all of them.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{
    SIDE_BY_SIDE, extent, shape_of, side_by_side, stroke_of, truth_stroke,
};
use crate::gate::{estimate_text, three_digits};
use crate::metrics::catalogue::{
    SCALE_FACTOR, SCALE_FACTOR_NONLINEARITY, SCALE_FACTOR_NONLINEARITY_OF_READING,
};
use crate::metrics::columns::staircase::INPUT;
use crate::metrics::{ChannelMetrics, Column};
use crate::report::record::measured::Measured;
use crate::report::text::scale_factor::{OF_FULL_SCALE, OF_READING, filter_state_word};
use crate::scenario::FilterState;
use crate::units::deg_per_h_to_deg_per_s;

/// Residual of one rate with the ends of its interval, ppm.
type Bar = [f64; 3];

/// A channel: rates, deg/s, with their residuals of full scale and of reading.
struct Channel<'a> {
    index: usize,
    name: &'a str,
    metrics: &'a ChannelMetrics,
    points: Vec<(f64, Bar, Bar)>,
}

/// Residuals of full scale over the rate above, those of reading over its size below; `None` where
/// no channel has a scale factor.
///
/// * `filter_state`: how the filters of a run were kept from rate to rate; none of a log.
pub(in crate::report) fn picture(
    measured: &Measured,
    filter_state: Option<FilterState>,
) -> Option<Picture> {
    let channels = channels(measured);
    let all = || channels.iter().flat_map(|channel| &channel.points);
    let x = extent(all().map(|point| point.0))?;
    let sizes = extent(all().map(|point| point.0.abs()))?;
    let mut picture = Picture::new(WIDTH, 870.0);
    let title = format!("{}: residuals of the scale factor", measured.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let above = extent(all().flat_map(|point| point.1))?;
    let upper = Panel::new(
        &mut picture,
        (56.0, 400.0),
        Axis::linear(x, 0.03, "rate [deg/s]"),
        Axis::linear(above, 0.06, "residual [ppm of full scale]"),
    );
    upper.line(&mut picture, &[(x.0, 0.0), (x.1, 0.0)], truth_stroke());
    let below = extent(all().flat_map(|point| point.2))?;
    let lower = Panel::new(
        &mut picture,
        (466.0, 810.0),
        Axis::log(sizes, 0.03, "size of the rate, both senses [deg/s]"),
        Axis::linear(below, 0.06, "residual [ppm of reading]"),
    );
    lower.line(
        &mut picture,
        &[(sizes.0, 0.0), (sizes.1, 0.0)],
        truth_stroke(),
    );
    for (place, channel) in channels.iter().enumerate() {
        let aside = side_by_side(place, channels.len());
        let points = channel.points.iter();
        let of_full_scale: Vec<_> = points.clone().map(|point| (point.0, point.1)).collect();
        draw(&mut picture, &upper, (channel.index, aside), &of_full_scale);
        for sense in [1.0, -1.0] {
            let own = points.clone().filter(|point| sense * point.0 > 0.0);
            let of_reading: Vec<_> = own.map(|point| (point.0.abs(), point.2)).collect();
            draw(&mut picture, &lower, (channel.index, aside), &of_reading);
        }
    }
    legends(&mut picture, filter_state, &channels);
    Some(picture)
}

fn legends(picture: &mut Picture, filter_state: Option<FilterState>, channels: &[Channel]) {
    let mut legend = Legend::new(56.0);
    for channel in channels {
        let stroke = stroke_of(channel.index);
        legend.curve(picture, stroke, shape_of(channel.index), channel.name);
        for (key, title) in [
            (&SCALE_FACTOR_NONLINEARITY, "of full scale"),
            (&SCALE_FACTOR_NONLINEARITY_OF_READING, "of reading"),
        ] {
            let Some(metric) = channel.metrics.get(key) else {
                continue;
            };
            let value = estimate_text(&metric.estimate, 2);
            legend.detail(picture, &format!("{title}: {value} ppm"));
            if let Some(floor) = metric.fields.get("noise_floor_ppm") {
                legend.detail(
                    picture,
                    &format!("noise alone: {} ppm", three_digits(*floor)),
                );
            }
        }
    }
    let mut legend = Legend::below(&legend, 466.0);
    legend.text(picture, "bars: 95 % interval of each rate");
    if let Some(state) = filter_state.map(filter_state_word) {
        legend.text(picture, &format!("filter state: {state}"));
    }
    if channels.len() > 1 {
        legend.text(picture, SIDE_BY_SIDE);
    }
}

/// A line through the points of one channel with their bars, some pixels beside their places.
fn draw(picture: &mut Picture, panel: &Panel, (index, aside): (usize, f64), points: &[(f64, Bar)]) {
    let stroke = stroke_of(index);
    let bar = Stroke::solid(stroke.colour, 1.25);
    let mut line: Vec<(f64, f64)> = points
        .iter()
        .map(|(x, bar)| (panel.beside(*x, aside), bar[0]))
        .collect();
    line.sort_by(|a, b| a.0.total_cmp(&b.0));
    panel.line(picture, &line, stroke);
    for (x, [value, low, high]) in points {
        let x = panel.beside(*x, aside);
        panel.bar(picture, x, (*low, *high), bar);
        panel.marker(picture, (x, *value), shape_of(index), stroke.colour);
    }
}

fn channels<'a>(measured: &Measured<'a>) -> Vec<Channel<'a>> {
    let channels = measured.channels.iter().enumerate();
    let found = channels.filter_map(|(index, (name, metrics))| {
        let curve = metrics.curve(&SCALE_FACTOR)?;
        let values = |column: &Column| column.of(curve).iter().copied();
        let bars = |[value, low, high]: [&Column; 3]| {
            let ends = values(low).zip(values(high));
            let bars = values(value).zip(ends);
            bars.map(|(value, (low, high))| [value, low, high])
        };
        let rates = values(&INPUT).map(deg_per_h_to_deg_per_s);
        let points = rates.zip(bars(OF_FULL_SCALE).zip(bars(OF_READING)));
        Some(Channel {
            index,
            name,
            metrics,
            points: points
                .map(|(rate, (of_full_scale, of_reading))| (rate, of_full_scale, of_reading))
                .collect(),
        })
    });
    found.collect()
}
