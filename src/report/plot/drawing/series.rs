//! Long records made short enough to draw.

use super::picture::{BLACK, Colour, Dash, Shape, Stroke};
use crate::metrics::ChannelMetrics;
use crate::report::record::measured::Measured;
use crate::signal::{Rates, RunSignals};

/// Colours that colour-blind readers tell apart (Okabe and Ito, 2008), raw first, then darker ones
/// (Tol, 2021). Their number has no factor in common with that of the dashes.
const COLOURS: [Colour; 13] = [
    (0x8a, 0x8a, 0x8a),
    (0xd5, 0x5e, 0x00),
    (0x00, 0x72, 0xb2),
    (0x00, 0x9e, 0x73),
    (0xcc, 0x79, 0xa7),
    (0xe6, 0x9f, 0x00),
    (0x56, 0xb4, 0xe9),
    (0x88, 0x22, 0x55),
    (0x99, 0x99, 0x33),
    (0x33, 0x22, 0x88),
    (0x7f, 0x3b, 0x08),
    (0x0b, 0x5d, 0x2e),
    (0xaa, 0x44, 0xdd),
];
const DASHES: [Dash; 4] = [Dash::Solid, Dash::Long, Dash::Mixed, Dash::Dotted];

/// A channel as it is drawn.
pub(in crate::report::plot) struct Series<'a> {
    pub(in crate::report::plot) name: &'a str,
    /// Whether this is the gyro's own output.
    pub(in crate::report::plot) is_raw: bool,
    pub(in crate::report::plot) metrics: Option<&'a ChannelMetrics>,
    pub(in crate::report::plot) stroke: Stroke,
    /// Rate words of the measured part, deg/h; none where the channel has no samples or failed.
    pub(in crate::report::plot) samples: &'a [f64],
}

impl Series<'_> {
    /// Why the channel is not drawn, if it failed.
    pub(in crate::report::plot) fn failure(&self) -> Option<String> {
        let error = self.metrics?.error.as_ref()?;
        Some(format!(
            "failed at sample {} ({})",
            error.sample, error.kind
        ))
    }
}

/// Line of channel number `index`: colour and pattern differ from channel to channel.
pub(in crate::report::plot) fn stroke_of(index: usize) -> Stroke {
    Stroke {
        colour: COLOURS[index % COLOURS.len()],
        width: 1.75,
        dash: DASHES[index % DASHES.len()],
        opacity: 1.0,
    }
}

/// Marker of channel number `index`.
pub(in crate::report::plot) fn shape_of(index: usize) -> Shape {
    [Shape::Circle, Shape::Square, Shape::Triangle][index % 3]
}

/// What is said where marks stand beside their places.
pub(in crate::report::plot) const SIDE_BY_SIDE: &str = "marks of one place stand side by side";

/// How far beside its place channel number `place` of `count` is drawn, pixels, so that none covers another
/// that it coincides with.
pub(in crate::report::plot) fn side_by_side(place: usize, count: usize) -> f64 {
    /// From the first to the last, and between neighbours, at most.
    const SPREAD: f64 = 18.0;
    const STEP: f64 = 6.0;
    let gaps = real(count.saturating_sub(1));
    if gaps > 0.0 {
        (SPREAD / gaps).min(STEP) * (real(place) - 0.5 * gaps)
    } else {
        0.0
    }
}

/// Line of the true rate.
pub(in crate::report::plot) fn truth_stroke() -> Stroke {
    Stroke {
        dash: Dash::Dotted,
        ..Stroke::solid(BLACK, 1.5)
    }
}

/// The channels of a report with their samples; the first of the signals is raw.
pub(in crate::report::plot) fn series<'a>(
    report: &Measured<'a>,
    signals: &RunSignals<'a>,
) -> Vec<Series<'a>> {
    report
        .channels
        .iter()
        .enumerate()
        .map(|(index, (name, metrics))| {
            let samples = signals
                .channels
                .iter()
                .find(|(other, _)| other == name)
                .filter(|_| metrics.error.is_none())
                .and_then(|(_, samples)| samples.get(signals.first_measured..))
                .unwrap_or(&[]);
            Series {
                name,
                is_raw: signals.channels.first().is_some_and(|(raw, _)| raw == name),
                metrics: Some(metrics),
                stroke: stroke_of(index),
                samples,
            }
        })
        .collect()
}

/// A run of samples as one pixel column shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report::plot) struct Column {
    /// Middle of the run, in samples from the first.
    pub(in crate::report::plot) index: f64,
    pub(in crate::report::plot) low: f64,
    pub(in crate::report::plot) high: f64,
    pub(in crate::report::plot) mean: f64,
}

/// The record cut into at most `columns` runs of equal length (the last may be shorter).
pub(in crate::report::plot) fn columns<'a>(
    values: impl Into<Rates<'a>>,
    columns: usize,
) -> Vec<Column> {
    let values = values.into();
    let length = values.len().div_ceil(columns.max(1)).max(1);
    let mut start = 0.0;
    (0..values.len())
        .step_by(length)
        .map(|first| {
            let run = values.cut(first..(first + length).min(values.len()));
            let count = real(run.len());
            let column = Column {
                index: start + 0.5 * (count - 1.0),
                low: run.iter().fold(f64::INFINITY, f64::min),
                high: run.iter().fold(f64::NEG_INFINITY, f64::max),
                mean: run.iter().sum::<f64>() / count,
            };
            start += count;
            column
        })
        .collect()
}

/// A count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "counts of samples lie below 2^53"
)]
pub(in crate::report::plot) fn real(count: usize) -> f64 {
    count as f64
}

/// A non-negative position as an index; 0 below zero.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a saturating cast to an index that is then checked against the record"
)]
pub(in crate::report::plot) fn index(position: f64) -> usize {
    position as usize
}

/// Smallest and largest of finite values; `None` if there is none.
pub(in crate::report::plot) fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(None, |range, value| {
            let (low, high) = range.unwrap_or((value, value));
            Some((low.min(value), high.max(value)))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirteen_channels_differ_in_colour_and_fifty_two_in_colour_or_dash() {
        let strokes: Vec<Stroke> = (0..52).map(stroke_of).collect();
        for (index, own) in strokes.iter().enumerate() {
            for (before, other) in strokes[..index].iter().enumerate() {
                assert_ne!(own, other, "{before} and {index}");
                if index < 13 {
                    assert_ne!(own.colour, other.colour, "{before} and {index}");
                }
            }
        }
    }
}
