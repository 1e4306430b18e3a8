//! The shipped reproduction scenarios against theory: whole runs of the program.

use std::process::{Command, Stdio};
use std::time::Duration;

use crate::support::{assert_close, code, field, fogbench, repository, stderr, stdout, summary};

/// Output sample period of the default gyro, ms: 64 transit times of 1.4677 * 800 m / c.
const SAMPLE_PERIOD_MS: f64 = 64.0 * 1.4677 * 800.0 / 299_792_458.0 * 1e3;

fn run(scenario: &str, more: &[&str]) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = repository(&format!("scenarios/paper/{scenario}.toml"));
    let path = path.to_string_lossy().into_owned();
    let mut arguments = vec!["run", path.as_str(), "-o", "out"];
    arguments.extend(more);
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    summary(&folder.path().join("out"), scenario)
}

/// Half width of the 95 % interval of a metric.
fn half_width(run: &serde_json::Value, metric: &str) -> f64 {
    (field(run, metric, "high") - field(run, metric, "low")) / 2.0
}

#[test]
fn delays_under_swing_are_the_predicted_ones() {
    // Independent of the program: optimal 4-tap predictor on the autocovariance of the swing and
    // the noise of a 2 kHz loop with one period of latency, output register included.
    for (scenario, rls_ms) in [("swing-5hz", 0.340_23), ("swing-10hz", 0.276_14)] {
        let run = run(scenario, &[]);
        let lms = field(&run, "lms.delay_vs_raw_ms", "value");
        assert_close(lms, 1.5 * SAMPLE_PERIOD_MS, 0.0, 0.002);
        assert_close(
            lms,
            field(&run, "lms.delay_predicted_ms", "value"),
            0.0,
            0.002,
        );
        let rls = field(&run, "rls.delay_vs_raw_ms", "value");
        let allowed = 0.002 + half_width(&run, "rls.delay_vs_raw_ms");
        assert!(
            allowed < 0.004,
            "{scenario}: the interval is too wide to test with: {allowed}"
        );
        assert_close(
            rls,
            field(&run, "rls.delay_predicted_ms", "value"),
            0.0,
            allowed,
        );
        assert_close(rls, rls_ms, 0.0, allowed);
    }
}

#[test]
fn at_one_degree_of_angle_the_rls_filter_is_one_sample_late() {
    for scenario in ["swing-5hz-1deg", "swing-10hz-1deg"] {
        let run = run(scenario, &[]);
        let samples = field(&run, "rls.delay_vs_raw_ms", "value") / SAMPLE_PERIOD_MS;
        assert_close(samples, 1.0, 0.0, 0.01);
    }
}

#[test]
fn bias_stability_of_many_hours_is_the_predicted_one() {
    let run = run("static-25c-bias", &[]);
    let stability = field(&run, "raw.bias_stability_100s_deg_per_h", "value");
    // sqrt(N^2/t + B^2 n ln n/(pi (n - 1)) + K^2 t n/6), n = 36 means of 100 s.
    assert_close(stability, 0.0606, 0.04, 0.0);
    assert_eq!(run["scenario"]["repeats"], 240);
}

#[test]
fn the_noise_ratio_of_the_rls_filter_is_its_dc_gain() {
    let run = run("static-25c-ratio", &[]);
    let noise = |channel: &str| {
        field(
            &run,
            &format!("{channel}.angle_random_walk_deg_per_sqrt_h"),
            "value",
        )
    };
    let gain = field(&run, "rls.dc_gain", "value");
    assert_close(noise("rls") / noise("raw"), gain, 0.01, 0.0);
    assert_close(field(&run, "rls.mean_ratio", "value"), gain, 0.01, 0.0);
    assert!(gain < 0.6, "the predictor shrinks Earth rate: {gain}");
    // A filter of unit DC gain leaves the angle random walk alone.
    assert_close(noise("lms") / noise("raw"), 1.0, 0.01, 0.0);
}

/// Peak resident memory of a run, kB, polled while it lives.
fn peak_memory_kb(arguments: &[&str], folder: &std::path::Path) -> u64 {
    let mut child = Command::new(env!("CARGO_BIN_EXE_fogbench"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().expect("the child can be asked").is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find(|line| line.starts_with("VmHWM"));
        let kb = line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok());
        peak = peak.max(kb.unwrap_or(0));
        std::thread::sleep(Duration::from_millis(5));
    }
    peak
}

#[test]
#[cfg(target_os = "linux")]
fn an_hour_with_three_channels_stays_under_1_gb() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = repository("scenarios/paper/static-25c.toml");
    let path = path.to_string_lossy().into_owned();
    // The rate model makes as many samples as the loop model, sooner.
    let arguments = ["run", path.as_str(), "-j", "2", "--set", "fidelity=rate"];
    let peak = peak_memory_kb(&arguments, folder.path());
    assert!(
        peak > 300_000,
        "an hour of four records cannot fit into {peak} kB: not measured"
    );
    assert!(peak < 1_000_000, "peak resident memory {peak} kB");
}
