//! `calibrate` on files that are wrong and on campaigns; `filter` and `analyze` with its parameters.

use std::fmt::Write as _;
use std::path::Path;

use fogbench::units::{deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h};
use serde_json::Value;

use crate::support::patent_cases::{rates, truth};
use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{assert_close, code, field, fogbench, npy, stderr, stdout, write};

/// The transcript of calibrations.
const CALIBRATE: &str = "calibrate";

const HEADING: &str = "mounting,rate_deg_per_s,temperature_c,output_x_deg_per_h,\
                       output_y_deg_per_h,output_z_deg_per_h";
const LINE: &str = "x,10,25,36037.8,-45.2,19.5";

/// The complaint about a groups file of a heading and one line.
#[track_caller]
fn refused(heading: &str, line: &str) -> String {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "groups.csv", &format!("{heading}\n{line}\n"));
    let arguments = ["calibrate", "groups.csv", "--latitude-deg", "32.03"];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 2, "{}", stdout(&output));
    stderr(&output)
}

#[test]
fn columns_unknown_repeated_missing_or_without_a_unit_are_all_named_at_once() {
    let no_unit = HEADING.replace("mounting", "mountng");
    let headings = [
        no_unit.replace("output_z_deg_per_h", "output_z"),
        HEADING.replace("temperature_c", "output_x_deg_per_s"),
        HEADING.replace("temperature_c", "temperature_y_c"),
        format!("{HEADING},reference_x_deg_per_s"),
    ];
    said_to_each(
        CALIBRATE,
        "Headings of a groups file that are refused",
        headings,
        |heading| refused(heading, LINE),
    );
}

#[test]
fn cells_that_are_no_number_out_of_range_or_empty_are_named_with_line_and_column() {
    let lines = [
        "x,10,warm,1,2,3",
        "x,10,,1,2,3",
        "x,10,inf,1,2,3",
        "x,10,2299,1,2,3",
        "a,10,25,1,2,3",
        "x,10,25,1,2",
    ];
    said_to_each(
        CALIBRATE,
        "Lines of a groups file that are refused",
        lines,
        |line| refused(HEADING, line),
    );
    let folder = tempfile::tempdir().expect("a scratch folder");
    let run = |arguments: &[&str]| {
        let output = fogbench(folder.path(), &[&["calibrate"], arguments].concat());
        (code(&output), stderr(&output))
    };
    std::fs::write(folder.path().join("latin.csv"), b"mounting,\xb0C\n").expect("a file");
    write(
        folder.path(),
        "empty.csv",
        &format!("# nothing yet\n{HEADING}\n"),
    );
    write(folder.path(), "groups.csv", &format!("{HEADING}\n{LINE}\n"));
    let mut transcript = Transcript::of(CALIBRATE, "Groups files that cannot be used");
    for (arguments, want) in [
        (&["latin.csv"][..], 2),
        (&["empty.csv"], 2),
        (&["nowhere.csv"], 74),
        (&["groups.csv"], 2),
        (&["groups.csv", "--latitude-deg", "91"], 2),
    ] {
        let (exit, words) = run(arguments);
        assert_eq!(exit, want, "{words}");
        transcript.case(format!("calibrate {}", arguments.join(" ")), words);
    }
    transcript.check();
}

/// A campaign of 36 s at each rate without noise.
fn campaign() -> String {
    let [x, y, z] = truth().bias_deg_per_h();
    let scale = truth().scale_error.map(|error| error * 1e6);
    format!(
        "schema = 1\nname = \"campaign\"\nfidelity = \"rate\"\nduration_s = 400.0\nwarm_up_s = 5.0\n\
         [turntable.calibration]\naxes = [\"x\", \"x\", \"x\", \"y\", \"y\", \"y\", \"z\", \"z\", \"z\"]\n\
         rates_deg_per_s = [10.0, 50.0, 90.0, 10.0, 50.0, 90.0, 10.0, 50.0, 90.0]\n\
         record_s = 36.0\nchange_s = 5.0\nremount_s = 10.0\n[calibration]\nestimators = [\"batch\"]\n\
         apply = \"batch\"\n[gyro.output]\nhalf_periods_per_sample = 25532\n[gyro.assembly]\n\
         bias_deg_per_h = [{x:?}, {y:?}, {z:?}]\nscale_factor_error_ppm = {scale:?}\n"
    )
}

