//! A calibration for people.

use crate::report::calibration::documents::{AXES, THETAS};
use crate::report::layout::text::{Grid, Tone, toned, wrapped};
use crate::signal::{
    AssemblyParameters, CalibrationEstimate, CalibrationGroup, CalibrationPlan, CalibrationSheet,
};
use crate::wording::counted;

const INDENT: &str = "  ";

/// Plan, groups, estimators side by side, the applied parameters, both forms of compensation and the
/// ranking over repeated campaigns.
#[must_use]
pub fn calibration_text(sheet: &CalibrationSheet, width: usize, colour: bool) -> String {
    let mut text = String::from("\n");
    text.push_str(&plan_line("calibration plan", &sheet.plan, width));
    if let Some(plan) = &sheet.plan_with_temperature {
        text.push_str(&plan_line("with a coefficient of temperature", plan, width));
    }
    text.push_str(&section(groups(sheet, colour)));
    text.push_str(&section(estimators(sheet, colour)));
    text.push_str(&section(applied(sheet, colour)));
    text.push_str(&weights(sheet, width));
    text.push_str(&compensation(sheet, width));
    if !sheet.ranking.is_empty() {
        text.push_str(&section(ranking(sheet, colour)));
    }
    for warning in &sheet.warnings {
        let warning = format!("{} {warning}", toned("note:", Tone::Doubt, colour));
        text.push_str(&wrapped(&warning, INDENT, width));
    }
    text
}

fn section(grid: Grid) -> String {
    format!("\n{}", grid.lines(INDENT))
}

fn heads<const N: usize>(grid: &mut Grid, heads: [&str; N], colour: bool) {
    grid.row(heads.map(|head| toned(head, Tone::Heading, colour)));
}

fn plan_line(name: &str, plan: &CalibrationPlan, width: usize) -> String {
    let line = format!(
        "{name}: {}, rank {}, condition number {}; per deg/h of a mean's standard error {} deg/h \
         of bias and {} ppm of scale factor, correlation {} (x, y, z)",
        counted(plan.groups, "group"),
        plan.rank,
        triple(&plan.condition_number, 1),
        triple(&plan.bias_per_standard_error, 3),
        triple(&plan.scale_factor_ppm_per_deg_per_h, 2),
        triple(&plan.scale_factor_bias_correlation, 3),
    );
    wrapped(&line, INDENT, width)
}

fn triple(values: &[f64; 3], decimals: usize) -> String {
    let [x, y, z] = values.map(|value| format!("{value:.decimals$}"));
    if x == y && y == z {
        x
    } else {
        format!("{x}, {y}, {z}")
    }
}

fn groups(sheet: &CalibrationSheet, colour: bool) -> Grid {
    let mut grid = Grid::default();
    heads(
        &mut grid,
        [
            "group", "axis", "deg/s", "averaged", "C", "x, deg/h", "y, deg/h", "z, deg/h",
            "rejected",
        ],
        colour,
    );
    for (index, group) in sheet.groups.iter().enumerate() {
        let means = group
            .output_deg_per_h
            .iter()
            .zip(&group.standard_error_deg_per_h);
        let means = means.map(|(mean, error)| format!("{mean:.3} ±{error:.3}"));
        let mut cells = vec![
            (index + 1).to_string(),
            AXES[group.mounting % 3].to_owned(),
            format!("{}", group.rate_deg_per_s),
            averaged(group),
            triple(&group.temperature_c, 3),
        ];
        cells.extend(means);
        let [x, y, z] = group.rejected;
        cells.push(format!("{x}, {y}, {z}"));
        grid.row(cells);
    }
    grid
}

/// Time and turns averaged over, as far as they are known.
fn averaged(group: &CalibrationGroup) -> String {
    if group.averaging_time_s <= 0.0 {
        return "-".to_owned();
    }
    let turns = group.turns;
    let turns = turns.map_or_else(String::new, |turns| format!(", {turns:.0} turns"));
    format!("{:.1} s{turns}", group.averaging_time_s)
}

/// One row for each estimator: biases and scale factors, or their errors where the truth is known.
fn estimators(sheet: &CalibrationSheet, colour: bool) -> Grid {
    let mut grid = Grid::default();
    let is_known = sheet.truth.is_some();
    let (bias, scale) = if is_known {
        ("bias error x, y, z, deg/h", "scale error, ppm")
    } else {
        ("bias x, y, z, deg/h", "scale factor, ppm")
    };
    let titles = [
        "estimator",
        bias,
        scale,
        "bias ±1 sigma",
        "residual rms, deg/h",
        "condition",
        if is_known { "NEES of 12" } else { "" },
        "rounding, deg/h",
    ];
    heads(&mut grid, titles, colour);
    for found in &sheet.estimates {
        let mark = if found.name == sheet.applied { "*" } else { "" };
        let shown = found
            .error
            .as_ref()
            .map_or(&found.parameters, |error| &error.parameters);
        let normalised = found.error.and_then(|error| error.normalised_error_squared);
        grid.row([
            format!("{}{mark}", found.name),
            triple(&shown.bias_deg_per_h, 3),
            triple(&shown.scale_factor_error_ppm, 2),
            triple(&found.standard_error.bias_deg_per_h, 3),
            triple(&found.residual_rms_deg_per_h, 3),
            triple(&found.condition_number, 1),
            normalised.map_or_else(String::new, |value| format!("{value:.1}")),
            found
                .rounding
                .map_or_else(String::new, |loss| format!("{:.1e}", loss.bias_deg_per_h)),
        ]);
    }
    grid
}

