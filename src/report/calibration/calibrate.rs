//! What `calibrate` prints: the tables of a calibration, and its estimators in full side by side.

use crate::gate::plain;
use crate::report::calibration::documents::{AXES, THETAS, calibration_json};
use crate::report::calibration::text::calibration_text;
use crate::report::layout::json::{SCHEMA, tool};
use crate::report::layout::json::{object, pretty, put};
use crate::report::layout::text::{Grid, Tone, toned, wrapped};
use crate::signal::{AssemblyParameters, CalibrationEstimate, CalibrationSheet};
use crate::wording::counted;

const INDENT: &str = "  ";

/// Everything the report of one calibration shows.
#[derive(Clone, Debug)]
pub struct CalibrateReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the groups file or the calibration scenario, without its folder.
    pub file: &'a str,
    /// Digest of the groups file, or of the resolved scenario.
    pub digest: &'a str,
    /// Latitude that the Earth rate about the table axis is from; none where the file gives the
    /// rates about the case axes itself.
    pub latitude_deg: Option<f64>,
    /// Plan, groups and estimates.
    pub sheet: &'a CalibrationSheet,
    /// What else is worth saying.
    pub notes: &'a [String],
}

/// The calibration as tables for people.
#[must_use]
pub fn calibrate_text(report: &CalibrateReport, width: usize, colour: bool) -> String {
    let sheet = report.sheet;
    let latitude = report
        .latitude_deg
        .map_or_else(String::new, |it| format!(", latitude {} deg", plain(it)));
    let mut text = format!(
        "{}  calibration, {}{latitude}\n",
        toned(report.file, Tone::Heading, colour),
        counted(sheet.groups.len(), "group"),
    );
    text.push_str(&calibration_text(sheet, width, colour));
    text.push_str(&estimates_text(sheet, width, colour));
    text.push_str(&groups_text(sheet, colour));
    text.push_str(&compensation_text(sheet, width));
    for note in report.notes {
        let note = format!("{} {note}", toned("note:", Tone::Doubt, colour));
        text.push_str(&wrapped(&note, INDENT, width));
    }
    text
}

/// The calibration as JSON; `calibration` is that of a run's `summary.json`.
#[must_use]
pub fn calibrate_json(report: &CalibrateReport) -> String {
    let mut source = object([
        ("file", report.file.into()),
        ("digest", report.digest.into()),
    ]);
    put(&mut source, "latitude_deg", report.latitude_deg);
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(report.tool_version)),
        ("source", source.into()),
        ("calibration", calibration_json(report.sheet)),
    ]);
    if !report.notes.is_empty() {
        root.insert("notes".to_owned(), report.notes.to_vec().into());
    }
    pretty(&root.into())
}

/// Three values, or the one that they share in these digits.
fn three(values: [f64; 3], decimals: usize) -> String {
    let [x, y, z] = values.map(|value| format!("{value:.decimals$}"));
    if x == y && y == z {
        x
    } else {
        format!("({x}, {y}, {z})")
    }
}

/// Estimators side by side, broken into as many blocks as the width asks for.
fn estimates_text(sheet: &CalibrationSheet, width: usize, colour: bool) -> String {
    let heads = row_heads(sheet);
    let head_width = heads.iter().map(String::len).max().unwrap_or(0);
    let columns: Vec<Vec<String>> = sheet
        .estimates
        .iter()
        .map(|estimate| column(sheet, estimate))
        .collect();
    let mut text = String::new();
    let mut rest = &columns[..];
    while !rest.is_empty() {
        let mut used = INDENT.len() + head_width;
        let fitting = rest.iter().take_while(|column| {
            let cells = column.iter().map(|cell| cell.chars().count());
            used += 2 + cells.max().unwrap_or(0);
            used <= width
        });
        let count = fitting.count().max(1);
        let (block, others) = rest.split_at(count);
        rest = others;
        let mut grid = Grid::default();
        for (row, head) in heads.iter().enumerate() {
            let cells = block.iter().map(|column| &column[row]);
            let cells = std::iter::once(head).chain(cells);
            let is_title = row == 0;
            grid.row(cells.map(|cell| {
                let tone = is_title && !cell.is_empty();
                if tone {
                    toned(cell, Tone::Heading, colour)
                } else {
                    cell.clone()
                }
            }));
        }
        text.push('\n');
        text.push_str(&grid.lines(INDENT));
    }
    let legend = "value +- standard error (1 sigma) from the noise of the means alone; theta_xy: \
                  rotation of the input axis of gyro x about case axis y";
    text.push_str(&wrapped(legend, INDENT, width));
    text
}

fn row_heads(sheet: &CalibrationSheet) -> Vec<String> {
    let mut heads = vec!["estimator".to_owned(), String::new()];
    heads.extend(AXES.map(|axis| format!("bias {axis}, deg/h")));
    heads.extend(AXES.map(|axis| format!("scale factor error {axis}, ppm")));
    heads.extend(THETAS.map(|theta| format!("theta_{theta}, arcsec")));
    let has_coefficient = |estimate: &CalibrationEstimate| estimate.bias_deg_per_h_per_k.is_some();
    if sheet.estimates.iter().any(has_coefficient) {
        heads.extend(AXES.map(|axis| format!("bias {axis}, deg/h/K")));
    }
    heads.push("at temperature, C".to_owned());
    heads.extend(AXES.map(|axis| format!("residual rms {axis}, deg/h")));
    heads.push("reduced chi-square x, y, z".to_owned());
    heads.push("condition number".to_owned());
    if sheet.estimates.iter().any(|it| it.rounding.is_some()) {
        heads.push("lost to rounding".to_owned());
    }
    if sheet.truth.is_some() {
        heads.push("true error, bias, deg/h rms".to_owned());
        heads.push("true error, scale factor, ppm rms".to_owned());
        heads.push("true error, theta, arcsec rms".to_owned());
        heads.push("normalised error squared (12)".to_owned());
    }
    heads
}