#[test]
fn a_campaign_is_calibrated_as_its_run_does_it() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "campaign.toml", &campaign());
    let calibrate = [
        "calibrate",
        "campaign.toml",
        "-o",
        "found",
        "--format",
        "json",
    ];
    let output = fogbench(folder.path(), &calibrate);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let output = fogbench(folder.path(), &["run", "campaign.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let read = |path: &str| std::fs::read_to_string(folder.path().join(path)).expect("a file");
    for file in ["calibration.toml", "groups.csv"] {
        assert_eq!(
            read(&format!("found/{file}")),
            read(&format!("out/campaign/{file}"))
        );
    }
    let summary: Value = serde_json::from_str(&read("out/campaign/summary.json")).expect("JSON");
    assert_eq!(report["calibration"], summary["calibration"]);
    // The groups that a run writes are a groups file.
    let again = [
        "calibrate",
        "found/groups.csv",
        "--estimator",
        "batch",
        "--format",
        "json",
    ];
    let output = fogbench(folder.path(), &again);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let again: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let parameters =
        |report: &Value| report["calibration"]["estimates"]["batch"]["parameters"].clone();
    assert_eq!(parameters(&again), parameters(&report));
}

#[test]
fn a_scenario_without_a_campaign_and_misplaced_options_exit_2() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let still = "schema = 1\nname = \"still\"\nduration_s = 1.0\n[turntable.static]\n";
    write(folder.path(), "still.toml", still);
    write(folder.path(), "groups.csv", &format!("{HEADING}\n{LINE}\n"));
    let mut transcript = Transcript::of(
        CALIBRATE,
        "Scenarios without a campaign and misplaced options",
    );
    for arguments in [
        "still.toml",
        "still.toml --latitude-deg 30",
        "groups.csv --set seed=2",
        "groups.csv --estimator kalman",
    ] {
        let words: Vec<&str> = ["calibrate"]
            .into_iter()
            .chain(arguments.split(' '))
            .collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 2);
        transcript.case(words.join(" "), stderr(&output));
    }
    transcript.check();
}

/// Three columns of an assembly that turns about x at 50 deg/s, and its temperature.
fn three_columns(folder: &Path, count: usize) {
    let mut text = String::from("gx,gy,gz,case_c\n");
    for sample in 0..count {
        let warmer_k = if sample % 2 == 0 { 0.0 } else { 5.0 };
        let mut outputs = truth().predict(rates((0, 50.0)));
        outputs[0] += deg_per_h_to_deg_per_s(0.1 * warmer_k);
        let [x, y, z] = outputs;
        let _ = writeln!(text, "{x:?},{y:?},{z:?},{:?}", 40.0 + warmer_k);
    }
    write(folder, "log.csv", &text);
}

const CALIBRATION: &str = "schema = 1\n[compensation]\nbias_deg_per_h = [1.0, -2.0, 1.5]\n\
    scale_factor_error_ppm = [800.0, -500.0, 300.0]\ntheta_xy_arcsec = 206.26480624709636\n\
    theta_xz_arcsec = -165.01184499767709\ntheta_yx_arcsec = 123.75888374825782\n\
    theta_yz_arcsec = 247.51776749651563\ntheta_zx_arcsec = -185.63832562238672\n\
    theta_zy_arcsec = 103.13240312354818\nreference_temperature_c = [40.0, 40.0, 40.0]\n\
    bias_deg_per_h_per_k = [0.1, 0.0, 0.0]\n";

