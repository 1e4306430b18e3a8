//! `claim` as a user meets it, and what it says measured on noise.

use fogbench::metrics::{Claim, ClaimedFigure, Motion, Record, measure};
use fogbench::signal::WeightRule;

use crate::support::records::{facts, raw_record, settings, white};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout};

#[test]
fn what_reads_the_same_is_said() {
    let folder = scratch();
    let mut transcript = Transcript::of("claim", "what reads the same");
    for line in [
        "claim --arw-before 0.0060 --arw-after 0.0029 --rate-hz 3989.45",
        "claim --arw-before 0.0060 --arw-after 0.0029",
        "claim --arw-before 0.03741 --arw-after 0.00976 --averaging-time-s 10 --rate-hz 100",
        "claim --bias-stability 0.05 0.02 --averaging-time-s 10",
        "claim --arw-before 0.006 --arw-after 0.0059 --rate-hz 1",
        "claim --arw-before 0.006 --arw-after 0.006",
        "claim --bias-stability 0.02 0.05 --averaging-time-s 10 --format json",
        "claim --arw-before 0.006 --arw-after 0.0029 --rate-hz 4000 --format json",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        transcript.case(format!("fogbench {line}"), stdout(&output));
    }
    transcript.check();
}

#[test]
fn half_a_claim_is_refused_with_what_it_lacks() {
    let folder = scratch();
    let mut transcript = Transcript::of("claim", "half a claim");
    for line in [
        "claim",
        "claim --arw-before 0.006",
        "claim --arw-after 0.006",
        "claim --bias-stability 0.05 0.02",
        "claim --bias-stability 0.05 --averaging-time-s 10",
        "claim --arw-before 0.006 --arw-after 0.003 --bias-stability 0.05 0.02 --averaging-time-s 10",
        "claim --arw-before 0 --arw-after 0.003",
        "claim --arw-before 0.006 --arw-after -0.003",
        "claim --arw-before 0.006 --arw-after 0.003 --averaging-time-s 0",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 2, "{line}");
        transcript.case(format!("fogbench {line}"), stderr(&output));
    }
    transcript.check();
}

#[test]
fn one_document_a_line_has_the_keys_of_the_pretty_one() {
    let folder = scratch();
    let document = |format: &str| -> serde_json::Value {
        let line = "claim --arw-before 0.006 --arw-after 0.0029 --rate-hz 4000 --format";
        let words: Vec<&str> = line.split(' ').chain([format]).collect();
        let text = stdout(&fogbench(folder.path(), &words));
        if format == "jsonl" {
            assert_eq!(text.lines().count(), 1);
        }
        serde_json::from_str(&text).expect("JSON")
    };
    assert_eq!(document("json"), document("jsonl"));
    let found = &document("json")["lookalikes"];
    let number = |pointer: &str| found.pointer(pointer).and_then(serde_json::Value::as_f64);
    assert_close(number("/dc_gain").expect("a gain"), 0.4833, 1e-4, 0.0);
    assert_close(
        number("/one_pole/time_constant_s").expect("a time"),
        0.78,
        0.01,
        0.0,
    );
    assert_close(number("/mean/length_s").expect("a length"), 1.7, 0.02, 0.0);
}

/// A mean and a one-pole low pass lower the Allan deviation of white noise at 1 s by what `claim` has
/// in closed form, and beyond their memory they do not.
#[test]
fn known_answer_noise_read_inside_the_memory_is_lower_and_beyond_it_is_not() {
    const RATE_HZ: usize = 20;
    const SAMPLES: usize = 60_000;
    let raw = white(5, SAMPLES, 1.0);
    let mean = vec![1.0 / RATE_HZ as f64; RATE_HZ];
    let decay = (-std::f64::consts::TAU * 0.2 / RATE_HZ as f64).exp();
    let pole: Vec<f64> = (0..400)
        .map(|age| (1.0 - decay) * decay.powi(age))
        .collect();
    for (weights, equal) in [(mean, "mean"), (pole, "pole")] {
        let from = weights.len();
        let output: Vec<f64> = (from..SAMPLES)
            .map(|now| {
                let each = weights.iter().enumerate();
                each.map(|(age, weight)| weight * raw[now - age]).sum()
            })
            .collect();
        let truth = vec![0.0; output.len()];
        let record = Record {
            channel_deg_per_h: &output,
            sample_period_s: (RATE_HZ as f64).recip(),
            ..raw_record(&raw[from..], &truth)
        };
        let mut facts = facts();
        facts.dc_gain = Some(1.0);
        facts.shape.rule = WeightRule::Fixed(weights.clone());
        facts.shape.taps = Some(weights.len());
        facts.shape.newest_age_samples = 0;
        let metrics = measure(&record, &settings(Motion::Steady), Some(&facts));
        let inside = &metrics.metrics["allan_ratio_inside_memory"].estimate;
        let claim = Claim {
            figure: ClaimedFigure::AngleRandomWalk,
            before: 1.0,
            after: inside.value,
            averaging_time_s: 1.0,
        };
        let found = claim.lookalikes().expect("less noise");
        let (time_s, length_s) = (found.one_pole_time_constant_s, found.mean_length_s);
        // A mean over the averaging time leaves half the variance; the pole has 1 / (2 pi 0.2 Hz). A
        // ratio of 3000 s is known to about 2 %, which the slope of the closed form makes 6 %.
        match equal {
            "mean" => {
                assert_close(inside.value, 0.5_f64.sqrt(), 0.02, 0.0);
                assert_close(length_s, 1.0, 0.06, 0.0);
            }
            _ => assert_close(time_s, 0.7958, 0.06, 0.0),
        }
        assert!(inside.high < 0.8, "{inside:?}");
        let beyond = &metrics.metrics["weight_noise_ratio"].estimate;
        assert_close(beyond.value, 1.0, 0.05, 0.0);
    }
}
