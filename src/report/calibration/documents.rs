//! A calibration as JSON, as the parameters that another run applies, and as a table of groups.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use crate::report::layout::json::SCHEMA;
use crate::report::layout::json::{array as numbers_of, numbers, object, put, put_array};
use crate::signal::{
    AssemblyParameters, CalibrationEstimate, CalibrationGroup, CalibrationPlan, CalibrationSheet,
};

/// Case axes in order.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// Misalignments in the order of [`AssemblyParameters::theta_arcsec`].
pub(crate) const THETAS: [&str; 6] = ["xy", "xz", "yx", "yz", "zx", "zy"];

/// Where a `calibration.toml` comes from.
#[derive(Clone, Debug)]
pub struct CalibrationProvenance<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the scenario or groups file, without its folder.
    pub file: &'a str,
    /// Digest of the resolved scenario or of the groups file, hexadecimal.
    pub digest: &'a str,
}

/// The text of `calibration.toml`: `[compensation]` with the applied parameters under the keys that
/// a scenario applies them by, their covariance, and where they come from.
#[must_use]
pub(in crate::report) fn calibration_toml(
    sheet: &CalibrationSheet,
    provenance: &CalibrationProvenance,
) -> String {
    let mut text = format!("schema = {SCHEMA}\n");
    let Some(applied) = sheet.applied_estimate() else {
        return text;
    };
    let parameters = &applied.parameters;
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "\n[compensation]\nbias_deg_per_h = {}\nscale_factor_error_ppm = {}",
        array(&parameters.bias_deg_per_h),
        array(&parameters.scale_factor_error_ppm)
    );
    for (name, theta) in THETAS.iter().zip(parameters.theta_arcsec) {
        let _ = writeln!(text, "theta_{name}_arcsec = {theta:?}");
    }
    let slope = applied
        .bias_deg_per_h_per_k
        .map_or([0.0; 3], |slope| slope.value);
    let _ = writeln!(
        text,
        "reference_temperature_c = {}\nbias_deg_per_h_per_k = {}",
        array(&applied.reference_temperature_c),
        array(&slope)
    );
    text.push_str(
        "\n# Of x1..x12, the rows of [I + K_G + theta_G | B_G] of patent CN101221046, equation (8): ratios\n\
         # and rad, but x4, x8 and x12 in deg/s. From the measurement noise alone.\n[covariance]\nmatrix = [\n",
    );
    for row in &applied.covariance {
        let _ = writeln!(text, "  {},", array(row));
    }
    let plan = &sheet.plan;
    let _ = writeln!(
        text,
        "]\n\n[provenance]\ntool = \"fogbench {}\"\nestimator = {}\nfile = {}\ndigest = {}\n\
         groups = {}\nrank = {}\ncondition_number = {}",
        provenance.tool_version,
        quoted(&sheet.applied),
        quoted(provenance.file),
        quoted(provenance.digest),
        plan.groups,
        plan.rank,
        array(&plan.condition_number)
    );
    text
}

/// A basic string of TOML; JSON escapes the same characters in the same way.
pub(crate) fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn array(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    format!("[{}]", values.join(", "))
}

