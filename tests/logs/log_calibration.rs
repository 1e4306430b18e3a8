//! Coefficients of the temperature that one log has shown, taken out of another one.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::records::normals;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// Words of a log, a second each.
const WORDS: usize = 14_400;
/// Bias over temperature, over its square and over its rate, of the gyros of a log, about 25 C.
const GYROS: [[f64; 3]; 3] = [[0.05, -0.004, 0.8], [-0.08, 0.002, 0.4], [0.11, 0.0, -0.6]];

/// A log of three gyros whose words have white noise of 1 deg/h, and whose temperature swings.
///
/// * `centre_c`, `period_s`: of the swing by 15 K.
fn log(seed: u64, centre_c: f64, period_s: f64) -> String {
    let noise = ["x", "y", "z"].map(|name| normals(seed, name, WORDS));
    let mut text = "time_s,gx_deg_per_h,gy_deg_per_h,gz_deg_per_h,coil_c\n".to_owned();
    for second in 0..WORDS {
        let turn = TAU * (second + 1) as f64 / period_s;
        let temperature_c = centre_c + 15.0 * turn.sin();
        let rate_k_per_min = 15.0 * turn.cos() * TAU / period_s * 60.0;
        let warmer_k = temperature_c - 25.0;
        write!(text, "{}", second + 1).expect("a string");
        for ([linear, square, rate], noise) in GYROS.iter().zip(&noise) {
            let bias = 8.0 + (linear + square * warmer_k) * warmer_k + rate * rate_k_per_min;
            write!(text, ",{:.5}", bias + noise[second]).expect("a string");
        }
        // Readings in steps of 1/16 K.
        writeln!(text, ",{}", (16.0 * temperature_c).round() / 16.0).expect("a string");
    }
    text
}

/// Two logs: one to calibrate with, and another of other noise, temperatures and times.
fn logs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "warm.csv", &log(1, 25.0, 6000.0));
    write(folder.path(), "other.csv", &log(2, 28.0, 4500.0));
    folder
}

const COIL: [&str; 2] = ["--temperature-column", "coil_c"];

#[track_caller]
fn analyze(folder: &Path, arguments: &[&str], exit: i32) -> (String, String) {
    let output = fogbench(folder, &[&["analyze"], arguments, &COIL].concat());
    assert_eq!(code(&output), exit, "{arguments:?}: {}", stderr(&output));
    (stdout(&output), stderr(&output))
}

/// Standard deviation of the noise of a channel, deg/h.
fn noise(report: &str, channel: &str) -> f64 {
    let report: Value = serde_json::from_str(report).expect("JSON");
    let value = &report["channels"][channel]["noise_std_deg_per_h"]["value"];
    value.as_f64().unwrap_or_else(|| panic!("{report}"))
}

#[test]
fn known_answer_coefficients_of_one_log_are_taken_out_of_another() {
    let folder = logs();
    let path = folder.path();
    let own = ["--column", "gx", "--temperature-reference-c", "25"];
    let model = [
        "--temperature-model",
        "calibration.toml",
        "--format",
        "json",
    ];
    let (report, _) = analyze(path, &[&["warm.csv"], &own[..], &model].concat(), 0);
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let text = std::fs::read_to_string(path.join("calibration.toml")).expect("it is written");
    let written: toml::Table = text.parse().expect("TOML");
    let raw = &report["channels"]["raw"];
    for (metric, key, want) in [
        (
            "bias_temperature_coefficient_deg_per_h_per_k",
            "bias_deg_per_h_per_k",
            0.05,
        ),
        (
            "bias_temperature_coefficient_deg_per_h_per_k2",
            "bias_deg_per_h_per_k2",
            -0.004,
        ),
        (
            "bias_temperature_rate_coefficient_deg_per_h_per_k_per_min",
            "bias_deg_per_h_per_k_per_min",
            0.8,
        ),
    ] {
        let applied = raw[metric]["applied"].as_f64().expect("a number");
        let kept = written["temperature"][key].as_float().expect("a number");
        assert_eq!(applied.to_bits(), kept.to_bits(), "{key}");
        assert_close(kept, want, 0.3, 0.0);
    }
    let calibration = ["--calibration", "calibration.toml", "--format", "json"];
    let other = [&["other.csv", "--column", "gx"], &calibration[..]].concat();
    let (report, _) = analyze(path, &other, 0);
    assert!(noise(&report, "raw") > 1.2, "{}", noise(&report, "raw"));
    // White noise of 1 deg/h is left, as if the other log had been fitted itself.
    assert_close(noise(&report, "compensated"), 1.0, 0.02, 0.0);
    // A sign turned round would double what it takes away.
    let turned = text.replace(
        "bias_deg_per_h_per_k_per_min = ",
        "bias_deg_per_h_per_k_per_min = -",
    );
    write(path, "calibration.toml", &turned);
    let (report, _) = analyze(path, &other, 0);
    assert!(noise(&report, "compensated") > 1.2);
}

