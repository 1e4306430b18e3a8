//! `bode.svg`: gain and phase of the channels against the true rate.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{extent, shape_of, stroke_of};
use super::drawing::theory::{curves, draw, legend_of};
use crate::gate::{estimate_text, plain};
use crate::metrics::catalogue::{BANDWIDTH, DELAY_VS_TRUTH, FREQUENCY_RESPONSE};
use crate::metrics::columns::tones::{
    FREQUENCY, GAIN, GAIN_HIGH, GAIN_LOW, PHASE, PHASE_HIGH, PHASE_LOW,
};
use crate::metrics::{ChannelMetrics, Column, Curve};
use crate::report::RunReport;
use crate::signal::TheoryQuantity;
use crate::units::gain_to_db;

/// Value, low and high of one quantity over the frequency, Hz.
type Points = Vec<(f64, [f64; 3])>;

/// A quantity of the response as one panel shows it.
struct Quantity {
    /// The value and the ends of its interval.
    columns: [&'static Column; 3],
    convert: fn(f64) -> f64,
    title: &'static str,
    theory: TheoryQuantity,
    frame: (f64, f64),
}

const QUANTITIES: [Quantity; 2] = [
    Quantity {
        columns: [&GAIN, &GAIN_LOW, &GAIN_HIGH],
        convert: gain_to_db,
        title: "gain [dB]",
        theory: TheoryQuantity::GainDb,
        frame: (56.0, 400.0),
    },
    Quantity {
        columns: [&PHASE, &PHASE_LOW, &PHASE_HIGH],
        convert: std::convert::identity,
        title: "phase [deg]",
        theory: TheoryQuantity::PhaseDeg,
        frame: (466.0, 810.0),
    },
];

/// Measured points with their intervals, and the line of theory for the raw channel.
pub(in crate::report) fn picture(report: &RunReport) -> Option<Picture> {
    let channels: Vec<(usize, &str, &ChannelMetrics, &Curve)> = report
        .channels
        .iter()
        .enumerate()
        .filter_map(|(index, (name, metrics))| {
            let curve = metrics.curve(&FREQUENCY_RESPONSE)?;
            Some((index, name.as_str(), metrics, curve))
        })
        .collect();
    let frequencies = channels
        .iter()
        .filter_map(|(.., curve)| FREQUENCY.get(curve));
    let x = extent(frequencies.flatten().copied())?;
    let mut picture = Picture::new(WIDTH, 870.0);
    let title = format!("{}: response to the true rate", report.scenario.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    for quantity in &QUANTITIES {
        let drawn: Vec<(usize, Points)> = channels
            .iter()
            .filter_map(|(index, .., curve)| Some((*index, points(curve, quantity)?)))
            .collect();
        let theory = curves(report, quantity.theory);
        let ends = drawn
            .iter()
            .flat_map(|(_, points)| points)
            .flat_map(|(_, ends)| *ends);
        let lines = theory.iter().flat_map(|curve| curve.y.iter().copied());
        let y = extent(ends.chain(lines))?;
        let x = Axis::log(x, 0.03, "frequency [Hz]");
        let y = Axis::linear(y, 0.06, quantity.title);
        let panel = Panel::new(&mut picture, quantity.frame, x, y);
        draw(&mut picture, &panel, &theory, std::convert::identity);
        for (index, points) in &drawn {
            draw_points(&mut picture, &panel, points, *index);
        }
    }
    let mut legend = Legend::new(56.0);
    for (index, name, metrics, _) in &channels {
        legend.marker(
            &mut picture,
            (shape_of(*index), stroke_of(*index).colour),
            name,
        );
        for text in remarks(metrics) {
            legend.detail(&mut picture, &text);
        }
    }
    legend_of(&mut picture, &mut legend, report, TheoryQuantity::GainDb);
    legend.space();
    legend.text(&mut picture, "bars: 95 % interval, where it is");
    legend.text(&mut picture, "larger than the marker");
    Some(picture)
}

fn points(curve: &Curve, quantity: &Quantity) -> Option<Points> {
    let frequency_hz = FREQUENCY.get(curve)?;
    let [value, low, high] = quantity.columns.map(|column| column.get(curve));
    let (value, low, high) = (value?, low?, high?);
    let at = |index: usize| -> Option<(f64, [f64; 3])> {
        let ends = [*value.get(index)?, *low.get(index)?, *high.get(index)?];
        Some((*frequency_hz.get(index)?, ends.map(quantity.convert)))
    };
    let found = (0..frequency_hz.len()).filter_map(at);
    Some(
        found
            .filter(|(_, ends)| ends.iter().all(|end| end.is_finite()))
            .collect(),
    )
}

/// A marker and the interval's bar at every point.
fn draw_points(picture: &mut Picture, panel: &Panel, points: &Points, index: usize) {
    let stroke = stroke_of(index);
    for (x, [value, low, high]) in points {
        let bar = Stroke::solid(stroke.colour, 1.5);
        panel.line(picture, &[(*x, *low), (*x, *high)], bar);
        panel.marker(picture, (*x, *value), shape_of(index), stroke.colour);
    }
}

/// Delay at the lowest tone, and the bandwidth if there is one.
fn remarks(metrics: &ChannelMetrics) -> Vec<String> {
    let delay = metrics.get(&DELAY_VS_TRUTH).map(|metric| {
        let text = estimate_text(&metric.estimate, 2);
        let frequency_hz = metric.fields.get("frequency_hz").copied().unwrap_or(0.0);
        format!("{text} ms late at {} Hz", plain(frequency_hz))
    });
    let bandwidth = metrics.get(&BANDWIDTH).map(|metric| {
        let text = estimate_text(&metric.estimate, 2);
        format!("bandwidth {text} Hz")
    });
    [delay, bandwidth].into_iter().flatten().collect()
}
