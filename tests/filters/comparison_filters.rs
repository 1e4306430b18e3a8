//! The filters a user would reach for first, against their textbook responses.

use std::f64::consts::{PI, TAU};

use fogbench::filters::{
    ConstrainedRls, Filter, FilterKind, FixedFilter, FrontEndConfig, Kalman, KalmanConfig,
    RecursiveFilter, Rls, RlsConfig, butterworth, kalman_gain, moving_average, one_pole,
    savitzky_golay,
};
use fogbench::metrics::predict;
use fogbench::random::Streams;
use fogbench::scenario::{Resolved, load_suite};
use fogbench::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{assert_close, code, field, fogbench, stderr, stdout, summary, write};

fn outputs(filter: &mut dyn Filter, words: &[f64]) -> Vec<f64> {
    words
        .iter()
        .map(|word| filter.step(*word).expect("no divergence").value_deg_per_h)
        .collect()
}

fn impulse(length: usize) -> Vec<f64> {
    let mut words = vec![0.0; length];
    words[0] = 1.0;
    words
}

/// Power response at a frequency of an impulse response.
fn power(response: &[f64], cycles_per_sample: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (age, value) in response.iter().enumerate() {
        let phase = TAU * cycles_per_sample * age as f64;
        re += value * phase.cos();
        im -= value * phase.sin();
    }
    re * re + im * im
}

#[test]
fn low_passes_have_half_power_at_their_cut_off_frequency() {
    for cutoff in [0.003, 0.03, 0.2, 0.4] {
        let mut sections = vec![(1, one_pole(cutoff))];
        sections.extend((1..=8).map(|order| (order, butterworth(order, cutoff))));
        for (order, sections) in sections {
            let mut filter = RecursiveFilter::new(sections, OutputRegister::Immediate);
            let response = outputs(&mut filter, &impulse(20_000));
            assert_close(power(&response, cutoff), 0.5, 1e-9, 0.0);
            assert_close(power(&response, 0.0), 1.0, 1e-9, 0.0);
            let step = filter.step(0.0).unwrap().weight_sum;
            assert_close(step, 1.0, 1e-9, 0.0);
            assert!(order > 0);
        }
    }
}

#[test]
fn a_butterworth_low_pass_is_maximally_flat_under_the_bilinear_map() {
    let cutoff = 0.05;
    for order in 1..=8_u32 {
        let sections = butterworth(order as usize, cutoff);
        let mut filter = RecursiveFilter::new(sections, OutputRegister::Immediate);
        let response = outputs(&mut filter, &impulse(20_000));
        for frequency in [0.01, 0.04, 0.07, 0.2] {
            let ratio = (PI * frequency).tan() / (PI * cutoff).tan();
            let exact = 1.0 / (1.0 + ratio.powi(2 * order.cast_signed()));
            // Deep in the stop band the impulse response is a difference of larger numbers.
            assert_close(power(&response, frequency), exact, 1e-8, 1e-20);
        }
    }
}

#[test]
fn savitzky_golay_passes_its_polynomials_and_costs_the_noise_of_the_books() {
    for (taps, order) in [(4, 1), (16, 1), (16, 2), (33, 4)] {
        let weights = savitzky_golay(taps, order);
        // Moments of the weights: 1, 0, 0, ... up to the order; so no delay.
        for moment in 0..=i32::try_from(order).unwrap() {
            let sum: f64 = weights
                .iter()
                .enumerate()
                .map(|(age, weight)| weight * (age as f64).powi(moment))
                .sum();
            let exact = if moment == 0 { 1.0 } else { 0.0 };
            let scale = (taps as f64).powi(moment);
            assert_close(sum, exact, 0.0, 1e-11 * scale);
        }
        if order == 1 {
            let p = taps as f64;
            let gain: f64 = weights.iter().map(|weight| weight * weight).sum();
            assert_close(gain, (4.0 * p - 2.0) / (p * (p + 1.0)), 1e-12, 0.0);
        }
    }
    for (smooth, mean) in savitzky_golay(5, 0).iter().zip(moving_average(5)) {
        assert_close(*smooth, mean, 1e-14, 0.0);
    }
}

#[test]
fn fixed_weights_are_the_impulse_response_behind_the_register() {
    let weights = savitzky_golay(6, 2);
    let mut held = FixedFilter::new(weights.clone(), OutputRegister::NextSample);
    let response = outputs(&mut held, &impulse(8));
    assert_eq!(response[0].to_bits(), 0.0_f64.to_bits());
    for (got, weight) in response[1..7].iter().zip(&weights) {
        assert_eq!(got.to_bits(), weight.to_bits());
    }
}

