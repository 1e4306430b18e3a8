//! `temperature.svg`: means of a log against its temperature, and what the coefficients leave of them.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Shape};
use super::drawing::series::{extent, stroke_of, truth_stroke};
use crate::gate::estimate_text;
use crate::metrics::catalogue::TEMPERATURE;
use crate::metrics::columns::temperature::{BIAS, FITTED, LEFT, RATE, TEMPERATURE_C, TIME};
use crate::metrics::{Column, TEMPERATURE_METRICS};
use crate::report::record::measured::Measured;

/// The two senses, each with its mark and its place among the colours.
const SENSES: [(&str, f64, Shape, usize); 2] = [
    ("rising", 1.0, Shape::Triangle, 1),
    ("falling", -1.0, Shape::Circle, 0),
];

/// Means and coefficients over the temperature, rising and falling; below them what is left over time.
pub(in crate::report) fn picture(measured: &Measured) -> Option<Picture> {
    let mut channels = measured.channels.iter();
    let (name, metrics, curve) =
        channels.find_map(|(name, metrics)| Some((name, metrics, metrics.curve(&TEMPERATURE)?)))?;
    let values = |column: &'static Column| column.of(curve);
    let pairs = |x: &'static Column, y: &'static Column| -> Vec<(f64, f64)> {
        let both = values(x).iter().zip(values(y));
        both.map(|(x, y)| (*x, *y)).collect()
    };
    let mut picture = Picture::new(WIDTH, 870.0);
    let title = format!("{}: {name} over its temperature", measured.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let errors = extent(values(&BIAS).iter().chain(values(&FITTED)).copied())?;
    let upper = Panel::new(
        &mut picture,
        (56.0, 400.0),
        Axis::linear(
            extent(values(&TEMPERATURE_C).iter().copied())?,
            0.03,
            "temperature [C]",
        ),
        Axis::linear(errors, 0.06, "mean [deg/h]"),
    );
    let lower = Panel::new(
        &mut picture,
        (466.0, 810.0),
        Axis::linear(extent(values(&TIME).iter().copied())?, 0.0, "time [s]"),
        Axis::linear(
            extent(values(&LEFT).iter().copied())?,
            0.06,
            "residual [deg/h]",
        ),
    );
    let mut legend = Legend::new(56.0);
    for (words, sense, shape, colour) in SENSES {
        let colour = stroke_of(colour).colour;
        let of_sense = |points: Vec<(f64, f64)>| {
            let rates = values(&RATE).iter().zip(points);
            let own = rates.filter(move |(rate, _)| sense * **rate > 0.0);
            own.map(|(_, point)| point).collect::<Vec<_>>()
        };
        for at in of_sense(pairs(&TEMPERATURE_C, &BIAS)) {
            upper.marker(&mut picture, at, shape, colour);
        }
        for at in of_sense(pairs(&TIME, &LEFT)) {
            lower.marker(&mut picture, at, shape, colour);
        }
        legend.marker(&mut picture, (shape, colour), words);
    }
    upper.line(
        &mut picture,
        &pairs(&TEMPERATURE_C, &FITTED),
        truth_stroke(),
    );
    legend.line(&mut picture, truth_stroke(), "all coefficients");
    for key in TEMPERATURE_METRICS {
        if let Some(metric) = metrics.get(key) {
            let value = estimate_text(&metric.estimate, 2);
            legend.detail(
                &mut picture,
                &format!("{}: {value} {}", key.title(), key.unit),
            );
        }
    }
    let mut legend = Legend::below(&legend, 466.0);
    legend.text(&mut picture, "without the significant coefficients");
    Some(picture)
}
