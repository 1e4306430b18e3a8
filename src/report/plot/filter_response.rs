//! `filter-response.svg`: gain and phase delay behind raw of every filter over the frequency, frozen
//! at its mean weights, and as a motion of several sines found it while it adapted.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{extent, shape_of, stroke_of};
use crate::gate::estimate_text;
use crate::metrics::MetricKey;
use crate::metrics::catalogue::{DC_GAIN, DELAY_AT_DC, FREQUENCY_RESPONSE_VS_RAW, FROZEN_RESPONSE};
use crate::metrics::columns::tones::{
    DELAY, DELAY_HIGH, DELAY_LOW, FREQUENCY, GAIN, GAIN_HIGH, GAIN_LOW,
};
use crate::metrics::{ChannelMetrics, Column, Curve, Estimate};
use crate::report::record::measured::Measured;
use crate::units::gain_to_db;

/// Gain down to which the response is shown, dB.
const LOWEST_DB: f64 = -40.0;
/// Fall of the gain from its first value up to which a phase delay means something, dB.
const DELAY_FALL_DB: f64 = -20.0;

/// Frequency, Hz, value and the ends of its interval.
type Point = (f64, [f64; 3]);

/// A filter with what is drawn of it.
struct Filter<'a> {
    index: usize,
    name: &'a str,
    metrics: &'a ChannelMetrics,
    frozen: &'a Curve,
    live: Option<&'a Curve>,
}