#[test]
fn the_kalman_filter_starts_as_a_mean_and_settles_at_the_gain_of_the_riccati_equation() {
    // Without a walk the estimate is the mean of all words so far.
    let mut filter = Kalman::new(&KalmanConfig {
        noise_deg_per_h: 19.0,
        step_deg_per_h: 1e-9,
        output_register: OutputRegister::Immediate,
    });
    let words = [3.0, 5.0, 1.0, 7.0];
    let mut sum = 0.0;
    for (index, word) in words.into_iter().enumerate() {
        sum += word;
        let mean = sum / (index + 1) as f64;
        assert_close(filter.step(word).unwrap().value_deg_per_h, mean, 1e-12, 0.0);
    }
    // With one it becomes a one-pole filter.
    let (noise, step) = (19.0, 3.0);
    let gain = kalman_gain((step / noise) * (step / noise));
    // k^2 / (1 - k) is the ratio of the variances: the Riccati equation in the gain.
    assert_close(
        gain * gain / (1.0 - gain),
        (step / noise).powi(2),
        1e-12,
        0.0,
    );
    let mut filter = Kalman::new(&KalmanConfig {
        noise_deg_per_h: noise,
        step_deg_per_h: step,
        output_register: OutputRegister::Immediate,
    });
    outputs(&mut filter, &[8.0; 1000]);
    let response = outputs(&mut filter, &[9.0, 8.0, 8.0]);
    assert_close(response[0] - 8.0, gain, 1e-9, 0.0);
    assert_close(response[1] - 8.0, gain * (1.0 - gain), 1e-9, 0.0);
}

fn constrained(taps: usize, forgetting_factor: f64) -> RlsConfig {
    RlsConfig {
        taps,
        forgetting_factor,
        initial_inverse_correlation: 1e3,
        update_sign: UpdateSign::Corrected,
        front_end: FrontEndConfig {
            desired: DesiredSignal::Current,
            input_lag_samples: 1,
            output_register: OutputRegister::Immediate,
        },
    }
}

/// White noise through a one-pole filter: neighbours correlate by one half.
fn coloured(count: usize) -> Vec<f64> {
    let mut stream = Streams::new(5, 0).stream("test");
    let mut value = 0.0;
    (0..count)
        .map(|_| {
            value = 0.5 * value + stream.normal();
            value
        })
        .collect()
}

#[test]
fn constrained_least_squares_leaves_every_constant_alone() {
    let noise = coloured(5000);
    let mut filter = ConstrainedRls::new(&constrained(4, 0.99));
    let base = outputs(&mut filter, &noise);
    let mut other = ConstrainedRls::new(&constrained(4, 0.99));
    let shifted: Vec<f64> = noise.iter().map(|word| word + 8.47).collect();
    let moved = outputs(&mut other, &shifted);
    // The zeros before the first word left other weights; 0.99^4900 of them is left.
    for (base, moved) in base[4900..].iter().zip(&moved[4900..]) {
        assert_close(moved - base, 8.47, 0.0, 1e-6);
    }
    assert_close(filter.weights().iter().sum(), 1.0, 1e-12, 0.0);
    // Plain least squares does not: the mean enters its weights.
    let mut plain = Rls::new(&constrained(4, 0.99));
    outputs(&mut plain, &shifted);
    let sum: f64 = plain.weights().iter().sum();
    assert!((sum - 1.0).abs() > 1e-3, "{sum}");
}

#[test]
fn constrained_weights_are_those_of_the_constrained_wiener_filter() {
    let mut filter = ConstrainedRls::new(&constrained(4, 1.0));
    let count = 200_000;
    outputs(&mut filter, &coloured(count));
    let second_moment: Vec<f64> = (0..12).map(|lag| 0.5_f64.powi(lag) / 0.75).collect();
    let prediction = predict(&filter.shape(), &second_moment).unwrap();
    let wiener = prediction.weights().unwrap();
    assert_close(prediction.dc_gain(), 1.0, 1e-12, 0.0);
    for (got, want) in filter.weights().iter().zip(wiener) {
        // Weights estimated from n samples scatter by about 1 / sqrt(n); five of that.
        assert_close(*got, *want, 0.0, 5.0 / (count as f64).sqrt());
    }
}

const SCENARIO: &str = r#"
schema = 1
name = "many"
duration_s = 60.0
warm_up_s = 5.0
fidelity = "rate"
filter = [
  { name = "mean", moving_average = { taps = 8 } },
  { name = "line", savitzky_golay = { taps = 16, output_register = "immediate" } },
  { name = "pole", one_pole = {} },
  { name = "butter", butterworth = { order = 3 } },
  { name = "kalman", kalman = {} },
  { name = "held", constrained_rls = {} },
]
"#;