fn column(sheet: &CalibrationSheet, estimate: &CalibrationEstimate) -> Vec<String> {
    let applied = if estimate.name == sheet.applied {
        "applied"
    } else {
        ""
    };
    let mut cells = vec![estimate.name.clone(), applied.to_owned()];
    cells.extend(parameter_cells(
        &estimate.parameters,
        &estimate.standard_error,
    ));
    let mut others = sheet.estimates.iter();
    if others.any(|other| other.bias_deg_per_h_per_k.is_some()) {
        cells.extend((0..3).map(|axis| {
            estimate
                .bias_deg_per_h_per_k
                .map_or_else(nothing, |it| cell(it.value[axis], it.standard_error[axis]))
        }));
    }
    cells.push(three(estimate.reference_temperature_c, 2));
    let residuals = estimate.residual_rms_deg_per_h;
    cells.extend(residuals.map(|rms| format!("{rms:.4}")));
    let misfit = estimate.reduced_chi_square;
    let misfit = misfit.map(|value| value.map_or_else(nothing, |it| format!("{it:.2}")));
    cells.push(misfit.join(", "));
    cells.push(three(estimate.condition_number, 1));
    if sheet.estimates.iter().any(|it| it.rounding.is_some()) {
        cells.push(estimate.rounding.map_or_else(nothing, |loss| {
            format!(
                "{:.1e} deg/h, {:.1e} ppm",
                loss.bias_deg_per_h, loss.sensitivity_ppm
            )
        }));
    }
    if sheet.truth.is_some() {
        let error = estimate.error.as_ref();
        let of = |value: Option<f64>| value.map_or_else(nothing, |it| format!("{it:.4}"));
        cells.push(of(error.map(|it| it.bias_rms_deg_per_h)));
        cells.push(of(error.map(|it| it.scale_factor_rms_ppm)));
        cells.push(of(error.map(|it| it.misalignment_rms_arcsec)));
        let squared = error.and_then(|it| it.normalised_error_squared);
        cells.push(squared.map_or_else(nothing, |it| format!("{it:.1}")));
    }
    cells
}

fn nothing() -> String {
    "-".to_owned()
}

fn parameter_cells(values: &AssemblyParameters, errors: &AssemblyParameters) -> Vec<String> {
    let pairs = |values: &[f64], errors: &[f64]| -> Vec<String> {
        let pairs = values.iter().zip(errors);
        pairs.map(|(value, error)| cell(*value, *error)).collect()
    };
    [
        pairs(&values.bias_deg_per_h, &errors.bias_deg_per_h),
        pairs(
            &values.scale_factor_error_ppm,
            &errors.scale_factor_error_ppm,
        ),
        pairs(&values.theta_arcsec, &errors.theta_arcsec),
    ]
    .concat()
}

/// A value with its standard error in two digits; six decimals where there is no error.
fn cell(value: f64, error: f64) -> String {
    if !(error > 0.0 && error.is_finite()) {
        return format!("{value:.6}");
    }
    let decimals = [6, 5, 4, 3, 2, 1];
    let limits = [1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0];
    let found = limits.iter().position(|limit| error < *limit);
    let decimals = found.map_or(0, |index| decimals[index]);
    format!("{value:.decimals$} +- {error:.decimals$}")
}

fn groups_text(sheet: &CalibrationSheet, colour: bool) -> String {
    let Some(applied) = sheet.applied_estimate() else {
        return String::new();
    };
    let mut grid = Grid::default();
    let titles = ["group", "residual x, y, z, deg/h", "weight x, y, z"];
    grid.row(titles.map(|title| toned(title, Tone::Heading, colour)));
    for index in 0..sheet.groups.len() {
        let rest = applied.residual_deg_per_h[index].map(signed);
        let weight = applied.weights[index];
        grid.row([(index + 1).to_string(), rest.join("  "), three(weight, 3)]);
    }
    format!("\n{}", grid.lines(INDENT))
}

fn compensation_text(sheet: &CalibrationSheet, width: usize) -> String {
    let speed = |index: &usize| {
        let rates = sheet.groups[*index].reference_rate_deg_per_s;
        rates.iter().map(|rate| rate * rate).sum::<f64>()
    };
    let fastest = (0..sheet.groups.len()).max_by(|a, b| speed(a).total_cmp(&speed(b)));
    let Some(fastest) = fastest else {
        return String::new();
    };
    let forms = sheet.compensation.iter().map(|check| {
        let left = check.residual_deg_per_h[fastest].map(signed);
        format!("{} leaves ({}) deg/h", check.form, left.join(", "))
    });
    let forms: Vec<String> = forms.collect();
    let line = format!(
        "compensation with {} at the fastest group ({}): {}",
        sheet.applied,
        fastest + 1,
        forms.join("; ")
    );
    format!("\n{}", wrapped(&line, INDENT, width))
}

/// A residual with its sign, zero without one.
fn signed(value: f64) -> String {
    let text = format!("{value:+.4}");
    if text
        .trim_start_matches(['+', '-'])
        .chars()
        .all(|c| "0.".contains(c))
    {
        text.trim_start_matches(['+', '-']).to_owned()
    } else {
        text
    }
}
