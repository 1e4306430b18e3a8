//! `fogbench analyze` and `fogbench filter`: a run's own samples give the run's own numbers.

use std::path::Path;

use serde_json::Value;

use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout, summary, tree, write};

/// The transcript of commands on recorded logs.
const ON_LOGS: &str = "log-commands";

/// Pipelines and the textbook behind a gyro at rest, samples kept.
const REST: &str = "schema = 1
name = \"rest\"
duration_s = 12.0
warm_up_s = 1.0
bias_averaging_time_s = 2.0
fidelity = \"rate\"

[[filter]]
name = \"rls\"
[filter.rls]
pipeline = \"fpga\"
clock_mhz = 40.0

[[filter]]
name = \"textbook\"
[filter.rls]
pipeline = \"textbook\"

[[filter]]
name = \"lms\"
[filter.lms]
pipeline = \"fpga\"
clock_mhz = 40.0

[output]
samples = \"npy\"
";

const SWING: &str = "
[turntable.swing]
rate_amplitude_deg_per_s = 1.0
frequency_hz = 5.0
";

/// Runs the scenario and gives its summary.
fn run(folder: &Path, text: &str) -> Value {
    write(folder, "rest.toml", text);
    let output = fogbench(folder, &["run", "rest.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    summary(&folder.join("output"), "rest")
}

/// A command on the run's raw samples, with the run's rate, warm-up and averaging time.
fn on_raw(folder: &Path, run: &Value, command: &str, more: &[&str]) -> Value {
    let rate_hz = run["gyro"]["output_rate_hz"].to_string();
    let mut arguments = vec![
        command,
        "output/rest/samples/raw.npy",
        "--rate-hz",
        &rate_hz,
        "--unit",
        "deg/h",
        "--warm-up-s",
        "1",
        "--format",
        "json",
    ];
    if !more.contains(&"--motion") {
        arguments.extend(["--bias-averaging-time-s", "2"]);
    }
    let output = fogbench(folder, &[&arguments[..], more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// Every number of `want` is that of `got`; the ends of intervals, where the log's are about another noise,
/// nearly so.
///
/// A run knows the slow noise of its gyro, of which a log shows next to nothing: the intervals of its
/// means, and of what a filter learned from them, hold that noise, and a log's hold what a fit finds.
///
/// The sample period comes from the printed rate and may differ in its last bit; the fits take the
/// square of times, so that some bits more may differ.
fn assert_same(path: &str, got: &Value, want: &Value) {
    match want {
        Value::Number(number) => {
            let want = number.as_f64().expect("a number");
            let got = got.as_f64().unwrap_or_else(|| panic!("{path}: {got}"));
            let scale = want.abs().max(1e-9);
            assert!(
                (got - want).abs() <= 1e-9 * scale,
                "{path}: {got}, want {want}"
            );
        }
        Value::Array(items) => {
            assert_eq!(got.as_array().map(Vec::len), Some(items.len()), "{path}");
            for (index, item) in items.iter().enumerate() {
                assert_same(&format!("{path}[{index}]"), &got[index], item);
            }
        }
        Value::Object(fields) => {
            let width = |of: &Value| Some(of["high"].as_f64()? - of["low"].as_f64()?);
            let widths = width(got).zip(width(want));
            for (key, value) in fields {
                match (key.as_str(), widths) {
                    // What a filter learned from the truth, which a log has not, has no interval in it.
                    ("low" | "high" | "interval", _) if got["interval"].is_string() => {}
                    ("low" | "high", Some((own, of_run))) => {
                        let known = value.as_f64().expect("a number");
                        let distance = (got[key].as_f64().expect("a number") - known).abs();
                        assert!(own <= 3.0 * of_run && of_run <= 3.0 * own, "{path}: {got}");
                        assert!(distance <= own.max(of_run), "{path}: {got}, want {want}");
                    }
                    ("slow_noise_deg_per_h" | "degrees_of_freedom", _) => {}
                    _ => assert_same(&format!("{path}.{key}"), &got[key], value),
                }
            }
        }
        other => assert_eq!(got, other, "{path}"),
    }
}

/// What a verdict says before its figures.
fn judgement(verdict: &Value) -> Option<&str> {
    verdict.as_str()?.split(':').next()
}

/// Compares all metrics and curves of a channel; `of_truth` are unavailable in the log's.
fn assert_same_channel(log: &Value, run: &Value, channel: &str, of_truth: &[&str]) -> usize {
    let (got, want) = (&log["channels"][channel], &run["channels"][channel]);
    let metrics = want.as_object().expect("a channel");
    let mut compared = 0;
    for (name, value) in metrics
        .iter()
        .filter(|(name, _)| !["unavailable", "metrics"].contains(&name.as_str()))
    {
        let reason = &got["unavailable"][name];
        if name == "verdict" {
            // The figures in it have the intervals' digits.
            assert_eq!(judgement(&got[name]), judgement(value), "{channel}");
        } else if of_truth.contains(&name.as_str()) {
            assert!(got[name].is_null(), "{channel}.{name}");
            let text = reason.as_str().unwrap_or_default();
            assert!(
                text.contains("the true rate is not known"),
                "{channel}.{name}: {reason}"
            );
        } else {
            assert_same(&format!("{channel}.{name}"), &got[name], value);
            compared += 1;
        }
    }
    compared
}

#[test]
fn analysing_a_runs_raw_samples_gives_the_runs_metrics() {
    let folder = scratch();
    let run = run(folder.path(), REST);
    let log = on_raw(folder.path(), &run, "analyze", &[]);
    let compared = assert_same_channel(&log, &run, "raw", &["mean_error_deg_per_h"]);
    // Angle random walk, two bias stabilities, mean, noise, curves at least.
    assert!(compared >= 6, "{compared} metrics");
    assert!(log["channels"]["raw"]["angle_random_walk_deg_per_sqrt_h"]["value"].is_number());
    let curves = &log["channels"]["raw"]["curves"];
    assert_eq!(curves.as_object().map(serde_json::Map::len), Some(4));
    assert_eq!(log["log"]["file"], "raw.npy");
    let samples = run["scenario"]["duration_s"].as_f64().expect("a time")
        * run["gyro"]["output_rate_hz"].as_f64().expect("a rate");
    assert_close(
        log["log"]["samples"].as_f64().expect("a count"),
        samples.floor(),
        0.0,
        0.0,
    );
}

#[test]
fn a_swing_is_measured_as_far_as_it_needs_no_truth() {
    let folder = scratch();
    // The averaging time of a bias stability has no effect in a swing.
    let text = format!("{REST}{SWING}").replace("bias_averaging_time_s = 2.0\n", "");
    let run = run(folder.path(), &text);
    let more = ["--motion", "swing:5", "--filters", "rest.toml"];
    let log = on_raw(folder.path(), &run, "filter", &more);
    let of_truth = [
        "mean_error_deg_per_h",
        "delay_vs_truth_ms",
        "delay_by_correlation_ms",
        "tracking_error_rms_deg_per_h",
        "two_run_noise_std_deg_per_h",
    ];
    let of_raw = [&of_truth[..], &["amplitude_ratio"]].concat();
    assert!(assert_same_channel(&log, &run, "raw", &of_raw) >= 4);
    for channel in ["rls", "textbook", "lms"] {
        assert!(assert_same_channel(&log, &run, channel, &of_truth) >= 10);
        assert!(log["channels"][channel]["delay_vs_raw_ms"]["value"].is_number());
    }
    let reason = &log["channels"]["raw"]["unavailable"]["delay_vs_encoder_ms"];
    assert_eq!(reason, "a recorded log brings no angle of an encoder");
}

#[test]
fn filtering_a_runs_raw_samples_gives_its_words_to_the_bit_and_its_trial() {
    let folder = scratch();
    let run = run(folder.path(), REST);
    let more = ["--filters", "rest.toml", "-o", "replay", "--csv"];
    let log = on_raw(folder.path(), &run, "filter", &more);
    for channel in ["rls", "textbook", "lms"] {
        let name = format!("samples/{channel}.npy");
        let of = |place: &str| std::fs::read(folder.path().join(place).join(&name)).expect(&name);
        let (replayed, words) = (of("replay"), of("output/rest"));
        assert!(replayed.len() > 8 * 50_000, "{} bytes", replayed.len());
        assert!(replayed == words, "{channel} differs from the run's words");
        assert!(assert_same_channel(&log, &run, channel, &["mean_error_deg_per_h"]) >= 12);
    }
    let names: Vec<String> = tree(&folder.path().join("replay"))
        .iter()
        .map(|(path, _)| path.to_string_lossy().into_owned())
        .collect();
    for name in [
        "allan.csv",
        "allan.svg",
        "autocovariance.csv",
        "psd.csv",
        "rate.svg",
        "samples/lms.csv",
        "samples/rls.csv",
        "spectrum.svg",
        "summary.json",
    ] {
        assert!(
            names.iter().any(|found| found == name),
            "{name} is not in {names:?}"
        );
    }
    let written = std::fs::read_to_string(folder.path().join("replay/summary.json"));
    let written: Value = serde_json::from_str(&written.expect("readable")).expect("JSON");
    assert_eq!(written, log);
    assert_eq!(log["log"]["filters"]["file"], "rest.toml");
    // No true rate, no line for it.
    let rate = std::fs::read_to_string(folder.path().join("replay/rate.svg")).expect("readable");
    assert!(rate.contains("textbook") && !rate.contains("true rate"));
}

/// A text of `count` rates of white noise above 8 deg/h.
fn text_log(folder: &Path, count: usize) {
    let mut text = "time_s,rate\n".to_owned();
    for k in 0..count {
        // SplitMix64 (Steele et al. 2014): noise without a library.
        let mut word = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let noise = (word ^ (word >> 31)) >> 40;
        text.push_str(&format!(
            "{:?},{:?}\n",
            k as f64 / 100.0,
            8.0 + noise as f64 / 1e7
        ));
    }
    write(folder, "log.csv", &text);
}

const ON_TEXT: [&str; 6] = [
    "log.csv",
    "--unit",
    "deg/h",
    "--time",
    "time_s",
    "--rate-hz",
];

#[test]
fn the_table_heads_the_log_and_says_what_is_lacking() {
    let folder = scratch();
    text_log(folder.path(), 6400);
    let output = fogbench(
        folder.path(),
        &["analyze", "log.csv", "--unit", "deg/h", "--time", "time_s"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.starts_with("log.csv, column rate  recorded log, deg/h, 6400 samples"),
        "{text}"
    );
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "ARW",
        "no mean_error_deg_per_h for raw: the true rate is not known",
        "note: time column: 100.000000 Hz, no gap",
    ] {
        assert!(words.contains(part), "no `{part}` in {text}");
    }
    let line = fogbench(
        folder.path(),
        &[&["analyze"], &ON_TEXT[..], &["100", "--format", "jsonl"]].concat(),
    );
    assert_eq!(stdout(&line).lines().count(), 1);
    assert!(serde_json::from_str::<Value>(&stdout(&line)).is_ok());
}

#[test]
fn bad_logs_and_usage_exit_2_and_unreadable_files_74() {
    let folder = scratch();
    text_log(folder.path(), 200);
    write(folder.path(), "bare.toml", "schema = 1\n");
    let slow = "schema = 1\n[[filter]]\nname = \"rls\"\n[filter.rls]\npipeline = \"fpga\"\n\
                clock_mhz = 0.001\n";
    write(folder.path(), "slow.toml", slow);
    let on = |command: &str, more: &[&str]| {
        let output = fogbench(folder.path(), &[&[command], &ON_TEXT[..], more].concat());
        (code(&output), stderr(&output))
    };
    let mut transcript = Transcript::of(ON_LOGS, "Logs and options that cannot be");
    for (command, more) in [
        ("analyze", "90"),
        ("analyze", "0"),
        ("analyze", "100 --warm-up-s 3"),
        ("analyze", "100 --motion swing:30"),
        ("analyze", "100 --motion swing:-1"),
        ("analyze", "100 --rows 1-2000"),
        ("analyze", "100 --rows 5:2"),
        ("analyze", "100 --scale 0"),
        ("filter", "100"),
        ("filter", "100 --filters bare.toml"),
        ("filter", "100 --filters slow.toml"),
        ("filter", "100 --filters none.toml"),
        ("filter", "100 --filters slow.toml --csv"),
    ] {
        let words: Vec<&str> = more.split(' ').collect();
        let (code, text) = on(command, &words);
        assert_eq!(code, 2, "{more}: {text}");
        transcript.case(format!("{command} log.csv --rate-hz {more}"), text);
    }
    let clockless = [
        "analyze", "log.csv", "--unit", "deg/h", "--column", "rate", "--time", "none",
    ];
    let output = fogbench(folder.path(), &clockless);
    assert_eq!(code(&output), 2);
    transcript.case(clockless.join(" "), stderr(&output));
    let missing = ["analyze", "none.csv", "--unit", "deg/h", "--rate-hz", "1"];
    let output = fogbench(folder.path(), &missing);
    assert_eq!(code(&output), 74, "{}", stderr(&output));
    transcript.case(missing.join(" "), stderr(&output));
    let (code, text) = on("analyze", &["100", "-o", "log.csv"]);
    assert_eq!(code, 2, "{text}");
    transcript.case("analyze log.csv --rate-hz 100 -o log.csv", text);
    transcript.check();
}

#[test]
fn a_filter_that_diverges_on_a_log_exits_3_and_leaves_the_others() {
    let folder = scratch();
    text_log(folder.path(), 6400);
    // Four taps on 8 deg/h: the step bound is 2 / (4 * 64), some 0.008.
    let filters = "schema = 1\n[[filter]]\nname = \"wild\"\n[filter.lms]\nnormalised = false\n\
                   allow_unstable = true\nstep_size = 1.0\npipeline = \"textbook\"\n\
                   [[filter]]\nname = \"tame\"\n[filter.rls]\npipeline = \"textbook\"\n";
    write(folder.path(), "filters.toml", filters);
    let more = [
        "100",
        "--filters",
        "filters.toml",
        "-o",
        "out",
        "--format",
        "json",
    ];
    let output = fogbench(folder.path(), &[&["filter"], &ON_TEXT[..], &more].concat());
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    let log: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(log["channels"]["wild"]["error"]["kind"], "diverged");
    assert!(log["channels"]["tame"]["noise_gain"]["value"].is_number());
    let words = |name: &str| folder.path().join("out/samples").join(name).exists();
    assert!(words("tame.npy") && !words("wild.npy"));
}
