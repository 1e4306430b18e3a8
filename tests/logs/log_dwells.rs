//! A scale factor test of one axis from a log whose dwells are found, or from its points.

use std::fmt::Write as _;
use std::path::Path;

use fogbench::metrics::fit_points;
use serde_json::Value;

use crate::support::records::{normals, white};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// Rates of the test, deg/s, each held for 20 s at 50 Hz behind a ramp of 2 s.
const RATES: [f64; 9] = [0.0, 10.0, 50.0, 100.0, 40.0, -10.0, -50.0, -100.0, 0.0];
const DWELL: usize = 1000;
const RAMP: usize = 100;

/// What the table does, deg/s.
fn table() -> Vec<f64> {
    let mut rates = Vec::new();
    for two in RATES.windows(2) {
        rates.extend(std::iter::repeat_n(two[0], DWELL));
        rates.extend((0..RAMP).map(|at| two[0] + (two[1] - two[0]) * at as f64 / RAMP as f64));
    }
    rates.extend(std::iter::repeat_n(0.0, DWELL));
    rates
}

/// A log of a gyro with an offset, a scale factor error and a bend that is 60 ppm of 100 deg/s there.
fn log(noise_deg_per_s: f64) -> String {
    let table = table();
    let noise = white(11, table.len(), noise_deg_per_s);
    let wobble = normals(12, "table", table.len());
    let mut text = "time_s,gyro_deg_per_s,table_deg_per_s\n".to_owned();
    for (index, rate) in table.iter().enumerate() {
        let shown = rate + 2e-5 * wobble[index];
        let bend = 60e-6 * 100.0 * (rate / 100.0).powi(3);
        let word = 0.002 + (1.0 + 250e-6) * rate + bend + noise[index];
        writeln!(
            text,
            "{:.2},{word:.8},{shown:.8}",
            (index + 1) as f64 / 50.0
        )
        .expect("a string");
    }
    text
}

const COLUMNS: [&str; 6] = [
    "--column",
    "gyro_deg_per_s",
    "--reference-column",
    "table_deg_per_s",
    "--motion",
    "dwells",
];

#[track_caller]
fn analyze(folder: &Path, arguments: &[&str], exit: i32) -> String {
    let output = fogbench(folder, &[&["analyze", "log.csv"], arguments].concat());
    assert_eq!(code(&output), exit, "{arguments:?}: {}", stderr(&output));
    stdout(&output) + &stderr(&output)
}

/// Slope, offset and largest residual of the line through the rates of the log, by hand.
fn line(points: &[(f64, f64)]) -> (f64, f64, f64) {
    let count = points.len() as f64;
    let (sum_x, sum_y) = points
        .iter()
        .fold((0.0, 0.0), |(x, y), point| (x + point.0, y + point.1));
    let (mean_x, mean_y) = (sum_x / count, sum_y / count);
    let (mut across, mut square) = (0.0, 0.0);
    for (x, y) in points {
        across += (x - mean_x) * (y - mean_y);
        square += (x - mean_x).powi(2);
    }
    let slope = across / square;
    let offset = mean_y - slope * mean_x;
    let largest = points
        .iter()
        .map(|(x, y)| (y - slope * x - offset).abs())
        .fold(0.0, f64::max);
    (slope, offset, largest)
}

