//! A log beside the temperature of its gyro: known coefficients come back, with intervals that hold.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use fogbench::Scenario;
use fogbench::gyro::coil_temperatures_c;
use fogbench::metrics::{ChannelMetrics, WarmRecord, measure_temperature};
use fogbench::scenario::{TemperatureConfig, TemperatureProfileConfig};
use serde_json::Value;

use crate::support::records::normals;
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// Metrics of the bias, with the coefficients of [`Warm`].
const TERMS: [(&str, f64); 3] = [
    ("bias_temperature_coefficient_deg_per_h_per_k", 0.05),
    ("bias_temperature_coefficient_deg_per_h_per_k2", -0.004),
    (
        "bias_temperature_rate_coefficient_deg_per_h_per_k_per_min",
        0.8,
    ),
];
const SCALE: &str = "scale_factor_temperature_coefficient_ppm_per_k";
const HYSTERESIS: &str = "temperature_hysteresis_deg_per_h";
const HYSTERESIS_LEFT: &str = "temperature_hysteresis_left_deg_per_h";
/// Rise and fall of the temperature, s.
const CYCLE_S: f64 = 9000.0;
/// Words of a log, a second each.
const WORDS: usize = 21_600;

/// Words of a gyro whose temperature swings about 25 C, read in steps of 1/16 K.
struct Warm {
    words: Vec<f64>,
    truth: Vec<f64>,
    temperature_c: Vec<f64>,
}

/// * `walk_deg_per_h`: step of a random walk of the bias, of each second.
/// * `truth`: true rate at a time, deg/h; the scale factor grows by 20 ppm/K.
fn warm(seed: u64, walk_deg_per_h: f64, truth: impl Fn(f64) -> f64) -> Warm {
    let (white, steps) = (normals(seed, "white", WORDS), normals(seed, "walk", WORDS));
    let mut walk = 0.0;
    let mut log = Warm {
        words: Vec::new(),
        truth: Vec::new(),
        temperature_c: Vec::new(),
    };
    for second in 0..WORDS {
        let time_s = (second + 1) as f64;
        let turn = TAU * time_s / CYCLE_S;
        let warmer_k = 15.0 * turn.sin();
        let rate_k_per_min = 15.0 * turn.cos() * TAU / CYCLE_S * 60.0;
        walk += walk_deg_per_h * steps[second];
        let [linear, square, rate] = TERMS.map(|term| term.1);
        let bias = 8.0 + (linear + square * warmer_k) * warmer_k + rate * rate_k_per_min;
        let true_rate = truth(time_s);
        let scale = 1.0 + 20e-6 * warmer_k;
        log.words
            .push(scale * true_rate + bias + walk + white[second]);
        log.truth.push(true_rate);
        log.temperature_c
            .push(25.0 + (16.0 * warmer_k).round() / 16.0);
    }
    log
}

impl Warm {
    fn measured(&self, with_truth: bool, swing_hz: Option<f64>) -> ChannelMetrics {
        let record = WarmRecord {
            words_deg_per_h: &self.words,
            truth_deg_per_h: if with_truth { &self.truth } else { &[] },
            temperature_c: &self.temperature_c,
            sample_period_s: 1.0,
            first_stamp_s: 1.0,
            swing_hz,
        };
        let mut metrics = ChannelMetrics::default();
        measure_temperature(&record, Some(25.0), &mut metrics);
        metrics
    }

    /// The same as a text with a heading.
    fn text(&self) -> String {
        let mut text = "time_s,gyro_deg_per_h,table_deg_per_h,coil_c\n".to_owned();
        for (index, word) in self.words.iter().enumerate() {
            let (truth, warmth) = (self.truth[index], self.temperature_c[index]);
            writeln!(text, "{},{word:.5},{truth:.5},{warmth}", index + 1).expect("a string");
        }
        text
    }
}

#[test]
fn known_answer_coefficients_lie_in_their_intervals_under_white_noise_and_a_random_walk() {
    for walk in [0.0, 0.003] {
        let (mut held, mut all) = (0, 0);
        for seed in 0..8 {
            let metrics = warm(seed, walk, |_| 0.0).measured(false, None);
            for (name, want) in TERMS {
                let found = &metrics.metrics[name];
                let estimate = found.estimate;
                held += usize::from((estimate.low..=estimate.high).contains(&want));
                all += 1;
                let width = estimate.high - estimate.low;
                assert!(width < 0.9 * want.abs(), "{name}: {estimate:?}");
                assert!(found.fields["p_value"] < 1e-3, "{name}: {found:?}");
                assert_close(found.fields["reference_c"], 25.0, 0.0, 0.0);
            }
        }
        // Of 24 intervals of 95 %, fewer than 20 hold in one case of 160.
        assert!(held >= 20, "walk {walk}: {held} of {all}");
    }
}