/// One panel.
struct Quantity {
    columns: [&'static Column; 3],
    convert: fn(f64) -> f64,
    title: &'static str,
    frame: (f64, f64),
    /// Metric at zero frequency, marked at the left edge.
    at_dc: &'static MetricKey,
}

const QUANTITIES: [Quantity; 2] = [
    Quantity {
        columns: [&GAIN, &GAIN_LOW, &GAIN_HIGH],
        convert: decibel,
        title: "gain over raw [dB]",
        frame: (56.0, 400.0),
        at_dc: &DC_GAIN,
    },
    Quantity {
        columns: [&DELAY, &DELAY_LOW, &DELAY_HIGH],
        convert: std::convert::identity,
        title: "phase delay behind raw [ms]",
        frame: (466.0, 810.0),
        at_dc: &DELAY_AT_DC,
    },
];

/// Decibel; of a gain that is none a number all the same.
fn decibel(gain: f64) -> f64 {
    gain_to_db(gain.max(1e-9))
}

/// Both panels; `None` where no filter has a response.
pub(in crate::report) fn picture(measured: &Measured) -> Option<Picture> {
    let channels = measured.channels.iter().enumerate();
    let filters: Vec<Filter> = channels
        .filter_map(|(index, (name, metrics))| {
            Some(Filter {
                index,
                name,
                metrics,
                frozen: metrics.curve(&FROZEN_RESPONSE)?,
                live: metrics.curve(&FREQUENCY_RESPONSE_VS_RAW),
            })
        })
        .collect();
    let frequencies = filters
        .iter()
        .filter_map(|filter| FREQUENCY.get(filter.frozen));
    let x = extent(frequencies.flatten().copied())?;
    let mut picture = Picture::new(WIDTH, 870.0);
    let title = format!("{}: response of the filters", measured.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    for quantity in &QUANTITIES {
        draw(&mut picture, quantity, &filters, x)?;
    }
    let mut legend = Legend::new(56.0);
    for filter in &filters {
        let stroke = stroke_of(filter.index);
        legend.curve(&mut picture, stroke, shape_of(filter.index), filter.name);
        if let Some(gain) = at_dc(filter, &DC_GAIN) {
            let text = format!("DC gain {}", estimate_text(&gain, 2));
            legend.detail(&mut picture, &text);
        }
    }
    legend.space();
    legend.text(
        &mut picture,
        "lines: frozen at the mean weights of the run,",
    );
    legend.text(&mut picture, "or at those given; thin: 95 % interval");
    legend.text(&mut picture, "markers at the left edge: constant rate");
    let mut gains = filters.iter().flat_map(|filter| GAIN.of(filter.frozen));
    if gains.any(|gain| decibel(*gain) < LOWEST_DB) {
        let text = format!("gains below {LOWEST_DB} dB lie below the picture");
        legend.text(&mut picture, &text);
    }
    let mut frozen = filters.iter().map(|filter| GAIN.of(filter.frozen));
    if frozen.any(|gains| before_null(gains) < gains.len()) {
        let text = format!(
            "phase delay: until the gain has fallen by {} dB",
            -DELAY_FALL_DB
        );
        legend.text(&mut picture, &text);
    }
    if filters.iter().any(|filter| filter.live.is_some()) {
        legend.text(&mut picture, "other markers: live, several sines at once");
    }
    Some(picture)
}

fn at_dc(filter: &Filter, key: &MetricKey) -> Option<Estimate> {
    Some(filter.metrics.get(key)?.estimate)
}

/// Count of the gains before the first that has fallen to where the phase means nothing: at a null it jumps,
/// and what a phase delay would be beyond it nobody can tell.
fn before_null(gains: &[f64]) -> usize {
    let first = gains.first().map_or(0.0, |gain| decibel(*gain));
    let has_fallen = |gain: &f64| decibel(*gain) - first <= DELAY_FALL_DB;
    gains.iter().position(has_fallen).unwrap_or(gains.len())
}

/// The points of a curve that the panel shows.
fn points(curve: &Curve, quantity: &Quantity) -> Vec<Point> {
    let [value, low, high] = quantity.columns.map(|column| column.of(curve));
    let gains = GAIN.of(curve);
    let shown = match *quantity.at_dc == DC_GAIN {
        true => gains.len(),
        false => before_null(gains),
    };
    let ends = value.iter().zip(low).zip(high);
    let frequencies = FREQUENCY.of(curve).iter().take(shown);
    frequencies
        .zip(ends)
        .map(|(frequency, ((value, low), high))| {
            (*frequency, [*value, *low, *high].map(quantity.convert))
        })
        .collect()
}

fn draw(
    picture: &mut Picture,
    quantity: &Quantity,
    filters: &[Filter],
    x: (f64, f64),
) -> Option<()> {
    let lines: Vec<Vec<Point>> = filters
        .iter()
        .map(|filter| points(filter.frozen, quantity))
        .collect();
    let live: Vec<Vec<Point>> = filters
        .iter()
        .map(|filter| {
            filter
                .live
                .map_or_else(Vec::new, |curve| points(curve, quantity))
        })
        .collect();
    let values = lines.iter().flatten().map(|(_, ends)| ends[0]);
    let measured = live.iter().flatten().flat_map(|(_, ends)| *ends);
    let (low, high) = extent(values.chain(measured).chain([0.0]))?;
    let axis = Axis::log(x, 0.03, "frequency [Hz]");
    // Lines end at the frame: what lies below it nobody takes for a value.
    let y = match *quantity.at_dc == DC_GAIN && low < LOWEST_DB {
        true => Axis::linear((LOWEST_DB, high - 0.06 * LOWEST_DB), 0.0, quantity.title),
        false => Axis::linear((low, high), 0.06, quantity.title),
    };
    let panel = Panel::new(picture, quantity.frame, axis, y);
    for (filter, (line, live)) in filters.iter().zip(lines.iter().zip(&live)) {
        let stroke = stroke_of(filter.index);
        let end = |end: usize| -> Vec<(f64, f64)> {
            line.iter().map(|(x, ends)| (*x, ends[end])).collect()
        };
        let thin = Stroke {
            opacity: 0.5,
            ..Stroke::solid(stroke.colour, 0.75)
        };
        panel.line(picture, &end(1), thin);
        panel.line(picture, &end(2), thin);
        panel.line(picture, &end(0), stroke);
        for (at, [value, low, high]) in live {
            let bar = Stroke::solid(stroke.colour, 1.5);
            panel.line(picture, &[(*at, *low), (*at, *high)], bar);
            panel.marker(
                picture,
                (*at, *value),
                shape_of(filter.index),
                stroke.colour,
            );
        }
        if let Some(estimate) = at_dc(filter, quantity.at_dc) {
            let value = (quantity.convert)(estimate.value);
            panel.marker(picture, (x.0, value), shape_of(filter.index), stroke.colour);
        }
    }
    Some(())
}
