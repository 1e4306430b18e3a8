//! `calibrate` through the program: known answers, what it refuses, and files that are read again.

use std::fmt::Write as _;
use std::path::Path;

use fogbench::units::{deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h};
use serde_json::Value;

use crate::support::patent_cases::{NINE, WARM_UP_C, rates, truth};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

const AXES: [&str; 3] = ["x", "y", "z"];
const HEADING: &str = "group,mounting,rate_deg_per_s,temperature_c,output_x_deg_per_s,\
                       output_y_deg_per_s,output_z_deg_per_s";
const LATITUDE: [&str; 2] = ["--latitude-deg", "32.03"];
/// Drift of the worked example, deg/h/K about 40 deg C.
const DRIFT_DEG_PER_H_PER_K: [f64; 3] = [0.10, -0.08, 0.12];

/// A line of a groups file before it is written.
#[derive(Clone)]
struct Line {
    name: String,
    mounting: &'static str,
    rate: f64,
    temperature_c: f64,
    outputs: [f64; 3],
}

/// The nine groups of the worked example without noise.
fn nine(drift_deg_per_h_per_k: [f64; 3]) -> Vec<Line> {
    let groups = NINE.iter().zip(WARM_UP_C).enumerate();
    let lines = groups.map(|(index, (group, temperature_c))| {
        let mut outputs = truth().predict(rates(*group));
        for (output, drift) in outputs.iter_mut().zip(drift_deg_per_h_per_k) {
            *output += deg_per_h_to_deg_per_s(drift * (temperature_c - 40.0));
        }
        Line {
            name: (index + 1).to_string(),
            mounting: AXES[group.0],
            rate: group.1,
            temperature_c,
            outputs,
        }
    });
    lines.collect()
}

fn text(heading: &str, lines: &[Line]) -> String {
    let mut text = format!("# group means of a worked example\n{heading}\n");
    for line in lines {
        let [x, y, z] = line.outputs;
        let (name, mounting) = (&line.name, line.mounting);
        let (rate, temperature_c) = (line.rate, line.temperature_c);
        let _ = writeln!(
            text,
            "{name},{mounting},{rate},{temperature_c},{x:?},{y:?},{z:?}"
        );
    }
    text
}

fn calibrate(folder: &Path, csv: &str, more: &[&str]) -> std::process::Output {
    write(folder, "groups.csv", csv);
    let mut arguments = vec!["calibrate", "groups.csv"];
    arguments.extend(more);
    fogbench(folder, &arguments)
}