#[test]
fn an_effect_that_is_not_there_is_not_significant_nor_applied() {
    let (mut told, mut all) = (0, 0);
    for seed in 0..8 {
        let mut log = warm(seed, 0.003, |_| 0.0);
        for (word, warmth) in log.words.iter_mut().zip(&log.temperature_c) {
            let k = warmth - 25.0;
            *word -= (0.05 - 0.004 * k) * k;
        }
        let metrics = log.measured(false, None);
        for (name, _) in &TERMS[..2] {
            let found = &metrics.metrics[*name];
            let is_told = found.fields["p_value"] < 0.05;
            assert_eq!(is_told, found.fields["applied"].abs() > 0.0, "{found:?}");
            told += usize::from(is_told);
            all += 1;
        }
        assert!(metrics.metrics[TERMS[2].0].fields["applied"] > 0.5);
    }
    // One in twenty by chance: more than four of sixteen in one case of a thousand.
    assert!(told <= 4, "{told} of {all}");
}

#[test]
fn known_answer_the_rate_of_the_temperature_makes_a_hysteresis_and_its_coefficient_takes_it_away() {
    let metrics = warm(3, 0.0, |_| 0.0).measured(false, None);
    // The mean of |cos| where it exceeds the part that counts as still, beside a parabola of the sine.
    let found = metrics.metrics[HYSTERESIS].estimate;
    let rate_k_per_min = 15.0 * TAU / CYCLE_S * 60.0;
    let least = 0.8 * 2.0 * 0.6 * rate_k_per_min;
    let most = 0.8 * 2.0 * rate_k_per_min;
    assert!((least..most).contains(&found.value), "{found:?}");
    let left = metrics.metrics[HYSTERESIS_LEFT].estimate;
    assert!(left.low < 0.0 && left.high > 0.0, "{left:?}");
    assert!(left.value.abs() < 0.1 * found.value, "{left:?}");
    let residual = &metrics.metrics["temperature_residual_std_deg_per_h"];
    // White noise of 1 deg/h in means of 45 s.
    assert_close(residual.estimate.value, 1.0 / 45.0_f64.sqrt(), 0.1, 0.0);
    assert!(residual.fields["before_deg_per_h"] > 0.4);
}

#[test]
fn known_answer_the_scale_factor_goes_with_the_temperature_where_a_reference_or_a_swing_shows_it() {
    let steps = |time_s: f64| {
        if (time_s / 500.0).fract() < 0.5 {
            36_000.0
        } else {
            -18_000.0
        }
    };
    let swing = |time_s: f64| 36_000.0 * (TAU * 0.1 * time_s).cos();
    let stairs = warm(5, 0.0, steps);
    let swung = warm(6, 0.0, swing);
    for (metrics, width) in [
        (stairs.measured(true, None), 0.6),
        (swung.measured(true, Some(0.1)), 0.6),
        (swung.measured(false, Some(0.1)), 0.6),
    ] {
        let found = metrics.metrics[SCALE].estimate;
        // The swing has the scale's temperature under the mean as well: 20 ppm/K to first order.
        assert!(
            (found.low - 0.05..=found.high + 0.05).contains(&20.0),
            "{found:?}"
        );
        assert!(found.high - found.low < width, "{found:?}");
        let bias = metrics.metrics[TERMS[2].0].estimate;
        assert!((bias.value - 0.8).abs() < 0.2, "{bias:?}");
    }
    let still = warm(5, 0.0, |_| 36_000.0).measured(true, None);
    let reason = still.why_unavailable(&fogbench::metrics::catalogue::SCALE_FACTOR_PER_K);
    assert_eq!(reason, Some("the reference does not vary"));
}