/// The twelve parameters of the applied estimate, with the truth where it is known.
fn applied(sheet: &CalibrationSheet, colour: bool) -> Grid {
    let mut grid = Grid::default();
    let Some(found) = sheet.applied_estimate() else {
        return grid;
    };
    let title = format!("{} (applied)", found.name);
    heads(
        &mut grid,
        [&title, "unit", "estimate", "±1 sigma", "truth", "weights"],
        colour,
    );
    let values = rows(&found.parameters);
    let errors = rows(&found.standard_error);
    let truths = sheet.truth.as_ref().map(|truth| rows(&truth.parameters));
    for (index, (name, unit, value)) in values.iter().enumerate() {
        let truth = truths.as_ref().map(|rows| rows[index].2);
        grid.row([
            name.clone(),
            (*unit).to_owned(),
            format!("{value:.4}"),
            format!("{:.4}", errors[index].2),
            truth.map_or_else(String::new, |truth| format!("{truth:.4}")),
        ]);
    }
    slopes(sheet, found, &mut grid);
    delays(found, &mut grid);
    grid
}

/// How much later than the encoder each gyro answers, and the samples left out for it, where samples tell.
fn delays(found: &CalibrationEstimate, grid: &mut Grid) {
    if let Some(delay) = &found.delay_ms {
        for (axis, name) in AXES.iter().enumerate() {
            grid.row([
                format!("delay {name}"),
                "ms".to_owned(),
                format!("{:.4}", delay.value[axis]),
                format!("{:.4}", delay.standard_error[axis]),
            ]);
        }
    }
    if let Some(rejected) = &found.rejected_samples {
        for (name, count) in AXES.iter().zip(rejected) {
            grid.row([
                format!("rejected {name}"),
                "samples".to_owned(),
                count.to_string(),
            ]);
        }
    }
}

fn slopes(sheet: &CalibrationSheet, found: &CalibrationEstimate, grid: &mut Grid) {
    let Some(slope) = &found.bias_deg_per_h_per_k else {
        return;
    };
    for (axis, name) in AXES.iter().enumerate() {
        let truth = sheet.truth.as_ref();
        let truth = truth.map(|truth| truth.bias_deg_per_h_per_k[axis]);
        grid.row([
            format!("bias {name} per K"),
            "deg/h/K".to_owned(),
            format!("{:.4}", slope.value[axis]),
            format!("{:.4}", slope.standard_error[axis]),
            truth.map_or_else(String::new, |truth| format!("{truth:.4}")),
        ]);
    }
}

/// Name, unit and value of the twelve parameters.
fn rows(parameters: &AssemblyParameters) -> Vec<(String, &'static str, f64)> {
    let axes = AXES.iter();
    let biases = axes.clone().zip(parameters.bias_deg_per_h);
    let scales = axes.zip(parameters.scale_factor_error_ppm);
    let thetas = THETAS.iter().zip(parameters.theta_arcsec);
    biases
        .map(|(axis, value)| (format!("bias {axis}"), "deg/h", value))
        .chain(scales.map(|(axis, value)| (format!("scale factor error {axis}"), "ppm", value)))
        .chain(thetas.map(|(name, value)| (format!("theta {name}"), "arcsec", value)))
        .collect()
}

/// How much each group counts in the applied estimate.
fn weights(sheet: &CalibrationSheet, width: usize) -> String {
    let groups = sheet.applied_estimate().map(|found| &found.weights);
    let groups: Vec<String> = groups
        .into_iter()
        .flatten()
        .map(|group| triple(group, 3).replace(", ", "/"))
        .collect();
    let line = format!("weights of the groups: {}", groups.join(", "));
    format!("\n{}", wrapped(&line, INDENT, width))
}

fn compensation(sheet: &CalibrationSheet, width: usize) -> String {
    let mut text = String::new();
    for check in &sheet.compensation {
        let mut line = format!(
            "compensation, {} form: leaves up to {:.4} deg/h at the rates of the plan",
            check.form, check.residual_max_deg_per_h
        );
        if let Some(error) = check.error_max_deg_per_h {
            line.push_str(&format!(
                "; {error:.4} deg/h with the errors of the applied parameters"
            ));
        }
        text.push_str(&wrapped(&line, INDENT, width));
    }
    text
}

fn ranking(sheet: &CalibrationSheet, colour: bool) -> Grid {
    let mut grid = Grid::default();
    let campaigns = sheet.ranking.first().map_or(0, |rank| rank.campaigns);
    let title = format!("rms over {campaigns} campaigns");
    let titles = [
        &title,
        "bias, deg/h",
        "scale factor, ppm",
        "misalignment, arcsec",
        "NEES of 12",
    ];
    heads(&mut grid, titles, colour);
    for rank in &sheet.ranking {
        grid.row([
            rank.name.clone(),
            format!("{:.4}", rank.bias_rms_deg_per_h),
            format!("{:.3}", rank.scale_factor_rms_ppm),
            format!("{:.4}", rank.misalignment_rms_arcsec),
            rank.normalised_error_squared
                .map_or_else(String::new, |value| format!("{value:.1}")),
        ]);
    }
    grid
}