/// The calibration of a groups file as JSON.
#[track_caller]
fn calibrated(csv: &str, more: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let arguments = [&LATITUDE, more, &["--format", "json"]].concat();
    let output = calibrate(folder.path(), csv, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// The complaints about a groups file, which must be refused.
#[track_caller]
fn refused(csv: &str) -> String {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let output = calibrate(folder.path(), csv, &LATITUDE);
    assert_eq!(code(&output), 2, "{}", stdout(&output));
    assert!(stdout(&output).is_empty());
    stderr(&output)
}

/// What a groups file is calibrated with, but for what is worth saying.
#[track_caller]
fn notes(csv: &str) -> Vec<String> {
    let report = calibrated(csv, &[]);
    let notes = report["notes"].as_array().cloned().unwrap_or_default();
    let notes = notes.iter().filter_map(Value::as_str);
    // The file of every test but one gives none; see the test of that note.
    let others = notes.filter(|note| !note.starts_with(NO_ERRORS));
    others.map(str::to_owned).collect()
}

/// How the note on a file without standard errors begins.
const NO_ERRORS: &str = "the file gives no standard errors";

#[track_caller]
fn three(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|axis: usize| value[axis].as_f64().expect("a number"))
}

/// Asserts biases (deg/h) and errors of the scale factors (ppm) as a table has them.
#[track_caller]
fn assert_row(report: &Value, estimator: &str, biases: [f64; 3], errors_ppm: [f64; 3]) {
    let found = &report["calibration"]["estimates"][estimator]["parameters"];
    let pairs = three(&found["bias_deg_per_h"]).into_iter().zip(biases);
    for (got, want) in pairs {
        // The temperatures are printed to 1 mK, which moves the last digit of weighted answers.
        assert_close(got, want, 0.0, 2e-6);
    }
    let scales = three(&found["scale_factor_error_ppm"]);
    for (axis, want) in errors_ppm.into_iter().enumerate() {
        let true_ppm = truth().scale_error[axis] * 1e6;
        assert_close(scales[axis] - true_ppm, want, 0.0, 0.6e-4);
    }
}

#[test]
fn a_groups_file_without_drift_gives_back_the_twelve_parameters() {
    let report = calibrated(&text(HEADING, &nine([0.0; 3])), &["--estimator", "batch"]);
    assert_row(&report, "batch", [1.0, -2.0, 1.5], [0.0; 3]);
    let found = &report["calibration"]["estimates"]["batch"]["parameters"];
    for (name, milliradians) in [
        ("xy", 1.0),
        ("xz", -0.8),
        ("yx", 0.6),
        ("yz", 1.2),
        ("zx", -0.9),
        ("zy", 0.5),
    ] {
        let got = found[format!("theta_{name}_arcsec")].as_f64();
        let want = (milliradians * 1e-3_f64).to_degrees() * 3600.0;
        assert_close(got.expect("a number"), want, 0.0, 1e-6);
    }
    let plan = &report["calibration"]["plan"];
    assert_eq!(plan["rank"], 4);
    assert_close(three(&plan["condition_number"])[0], 63.1, 0.0, 0.051);
}

#[test]
fn a_groups_file_of_a_warm_up_gives_the_known_answers_of_every_estimator() {
    let csv = text(HEADING, &nine(DRIFT_DEG_PER_H_PER_K));
    let report = calibrated(&csv, &[]);
    let batch = [0.190_319, -1.352_256, 0.528_383];
    assert_row(&report, "batch", batch, [-0.7272, -1.6477, 3.4137]);
    let patent = [0.843_219, -1.874_576, 1.311_863];
    assert_row(&report, "arls", patent, [-2.0673, 0.2476, 0.3573]);
    // At 40 deg C the biases with a temperature coefficient are the true ones.
    for estimator in ["batch-temperature", "arls-temperature"] {
        let found = &report["calibration"]["estimates"][estimator];
        let coefficients = three(&found["bias_deg_per_h_per_k"]["value"]);
        let reference_c = three(&found["reference_temperature_c"]);
        let biases = three(&found["parameters"]["bias_deg_per_h"]);
        for axis in 0..3 {
            assert_close(coefficients[axis], DRIFT_DEG_PER_H_PER_K[axis], 0.0, 1e-7);
            let warm = biases[axis] + coefficients[axis] * (40.0 - reference_c[axis]);
            assert_close(warm, [1.0, -2.0, 1.5][axis], 0.0, 1e-6);
        }
    }
    let options = ["--estimator", "arls", "--forgetting-constant-per-k", "0.1"];
    let exponential = calibrated(&csv, &options);
    let biases = [0.528_353, -1.622_682, 0.934_023];
    assert_row(&exponential, "arls", biases, [-1.7082, -0.5956, 1.8236]);
    let linear = calibrated(
        &csv,
        &[&options[..], &["--forgetting-form", "linear"]].concat(),
    );
    let biases = [0.575_587, -1.660_469, 0.990_704];
    assert_row(&linear, "arls", biases, [-1.8074, -0.4521, 1.6042]);
}

#[test]
fn the_printed_tables_show_plan_estimators_residuals_and_both_compensations() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let csv = text(HEADING, &nine(DRIFT_DEG_PER_H_PER_K));
    let output = calibrate(folder.path(), &csv, &LATITUDE);
    let printed = stdout(&output);
    for part in [
        "groups.csv  calibration, 9 groups, latitude 32.03 deg",
        "rank 4, condition number 63.1",
        "correlation -0.662",
        "bias x, deg/h",
        "0.843219",
        "theta_zy, arcsec",
        "residual x, y, z, deg/h",
        "compensation with arls-temperature at the fastest group (9): exact leaves (0.0000, 0.0000, 0.0000)",
    ] {
        let flat: Vec<&str> = printed.split_whitespace().collect();
        let wanted: Vec<&str> = part.split_whitespace().collect();
        let is_there = flat.windows(wanted.len()).any(|words| words == wanted);
        assert!(is_there || printed.contains(part), "{part}\n{printed}");
    }
}

