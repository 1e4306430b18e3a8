//! Threshold, resolution, overshoot, rise time and repeatability.

use fogbench::metrics::{IntervalKind, RatePoint, Step, settling, smallest_answered};

use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, field, fogbench, stderr, stdout, summary};

fn point(input: f64, output: f64, deviation: f64) -> RatePoint {
    RatePoint {
        input_deg_per_h: input,
        output_deg_per_h: output,
        deviation_deg_per_h: deviation,
        degrees_of_freedom: 9.0,
    }
}

/// Adler's mean of an input over the dead band.
fn adler(x: f64) -> f64 {
    x.signum() * (x * x - 1.0).max(0.0).sqrt()
}

#[test]
fn known_answer_k11_half_of_an_input_comes_out_from_1_155_dead_bands_on() {
    let inputs: Vec<f64> = (-40..=40).map(|step| 0.05 * f64::from(step)).collect();
    let points: Vec<RatePoint> = inputs.iter().map(|x| point(*x, adler(*x), 0.0)).collect();
    let [up, down] = smallest_answered(&points, 0.0).expect("an answer");
    for sense in [up.expect("upwards"), down.expect("downwards")] {
        let threshold = 2.0 / 3.0_f64.sqrt();
        assert!(
            sense.low < threshold && threshold <= sense.high,
            "{sense:?}"
        );
        assert_close(sense.low, 1.15, 1e-9, 0.0);
        assert_close(sense.value, 1.2, 1e-9, 0.0);
    }
    // A bias of the output changes nothing: answers are counted from the output at the base.
    let biased: Vec<RatePoint> = inputs
        .iter()
        .map(|x| point(*x, adler(*x) + 9.0, 0.0))
        .collect();
    assert_eq!(smallest_answered(&biased, 0.0), Ok([up, down]));
}

#[test]
fn a_threshold_that_noise_hides_is_refused_with_its_reason() {
    let points = |deviation: f64| [-2.0, -1.0, 0.0, 1.0, 2.0].map(|x: f64| point(x, x, deviation));
    let [up, _] = smallest_answered(&points(0.01), 0.0).expect("little noise");
    let up = up.expect("upwards");
    assert_eq!(
        (up.low.to_bits(), up.high.to_bits()),
        (0.0_f64.to_bits(), 1.0_f64.to_bits())
    );
    // Three standard deviations of 0.2 forbid a verdict at 1, not at 2.
    let [up, _] = smallest_answered(&points(0.15), 0.0).expect("some noise");
    assert_close(up.expect("upwards").value, 2.0, 1e-12, 0.0);
    let mut transcript = Transcript::of("metrics", "Thresholds that cannot be told");
    let refused = smallest_answered(&points(1.0), 0.0).unwrap_err();
    transcript.case("inputs up to 2 deg/h in noise of 1 deg/h", refused);
    let dead = [0.0, 1.0, 2.0].map(|x: f64| point(x, 0.0, 0.0));
    let refused = smallest_answered(&dead, 0.0).unwrap_err();
    transcript.case("no output at 1 and at 2 deg/h", refused);
    let refused = smallest_answered(&points(0.0), 0.5).unwrap_err();
    transcript.case("no input of 0.5 deg/h", refused);
    transcript.check();
}

#[test]
fn increments_from_a_bias_rate_are_told_from_it() {
    // Steps of 0.1 are lost beneath a quantum of 0.25.
    let quantised = |x: f64| (x / 0.25).round() * 0.25;
    let inputs = [10.0, 10.1, 10.0, 10.2, 10.0, 10.4];
    let points = inputs.map(|x| point(x, quantised(x), 0.0));
    let [up, down] = smallest_answered(&points, 10.0).expect("an answer");
    let up = up.expect("upwards");
    assert!(
        (up.low - 0.1).abs() < 1e-9 && (up.value - 0.2).abs() < 1e-9,
        "{up:?}"
    );
    assert_eq!(down, None);
}

/// Register of the linear loop after a unit step: `r_k = r_(k-1) + g (1 - r_(k-1-d))`.
fn loop_step(gain: f64, latency: usize, periods: usize) -> Vec<f64> {
    let mut register = vec![0.0; latency + 1];
    for _ in 0..periods {
        let last = register.len() - 1;
        register.push(register[last] + gain * (1.0 - register[last - latency]));
    }
    register
}

#[test]
fn a_first_order_loop_rises_in_2_2_time_constants_and_does_not_overshoot() {
    let gain = 0.05;
    let mut rates = vec![0.0; 50];
    rates.extend(loop_step(gain, 0, 1000).iter().map(|value| 36.0 * value));
    let settled = settling(&rates, 50, 36.0, 1e-3).expect("it settles");
    let step = Step {
        rate_deg_per_h: &rates,
        index: 50,
        height_deg_per_h: 36.0,
        settling: settled,
        sample_period_s: 1e-3,
    };
    assert!(step.overshoot().value < 1e-9, "{:?}", step.overshoot());
    let rise = step.rise_time_s().expect("no noise");
    // ln 9 / -ln(1 - g) samples; chords of the exponential err by less than a sample in fifty.
    let expected = 1e-3 * 9.0_f64.ln() / -(1.0 - gain).ln();
    assert_close(rise.value, expected, 0.0, 2e-5);
    // Without noise every record has the same rise, chords included.
    assert_eq!(rise.interval, IntervalKind::Exact);
}