#[test]
fn known_answer_dwells_are_found_in_the_reference_and_give_the_line_of_a_staircase() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    write(path, "log.csv", &log(0.001));
    let written = ["--settle-s", "1", "-o", "out", "--format", "json"];
    let output = fogbench(
        path,
        &[&["analyze", "log.csv"], &COLUMNS[..], &written].concat(),
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let raw = &report["channels"]["raw"];
    let points = RATES.map(|rate| {
        let bend = 60e-6 * 100.0 * (rate / 100.0_f64).powi(3);
        (rate, 0.002 + (1.0 + 250e-6) * rate + bend)
    });
    let (slope, offset, largest) = line(&points);
    let full_scale = points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    for (name, want) in [
        ("scale_factor_error_ppm", 1e6 * (slope - 1.0)),
        ("scale_factor_offset_deg_per_h", 3600.0 * offset),
        ("scale_factor_nonlinearity_ppm", 1e6 * largest / full_scale),
    ] {
        let found = |key: &str| raw[name][key].as_f64().expect("a number");
        let half_width = 0.5 * (found("high") - found("low"));
        assert!(
            half_width > 0.0 && half_width < 0.1 * want.abs(),
            "{name}: {half_width}"
        );
        assert!(
            (found("value") - want).abs() < 1.5 * half_width,
            "{name}: {}",
            found("value")
        );
    }
    assert_close(
        raw["scale_factor_error_ppm"]["count"]
            .as_f64()
            .expect("a count"),
        9.0,
        0.0,
        0.0,
    );
    assert!(raw["scale_factor_asymmetry_ppm"]["value"].is_number());
    let reason = raw["unavailable"]["settling_time_s"].as_str();
    assert_eq!(reason, Some("the transitions of a reference are no steps"));
    // Transitions are cut, and the time to settle: 20 s less a second and a tenth.
    let times = raw["curves"]["scale_factor"]["measured_s"]
        .as_array()
        .expect("a curve");
    for time_s in times {
        let time_s = time_s.as_f64().expect("a time");
        assert!((18.5..=19.0).contains(&time_s), "{time_s}");
    }
    assert!(path.join("out/scale-factor.csv").is_file());
    assert!(path.join("out/scale-factor.svg").is_file());
    let mut transcript = Transcript::of("log_dwells", "A log of dwells");
    let text = analyze(path, &COLUMNS, 0);
    transcript.case(
        "analyze log.csv --reference-column table --motion dwells",
        text,
    );
    transcript.check();
}

#[test]
fn a_reference_without_dwells_or_none_at_all_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    write(path, "log.csv", &log(0.001));
    let mut transcript = Transcript::of("log_dwells", "Logs without dwells");
    let without = ["--column", "gyro_deg_per_s", "--motion", "dwells"];
    transcript.case("without a reference", analyze(path, &without, 2));
    let part = [&COLUMNS[..], &["--from-s", "20.2", "--to-s", "21.8"]].concat();
    transcript.case("a ramp alone", analyze(path, &part, 2));
    let part = [&COLUMNS[..], &["--to-s", "19", "--format", "json"]].concat();
    let report = analyze(path, &part, 0);
    let at = report.find('{').expect("JSON");
    let end = report.rfind('}').expect("JSON");
    let report: Value = serde_json::from_str(&report[at..=end]).expect("JSON");
    let reason = &report["channels"]["raw"]["unavailable"]["scale_factor_error_ppm"];
    transcript.case("one dwell", reason.as_str().expect("a reason"));
    let idle = ["--column", "gyro_deg_per_s", "--settle-s", "1"];
    transcript.case("--settle-s at rest", analyze(path, &idle, 2));
    transcript.check();
}

#[test]
fn a_scenario_of_a_log_with_dwells_is_gated_as_a_staircase_is() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    write(path, "log.csv", &log(0.001));
    for (max, exit) in [(400.0, 0), (100.0, 1)] {
        let text = format!(
            "schema = 1\nname = \"dwells\"\n[log]\nfile = \"log.csv\"\ncolumn = [\"gyro_deg_per_s\"]\n\
             reference_column = \"table_deg_per_s\"\nmotion = \"dwells\"\n\
             [[gate]]\nmetric = \"raw.scale_factor_error_ppm\"\nmax = {max:?}\n"
        );
        write(path, "dwells.toml", &text);
        let output = fogbench(path, &["run", "dwells.toml", "-o", "out"]);
        assert_eq!(code(&output), exit, "{}", stderr(&output));
    }
    assert!(path.join("out/dwells/scale-factor.svg").is_file());
}

