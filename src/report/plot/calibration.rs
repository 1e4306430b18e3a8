//! `calibration.svg`: errors of the estimators side by side, and how much each group counts.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Stroke};
use super::drawing::series::{extent, real, shape_of, stroke_of, truth_stroke};
use crate::signal::{AssemblyParameters, CalibrationEstimate, CalibrationSheet};

/// Standard errors on either side of a 95 % interval.
const SIGMAS: f64 = 1.96;
const GYROS: [&str; 3] = ["x", "y", "z"];

/// The picture of a calibration as SVG.
///
/// Biases and scale factors as errors where the truth is known, else against the applied estimate;
/// bars are 95 % intervals from the measurement noise. Weights are those of gyro x. Nothing if the
/// picture would be too large.
#[must_use]
pub(crate) fn calibration_svg(name: &str, sheet: &CalibrationSheet) -> Option<String> {
    let mut picture = Picture::new(WIDTH, 1180.0);
    picture.heading((90.0, 28.0), &format!("{name}: calibration"), 18.0);
    let from = if sheet.truth.is_some() {
        "error"
    } else {
        "minus applied"
    };
    let title = format!("bias, {from} [deg/h]");
    values(&mut picture, (56.0, 380.0), sheet, &title, |parameters| {
        parameters.bias_deg_per_h
    });
    let title = format!("scale factor, {from} [ppm]");
    values(&mut picture, (440.0, 764.0), sheet, &title, |parameters| {
        parameters.scale_factor_error_ppm
    });
    weights(&mut picture, sheet);
    let mut legend = Legend::new(56.0);
    for (index, found) in sheet.estimates.iter().enumerate() {
        let colour = stroke_of(index).colour;
        let mark = if found.name == sheet.applied {
            " (applied)"
        } else {
            ""
        };
        let look = (shape_of(index), colour);
        legend.marker(&mut picture, look, &format!("{}{mark}", found.name));
    }
    legend.text(&mut picture, "bars: 95 % intervals from");
    legend.text(&mut picture, "the measurement noise");
    picture.svg()
}

/// What an estimate is compared with.
fn origin(sheet: &CalibrationSheet) -> AssemblyParameters {
    let known = sheet.truth.map(|truth| truth.parameters);
    let applied = sheet.applied_estimate().map(|found| found.parameters);
    known.or(applied).unwrap_or_default()
}

/// One point with its interval for each gyro and estimator.
fn values(
    picture: &mut Picture,
    edges: (f64, f64),
    sheet: &CalibrationSheet,
    title: &str,
    of: fn(&AssemblyParameters) -> [f64; 3],
) {
    let origin = of(&origin(sheet));
    let width = real(sheet.estimates.len()) + 1.0;
    let point = |index: usize, found: &CalibrationEstimate, gyro: usize| {
        let value = of(&found.parameters)[gyro] - origin[gyro];
        let half = SIGMAS * of(&found.standard_error)[gyro];
        let at = real(gyro) * width + real(index) + 1.0;
        (at, value, half)
    };
    let estimates = || sheet.estimates.iter().enumerate();
    let all = estimates().flat_map(|(index, found)| {
        [0, 1, 2].map(|gyro| {
            let (_, value, half) = point(index, found, gyro);
            [value - half, value + half]
        })
    });
    let Some(range) = extent(all.flatten().chain([0.0])) else {
        return;
    };
    let mut x = Axis::linear((0.0, 3.0 * width), 0.0, "gyro");
    x.minor = Vec::new();
    x.ticks = (0..3)
        .map(|gyro| ((real(gyro) + 0.5) * width, GYROS[gyro].to_owned()))
        .collect();
    let panel = Panel::new(picture, edges, x, Axis::linear(range, 0.05, title));
    panel.line(picture, &[(0.0, 0.0), (3.0 * width, 0.0)], truth_stroke());
    for (index, found) in estimates() {
        let colour = stroke_of(index).colour;
        for gyro in 0..3 {
            let (at, value, half) = point(index, found, gyro);
            let bar = [(at, value - half), (at, value + half)];
            panel.line(picture, &bar, Stroke::solid(colour, 1.25));
            panel.marker(picture, (at, value), shape_of(index), colour);
        }
    }
}

/// The weight of each group in each estimate.
fn weights(picture: &mut Picture, sheet: &CalibrationSheet) {
    let last = real(sheet.groups.len());
    let of = |found: &CalibrationEstimate| -> Vec<f64> {
        found.weights.iter().map(|group| group[0]).collect()
    };
    let all = sheet.estimates.iter().flat_map(of);
    let Some(range) = extent(all.chain([0.0])) else {
        return;
    };
    let mut x = Axis::linear(
        (0.5, last + 0.5),
        0.0,
        "group, with its mean temperature [C]",
    );
    x.minor = Vec::new();
    let groups = sheet.groups.iter().enumerate();
    x.ticks = groups
        .map(|(index, group)| {
            let label = format!("{}: {:.1}", index + 1, group.temperature_c[0]);
            (real(index + 1), label)
        })
        .collect();
    let y = Axis::linear(range, 0.05, "weight of the group (gyro x)");
    let panel = Panel::new(picture, (824.0, 1120.0), x, y);
    for (index, found) in sheet.estimates.iter().enumerate() {
        let stroke = stroke_of(index);
        let points = of(found).into_iter().enumerate();
        let points: Vec<_> = points
            .map(|(group, weight)| (real(group + 1), weight))
            .collect();
        panel.line(picture, &points, stroke);
        for point in points {
            panel.marker(picture, point, shape_of(index), stroke.colour);
        }
    }
}
