//! `before-after.svg`: each channel's deviation from the true rate, before and after compensation
//! and filters, on one time axis.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{BLACK, Colour, Picture, Stroke};
use super::drawing::series::{Series, columns, extent, real, series};
use crate::report::RunReport;
use crate::signal::RunSignals;

/// Pixel columns of the envelopes, all rows together: bounds the size of the file.
const ENVELOPE_COLUMNS: usize = 4000;
/// Means of a row.
const MEANS: usize = 150;
/// Height of a row and of the space below it, pixels.
const ROW: f64 = 130.0;
const GAP: f64 = 66.0;
const TOP: f64 = 56.0;
/// Deviation over that of raw above which a channel has a scale of its own: it would flatten all others.
const OWN_SCALE: f64 = 3.0;
const BAND_OPACITY: f64 = 0.5;

/// One row for each channel of a gyro whose words are compensated: raw, compensated, each filter.
pub(in crate::report) fn picture(report: &RunReport, signals: &RunSignals) -> Option<Picture> {
    report.compensation?;
    let truth = &signals.truth_deg_per_h.from(signals.first_measured).words();
    let measured = report.measured();
    let channels = series(&measured, signals);
    let rows: Vec<&Series> = channels
        .iter()
        .filter(|channel| channel.samples.len() == truth.len() && truth.len() > 1)
        .collect();
    if rows.is_empty() {
        return None;
    }
    let height = TOP + real(rows.len()) * (ROW + GAP);
    let mut picture = Picture::new(WIDTH, height);
    let title = format!(
        "{}: deviation from the true rate before and after",
        report.scenario.name
    );
    picture.heading((90.0, 28.0), &title, 18.0);
    let rows: Vec<Row> = rows
        .iter()
        .map(|channel| Row {
            name: channel.name,
            colour: channel.stroke.colour,
            deviation: difference(channel.samples, truth),
        })
        .collect();
    let common = common_range(&rows)?;
    let share = (ENVELOPE_COLUMNS / rows.len()).min(790);
    let time_s = |index: f64| (real(signals.first_measured + 1) + index) * signals.sample_period_s;
    for (index, row) in rows.iter().enumerate() {
        let top = TOP + real(index) * (ROW + GAP);
        let is_own = row.size() > OWN_SCALE * rows[0].size();
        let y = if is_own { row.range()? } else { common };
        let panel = Panel::new(
            &mut picture,
            (top, top + ROW),
            Axis::linear((time_s(0.0), time_s(real(truth.len()))), 0.0, "time [s]"),
            Axis::linear(y, 0.05, "deviation [deg/h]"),
        );
        let band: Vec<(f64, f64, f64)> = columns(&row.deviation, share)
            .iter()
            .map(|column| (time_s(column.index), column.low, column.high))
            .collect();
        panel.band(&mut picture, &band, row.colour, BAND_OPACITY);
        let means: Vec<(f64, f64)> = columns(&row.deviation, MEANS)
            .iter()
            .map(|column| (time_s(column.index), column.mean))
            .collect();
        let mean_stroke = Stroke::solid(BLACK, 1.25);
        panel.line(&mut picture, &means, mean_stroke);
        let mut legend = Legend::new(top);
        let text = format!("{}: smallest to largest", row.name);
        legend.area(&mut picture, (row.colour, BAND_OPACITY), &text);
        legend.line(&mut picture, mean_stroke, "means");
        if is_own {
            legend.text(&mut picture, "on a scale of its own");
        }
    }
    Some(picture)
}

/// A channel's deviation from the true rate.
struct Row<'a> {
    name: &'a str,
    colour: Colour,
    deviation: Vec<f64>,
}

impl Row<'_> {
    /// Smallest and largest deviation, and 0.
    fn range(&self) -> Option<(f64, f64)> {
        extent(self.deviation.iter().copied().chain([0.0]))
    }

    /// Largest deviation of either sign.
    fn size(&self) -> f64 {
        self.range().map_or(0.0, |(low, high)| high.max(-low))
    }
}

fn difference(rates: &[f64], truth: &[f64]) -> Vec<f64> {
    let pairs = rates.iter().zip(truth);
    pairs.map(|(rate, truth)| rate - truth).collect()
}

/// The range of all channels that do not run far away from raw, the first of them: before and after are
/// compared by eye.
fn common_range(rows: &[Row]) -> Option<(f64, f64)> {
    let raw = rows.first()?.size();
    let near = rows.iter().filter(|row| row.size() <= OWN_SCALE * raw);
    let ranges = near.filter_map(Row::range);
    extent(ranges.flat_map(|(low, high)| [low, high]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn before_and_after_share_a_scale_but_for_what_runs_away() {
        let row = |deviation: &[f64]| Row {
            name: "x",
            colour: BLACK,
            deviation: deviation.to_vec(),
        };
        let rows = [row(&[90.0, 110.0]), row(&[-20.0, 30.0]), row(&[-5e4, 1.0])];
        assert_eq!(common_range(&rows), Some((-20.0, 110.0)));
    }
}