/// The groups as CSV, in the form that `fogbench calibrate` reads; names hold the units.
#[must_use]
pub(in crate::report) fn groups_csv(groups: &[CalibrationGroup]) -> String {
    let has_start = groups.iter().all(|group| group.start_s.is_some());
    let mut heads = vec![
        "group".to_owned(),
        "mounting".to_owned(),
        "rate_deg_per_s".to_owned(),
    ];
    for (stem, unit) in [
        ("reference", "_deg_per_s"),
        ("temperature", "_c"),
        ("temperature_rate", "_k_per_min"),
        ("output", "_deg_per_h"),
        ("standard_error", "_deg_per_h"),
        ("rejected", ""),
    ] {
        heads.extend(AXES.map(|axis| format!("{stem}_{axis}{unit}")));
    }
    heads.extend(["averaging_time_s".to_owned(), "samples".to_owned()]);
    if has_start {
        heads.push("start_s".to_owned());
    }
    let mut text = heads.join(",");
    text.push('\n');
    for (index, group) in groups.iter().enumerate() {
        let mut cells = vec![
            (index + 1).to_string(),
            AXES[group.mounting % 3].to_owned(),
            format!("{:?}", group.rate_deg_per_s),
        ];
        for values in [
            &group.reference_rate_deg_per_s,
            &group.temperature_c,
            &group.temperature_rate_k_per_min,
            &group.output_deg_per_h,
            &group.standard_error_deg_per_h,
        ] {
            cells.extend(values.iter().map(|value| format!("{value:?}")));
        }
        cells.extend(group.rejected.iter().map(ToString::to_string));
        cells.push(format!("{:?}", group.averaging_time_s));
        cells.push(group.samples.to_string());
        if has_start {
            cells.extend(group.start_s.map(|start_s| format!("{start_s:?}")));
        }
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// The record `calibration` of `summary.json`, and what `fogbench calibrate --format json` prints.
#[must_use]
pub fn calibration_json(sheet: &CalibrationSheet) -> Value {
    let mut root = object([
        ("plan", plan(&sheet.plan)),
        ("groups", sheet.groups.iter().map(group).collect()),
        ("applied", sheet.applied.as_str().into()),
    ]);
    if let Some(with_temperature) = &sheet.plan_with_temperature {
        root.insert("plan_with_temperature".to_owned(), plan(with_temperature));
    }
    let estimates = sheet.estimates.iter();
    let estimates: Map<String, Value> = estimates
        .map(|found| (found.name.clone(), estimate(found)))
        .collect();
    root.insert("estimates".to_owned(), estimates.into());
    let forms = sheet.compensation.iter().map(|check| {
        let mut record = numbers([("residual_max_deg_per_h", check.residual_max_deg_per_h)]);
        put(
            &mut record,
            "error_max_deg_per_h",
            check.error_max_deg_per_h,
        );
        put_rows(&mut record, "residual_deg_per_h", &check.residual_deg_per_h);
        (check.form.to_owned(), record.into())
    });
    let forms: Map<String, Value> = forms.collect();
    root.insert("compensation".to_owned(), forms.into());
    if let Some(truth) = &sheet.truth {
        let mut record = parameters(&truth.parameters);
        let slopes = &truth.bias_deg_per_h_per_k;
        put_array(&mut record, "bias_deg_per_h_per_k", slopes);
        let reference_c = truth.reference_temperature_c;
        put(&mut record, "reference_temperature_c", reference_c);
        root.insert("truth".to_owned(), record.into());
    }
    let ranking = sheet.ranking.iter().map(|rank| {
        let mut record = object([
            ("estimator", rank.name.as_str().into()),
            ("campaigns", rank.campaigns.into()),
        ]);
        record.extend(numbers([
            ("bias_rms_deg_per_h", rank.bias_rms_deg_per_h),
            ("scale_factor_rms_ppm", rank.scale_factor_rms_ppm),
            ("misalignment_rms_arcsec", rank.misalignment_rms_arcsec),
        ]));
        put(
            &mut record,
            "normalised_error_squared",
            rank.normalised_error_squared,
        );
        Value::from(record)
    });
    let ranking: Vec<Value> = ranking.collect();
    if !ranking.is_empty() {
        root.insert("ranking".to_owned(), ranking.into());
    }
    root.insert("warnings".to_owned(), sheet.warnings.clone().into());
    root.into()
}

fn plan(plan: &CalibrationPlan) -> Value {
    let mut record = object([("groups", plan.groups.into()), ("rank", plan.rank.into())]);
    for (key, values) in [
        ("condition_number", &plan.condition_number[..]),
        ("singular_values", &plan.singular_values),
        (
            "scale_factor_ppm_per_deg_per_h",
            &plan.scale_factor_ppm_per_deg_per_h,
        ),
        ("bias_per_standard_error", &plan.bias_per_standard_error),
        (
            "scale_factor_bias_correlation",
            &plan.scale_factor_bias_correlation,
        ),
    ] {
        put_array(&mut record, key, values);
    }
    record.into()
}

fn group(group: &CalibrationGroup) -> Value {
    let mut record = object([("mounting", AXES[group.mounting % 3].into())]);
    put(&mut record, "rate_deg_per_s", group.rate_deg_per_s);
    for (key, values) in [
        ("reference_rate_deg_per_s", &group.reference_rate_deg_per_s),
        ("temperature_c", &group.temperature_c),
        (
            "temperature_rate_k_per_min",
            &group.temperature_rate_k_per_min,
        ),
        ("output_deg_per_h", &group.output_deg_per_h),
        ("standard_error_deg_per_h", &group.standard_error_deg_per_h),
    ] {
        put_array(&mut record, key, values);
    }
    put(&mut record, "averaging_time_s", group.averaging_time_s);
    record.extend(object([
        ("samples", group.samples.into()),
        ("rejected", group.rejected.to_vec().into()),
    ]));
    put(&mut record, "start_s", group.start_s);
    put(&mut record, "turns", group.turns);
    record.into()
}

fn parameters(parameters: &AssemblyParameters) -> Map<String, Value> {
    let mut record = Map::new();
    put_array(&mut record, "bias_deg_per_h", &parameters.bias_deg_per_h);
    let scale_errors = &parameters.scale_factor_error_ppm;
    put_array(&mut record, "scale_factor_error_ppm", scale_errors);
    for (name, theta) in THETAS.iter().zip(parameters.theta_arcsec) {
        put(&mut record, &format!("theta_{name}_arcsec"), theta);
    }
    record
}

fn estimate(found: &CalibrationEstimate) -> Value {
    let mut record = object([
        ("parameters", parameters(&found.parameters).into()),
        ("standard_error", parameters(&found.standard_error).into()),
    ]);
    for (key, values) in [
        ("reference_temperature_c", &found.reference_temperature_c),
        ("condition_number", &found.condition_number),
        ("residual_rms_deg_per_h", &found.residual_rms_deg_per_h),
    ] {
        put_array(&mut record, key, values);
    }
    put_rows(&mut record, "weights", &found.weights);
    put_rows(&mut record, "residual_deg_per_h", &found.residual_deg_per_h);
    for (key, fitted) in [
        ("bias_deg_per_h_per_k", &found.bias_deg_per_h_per_k),
        ("delay_ms", &found.delay_ms),
    ] {
        let Some(fitted) = fitted else { continue };
        let mut both = Map::new();
        put_array(&mut both, "value", &fitted.value);
        put_array(&mut both, "standard_error", &fitted.standard_error);
        record.insert(key.to_owned(), both.into());
    }
    if let Some(rejected) = &found.rejected_samples {
        record.insert("rejected_samples".to_owned(), rejected.to_vec().into());
    }
    let misfit: Option<Vec<f64>> = found.reduced_chi_square.iter().copied().collect();
    if let Some(misfit) = misfit {
        put_array(&mut record, "reduced_chi_square", &misfit);
    }
    if let Some(rounding) = &found.rounding {
        let rounding = numbers([
            ("bias_deg_per_h", rounding.bias_deg_per_h),
            ("sensitivity_ppm", rounding.sensitivity_ppm),
        ]);
        record.insert("rounding".to_owned(), rounding.into());
    }
    if let Some(error) = &found.error {
        let mut errors = parameters(&error.parameters);
        for (key, value) in [
            ("bias_rms_deg_per_h", error.bias_rms_deg_per_h),
            ("scale_factor_rms_ppm", error.scale_factor_rms_ppm),
            ("misalignment_rms_arcsec", error.misalignment_rms_arcsec),
            (
                "compensated_rate_max_deg_per_h",
                error.compensated_rate_max_deg_per_h,
            ),
        ] {
            put(&mut errors, key, value);
        }
        let normalised = error.normalised_error_squared;
        put(&mut errors, "normalised_error_squared", normalised);
        record.insert("error".to_owned(), errors.into());
    }
    record.into()
}

/// Enters one row of three numbers for each group, if all of them are numbers.
fn put_rows(record: &mut Map<String, Value>, key: &str, rows: &[[f64; 3]]) {
    let rows: Option<Vec<Value>> = rows.iter().map(numbers_of).collect();
    if let Some(rows) = rows {
        record.insert(key.to_owned(), rows.into());
    }
}
