//! `spectrum.svg`: one-sided power spectral density.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Point};
use super::drawing::series::{extent, real, stroke_of};
use crate::metrics::ChannelMetrics;
use crate::metrics::catalogue::PSD;
use crate::metrics::columns::spectrum::{DENSITY, FREQUENCY};
use crate::report::record::measured::Measured;

/// Densities are averaged over steps of this part of a decade.
const STEPS_PER_DECADE: f64 = 60.0;

/// The spectrum of every channel that has one.
pub(in crate::report) fn picture(report: &Measured) -> Option<Picture> {
    let curves: Vec<(usize, &str, &ChannelMetrics, Vec<Point>)> = report
        .channels
        .iter()
        .enumerate()
        .filter_map(|(index, (name, metrics))| {
            let curve = metrics.curve(&PSD)?;
            let points = thinned(FREQUENCY.get(curve)?, DENSITY.get(curve)?);
            Some((index, name.as_str(), metrics, points))
        })
        .collect();
    let points = || curves.iter().flat_map(|(.., points)| points);
    let x = extent(points().map(|(frequency, _)| *frequency))?;
    let y = extent(points().map(|(_, density)| *density))?;
    let mut picture = Picture::new(WIDTH, 640.0);
    let title = format!("{}: spectrum of the rate", report.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let x = Axis::log(x, 0.01, "frequency [Hz]");
    let y = Axis::log(y, 0.04, "one-sided power spectral density [(deg/h)²/Hz]");
    let panel = Panel::new(&mut picture, (56.0, 580.0), x, y);
    let mut legend = Legend::new(56.0);
    for (index, name, metrics, points) in &curves {
        panel.line(&mut picture, points, stroke_of(*index));
        legend.line(&mut picture, stroke_of(*index), name);
        legend.gain(&mut picture, metrics);
    }
    legend.space();
    legend.text(&mut picture, "one-sided: the integral over positive");
    legend.text(&mut picture, "frequencies is the variance;");
    legend.text(&mut picture, "means of 1/60 decade");
    Some(picture)
}

/// Means over equal steps of the logarithm: as many points as a reader can see.
fn thinned(frequency_hz: &[f64], density: &[f64]) -> Vec<(f64, f64)> {
    let step = |frequency: f64| (frequency.log10() * STEPS_PER_DECADE).floor();
    let usable: Vec<(f64, f64)> = frequency_hz
        .iter()
        .zip(density)
        .map(|(frequency, density)| (*frequency, *density))
        .filter(|(frequency, density)| *frequency > 0.0 && *density > 0.0)
        .collect();
    usable
        .chunk_by(|a, b| (step(a.0) - step(b.0)).abs() < 0.5)
        .map(|run| {
            let sum = run
                .iter()
                .fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
            (sum.0 / real(run.len()), sum.1 / real(run.len()))
        })
        .collect()
}
