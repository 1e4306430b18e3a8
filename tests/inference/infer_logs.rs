//! Settings from the figures of a recorded log, as `fogbench analyze` has measured them.

use std::path::Path;

use crate::support::inference::number;
use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, stderr, stdout, write};
use serde_json::Value;

const GYRO: &str = r#"
schema = 1
name = "rest"
duration_s = 60.0
warm_up_s = 1.0
fidelity = "rate"
output.samples = "npy"
"#;

/// What made the log: half of the power and twice the bandwidth of the scenario that stands for it.
const TRUTH: [(&str, f64); 3] = [
    ("gyro.source.power_uw", 0.5),
    ("turntable.site.latitude_deg", 40.0),
    ("gyro.controller.loop_bandwidth_hz", 600.0),
];

const PROBLEM: &str = r#"
schema = 1
name = "log"
points = 96
[[record]]
name = "rest"
scenario = "rest.toml"
[[parameter]]
name = "power"
keys = ["gyro.source.power_uw"]
low = 0.2
high = 3.0
prior = "log-uniform"
[[parameter]]
name = "latitude"
keys = ["turntable.site.latitude_deg"]
low = 20.0
high = 60.0
[[parameter]]
name = "bandwidth"
keys = ["gyro.controller.loop_bandwidth_hz"]
low = 300.0
high = 3000.0
prior = "log-uniform"
"#;

