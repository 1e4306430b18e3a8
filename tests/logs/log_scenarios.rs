//! Scenarios that measure a recorded log: the same path, files and exit codes as a simulation.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

const LOG: &str = "schema = 1\nname = \"my-log\"\n[log]\nfile = \"log.csv\"\n";
const FILTER: &str = "[[filter]]\nname = \"mean\"\nmoving_average.taps = 8\n";
const WALK: &str = "raw.angle_random_walk_deg_per_sqrt_h";

/// A folder with 60 s at 100 Hz of 0.2 deg/s a word about 0.01 deg/s: 1.2 deg/sqrt(h).
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut text = "time_s,g_dps\n".to_owned();
    for (k, noise) in white(7, 6000, 0.2).iter().enumerate() {
        writeln!(text, "{:.2},{:.6}", k as f64 / 100.0, noise + 0.01).expect("a string");
    }
    write(folder.path(), "log.csv", &text);
    folder
}

fn gate(metric: &str, limit: &str) -> String {
    format!("[[gate]]\nmetric = \"{metric}\"\n{limit}\n")
}

#[track_caller]
fn run(folder: &Path, arguments: &[&str], exit: i32) -> String {
    let output = fogbench(folder, &[&["run"], arguments, &["-o", "out"]].concat());
    assert_eq!(code(&output), exit, "{arguments:?}: {}", stderr(&output));
    stdout(&output) + &stderr(&output)
}

#[track_caller]
fn summary(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("out/my-log/summary.json"));
    serde_json::from_str(&text.expect("a summary")).expect("JSON")
}

#[test]
fn a_scenario_of_a_log_runs_beside_a_simulation_with_the_same_files_and_exit_codes() {
    let folder = folder();
    let path = folder.path();
    let own = [LOG, FILTER, &gate(WALK, "max = 1.3")].concat();
    write(path, "log.toml", &own);
    write(
        path,
        "gyro.toml",
        "schema = 1\nname = \"gyro\"\nduration_s = 1.0\nwarm_up_s = 0.0\nfidelity = \"rate\"\n",
    );
    let listed = stdout(&fogbench(path, &["list", "."]));
    assert!(listed.contains("my-log  60 s"), "{listed}");
    assert_eq!(code(&fogbench(path, &["check", "."])), 0);
    run(path, &["."], 0);
    for file in [
        "summary.json",
        "index.html",
        "gyro/summary.json",
        "my-log/manifest.toml",
        "my-log/report.html",
        "my-log/metrics.csv",
        "my-log/allan.svg",
        "my-log/noise-delay.svg",
        "my-log/filter-response.svg",
    ] {
        assert!(path.join("out").join(file).is_file(), "{file}");
    }
    let json = summary(path);
    assert_eq!(json["log"]["rate_hz"], 100.0);
    assert_eq!(json["log"]["samples"], 6000);
    assert!(json.get("gyro").is_none(), "there is no gyro: {json}");
    let metrics = &json["channels"]["raw"]["metrics"];
    let walk = metrics["angle_random_walk_deg_per_sqrt_h"]["value"].as_f64();
    assert_close(walk.expect("a walk"), 1.2, 0.05, 0.0);

    write(path, "log.toml", &own.replace("1.3", "1.0"));
    let said = run(path, &["log.toml"], 1);
    assert!(said.contains(WALK), "{said}");
}

#[test]
fn a_run_of_a_log_and_its_short_forms_measure_the_same() {
    let folder = folder();
    let path = folder.path();
    write(path, "log.toml", &[LOG, FILTER].concat());
    run(path, &["log.toml"], 0);
    let short = [
        "filter",
        "log.csv",
        "--filters",
        "log.toml",
        "--format",
        "json",
    ];
    let short: Value = serde_json::from_str(&stdout(&fogbench(path, &short))).expect("JSON");
    assert_eq!(short["channels"], summary(path)["channels"]);
}

