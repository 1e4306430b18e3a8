//! The least noise of consecutive taps at a delay, and what stands beside it.

use fogbench::metrics::{
    FilterFacts, Motion, NoiseDelayBound, Record, measure, noise_delay_bound_coloured,
};
use fogbench::signal::{FilterShape, Section, WeightRule};

use crate::support::records::{PERIOD_S, facts, raw_record, settings, value, white};
use crate::support::{
    assert_close, code, field, fogbench, repository, stderr, stdout, summary, write,
};

/// Autocovariance of the sum of a few neighbours, as the words of a loop have it.
const COLOURED: [f64; 8] = [1.0, 0.4, 0.1, 0.02, 0.0, 0.0, 0.0, 0.0];

#[test]
fn the_best_window_is_the_best_of_all_windows() {
    for taps in 2..=6_usize {
        for register in 0..=1_usize {
            let bound = NoiseDelayBound::new(taps, register, &COLOURED).unwrap();
            for step in 0..60_i32 {
                let delay = -1.0 + 0.213 * f64::from(step);
                let found = bound.at(delay).unwrap();
                let windows = (0..20).map(|first| {
                    let newest = first + register;
                    let gain = noise_delay_bound_coloured(taps, newest, delay, &COLOURED).unwrap();
                    (first, gain)
                });
                let (_, least) = windows.clone().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
                assert_close(found.noise_gain, least, 1e-9, 0.0);
                let (_, own) = windows
                    .clone()
                    .find(|(first, _)| *first == found.first_age_samples)
                    .unwrap();
                assert_close(own, least, 1e-9, 0.0);
            }
        }
    }
    assert_eq!(NoiseDelayBound::new(0, 0, &[1.0]), None);
    let one = NoiseDelayBound::new(1, 1, &[1.0]).unwrap();
    assert_eq!(one.at(7.0).unwrap().first_age_samples, 6);
    assert_eq!(one.at(0.0), None);
    assert_eq!(one.at(7.5), None);
}