/// Points in counts: 1234.5 a deg/s, an offset, a bend and noise of known size.
fn points(deviation: f64) -> (Vec<f64>, Vec<f64>) {
    let rates: Vec<f64> = (-10..=10).map(|step| 10.0 * f64::from(step)).collect();
    let noise = white(21, rates.len(), deviation);
    let output = rates
        .iter()
        .zip(&noise)
        .map(|(rate, noise)| 88.0 + 1234.5 * rate + noise);
    let output = output.collect();
    (rates, output)
}

#[test]
fn known_answer_points_give_scale_factor_and_offset_with_intervals_that_hold() {
    let (mut held, mut all) = (0, 0);
    for seed in 0..40 {
        let rates: Vec<f64> = (-10..=10).map(|step| 10.0 * f64::from(step)).collect();
        let noise = white(seed, rates.len(), 2.0);
        let rows: Vec<(f64, f64)> = rates
            .iter()
            .zip(&noise)
            .map(|(rate, noise)| (*rate, 88.0 + 1234.5 * rate + noise))
            .collect();
        let errors = vec![2.0; rows.len()];
        for errors in [None, Some(&errors[..])] {
            let fit = fit_points(&rows, errors).expect("a line");
            for (found, want) in [(fit.factor, 1234.5), (fit.offset, 88.0)] {
                held += usize::from((found.low..=found.high).contains(&want));
                all += 1;
            }
        }
    }
    // 95 % of 160: fewer than 143 in one case of a thousand.
    assert!(held >= 143, "{held} of {all}");
}

#[test]
fn points_in_counts_or_in_rates_are_told_by_their_headings() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    let (rates, output) = points(1.0);
    let mut counts = "rate [deg/s],output,sigma\n".to_owned();
    let mut as_rates = "rate_deg_per_s,gyro [deg/s]\n".to_owned();
    for (rate, output) in rates.iter().zip(&output) {
        writeln!(counts, "{rate},{output:.3},1.0").expect("a string");
        writeln!(as_rates, "{rate},{:.8}", output / 1234.0).expect("a string");
    }
    write(path, "counts.csv", &counts);
    write(path, "rates.csv", &as_rates);
    let of = |arguments: &[&str], exit: i32| {
        let output = fogbench(path, &[&["scale-factor"], arguments].concat());
        assert_eq!(code(&output), exit, "{arguments:?}: {}", stderr(&output));
        stdout(&output) + &stderr(&output)
    };
    let report = of(&["counts.csv", "--error", "sigma", "--format", "json"], 0);
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let figure = |name: &str, key: &str| report["figures"][name][key].as_f64().expect("a number");
    for (name, want) in [("scale_factor", 1234.5), ("offset", 88.0)] {
        let half_width = 0.5 * (figure(name, "high") - figure(name, "low"));
        assert!(
            (figure(name, "value") - want).abs() < 2.0 * half_width,
            "{name}"
        );
    }
    // 88 counts of 1234.5 a deg/s.
    assert_close(
        figure("offset_deg_per_h", "value"),
        88.0 / 1234.5 * 3600.0,
        0.01,
        0.0,
    );
    let mut transcript = Transcript::of("log_dwells", "Points of a scale factor test");
    transcript.case(
        "scale-factor counts.csv --error sigma",
        of(&["counts.csv", "--error", "sigma"], 0),
    );
    transcript.case("scale-factor rates.csv", of(&["rates.csv"], 0));
    write(path, "two.csv", "rate [deg/s],output\n1,2\n2,4\n");
    transcript.case("two points", of(&["two.csv"], 2));
    write(path, "bare.csv", "1,2\n2,4\n3,6\n");
    transcript.case("a rate without a unit", of(&["bare.csv"], 2));
    write(path, "angle.csv", "rate [deg],output\n1,2\n2,4\n3,6\n");
    transcript.case("an angle", of(&["angle.csv"], 2));
    write(
        path,
        "negative.csv",
        "rate [deg/s],output,sigma\n1,2,1\n2,4,-1\n3,6,1\n",
    );
    transcript.case(
        "a negative error",
        of(&["negative.csv", "--error", "sigma"], 2),
    );
    transcript.check();
}