#[test]
fn written_groups_are_read_again_to_the_same_parameters() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let csv = text(HEADING, &nine(DRIFT_DEG_PER_H_PER_K));
    let output = calibrate(
        folder.path(),
        &csv,
        &[&LATITUDE[..], &["-o", "first"]].concat(),
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let again = ["calibrate", "first/groups.csv", "-o", "second"];
    let output = fogbench(folder.path(), &again);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let read = |name: &str| -> toml::Table {
        let path = folder.path().join(name).join("calibration.toml");
        let text = std::fs::read_to_string(path).expect("a calibration");
        text.parse().expect("TOML")
    };
    let (first, second) = (read("first"), read("second"));
    assert_eq!(first["compensation"], second["compensation"]);
    assert_eq!(first["covariance"], second["covariance"]);
    let provenance = &first["provenance"];
    assert_eq!(provenance["file"].as_str(), Some("groups.csv"));
    assert_eq!(provenance["estimator"].as_str(), Some("arls-temperature"));
    let digest = blake3::hash(csv.as_bytes()).to_hex().to_string();
    assert_eq!(provenance["digest"].as_str(), Some(digest.as_str()));
}

#[test]
fn a_missing_mounting_a_reversed_sense_and_swapped_axes_are_named() {
    let lines = nine([0.0; 3]);
    assert_eq!(
        refused(&text(HEADING, &lines[..6])),
        "error: groups.csv: no group turns about z: a mounting is missing\n"
    );
    let reverse = |line: &mut Line| line.outputs = line.outputs.map(|output| -output);
    let mut all = lines.clone();
    all.iter_mut().for_each(reverse);
    assert_eq!(
        refused(&text(HEADING, &all)),
        "error: groups.csv: the sense of rotation is reversed in all groups (scale error near -2)\n"
    );
    let mut one = lines.clone();
    reverse(&mut one[1]);
    assert_eq!(
        refused(&text(HEADING, &one)),
        "error: groups.csv: the sense of rotation is reversed in group 2 (scale error near -2) \
         (line 4)\n"
    );
    // The same is said right if the mounting says that the axis points down.
    let mut down = lines.clone();
    for line in &mut down[3..6] {
        line.mounting = "-y";
    }
    assert_eq!(
        refused(&text(HEADING, &down)),
        "error: groups.csv: the sense of rotation is reversed in the mounting that turns about y \
         (scale error near -2)\n"
    );
    let swapped = HEADING
        .replace("_x_", "_q_")
        .replace("_y_", "_x_")
        .replace("_q_", "_y_");
    assert_eq!(
        refused(&text(&swapped, &lines)),
        "error: groups.csv: gyro y sees the rate stated about x in the mounting that turns about x: \
         axes or mountings are swapped\n\
         error: groups.csv: gyro x sees the rate stated about y in the mounting that turns about y: \
         axes or mountings are swapped\n"
    );
    let mut mislabelled = lines;
    mislabelled[0].mounting = "y";
    assert_eq!(
        refused(&text(HEADING, &mislabelled)),
        "error: groups.csv: gyro x sees the rate stated about y in group 1: axes or mountings are \
         swapped (line 3)\n"
    );
}

#[test]
fn wrong_units_are_named_as_the_headings_have_them() {
    let lines = nine([0.0; 3]);
    let outputs = HEADING.replace("x_deg_per_s", "x_deg_per_h");
    let outputs = outputs.replace("y_deg_per_s", "y_deg_per_h");
    let outputs = outputs.replace("z_deg_per_s", "z_deg_per_h");
    assert_eq!(
        refused(&text(&outputs, &lines)),
        "error: groups.csv: the outputs look like deg/s under headings of deg/h, or the table rates \
         look like deg/h under a heading of deg/s in all groups (ratio 2.7778e-4)\n"
    );
    let mut radians = lines.clone();
    for line in &mut radians {
        line.rate = line.rate.to_radians();
    }
    assert_eq!(
        refused(&text(HEADING, &radians)),
        "error: groups.csv: the table rates look like rad/s under a heading of deg/s in all groups \
         (ratio 5.7296e1)\n"
    );
    let mut hours = lines.clone();
    for line in &mut hours {
        line.rate = deg_per_s_to_deg_per_h(line.rate);
    }
    assert_eq!(
        refused(&text(HEADING, &hours)),
        "error: groups.csv:3: column rate_deg_per_s: 36000 deg/s is out of range: expected -2000 to \
         2000 deg/s (the unit is what the column's name ends with)\n"
    );
    // Said right, the unit makes no difference.
    let report = calibrated(
        &text(&HEADING.replace("rate_deg_per_s", "rate_deg_per_h"), &hours),
        &["--estimator", "batch"],
    );
    assert_row(&report, "batch", [1.0, -2.0, 1.5], [0.0; 3]);
}