/// A simulated log of known settings, measured: what `analyze` prints of it lies in the folder.
fn analysed(folder: &Path, seed: u64) {
    write(folder, "rest.toml", GYRO);
    let mut arguments: Vec<String> = ["run", "rest.toml", "-o", "output", "--force", "-q"]
        .map(str::to_owned)
        .to_vec();
    let set = |key: &str, value: String| ["--set".to_owned(), format!("{key}={value}")];
    arguments.extend(set("seed", seed.to_string()));
    for (key, value) in TRUTH {
        arguments.extend(set(key, value.to_string()));
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = crate::support::summary(&folder.join("output"), "rest");
    let rate = summary["gyro"]["output_rate_hz"].to_string();
    let log = "output/rest/samples/raw.npy";
    let how = [
        "--rate-hz",
        &rate,
        "--unit",
        "deg/h",
        "--warm-up-s",
        "1",
        "--format",
        "json",
    ];
    let output = fogbench(folder, &[&["analyze", log][..], &how].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    write(folder, "rest.json", &stdout(&output));
}

fn log(metrics: &str) -> String {
    format!("{PROBLEM}[[log]]\nrecord = \"rest\"\nfile = \"rest.json\"\nmetrics = {metrics}\n")
}

fn answer(folder: &Path, problem: &str) -> Value {
    write(folder, "problem.toml", problem);
    let output = fogbench(folder, &["infer", "problem.toml", "--format", "json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// Allan curve, autocovariance and mean of a log give back the power, the bandwidth and the latitude that
/// made it: of 36 intervals of 95 % at most four miss, which is more than chance leaves in 99 %.
#[test]
fn the_figures_of_a_log_lead_back_to_the_settings_that_made_it() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let problem = log(r#"["raw.mean_deg_per_h", "raw.allan", "raw.autocovariance"]"#);
    let (mut missed, mut unexplained) = (Vec::new(), Vec::new());
    let mut shares: [Vec<f64>; 3] = Default::default();
    for seed in 1..=12 {
        analysed(folder.path(), seed);
        let found = answer(folder.path(), &problem);
        let figures = found["figures"].as_array().expect("figures");
        let of = |curve: &str| {
            let own = figures.iter().filter(|own| {
                let metric = own["metric"].as_str().unwrap_or_default();
                metric.starts_with(curve)
            });
            own.count()
        };
        assert!(of("raw.allan[") >= 8, "{found:#}");
        assert_eq!(of("raw.autocovariance["), 8);
        let own = figures.iter().filter(|own| own["explained"] == false);
        unexplained.extend(own.map(|own| format!("seed {seed}: {own}")));
        let parameters = &found["readings"][0]["parameters"];
        let named = TRUTH.iter().zip(["power", "latitude", "bandwidth"]);
        for (((_, truth), name), shares) in named.zip(&mut shares) {
            let own = &parameters[name];
            let (low, high) = (number(&own["low"]), number(&own["high"]));
            shares.push(number(&own["share_of_prior"]));
            if !(low..=high).contains(truth) {
                missed.push(format!("seed {seed}, {name}: {low} to {high}"));
            }
        }
    }
    assert!(missed.len() <= 4, "{missed:#?}");
    // The mean of a record in which a slow term is found by chance tells less of the latitude.
    for mut shares in shares {
        shares.sort_by(f64::total_cmp);
        assert!(shares[6] < 0.3, "{shares:?}");
    }
    // One record in 20 has such a figure by chance.
    assert!(unexplained.len() <= 3, "{unexplained:#?}");
}

/// The interval of a figure of a log holds the scatter of its record already: beside a figure that is printed
/// with the same uncertainty it is narrower by the root of two.
#[test]
fn the_scatter_of_a_record_is_counted_once() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    analysed(folder.path(), 1);
    let width = |problem: &str| {
        let found = answer(folder.path(), problem);
        let own = &found["readings"][0]["parameters"]["latitude"];
        number(&own["high"]) - number(&own["low"])
    };
    let logged = width(&log(r#"["raw.mean_deg_per_h"]"#));
    let text = std::fs::read_to_string(folder.path().join("rest.json")).expect("a log");
    let mean = serde_json::from_str::<Value>(&text).expect("JSON");
    let mean = mean["channels"]["raw"]["mean_deg_per_h"].clone();
    let error = (number(&mean["high"]) - number(&mean["low"])) / 2.0 / 1.96;
    // A degree of latitude at 40 deg is 0.2 deg/h of the mean; 3.92 deviations are the interval.
    let expected = 3.92 * error / (15.041 * 40.0_f64.to_radians().cos() * 1.0_f64.to_radians());
    assert!(
        (logged / expected - 1.0).abs() < 0.25,
        "{logged} {expected}"
    );
    let printed = format!(
        "{PROBLEM}[[published]]\nrecord = \"rest\"\nmetric = \"raw.mean_deg_per_h\"\nvalue = {}\n\
         unit = \"deg/h\"\nstandard_uncertainty = {error}\nsource = \"made up\"\n",
        mean["value"]
    );
    assert!(width(&printed) > 1.15 * logged, "{logged}");
}

#[test]
fn what_is_wrong_with_a_log_is_said_at_its_place() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    analysed(at, 1);
    write(at, "other.json", "{\"schema\": 1}\n");
    let cases = [
        log(r#"["raw.mean_deg_per_h"]"#).replace("rest.json", "none.json"),
        log(r#"["raw.mean_deg_per_h"]"#).replace("rest.json", "other.json"),
        log(r#"["lms.mean_deg_per_h"]"#),
        log(r#"["raw.mean"]"#),
        log(r#"["raw.alan[10]"]"#),
        log(r#"["raw.allan[ten]"]"#),
        log(r#"["raw.allan[1e6]"]"#),
        log(r#"["raw.angle_random_walk_deg_per_sqrt_h", "raw.allan[1]"]"#),
        log(r#"["raw.mean_deg_per_h"]"#)
            .replace("[[log]]\nrecord = \"rest\"", "[[log]]\nrecord = \"test\""),
    ];
    let mut transcript = Transcript::of("infer", "what is wrong with a log");
    for case in cases {
        write(at, "problem.toml", &case);
        let output = fogbench(at, &["infer", "problem.toml", "--check"]);
        assert_eq!(code(&output), 2, "{case}");
        let shown = case.split("[[log]]").nth(1).unwrap_or_default();
        transcript.case(format!("[[log]]{shown}"), stderr(&output));
    }
    transcript.check();
}