#[test]
fn filters_and_scenarios_take_the_same_words() {
    let folder = logs();
    let path = folder.path();
    let model = [
        "warm.csv",
        "--column",
        "gx",
        "--temperature-model",
        "c/calibration.toml",
    ];
    std::fs::create_dir(path.join("c")).expect("a folder");
    analyze(path, &model, 0);
    let head = "schema = 1\nname = \"other\"\n";
    let filter = "[[filter]]\nname = \"same\"\n[filter.moving_average]\ntaps = 1\n\
                  output_register = \"immediate\"\n";
    let log = "[log]\nfile = \"../other.csv\"\ncolumn = [\"gx\"]\ntemperature_column = \"coil_c\"\n\
               calibration = \"calibration.toml\"\n";
    let gate = "[[gate]]\nmetric = \"compensated.noise_std_deg_per_h\"\nmax = 1.05\n";
    write(path, "c/other.toml", &[head, log, filter, gate].concat());
    write(path, "c/filters.toml", &[head, filter].concat());
    let output = fogbench(path, &["run", "c/other.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    // A manifest repeats it, and another calibration is not the same run.
    std::fs::copy(
        path.join("out/other/manifest.toml"),
        path.join("c/again.toml"),
    )
    .expect("a copy");
    let manifest = ["run", "c/again.toml", "-o", "again"];
    let output = fogbench(path, &manifest);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let of_log = ["filter", "other.csv", "--column", "gx"];
    let compensated = ["--calibration", "c/calibration.toml", "--format", "json"];
    let short = |own: &[&str]| fogbench(path, &[&of_log[..], own, &compensated, &COIL].concat());
    let output = short(&["--filters", "c/filters.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report = stdout(&output);
    // The file of the log does for its filters and gates as well, where the same is taken out.
    let own = ["--filters", "c/other.toml", "--gates", "c/other.toml"];
    let output = short(&own);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let gates: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(gates["gates"][0]["verdict"], "pass", "{}", gates["gates"]);
    let output = fogbench(path, &[&of_log[..], &own].concat());
    assert_eq!(code(&output), 2, "{}", stdout(&output));
    let said = stderr(&output);
    assert!(said.contains("there is one with --calibration"), "{said}");
    let run = std::fs::read_to_string(path.join("out/other/summary.json")).expect("a summary");
    let run: Value = serde_json::from_str(&run).expect("JSON");
    for channel in ["compensated", "same"] {
        let metric = &run["channels"][channel]["metrics"]["noise_std_deg_per_h"]["value"];
        let value = metric.as_f64().expect("a number");
        assert_eq!(
            value.to_bits(),
            noise(&report, channel).to_bits(),
            "{channel}"
        );
        assert_close(value, 1.0, 0.02, 0.0);
    }
    let text = std::fs::read_to_string(path.join("c/calibration.toml")).expect("it is written");
    write(
        path,
        "c/calibration.toml",
        &text.replace("provenance", "other"),
    );
    assert_eq!(code(&fogbench(path, &manifest)), 2);
}

/// An assembly without errors at 20 C, but for the bias of x.
const ASSEMBLY: &str = "# Bench 3.\nschema = 1\n\n[compensation]\nbias_deg_per_h = [8.0, 0.0, 0.0]\n\
                        reference_temperature_c = [25.0, 20.0, 25.0]\n\
                        bias_deg_per_h_per_k = [0.5, 0.0, 0.0]\n";

#[test]
fn known_answer_tables_of_an_assembly_take_the_place_of_its_linear_coefficient() {
    let folder = logs();
    let path = folder.path();
    let file = write(path, "calibration.toml", ASSEMBLY);
    for (axis, column) in [("x", "gx"), ("y", "gy")] {
        let own = ["warm.csv", "--column", column, "--axis", axis];
        let model = ["--temperature-model", "calibration.toml"];
        analyze(path, &[&own[..], &model].concat(), 0);
    }
    let text = std::fs::read_to_string(&file).expect("it is there");
    assert!(text.starts_with(ASSEMBLY), "{text}");
    assert!(text.contains("\n[temperature.x]\n") && text.contains("\n[temperature.y]\n"));
    let columns = [
        "other.csv",
        "--columns",
        "gx,gy,gz",
        "--calibration",
        "calibration.toml",
    ];
    let of = |axis: &str| {
        let options = [&columns[..], &["--axis", axis, "--format", "json"]].concat();
        let (report, _) = analyze(path, &options, 0);
        let mean: Value = serde_json::from_str(&report).expect("JSON");
        let mean = mean["channels"]["compensated"]["mean_deg_per_h"]["value"].as_f64();
        (noise(&report, "compensated"), mean.expect("a mean"))
    };
    let ((x, mean_x), (y, mean_y)) = (of("x"), of("y"));
    assert_close(x, 1.0, 0.02, 0.0);
    assert_close(y, 1.0, 0.02, 0.0);
    // The bias of x is out; y is told at 20 C, 5 K below where it is 8 deg/h.
    assert_close(mean_x, 0.0, 0.0, 0.1);
    assert_close(mean_y, 8.0 + 5.0 * 0.08 + 25.0 * 0.002, 0.0, 0.1);
    assert!(of("z").0 > 1.2, "z has no table");
}

#[test]
fn what_is_wrong_with_coefficients_of_the_temperature_is_said_in_a_sentence() {
    let folder = logs();
    let path = folder.path();
    let mut transcript = Transcript::of("log_temperature", "Coefficients that are not applied");
    write(path, "bare.toml", ASSEMBLY);
    write(
        path,
        "other.toml",
        "schema = 1\n[temperature.y]\nreference_temperature_c = 25.0\n",
    );
    write(
        path,
        "wrong.toml",
        "schema = 1\n[temperature]\nbias_deg_per_h_per_kelvin = 0.1\nbias_deg_per_h_per_k = 1e9\n",
    );
    let cold = "schema = 1\n[temperature]\nreference_temperature_c = -20.0\n\
                bias_deg_per_h_per_k_per_min = 0.1\nlowest_c = -30.0\nhighest_c = 10.0\n";
    write(path, "cold.toml", cold);
    let mut said = |name: &str, arguments: &[&str], exit: i32| {
        let log = ["analyze", "warm.csv", "--column", "gx"];
        let output = fogbench(path, &[&log[..], arguments].concat());
        assert_eq!(code(&output), exit, "{name}: {}", stderr(&output));
        let told = stderr(&output);
        let told = told.lines().filter(|line| !line.starts_with("warm.csv: "));
        transcript.case(name, told.collect::<Vec<_>>().join("\n"));
        stdout(&output)
    };
    said("no temperature", &["--calibration", "cold.toml"], 2);
    for (name, file) in [
        ("no table", "bare.toml"),
        ("that of another gyro", "other.toml"),
        ("unknown key, out of range, no reference", "wrong.toml"),
    ] {
        said(name, &[&["--calibration", file], &COIL[..]].concat(), 2);
    }
    said(
        "no file",
        &[&["--calibration", "none.toml"], &COIL[..]].concat(),
        74,
    );
    said("an axis alone", &[&["--axis", "x"], &COIL[..]].concat(), 2);
    let text = said(
        "other temperatures",
        &[&["--calibration", "cold.toml"], &COIL[..]].concat(),
        0,
    );
    assert!(text.contains("[temperature] is extrapolated"), "{text}");
    let model = ["--temperature-model", "new.toml"];
    said("nothing to write", &model, 3);
    assert!(!path.join("new.toml").exists());
    let foreign = ["--temperature-model", "foreign.toml"];
    write(path, "foreign.toml", "mine = 1\n");
    said("another file", &[&foreign, &COIL[..]].concat(), 2);
    transcript.check();
}