#[test]
fn one_rate_or_too_few_groups_are_refused_with_the_missing_motion() {
    let lines = nine([0.0; 3]);
    let one_rate = [lines[1].clone(), lines[4].clone(), lines[7].clone()];
    let mut transcript = Transcript::of("calibrate", "Groups that do not determine the parameters");
    transcript.case(
        "three mountings at one rate",
        refused(&text(HEADING, &one_rate)),
    );
    let mut few = one_rate;
    few[0].rate = 10.0;
    few[0].outputs = truth().predict(rates((0, 10.0)));
    transcript.case("three groups at two rates", refused(&text(HEADING, &few)));
    transcript.check();
}

#[test]
fn a_constant_temperature_leaves_the_coefficient_out_unless_it_is_asked_for() {
    let mut lines = nine([0.0; 3]);
    for line in &mut lines {
        line.temperature_c = 25.0;
    }
    let csv = text(HEADING, &lines);
    let report = calibrated(&csv, &[]);
    assert_eq!(report["calibration"]["applied"], "batch");
    let note = "batch is applied in place of arls-temperature: the groups do not determine a \
                temperature coefficient of the biases";
    assert!(notes(&csv).iter().any(|found| found == note));
    let folder = tempfile::tempdir().expect("a scratch folder");
    let asked = [&LATITUDE[..], &["--estimator", "arls-temperature"]].concat();
    let output = calibrate(folder.path(), &csv, &asked);
    assert_eq!(code(&output), 2);
    let title = "A temperature coefficient of groups at one temperature";
    let mut transcript = Transcript::of("calibrate", title);
    transcript.case("--estimator arls-temperature", stderr(&output));
    transcript.check();
}

#[test]
fn without_standard_errors_those_of_the_parameters_follow_from_the_residuals() {
    // Errors of 0.3 deg/h in the means of x, which no parameter follows; none in y and z.
    let mut lines = nine([0.0; 3]);
    for (index, line) in lines.iter_mut().enumerate() {
        line.outputs[0] += deg_per_h_to_deg_per_s(if index % 2 == 0 { 0.3 } else { -0.3 });
    }
    let report = calibrated(&text(HEADING, &lines), &[]);
    let notes = report["notes"].as_array().expect("notes");
    let told = notes
        .iter()
        .filter_map(Value::as_str)
        .find(|note| note.starts_with(NO_ERRORS));
    let told = told.expect("a note on the standard errors");
    assert!(told.contains("the residuals of batch"), "{told}");
    let applied = report["calibration"]["applied"].as_str().expect("a name");
    let found = &report["calibration"]["estimates"][applied];
    let errors = three(&found["standard_error"]["bias_deg_per_h"]);
    assert!(errors[0] > 0.1 && errors[0] < 1.0, "{errors:?}");
    assert!(errors[1] < 0.02, "{errors:?}");
}

#[test]
fn groups_entered_twice_and_another_order_are_noticed() {
    let lines = nine([0.0; 3]);
    assert!(notes(&text(HEADING, &lines)).is_empty());
    let mut twice = lines.clone();
    twice.push(lines[8].clone());
    assert_eq!(
        refused(&text(HEADING, &twice)),
        "error: groups.csv:12: column group: `9` is the group of line 11 too\n"
    );
    twice[9].name = "10".to_owned();
    assert_eq!(
        notes(&text(HEADING, &twice)),
        ["lines 11 and 12 hold the same rate and outputs: a group entered twice counts twice"]
    );
    let mut turned = lines;
    turned.rotate_left(3);
    assert_eq!(
        notes(&text(HEADING, &turned)),
        [
            "lines 8 and 9 are not in the order of group: forgetting needs the order in which the \
             groups were taken, and takes that of the lines"
        ]
    );
}

#[test]
fn means_over_parts_of_a_turn_are_noticed() {
    let csv = text(HEADING, &nine([0.0; 3]));
    let timed = |time_of: &dyn Fn(&str) -> &'static str| -> String {
        let lines = csv.lines().map(|line| match line.split(',').nth(2) {
            None => format!("{line}\n"),
            Some("rate_deg_per_s") => format!("{line},averaging_time_s\n"),
            Some(rate) => format!("{line},{}\n", time_of(rate)),
        });
        lines.collect()
    };
    let fixed = notes(&timed(&|_| "600"));
    assert!(
        fixed[0].contains("leaves up to 0.211 deg/h of the horizontal Earth rate"),
        "{fixed:?}"
    );
    let whole = |rate: &str| match rate {
        "10" => "576",
        "50" => "597.6",
        _ => "600",
    };
    assert!(notes(&timed(&whole)).is_empty());
}