#[test]
fn every_kind_runs_from_one_line_and_keeps_its_dc_gain() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "many.toml", SCENARIO);
    let run = fogbench(folder.path(), &["run", path.to_str().unwrap(), "-o", "out"]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let result = summary(&folder.path().join("out"), "many");
    for channel in ["mean", "line", "pole", "butter", "kalman", "held"] {
        for metric in ["dc_gain", "dc_gain_predicted"] {
            let gain = field(&result, &format!("{channel}.{metric}"), "value");
            assert_close(gain, 1.0, 0.0, 1e-6);
        }
        let noise = field(&result, &format!("{channel}.noise_gain"), "value");
        assert!(noise > 0.0 && noise < 1.0, "{channel} {noise}");
    }
    // Eight samples and the register: (8 - 1) / 2 + 1 = 4.5 samples of age.
    let bound = "mean.noise_delay_bound_noise_gain";
    let delay_ms = field(&result, bound, "delay_ms");
    assert_close(delay_ms, 4.5 * 64.0 * 3.916_576e-3, 1e-6, 0.0);
    assert_close(field(&result, bound, "white_noise_gain"), 0.125, 1e-9, 0.0);
    // No filter of as many consecutive taps and its delay has less noise.
    let gain = field(&result, "mean.noise_gain", "high");
    assert!(gain >= field(&result, bound, "low"));
    // One without a number of taps has the bound of as many as it remembers.
    let of_butter = "butter.noise_delay_bound_noise_gain";
    assert!(field(&result, of_butter, "taps") > 4.0);
    assert!(field(&result, of_butter, "value") > 0.0);
}

#[test]
fn constants_that_make_no_filter_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let tables = [
        "savitzky_golay = { taps = 3, polynomial_order = 3 }",
        "one_pole = { cutoff_hz = 2000.0 }",
        "butterworth = { cutoff_hz = 3000.0 }",
        "constrained_rls = { taps = 1 }",
    ];
    said_to_each(
        "filters",
        "Constants that make no filter",
        tables,
        |table| {
            let text = format!(
                "schema = 1\nname = \"bad\"\nduration_s = 1.0\nfilter = [{{ name = \"f\", {table} }}]\n"
            );
            write(folder.path(), "bad.toml", &text);
            let run = fogbench(folder.path(), &["check", "bad.toml"]);
            assert_eq!(code(&run), 2, "{table}");
            stderr(&run)
        },
    );
}

#[test]
fn the_random_walk_under_its_former_name_keeps_its_bits_and_is_answered_with_the_new_one() {
    const OLD: &str = "rate_random_walk_deg_per_h_per_sqrt_s";
    const NEW: &str = "rate_random_walk_deg_per_h_per_sqrt_h";
    const PERIOD_S: f64 = 0.000_25;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.toml");
    let read = |text: &str, sets: &[String]| {
        std::fs::write(&path, text).unwrap();
        load_suite(std::slice::from_ref(&path), sets).map(|mut runs| runs.remove(0))
    };
    let scenario = |keys: &str| {
        format!(
            "schema = 1\nname = \"walk\"\nduration_s = 1.0\n[[filter]]\nname = \"k\"\n\
             [filter.kalman]\n{keys}\n"
        )
    };
    // The step of the walk in a word, which is all that the filter reads of the key.
    let step = |run: &Resolved| match &run.scenario.filters[0].kind {
        FilterKind::Kalman(config) => config.rate_random_walk.after(PERIOD_S),
        other => panic!("{other:?}"),
    };
    let default = read(&scenario(""), &[]).unwrap();
    assert_eq!(
        step(&default).to_bits(),
        (190.0 * PERIOD_S.sqrt()).to_bits()
    );
    assert!(default.warnings.is_empty());

    // 0.7 x 60 / 60 is another number than 0.7 in binary64 for some values: the old one is kept as it is.
    for old in [0.7, 0.1, 123.456, 190.0, 7.3e-5] {
        let run = read(&scenario(&format!("{OLD} = {old:?}")), &[]).unwrap();
        assert_eq!(
            step(&run).to_bits(),
            (old * PERIOD_S.sqrt()).to_bits(),
            "{old}"
        );
        let said = format!(
            "filter[0].kalman.{OLD} = {old:?} deg/h/sqrt(s) is the former name and unit of {NEW}: \
             write {NEW} = {:?} (deg/h/sqrt(h))",
            old * 60.0
        );
        assert_eq!(run.warnings, [said]);
        // What is printed of the run can be read again and is the same run.
        let again = read(&run.to_toml(), &[]).unwrap();
        assert_eq!(step(&again).to_bits(), step(&run).to_bits());
    }
    let run = read(&scenario(&format!("{NEW} = 42.0")), &[]).unwrap();
    assert_eq!(step(&run).to_bits(), (0.7 * PERIOD_S.sqrt()).to_bits());

    // Both in one file contradict each other; a later source replaces an earlier one.
    let both = read(&scenario(&format!("{OLD} = 1.0\n{NEW} = 60.0")), &[]).unwrap_err();
    let mut transcript = Transcript::of("filters", "A random walk under both of its names");
    transcript.case(format!("{OLD} = 1.0\n{NEW} = 60.0"), &both[0]);
    transcript.check();
    let sets = [format!("filter.k.{NEW}=60.0")];
    let run = read(&scenario(&format!("{OLD} = 5.0")), &sets).unwrap();
    assert_eq!(step(&run).to_bits(), PERIOD_S.sqrt().to_bits());
    assert!(run.warnings.is_empty(), "{:?}", run.warnings);
}
