//! `before-after.svg`: each channel's deviation from the true rate, before and after compensation
//! and filters, on one time axis.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{BLACK, Picture, Stroke};
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

/// One row for each channel of a gyro whose words are compensated: raw, compensated, each filter.
pub(in crate::report) fn picture(report: &RunReport, signals: &RunSignals) -> Option<Picture> {
    report.compensation?;
    let truth = signals.truth_deg_per_h.get(signals.first_measured..)?;
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
    let share = (ENVELOPE_COLUMNS / rows.len()).min(790);
    for (index, channel) in rows.iter().enumerate() {
        let top = TOP + real(index) * (ROW + GAP);
        let deviation: Vec<f64> = channel
            .samples
            .iter()
            .zip(truth)
            .map(|(rate, truth)| rate - truth)
            .collect();
        let time_s =
            |index: f64| (real(signals.first_measured + 1) + index) * signals.sample_period_s;
        let y = extent(deviation.iter().copied().chain([0.0]))?;
        let panel = Panel::new(
            &mut picture,
            (top, top + ROW),
            Axis::linear((time_s(0.0), time_s(real(truth.len()))), 0.0, "time [s]"),
            Axis::linear(y, 0.05, "[deg/h]"),
        );
        let band: Vec<(f64, f64, f64)> = columns(&deviation, share)
            .iter()
            .map(|column| (time_s(column.index), column.low, column.high))
            .collect();
        panel.band(&mut picture, &band, channel.stroke.colour, 0.5);
        let means: Vec<(f64, f64)> = columns(&deviation, MEANS)
            .iter()
            .map(|column| (time_s(column.index), column.mean))
            .collect();
        panel.line(&mut picture, &means, Stroke::solid(BLACK, 1.25));
        let mut legend = Legend::new(top);
        legend.line(&mut picture, channel.stroke, channel.name);
        legend.detail(&mut picture, "band: smallest to largest");
        legend.detail(&mut picture, "line: means");
    }
    Some(picture)
}
