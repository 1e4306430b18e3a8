//! `fogbench analyze` and `fogbench filter` on logs with something the matter: outliers, smoothing.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::records::white;
use crate::support::{code, fogbench, stderr, stdout, write};

/// Rate of the words, Hz.
const RATE_HZ: f64 = 100.0;

/// White noise of 1.2 deg/sqrt(h) in words of 10 ms, deg/s: `1.2 x 60 / sqrt(0.01) / 3600`.
const WORD_STD_DEG_PER_S: f64 = 0.2;

fn log(folder: &Path, words: &[f64]) {
    let mut text = String::from("rate\n");
    for word in words {
        writeln!(text, "{word:.6}").expect("writing to a string");
    }
    write(folder, "log.csv", &text);
}

fn run(folder: &Path, command: &str, more: &[&str]) -> String {
    let arguments = ["log.csv", "--unit", "deg/s", "--rate-hz", "100"];
    let output = fogbench(folder, &[&[command], &arguments[..], more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    stdout(&output)
}

fn analysed(words: &[f64], more: &[&str]) -> (Value, String) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    log(folder.path(), words);
    let json = run(
        folder.path(),
        "analyze",
        &[more, &["--format", "json"]].concat(),
    );
    let text = run(folder.path(), "analyze", more);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    (serde_json::from_str(&json).expect("JSON"), text)
}

fn value(json: &Value, channel: &str, metric: &str) -> f64 {
    let metric = &json["channels"][channel][metric];
    metric["value"]
        .as_f64()
        .unwrap_or_else(|| panic!("{channel}: {metric}"))
}

#[test]
fn two_spikes_in_a_static_log_are_listed_and_the_figures_without_them_stand_beside() {
    let clean = white(11, 4000, WORD_STD_DEG_PER_S);
    let mut words = clean.clone();
    words[1000] += 200.0 * WORD_STD_DEG_PER_S;
    words[2600] -= 300.0 * WORD_STD_DEG_PER_S;
    let (json, text) = analysed(&words, &[]);
    let list = json["channels"]["raw"]["outlier_list"]
        .as_array()
        .expect("a list");
    let places: Vec<_> = list
        .iter()
        .map(|it| (it["index"].as_u64(), it["words"].as_u64()))
        .collect();
    assert_eq!(places, [(Some(1000), Some(1)), (Some(2600), Some(1))]);
    let sizes = [200.0, -300.0].map(|size| size * WORD_STD_DEG_PER_S * 3600.0);
    for (found, size) in list.iter().zip(sizes) {
        let found = found["size_deg_per_h"].as_f64().expect("a size");
        assert!((found / size - 1.0).abs() < 0.02, "{found} {size}");
    }
    // Of the clean log, what it measures; without the outliers the same, two of 4000 words fewer.
    let (wanted, none) = analysed(&clean, &[]);
    for (metric, within) in [
        ("angle_random_walk_deg_per_sqrt_h", 0.01),
        ("noise_std_deg_per_h", 0.001),
        ("bias_stability_1s_deg_per_h", 0.01),
    ] {
        let without = value(&json, "raw_without_outliers", metric);
        let wanted = value(&wanted, "raw", metric);
        assert!(
            (without / wanted - 1.0).abs() < within,
            "{metric}: {without} {wanted}"
        );
        assert!(value(&json, "raw", metric) > 1.5 * wanted, "{metric}");
    }
    let walk = value(
        &json,
        "raw_without_outliers",
        "angle_random_walk_deg_per_sqrt_h",
    );
    assert!((1.1..1.3).contains(&walk), "{walk}");
    assert!(value(&json, "raw", "angle_random_walk_deg_per_sqrt_h") > 5.0);
    // Differences that touch one of two spikes far apart are left out: four averaging times of starts.
    let count = |channel: &str, curve: &str| {
        json["channels"][channel]["curves"][curve]["count"][3].as_f64()
    };
    assert_eq!(count("raw", "allan_fit"), Some(4001.0 - 8.0));
    assert_eq!(
        count("raw_without_outliers", "allan_fit"),
        Some(4001.0 - 8.0 - 16.0)
    );
    assert!(text.contains("outliers of raw: 2 beyond "), "{text}");
    assert!(text.contains("word 1000 at 10.010 s (+14"), "{text}");
    assert!(text.contains("raw_without_outliers"), "{text}");
    assert!(none.contains("outliers of raw: none beyond "), "{none}");
    assert!(wanted["channels"]["raw_without_outliers"].is_null());
    assert_eq!(
        value(&wanted, "raw", "outliers").to_bits(),
        0.0_f64.to_bits()
    );
}

#[test]
fn a_glitch_on_a_swing_is_found_and_its_noise_is_that_without_it() {
    let swing = |index: usize| 10.0 * (TAU * 0.5 * index as f64 / RATE_HZ).sin();
    let mut words: Vec<f64> = white(12, 6000, WORD_STD_DEG_PER_S)
        .iter()
        .enumerate()
        .map(|(index, noise)| swing(index) + noise)
        .collect();
    let motion = ["--motion", "swing:0.5"];
    let (clean, text) = analysed(&words, &motion);
    assert!(text.contains("outliers of raw: none beyond "), "{text}");
    for word in &mut words[3010..3013] {
        *word += 4.0;
    }
    let (json, _) = analysed(&words, &motion);
    let list = &json["channels"]["raw"]["outlier_list"];
    assert_eq!(
        (list[0]["index"].as_u64(), list[0]["words"].as_u64()),
        (Some(3010), Some(3))
    );
    assert!(list[1].is_null());
    for metric in ["noise_std_deg_per_h", "mean_deg_per_h"] {
        let wanted = value(&clean, "raw", metric);
        let without = value(&json, "raw_without_outliers", metric);
        assert!(
            (without - wanted).abs() < 1e-3 * wanted.abs().max(500.0),
            "{metric} {without} {wanted}"
        );
    }
    assert!(
        value(&json, "raw", "noise_std_deg_per_h")
            > 1.05 * value(&clean, "raw", "noise_std_deg_per_h")
    );
}

#[test]
fn a_step_is_no_outlier_and_coarse_words_are_not_judged() {
    let mut words = white(13, 4000, WORD_STD_DEG_PER_S);
    for word in &mut words[2000..] {
        *word += 50.0;
    }
    let (json, _) = analysed(&words, &[]);
    assert_eq!(value(&json, "raw", "outliers").to_bits(), 0.0_f64.to_bits());
    let coarse: Vec<f64> = words[..2000]
        .iter()
        .map(|it| (it / 0.4).round() * 0.4)
        .collect();
    let (json, text) = analysed(&coarse, &[]);
    let reason = json["channels"]["raw"]["unavailable"]["outliers"]
        .as_str()
        .expect("a reason");
    assert!(reason.contains("distinct values, fewer than 8"), "{reason}");
    assert!(
        text.contains(&format!("outliers of raw: {reason}")),
        "{text}"
    );
}

#[test]
fn a_log_that_was_smoothed_is_named_and_one_that_was_not_is_not() {
    let clean = white(14, 20_000, WORD_STD_DEG_PER_S);
    let smooth: Vec<f64> = clean
        .windows(200)
        .map(|window| window.iter().sum::<f64>() / 200.0)
        .collect();
    let (json, text) = analysed(&smooth, &[]);
    let time = value(&json, "raw", "smoothing_averaging_time_s");
    assert!((time / 2.0 - 1.0).abs() < 0.1, "{time}");
    assert!(
        text.contains("raw behaves as if averaged over about 2 s ("),
        "{text}"
    );
    let words = json["channels"]["raw"]["smoothing"]
        .as_str()
        .expect("words");
    assert!(
        words.ends_with("as behind a mean); noise inside that time is not the gyro's"),
        "{words}"
    );
    let (json, text) = analysed(&clean, &[]);
    let reason = &json["channels"]["raw"]["unavailable"]["smoothing_averaging_time_s"];
    assert!(
        reason
            .as_str()
            .is_some_and(|it| it.starts_with("no averaging shows")),
        "{reason}"
    );
    assert!(!text.contains("behaves as if averaged"), "{text}");
}