#[test]
fn three_columns_of_a_log_are_compensated_before_the_filters() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    three_columns(folder.path(), 400);
    write(folder.path(), "calibration.toml", CALIBRATION);
    let filters = "schema = 1\nname = \"two\"\nduration_s = 1.0\n[turntable.static]\n\
                   [[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 2\n";
    write(folder.path(), "filters.toml", filters);
    let log = [
        "log.csv",
        "--rate-hz",
        "10",
        "--unit",
        "deg/s",
        "--columns",
        "gx,gy,gz",
    ];
    let calibration = ["--calibration", "calibration.toml", "--axis", "x"];
    let warmth = ["--temperature-column", "case_c"];
    let rest = ["--filters", "filters.toml", "-o", "out", "--format", "json"];
    let arguments = [&["filter"], &log[..], &calibration, &warmth, &rest].concat();
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let true_rate = deg_per_s_to_deg_per_h(rates((0, 50.0))[0]);
    let mean = |channel: &str| field(&report, &format!("{channel}.mean_deg_per_h"), "value");
    assert_close(mean("compensated"), true_rate, 0.0, 1e-6);
    assert!((mean("raw") - true_rate).abs() > 100.0);
    for word in npy(&folder.path().join("out/samples/compensated.npy")) {
        assert_close(word, true_rate, 0.0, 1e-6);
    }
    let filtered = npy(&folder.path().join("out/samples/mean.npy"));
    assert_close(filtered[399], true_rate, 0.0, 1e-6);
    // Without the temperature the biases stay at their reference, which is said; the first-order
    // form leaves -(D D W + D B) of about 0.1 deg/h.
    let form = ["--compensation-form", "first-order", "--format", "json"];
    let arguments = [&["analyze"], &log[..], &calibration, &form].concat();
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let mean = field(&report, "compensated.mean_deg_per_h", "value");
    let deviation = truth().deviation();
    let rate = [true_rate, 0.0, 0.0];
    let error: [f64; 3] = [0, 1, 2].map(|row: usize| {
        let sum: f64 = (0..3).map(|axis| deviation[row][axis] * rate[axis]).sum();
        sum + truth().bias_deg_per_h()[row]
    });
    let left: f64 = (0..3).map(|axis| -deviation[0][axis] * error[axis]).sum();
    // Half of the words are 0.5 deg/h too large; the form takes D of that out as well.
    let warm = 0.25 * (1.0 - deviation[0][0]);
    assert_close(mean - true_rate, left + warm, 0.0, 1e-6);
    let notes = report["notes"].as_array().expect("notes");
    let notes: Vec<&str> = notes.iter().filter_map(Value::as_str).collect();
    let mut transcript = Transcript::of(CALIBRATE, "Notes on a log that was compensated");
    transcript.case("--compensation-form first-order", notes.join("\n"));
    transcript.check();
}

#[test]
fn a_calibration_that_is_none_is_refused_at_its_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    three_columns(folder.path(), 40);
    let analyze = |calibration: &str, columns: &str| {
        let log = ["analyze", "log.csv", "--rate-hz", "10", "--unit", "deg/s"];
        let rest = [
            "--columns",
            columns,
            "--calibration",
            calibration,
            "--axis",
            "z",
        ];
        let output = fogbench(folder.path(), &[&log[..], &rest].concat());
        (code(&output), stderr(&output))
    };
    let wrong = CALIBRATION.replace("206.26480624709636", "3e6");
    write(folder.path(), "wrong.toml", &wrong);
    write(folder.path(), "none.toml", "schema = 1\n");
    write(folder.path(), "calibration.toml", CALIBRATION);
    let mut transcript = Transcript::of(CALIBRATE, "Calibrations that are none");
    for (calibration, columns, want) in [
        ("wrong.toml", "gx,gy,gz", 2),
        ("none.toml", "gx,gy,gz", 2),
        ("calibration.toml", "gx,gy", 2),
        ("calibration.toml", "gx,gy,gw", 2),
        ("nowhere.toml", "gx,gy,gz", 74),
    ] {
        let (exit, words) = analyze(calibration, columns);
        assert_eq!(exit, want, "{words}");
        transcript.case(
            format!("analyze --columns {columns} --calibration {calibration}"),
            words,
        );
    }
    transcript.check();
}