#[test]
fn a_run_of_a_log_is_taken_over_and_repeated_from_its_manifest() {
    let folder = folder();
    let path = folder.path();
    write(path, "log.toml", &[LOG, FILTER].concat());
    run(path, &["log.toml"], 0);
    let first = std::fs::read(path.join("out/my-log/summary.json")).expect("a summary");
    std::fs::copy(
        path.join("out/my-log/manifest.toml"),
        path.join("again.toml"),
    )
    .expect("a copy");
    run(path, &["again.toml"], 0);
    let again = std::fs::read(path.join("out/my-log/summary.json")).expect("a summary");
    assert_eq!(first, again);
    let modified = |path: &Path| {
        std::fs::metadata(path)
            .and_then(|it| it.modified())
            .expect("a time")
    };
    let page = path.join("out/my-log/report.html");
    let before = modified(&page);
    run(path, &["again.toml", "--resume=any-build"], 0);
    assert_eq!(modified(&page), before, "it was taken over");

    let text = std::fs::read_to_string(path.join("log.csv")).expect("a log");
    write(path, "log.csv", &text.replacen("0.00,", "0.00,1", 1));
    let said = run(path, &["again.toml"], 2);
    assert!(
        said.contains("not the file that the manifest was made from"),
        "{said}"
    );
}

#[test]
fn a_part_of_a_log_is_measured_behind_the_warm_up() {
    let folder = folder();
    let path = folder.path();
    write(
        path,
        "log.toml",
        &LOG.replace("[log]", "warm_up_s = 10\nduration_s = 20\n[log]"),
    );
    run(path, &["log.toml"], 0);
    let json = summary(path);
    let deviation = &json["channels"]["raw"]["metrics"]["noise_std_deg_per_h"];
    assert_eq!(deviation["count"], 2000.0);
    let short = [
        "analyze",
        "log.csv",
        "--warm-up-s",
        "10",
        "--rows",
        ":3000",
        "--format",
        "json",
    ];
    let short: Value = serde_json::from_str(&stdout(&fogbench(path, &short))).expect("JSON");
    assert_eq!(
        short["channels"]["raw"]["metrics"],
        json["channels"]["raw"]["metrics"]
    );
}

#[test]
fn logs_are_swept_over() {
    let folder = folder();
    let path = folder.path();
    let text = std::fs::read_to_string(path.join("log.csv")).expect("a log");
    let half: Vec<&str> = text.lines().take(3001).collect();
    write(path, "half.csv", &(half.join("\n") + "\n"));
    write(
        path,
        "log.toml",
        &format!("{LOG}[matrix]\n\"log.file\" = [\"log.csv\", \"half.csv\"]\n"),
    );
    let listed = stdout(&fogbench(path, &["list", "log.toml"]));
    assert!(
        listed.contains("60 s") && listed.contains("30 s"),
        "{listed}"
    );
    run(path, &["log.toml"], 0);
    assert!(path.join("out/my-log/0001/summary.json").is_file());
}

#[test]
fn what_is_wrong_with_a_scenario_of_a_log_is_said_before_it_runs() {
    let folder = folder();
    let path = folder.path();
    let mut transcript = Transcript::of("logs", "Scenarios of logs");
    let mut refuse = |what: &str, text: String| {
        write(path, "log.toml", &text);
        let output = fogbench(path, &["check", "log.toml"]);
        assert_eq!(code(&output), 2, "{what}");
        let said = stderr(&output).replace(&*path.to_string_lossy(), "");
        transcript.case(what, said);
    };
    refuse(
        "no file",
        LOG.replace("file = \"log.csv\"", "unit = \"deg/s\""),
    );
    refuse(
        "a file that is not there",
        LOG.replace("log.csv", "lag.csv"),
    );
    refuse(
        "a unit that contradicts",
        format!("{LOG}unit = \"rad/s\"\n"),
    );
    refuse(
        "more than there is",
        LOG.replace("[log]", "duration_s = 61\n[log]"),
    );
    refuse(
        "nothing left",
        LOG.replace("[log]", "warm_up_s = 60\n[log]"),
    );
    refuse("a gyro", format!("{LOG}[gyro.coil]\nlength_m = 500.0\n"));
    refuse("an unknown key", format!("{LOG}colunm = [\"g\"]\n"));
    refuse(
        "no truth",
        format!("{LOG}{}", gate("raw.mean_error_deg_per_h", "max = 1.0")),
    );
    for value in [
        "rows = \"1-60\"",
        "unit = \"deg/w\"",
        "motion = \"swung\"",
        "dtype = \"i9\"",
    ] {
        refuse(
            "a value that its key does not know",
            format!("{LOG}{value}\n"),
        );
    }
    for value in ["scale = 0.0", "rows = \"900000:\"", "from_s = 1e6"] {
        refuse(
            "a value that the log does not bear",
            format!("{LOG}{value}\n"),
        );
    }
    refuse("a swing too fast", format!("{LOG}motion = \"swing:30\"\n"));
    transcript.check();
}