/// A gyro of the rate model in a chamber that goes up and down twice; nothing but its noise, and the effects
/// of the temperature. Half an hour of a coil that follows its case within a minute or so, as the rate model finds
/// the matrices of its loop anew for each word.
const CHAMBER: &str = r#"
schema = 1
name = "chamber"
duration_s = 1800.0
warm_up_s = 0.0
fidelity = "rate"
seed = 4
[turntable.site]
latitude_deg = 0.0
[turntable.static]
[gyro.output]
half_periods_per_sample = 255320
[gyro.slow_noise]
bias_instability_deg_per_h = 0.0
rate_random_walk_deg_per_h_per_sqrt_h = 0.0
[gyro.temperature.profile]
times_s = [0.0, 450.0, 900.0, 1350.0, 1800.0]
temperatures_c = [10.0, 40.0, 10.0, 40.0, 10.0]
[gyro.thermal]
case_time_constant_s = 75.0
outer_time_constant_s = 37.5
inner_time_constant_s = 12.5
index_per_k = 0.0
bias_deg_per_h_per_k = 0.03
bias_deg_per_h_per_k2 = -0.002
bias_deg_per_h_per_c_per_min = 0.5
"#;

#[test]
fn known_answer_a_simulated_gyro_gives_back_what_its_file_says() {
    let run = Scenario::from_toml(CHAMBER).expect("a sound text").run();
    let run = run.expect("it runs");
    let samples = run.samples("raw").expect("raw words");
    let words = samples.measured();
    let (first_s, next_s) = (samples.time_s(0), samples.time_s(1));
    let mut gyro = reference_gyro();
    gyro.temperature = TemperatureConfig::Profile(TemperatureProfileConfig {
        times_s: vec![0.0, 450.0, 900.0, 1350.0, 1800.0],
        temperatures_c: vec![10.0, 40.0, 10.0, 40.0, 10.0],
        ..TemperatureProfileConfig::reference()
    });
    gyro.thermal.case_time_constant_s = 75.0;
    gyro.thermal.outer_time_constant_s = 37.5;
    gyro.thermal.inner_time_constant_s = 12.5;
    let count = u32::try_from(words.len()).expect("some words");
    let temperature_c = coil_temperatures_c(&gyro, first_s, next_s - first_s, count);
    let record = WarmRecord {
        words_deg_per_h: words,
        truth_deg_per_h: &[],
        temperature_c: &temperature_c,
        sample_period_s: next_s - first_s,
        first_stamp_s: first_s,
        swing_hz: None,
    };
    let mut metrics = ChannelMetrics::default();
    measure_temperature(&record, Some(25.0), &mut metrics);
    for (name, want) in [(TERMS[0].0, 0.03), (TERMS[1].0, -0.002), (TERMS[2].0, 0.5)] {
        let found = metrics.metrics[name].estimate;
        assert!(
            (found.low..=found.high).contains(&want),
            "{name}: {found:?}"
        );
        assert!(
            found.high - found.low < 0.5 * want.abs(),
            "{name}: {found:?}"
        );
    }
}

