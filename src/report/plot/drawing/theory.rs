//! Lines of theory beside measured points.

use super::panel::{Legend, Panel};
use super::picture::{BLACK, Dash, Picture, Stroke};
use crate::report::RunReport;
use crate::signal::{TheoryCurve, TheoryQuantity};

fn stroke() -> Stroke {
    Stroke {
        dash: Dash::Long,
        ..Stroke::solid(BLACK, 1.25)
    }
}

/// The curves of a quantity.
pub(in crate::report::plot) fn curves<'a>(
    report: &RunReport<'a>,
    quantity: TheoryQuantity,
) -> Vec<&'a TheoryCurve> {
    let all = report.theory.iter();
    all.filter(|curve| curve.quantity == quantity).collect()
}

/// Draws curves, cut off at the frame; `convert_x` turns abscissae into the unit of the axis.
pub(in crate::report::plot) fn draw(
    picture: &mut Picture,
    panel: &Panel,
    curves: &[&TheoryCurve],
    convert_x: fn(f64) -> f64,
) {
    for curve in curves {
        let x = curve.x.iter().copied().map(convert_x);
        let line: Vec<(f64, f64)> = x.zip(curve.y.iter().copied()).collect();
        panel.line(picture, &line, stroke());
    }
}

/// Names the curves of a quantity.
pub(in crate::report::plot) fn legend_of(
    picture: &mut Picture,
    legend: &mut Legend,
    report: &RunReport,
    quantity: TheoryQuantity,
) {
    for curve in curves(report, quantity) {
        legend.line(picture, stroke(), curve.name);
    }
}