#[test]
fn the_predictor_of_the_paper_stands_above_taps_that_may_see_the_newest_sample() {
    // Its own ages, 2 to 5, gave 0.411 at its delay of 2.88 samples; ages 0 to 3 behind the same
    // register give 0.3587 at the same delay (computed apart from this program).
    let folder = tempfile::tempdir().unwrap();
    let base = repository("scenarios/base/fog70.toml");
    let text = format!(
        r#"
schema = 1
name = "least"
description = "The predictor of the paper at rest."
extends = {base:?}
duration_s = 20.0
warm_up_s = 20.0
fidelity = "rate"
bias_averaging_time_s = 1.0
turntable.static = {{}}
[[filter]]
name = "rls"
[filter.rls]
taps = 4
forgetting_factor = 1.0
input_lag_samples = 1
"#
    );
    let path = write(folder.path(), "least.toml", &text);
    let run = fogbench(folder.path(), &["run", path.to_str().unwrap(), "-o", "out"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let result = summary(&folder.path().join("out"), "least");
    let bound = "rls.noise_delay_bound_noise_gain";
    assert_close(field(&result, bound, "value"), 0.3587, 0.01, 0.0);
    assert_close(field(&result, bound, "first_age_samples"), 0.0, 0.0, 0.0);
    assert_close(field(&result, bound, "taps"), 4.0, 0.0, 0.0);
    // 0.1126 of the noise: it takes the signal with it.
    let over = field(&result, "rls.noise_gain_over_bound", "value");
    assert_close(over, 0.314, 0.03, 0.0);
}

#[test]
fn filters_without_a_number_of_taps_have_the_bound_of_their_memory() {
    let pole = (-0.1_f64).exp();
    let facts = FilterFacts {
        shape: FilterShape {
            taps: None,
            newest_age_samples: 1,
            register_samples: 1,
            rule: WeightRule::Sections(vec![Section {
                numerator: [1.0 - pole, 0.0, 0.0],
                denominator: [-pole, 0.0],
            }]),
        },
        ..facts()
    };
    let raw = white(8, 100_000, 22.8);
    let mut channel = Vec::new();
    let mut state = 0.0;
    for word in &raw {
        channel.push(state);
        state += (1.0 - pole) * (word - state);
    }
    let truth = vec![0.0; raw.len()];
    let record = Record {
        channel_deg_per_h: &channel,
        ..raw_record(&raw, &truth)
    };
    let metrics = measure(&record, &settings(Motion::Steady), Some(&facts));
    let name = "noise_delay_bound_noise_gain";
    // (1 + x) exp(-x) = 0.01 at 6.64 time constants of ten samples.
    let taps = metrics.metrics[name].fields["taps"];
    assert_close(taps, 66.4, 0.03, 0.0);
    // 1 / (e^0.1 - 1) = 9.508 samples and the register, towards the newest end of 66 taps.
    let white_gain = metrics.metrics[name].fields["white_noise_gain"];
    let middle = 1.0 + (taps - 1.0) / 2.0;
    let off = middle - (1.0 + pole / (1.0 - pole));
    let want = 1.0 / taps + 12.0 * off * off / (taps * (taps * taps - 1.0));
    assert_close(white_gain, want, 1e-6, 0.0);
    assert_close(value(&metrics, name), want, 0.1, 0.0);
    assert!(metrics.curves.contains_key("noise_delay_bound"));
    // The pole has (1 - p) / (1 + p) of the noise, more than the least.
    assert!(value(&metrics, "noise_gain_over_bound") > 1.0);
}

#[test]
fn a_filter_that_does_not_adapt_readapts_within_its_memory_under_every_motion() {
    // Eight taps behind a register: the word in which the motion begins, eight more, and the register.
    let want_s = 10.0 * PERIOD_S;
    let facts = FilterFacts {
        shape: FilterShape {
            taps: Some(8),
            newest_age_samples: 1,
            register_samples: 1,
            rule: WeightRule::Fixed(vec![0.125; 8]),
        },
        ..facts()
    };
    let noise = white(9, 8000, 22.8);
    // A trapezoid that ends at a new rate, and one that comes back to rest.
    let course = |back: bool| -> Vec<f64> {
        let rate = |k: usize| match k {
            0..2000 => 0.0,
            2000..4000 => (k as f64 - 2000.0) * 1.8,
            4000..6000 if back => (6000.0 - k as f64) * 1.8,
            _ if back => 0.0,
            _ => 3600.0,
        };
        (0..8000).map(rate).collect()
    };
    let swing: Vec<f64> = (0..8000)
        .map(|k| 3600.0 * (std::f64::consts::TAU * 5.0 * f64::from(k) * PERIOD_S).sin())
        .collect();
    let steps = Motion::Steps {
        last_step_index: 2000,
        step_deg_per_h: 3600.0,
        staircase: fogbench::metrics::Staircase::default(),
    };
    let step: Vec<f64> = (0..8000)
        .map(|k| if k < 2000 { 0.0 } else { 3600.0 })
        .collect();
    let to_rest: Vec<f64> = step.iter().map(|rate| 3600.0 - rate).collect();
    for (truth, motion) in [
        (course(false), Motion::General),
        (course(true), Motion::General),
        (swing, Motion::SwingFromRest { frequency_hz: 5.0 }),
        (step, steps.clone()),
        (to_rest, steps),
    ] {
        let raw: Vec<f64> = noise.iter().zip(&truth).map(|(n, rate)| n + rate).collect();
        let filtered: Vec<f64> = (0..raw.len())
            .map(|k| {
                (1..=8)
                    .map(|age: usize| raw[k.saturating_sub(age)] / 8.0)
                    .sum()
            })
            .collect();
        let record = Record {
            channel_deg_per_h: &filtered,
            ..raw_record(&raw, &truth)
        };
        let metrics = measure(&record, &settings(motion.clone()), Some(&facts));
        let found = &metrics.metrics["readaptation_time_s"];
        assert_close(found.estimate.value, want_s, 1e-9, 0.0);
        assert_close(found.estimate.low, 9.0 * PERIOD_S, 1e-9, 0.0);
        assert_close(found.fields["memory_samples"], 8.0, 0.0, 0.0);
    }
}

#[test]
fn the_noise_is_divided_as_other_standard_deviations_are() {
    let raw: Vec<f64> = white(10, 64, 3.0);
    let truth = vec![0.0; raw.len()];
    let metrics = measure(&raw_record(&raw, &truth), &settings(Motion::Steady), None);
    let mean = raw.iter().sum::<f64>() / 64.0;
    let squares: f64 = raw.iter().map(|word| (word - mean).powi(2)).sum();
    let want = (squares / 63.0).sqrt();
    assert_close(value(&metrics, "noise_std_deg_per_h"), want, 1e-12, 0.0);
}

#[test]
fn a_published_figure_without_a_simulated_one_does_not_refuse_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let base = repository("scenarios/base/fog70.toml");
    let text = format!(
        r#"
schema = 1
name = "beside"
description = "A figure that a short record cannot have."
extends = {base:?}
duration_s = 600.0
fidelity = "rate"
turntable.static = {{}}
[[published]]
metric = "raw.bias_stability_100s_deg_per_h"
value = 0.06
unit = "deg/h"
source = "a paper"
"#
    );
    let path = write(folder.path(), "beside.toml", &text);
    let file = path.to_str().unwrap();
    let set = ["run", file, "-o", "out", "--set", "duration_s=2"];
    let run = fogbench(folder.path(), &set);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let said = stdout(&run)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let want = "nothing is simulated beside raw.bias_stability_100s_deg_per_h";
    assert!(said.contains(want), "{said}");
    // What is gated refuses as before.
    let gate =
        format!("{text}[[gate]]\nmetric = \"raw.bias_stability_100s_deg_per_h\"\nmin = 0.0\n");
    write(folder.path(), "beside.toml", &gate);
    assert_eq!(code(&fogbench(folder.path(), &set)), 2);
}

#[test]
fn the_dc_gain_of_given_weights_leaves_their_start_up_out() {
    let folder = tempfile::tempdir().unwrap();
    let text = "name = \"f\"\nduration_s = 1.0\nwarm_up_s = 0.0\n[turntable.static]\n\
                [[filter]]\nname = \"low\"\n[filter.butterworth]\ncutoff_hz = 30.0\n\
                [[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 400\n";
    write(folder.path(), "f.toml", text);
    let words: String = white(11, 8000, 20.0)
        .iter()
        .map(|word| format!("{word}\n"))
        .collect();
    write(folder.path(), "log.csv", &words);
    let arguments = [
        "filter",
        "log.csv",
        "--unit",
        "deg/h",
        "--rate-hz",
        "8000",
        "--filters",
        "f.toml",
        "--format",
        "json",
    ];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    for channel in ["low", "mean"] {
        for metric in ["dc_gain", "dc_gain_adapted"] {
            let gain = &report["channels"][channel][metric]["value"];
            assert_close(gain.as_f64().unwrap(), 1.0, 1e-12, 0.0);
        }
    }
}
