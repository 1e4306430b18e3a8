//! A campaign calibrated by every sample with the rate of the table's encoder, beside its group means.

use std::fs;

use serde_json::Value;

use crate::support::{code, fogbench, repository, stderr, stdout, write};

/// Estimators that are compared: the means with the same unknowns, and the samples.
const MEANS: &str = "batch-temperature";
const SAMPLES: &str = "encoder-rate";

fn scenario() -> String {
    let path = repository("scenarios/patent/encoder-rate.toml");
    let text = fs::read_to_string(path).expect("the scenario");
    let base = repository("scenarios/base/patent.toml");
    text.replace("../base/patent.toml", &base.display().to_string())
}

/// Calibrates the scenario with keys changed.
fn calibrated(sets: &[String]) -> Value {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "campaign.toml", &scenario());
    let sets = sets.iter().flat_map(|set| ["--set", set.as_str()]);
    let arguments: Vec<&str> = ["calibrate", "campaign.toml", "--format", "json"]
        .into_iter()
        .chain(sets)
        .collect();
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

fn estimate<'a>(report: &'a Value, name: &str) -> &'a Value {
    let estimates = match &report["estimates"] {
        Value::Null => &report["calibration"]["estimates"],
        found => found,
    };
    &estimates[name]
}

/// Root mean square of three numbers.
fn rms(values: &Value) -> f64 {
    let values = values.as_array().expect("three numbers").iter();
    let squares = values.map(|value| value.as_f64().expect("a number").powi(2));
    (squares.sum::<f64>() / 3.0).sqrt()
}

fn bias_error(report: &Value, name: &str) -> f64 {
    rms(&estimate(report, name)["standard_error"]["bias_deg_per_h"])
}

#[test]
fn known_answer_samples_find_the_parameters_within_their_covariance() {
    const SEEDS: u32 = 40;
    let mut sum = 0.0;
    for seed in 1..=SEEDS {
        let report = calibrated(&[format!("seed={seed}")]);
        let own = &estimate(&report, SAMPLES)["error"]["normalised_error_squared"];
        sum += own.as_f64().expect("a number");
    }
    // 99.9 % of the means of so many chi-squares of 12 degrees of freedom.
    let mean = sum / f64::from(SEEDS);
    let open = 3.29 * (24.0 / f64::from(SEEDS)).sqrt();
    assert!((mean - 12.0).abs() < open, "{mean}");
}

#[test]
fn known_answer_the_delay_of_the_encoder_and_what_was_left_out_are_told() {
    // Of itself a gyro is as late as its loop; an encoder that is late makes it early.
    let [own, late] = [0.0, 5000.0].map(|latency_us| {
        let report = calibrated(&[format!("turntable.encoder.latency_us={latency_us:?}")]);
        let found = estimate(&report, SAMPLES);
        let rejected = found["rejected_samples"].as_array().expect("three counts");
        // Beyond five robust deviations lies one normal sample in two million.
        assert!(
            rejected.iter().all(|count| count.as_u64() < Some(10)),
            "{rejected:?}"
        );
        found["delay_ms"].clone()
    });
    for axis in 0..3 {
        let of = |delay: &Value, field: &str| delay[field][axis].as_f64().expect("a number");
        let change = of(&late, "value") - of(&own, "value");
        let open = 4.0 * of(&own, "standard_error");
        assert!(
            (change + 5.0).abs() < open,
            "{axis}: {change} within {open}"
        );
        assert!(open < 0.2, "{open}");
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "campaign.toml", &scenario());
    let text = stdout(&fogbench(folder.path(), &["calibrate", "campaign.toml"]));
    assert!(
        text.contains("  delay x ") && text.contains("  rejected z "),
        "{text}"
    );
}

#[test]
fn samples_save_the_time_of_the_pauses() {
    // A standard error by the scatter of a record is known to a tenth or so: the mean of four.
    let mean = |name: &str, sets: &[&str]| {
        let errors = (1..=4).map(|seed| {
            let seed = format!("seed={seed}");
            let sets = sets.iter().map(|set| (*set).to_owned());
            bias_error(&calibrated(&sets.chain([seed]).collect::<Vec<_>>()), name)
        });
        errors.sum::<f64>() / 4.0
    };
    let (by_means, by_samples) = (mean(MEANS, &[]), mean(SAMPLES, &[]));
    assert!(by_samples < 0.85 * by_means, "{by_samples} {by_means}");
    // The means want groups of half the length more for the same bias: 1788 s in place of 1464 s.
    let longer = ["turntable.calibration.record_s=108", "duration_s=1800"];
    let by_longer_means = mean(MEANS, &longer);
    assert!(
        by_samples < 1.1 * by_longer_means,
        "{by_samples} {by_longer_means}"
    );
}

#[test]
fn a_delay_of_the_encoder_is_told_from_a_scale_factor() {
    let late = calibrated(&["turntable.encoder.latency_us=5000".to_owned()]);
    let error = &estimate(&late, SAMPLES)["error"]["normalised_error_squared"];
    let error = error.as_f64().expect("a number");
    assert!(error < 45.0, "{error}");
}

#[test]
fn samples_want_an_encoder_and_a_campaign() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let without = scenario().replace("[turntable.encoder]\nresolution_arcsec = 0.36\n", "");
    write(folder.path(), "campaign.toml", &without);
    let output = fogbench(folder.path(), &["check", "campaign.toml"]);
    assert_eq!(code(&output), 2);
    let said = stderr(&output);
    assert!(
        said.contains("turntable.encoder.resolution_arcsec"),
        "{said}"
    );
    let groups = "mounting,rate_deg_per_s,temperature_c,output_x_deg_per_h,output_y_deg_per_h,output_z_deg_per_h\n\
                  x,10,25,36000,0,0\n";
    write(folder.path(), "groups.csv", groups);
    let arguments = [
        "calibrate",
        "groups.csv",
        "--latitude-deg",
        "30",
        "--estimator",
        SAMPLES,
    ];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 2);
    let said = stderr(&output);
    assert!(said.contains("a groups file holds their means"), "{said}");
}
