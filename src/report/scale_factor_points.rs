//! A scale factor test of points, as text and JSON.

use serde_json::{Map, Value};

use crate::gate::{estimate_text, plain, three_digits};
use crate::metrics::{Estimate, Metric, Residual, ScaleFactorFit};
use crate::report::layout::json::{SCHEMA, estimate, numbers, object, pretty, put, tool};
use crate::report::layout::text::{Grid, wrapped};
use crate::units::{deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h, ratio_to_ppm};
use crate::wording::counted;

/// Digits of the half width of an interval.
const DIGITS: i32 = 2;

/// Everything the report of a scale factor test of points shows.
#[derive(Clone, Debug)]
pub struct PointsReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the file, without its folder.
    pub file: &'a str,
    /// Rates of the table, deg/h, in the order of the file.
    pub rate_deg_per_h: &'a [f64],
    /// Whether the outputs are counts; else they are rates, deg/h.
    pub is_in_counts: bool,
    /// Whether the file gives standard errors of the outputs.
    pub has_errors: bool,
    /// What the points say.
    pub fit: &'a ScaleFactorFit,
}

/// A figure of the test: key, name, unit, estimate.
struct Figure {
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    estimate: Estimate,
}

impl PointsReport<'_> {
    /// The figures, in the order in which they are shown.
    fn figures(&self) -> Vec<Figure> {
        let fit = self.fit;
        let of = |key, name, unit, estimate| Figure {
            key,
            name,
            unit,
            estimate,
        };
        let per_deg_per_s = fit.factor.scaled(deg_per_s_to_deg_per_h(1.0));
        let as_rate = fit.offset.scaled(1.0 / fit.factor.value.abs());
        let mut figures = if self.is_in_counts {
            vec![
                of(
                    "scale_factor",
                    "scale factor",
                    "counts/(deg/s)",
                    per_deg_per_s,
                ),
                of("offset", "offset", "counts", fit.offset),
                of("offset_deg_per_h", "offset as a rate", "deg/h", as_rate),
            ]
        } else {
            let error = fit.factor.shifted(-1.0).scaled(ratio_to_ppm(1.0));
            vec![
                of("scale_factor_error_ppm", "scale factor error", "ppm", error),
                of("offset_deg_per_h", "offset", "deg/h", fit.offset),
            ]
        };
        let ppm = |estimate: Estimate| estimate.scaled(ratio_to_ppm(1.0));
        figures.push(of(
            "nonlinearity_ppm",
            "nonlinearity",
            "ppm of full scale",
            ppm(fit.nonlinearity.value),
        ));
        figures.push(of(
            "nonlinearity_of_reading_ppm",
            "nonlinearity",
            "ppm of reading",
            ppm(fit.nonlinearity_of_reading.value),
        ));
        if let Some(asymmetry) = &fit.asymmetry {
            figures.push(of(
                "asymmetry_ppm",
                "asymmetry",
                "ppm",
                ppm(asymmetry.value),
            ));
        }
        figures
    }

    fn residual_ppm(&self, residual: &Residual) -> f64 {
        ratio_to_ppm(residual.value_deg_per_h / self.fit.full_scale_deg_per_h)
    }
}

/// The test for people.
#[must_use]
pub fn points_text(report: &PointsReport, width: usize) -> String {
    let rates = report.rate_deg_per_h.iter().copied();
    let low = rates.clone().fold(f64::INFINITY, f64::min);
    let high = rates.fold(f64::NEG_INFINITY, f64::max);
    let output = if report.is_in_counts {
        "counts"
    } else {
        "deg/h"
    };
    let mut text = format!(
        "{}  scale factor test, {} from {} to {} deg/s, output in {output}\n\n",
        report.file,
        counted(report.rate_deg_per_h.len(), "point"),
        three_digits(deg_per_h_to_deg_per_s(low)),
        three_digits(deg_per_h_to_deg_per_s(high)),
    );
    let mut grid = Grid::default();
    for figure in report.figures() {
        let value = estimate_text(&figure.estimate, DIGITS);
        grid.row([figure.name.to_owned(), value, figure.unit.to_owned()]);
    }
    text.push_str(&grid.lines("  "));
    text.push('\n');
    let mut rows = Grid::default();
    rows.row(["rate [deg/s]", "residual [ppm of full scale]"].map(str::to_owned));
    let pairs = report.rate_deg_per_h.iter().zip(&report.fit.residuals);
    for (rate, residual) in pairs {
        let rate = plain(deg_per_h_to_deg_per_s(*rate));
        rows.row([rate, three_digits(report.residual_ppm(residual))]);
    }
    text.push_str(&rows.lines("  "));
    let note = if report.has_errors {
        let floor = three_digits(ratio_to_ppm(report.fit.nonlinearity.noise_floor));
        format!(
            "an ideal gyro with these standard errors has a nonlinearity of {floor} ppm of full scale"
        )
    } else {
        "no standard errors: what is left of the line is taken as noise of the points".to_owned()
    };
    text.push_str(&wrapped(&format!("note: {note}"), "  ", width));
    text
}

/// The test as JSON.
#[must_use]
pub fn points_json(report: &PointsReport) -> String {
    let mut figures = Map::new();
    for figure in report.figures() {
        let metric = Metric::new(figure.estimate, figure.unit);
        figures.insert(figure.key.to_owned(), estimate(&metric).into());
    }
    let pairs = report.rate_deg_per_h.iter().zip(&report.fit.residuals);
    let points = pairs.map(|(rate, residual)| {
        let mut row = numbers([
            ("rate_deg_per_s", deg_per_h_to_deg_per_s(*rate)),
            ("residual_ppm_of_full_scale", report.residual_ppm(residual)),
        ]);
        if report.has_errors {
            let deviation = residual.deviation_deg_per_h / report.fit.full_scale_deg_per_h;
            put(
                &mut row,
                "residual_std_ppm_of_full_scale",
                ratio_to_ppm(deviation),
            );
        }
        Value::from(row)
    });
    let points: Vec<Value> = points.collect();
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(report.tool_version)),
        ("file", report.file.into()),
        (
            "output",
            if report.is_in_counts {
                "counts"
            } else {
                "deg/h"
            }
            .into(),
        ),
        ("has_standard_errors", report.has_errors.into()),
        ("figures", figures.into()),
        ("points", points.into()),
    ]);
    if report.has_errors {
        let floor = ratio_to_ppm(report.fit.nonlinearity.noise_floor);
        put(&mut root, "noise_floor_ppm", floor);
    }
    pretty(&root.into())
}