/// A noiseless loop on a step of 1 deg/s at the rate of the loop itself; its summary.
fn stepped_loop(latency: usize, bandwidth_hz: f64) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"x\"\nduration_s = 0.02\nwarm_up_s = 0.01\nfidelity = \"loop\"\n\
         [turntable.site]\nlatitude_deg = 0.0\n\
         [turntable.steps]\nrates_deg_per_s = [0.0, 1.0]\ndwell_s = 0.005\nsettle_s = 0.001\n\
         [gyro.controller]\nloop_bandwidth_hz = {bandwidth_hz:?}\nloop_latency_periods = {latency}\n\
         [gyro.output]\nhalf_periods_per_sample = 2\nrate_lsb_deg_per_s = 0.0\n\
         [gyro.modulator]\ndac_bits = 0\n[gyro.adc]\nbits = 0\n\
         [gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
         [gyro.slow_noise]\nbias_instability_deg_per_h = 0.0\n\
         rate_random_walk_deg_per_h_per_sqrt_h = 0.0\n"
    );
    crate::support::write(folder.path(), "x.toml", &text);
    let output = fogbench(folder.path(), &["run", "x.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    summary(&folder.path().join("out"), "x")
}

#[test]
fn a_slow_pipeline_makes_the_loop_overshoot_as_its_transfer_function_says() {
    for (latency, bandwidth_hz) in [(0, 2000.0), (1, 2000.0), (2, 20_000.0), (3, 12_000.0)] {
        let found = stepped_loop(latency, bandwidth_hz);
        let gain = found["gyro"]["loop_gain"].as_f64().expect("a gain");
        let theory = loop_step(gain, latency, 2000);
        let peak = theory.iter().copied().fold(0.0, f64::max);
        let overshoot = field(&found, "raw.overshoot_percent", "value");
        assert_close(overshoot, 100.0 * (peak - 1.0).max(0.0), 1e-2, 0.01);
        if latency > 1 {
            assert!(overshoot > 5.0, "{latency}: {overshoot}");
        }
        let reached = |level: f64| {
            let after = theory
                .iter()
                .position(|value| *value >= level)
                .expect("reached");
            let (low, high) = (theory[after - 1], theory[after]);
            after as f64 - 1.0 + (level - low) / (high - low)
        };
        let period_s = 2.0 * 3.916_576e-6;
        let rise_s = (reached(0.9) - reached(0.1)) * period_s;
        // The step falls between two periods of the loop: chords differ within the first.
        let rise = field(&found, "raw.rise_time_s", "value");
        assert_close(rise, rise_s, 2e-2, 0.5 * period_s);
    }
}

/// Repeats of a short record at rest whose bias differs from start to start.
fn starts(repeats: u32, gate: &str) -> (i32, String, Option<serde_json::Value>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"x\"\nduration_s = 0.2\nwarm_up_s = 0.1\nfidelity = \"rate\"\n\
         repeats = {repeats}\n[gyro.slow_noise]\nturn_on_bias_deg_per_h = 50.0\n{gate}"
    );
    crate::support::write(folder.path(), "x.toml", &text);
    let output = fogbench(folder.path(), &["run", "x.toml", "-o", "out"]);
    let text = format!("{}{}", stdout(&output), stderr(&output));
    let found = (code(&output) == 0).then(|| summary(&folder.path().join("out"), "x"));
    (code(&output), text, found)
}

#[test]
fn bias_repeatability_is_the_scatter_of_the_turn_on_bias_over_six_starts_or_more() {
    let (_, _, found) = starts(12, "");
    let found = found.expect("it runs");
    let of = |name: &str| field(&found, "raw.bias_repeatability_deg_per_h", name);
    // Twelve draws of 50 deg/h: chi-square of 11 degrees of freedom, 99.9 %.
    assert!(
        (0.4 * 50.0..1.75 * 50.0).contains(&of("value")),
        "{}",
        of("value")
    );
    // Its 95 % interval with 11 degrees of freedom: 0.7084 and 1.6979 times the value.
    assert_close(of("low"), 0.708_4 * of("value"), 1e-3, 0.0);
    assert_close(of("high"), 1.697_9 * of("value"), 1e-3, 0.0);
    assert_close(of("repeats"), 12.0, 1e-12, 0.0);
}

#[test]
fn five_starts_have_no_repeatability_and_a_gate_on_it_is_refused() {
    let (_, _, found) = starts(5, "");
    let reasons = &found.expect("it runs")["channels"]["raw"]["unavailable"];
    let reason = reasons["bias_repeatability_deg_per_h"].as_str();
    assert_eq!(reason, Some("it needs 6 repeats or more; there are 5"));
    let gate = "[[gate]]\nmetric = \"raw.bias_repeatability_deg_per_h\"\nmax = 1.0\n";
    let (code, text, _) = starts(5, gate);
    assert!(
        code != 0 && text.contains("it needs 6 repeats or more"),
        "{text}"
    );
}