#[track_caller]
fn analyze(folder: &Path, arguments: &[&str], exit: i32) -> String {
    let output = fogbench(folder, &[&["analyze", "log.csv"], arguments].concat());
    assert_eq!(code(&output), exit, "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

#[test]
fn a_log_with_a_temperature_is_measured_with_and_without_it() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    write(path, "log.csv", &warm(3, 0.0, |_| 0.0).text());
    let column = ["--column", "gyro", "--temperature-column", "coil_c"];
    let written = [
        "--temperature-reference-c",
        "25",
        "-o",
        "out",
        "--format",
        "json",
    ];
    let report = analyze(path, &[&column[..], &written].concat(), 0);
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let raw = &report["channels"]["raw"];
    for (name, want) in TERMS {
        let found = |key: &str| raw[name][key].as_f64().expect("a number");
        assert!((found("low")..=found("high")).contains(&want), "{name}");
        assert_close(found("applied"), want, 0.3, 0.0);
    }
    let std = |channel: &str| {
        let metric = &report["channels"][channel]["noise_std_deg_per_h"]["value"];
        metric.as_f64().expect("a number")
    };
    // White noise of 1 deg/h is left.
    assert_close(std("raw_without_temperature"), 1.0, 0.02, 0.0);
    assert!(std("raw") > 1.1, "{}", std("raw"));
    for file in ["out/temperature.csv", "out/temperature.svg"] {
        assert!(path.join(file).is_file(), "{file}");
    }
    let mut transcript = Transcript::of("log_temperature", "A log with its temperature");
    let text = analyze(path, &column, 0);
    transcript.case(
        "analyze log.csv --column gyro --temperature-column coil_c",
        text,
    );
    transcript.check();
}

#[test]
fn a_log_whose_temperature_does_not_change_says_so() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    let mut log = warm(3, 0.0, |_| 0.0);
    log.temperature_c.fill(25.25);
    write(path, "log.csv", &log.text());
    let column = ["--column", "gyro", "--temperature-column", "coil_c"];
    let mut transcript = Transcript::of("log_temperature", "Temperatures that tell nothing");
    let told = |text: &str| {
        let from = text.find("  no temperature").unwrap_or_default();
        text[from..]
            .split("\n\n")
            .next()
            .map(str::to_owned)
            .unwrap_or_default()
    };
    transcript.case("a constant temperature", told(&analyze(path, &column, 0)));
    let short = [&column[..], &["--to-s", "30"]].concat();
    let text = analyze(path, &short, 0);
    transcript.case("30 s of it", told(&text));
    // A kelvin is no degree Celsius, and a word is none either.
    log.temperature_c.fill(298.4);
    write(path, "log.csv", &log.text());
    let output = fogbench(path, &[&["analyze", "log.csv"], &column[..]].concat());
    assert_eq!(code(&output), 2);
    transcript.case("a temperature in kelvin", stderr(&output));
    let output = fogbench(
        path,
        &[
            "analyze",
            "log.csv",
            "--column",
            "gyro",
            "--temperature-column",
            "oven",
        ],
    );
    assert_eq!(code(&output), 2);
    transcript.case("no such column", stderr(&output));
    transcript.check();
}

#[test]
fn a_scenario_gates_the_temperature_of_its_log() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    write(path, "log.csv", &warm(3, 0.0, |_| 0.0).text());
    let log = "schema = 1\nname = \"warm\"\n[log]\nfile = \"log.csv\"\ncolumn = [\"gyro\"]\n";
    let column = "temperature_column = \"coil_c\"\ntemperature_reference_c = 25.0\n";
    let gates = |max: f64| {
        format!(
            "[[gate]]\nmetric = \"raw.{}\"\nmax = {max}\n\
             [[gate]]\nmetric = \"raw_without_temperature.noise_std_deg_per_h\"\nmax = 1.05\n",
            TERMS[0].0
        )
    };
    for (max, exit) in [(0.1, 0), (0.01, 1)] {
        write(path, "warm.toml", &[log, column, &gates(max)].concat());
        let output = fogbench(path, &["run", "warm.toml", "-o", "out"]);
        assert_eq!(code(&output), exit, "{}", stderr(&output));
    }
    assert!(path.join("out/warm/temperature.svg").is_file());
    write(path, "warm.toml", &[log, &gates(0.1)].concat());
    let output = fogbench(path, &["check", "warm.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of("log_temperature", "Gates without a temperature");
    transcript.case("gates of a log without temperature_column", stderr(&output));
    transcript.check();
}

#[test]
fn a_running_angle_and_a_gap_keep_their_temperatures() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path();
    let log = warm(3, 0.0, |_| 0.0);
    let mut angle_deg = 0.0;
    let mut text = "time_s,angle_deg,coil_c\n".to_owned();
    for (index, word) in log.words.iter().enumerate() {
        angle_deg += word / 3600.0;
        // 100 s are missing.
        if !(9000..9100).contains(&index) {
            let warmth = log.temperature_c[index];
            writeln!(text, "{},{angle_deg:.9},{warmth}", index + 1).expect("a string");
        }
    }
    write(path, "log.csv", &text);
    let angle = ["--column", "angle_deg", "--unit", "deg", "--kind", "angle"];
    let rest = [
        "--temperature-column",
        "coil_c",
        "--temperature-reference-c",
        "25",
        "--split-gaps",
        "--format",
        "json",
    ];
    let report = analyze(path, &[&angle[..], &rest].concat(), 0);
    let report: Value = serde_json::from_str(&report).expect("JSON");
    for (name, want) in TERMS {
        let found = |key: &str| {
            report["channels"]["raw"][name][key]
                .as_f64()
                .expect("a number")
        };
        assert!((found("low")..=found("high")).contains(&want), "{name}");
    }
}
