//! Metrology of the filters: frozen response, readaptation, noise about a known motion, intervals.

use std::f64::consts::{PI, TAU};

use fogbench::metrics::{
    ChannelMetrics, FilterFacts, Motion, Record, SwingClock, correlation_delay_s, measure,
};
use fogbench::signal::{FilterShape, Section, WeightRule};

use crate::support::records::{PERIOD_S, facts, raw_record, settings, sine, value, white};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, field, fogbench, repository, stderr, stdout, summary};

/// A filter of given rule on samples of age 1 and older.
fn given(rule: WeightRule, taps: Option<usize>) -> FilterFacts {
    FilterFacts {
        shape: FilterShape {
            taps,
            newest_age_samples: 1,
            register_samples: 1,
            rule,
        },
        ..facts()
    }
}

fn column(metrics: &ChannelMetrics, curve: &str, name: &str) -> Vec<f64> {
    metrics.curves[curve][name].clone()
}

fn resting(filter: &FilterFacts) -> ChannelMetrics {
    let raw = white(1, 2000, 20.0);
    let truth = vec![0.0; raw.len()];
    measure(
        &raw_record(&raw, &truth),
        &settings(Motion::Steady),
        Some(filter),
    )
}

#[test]
fn the_frozen_response_of_given_weights_is_their_closed_form() {
    let metrics = resting(&given(WeightRule::Fixed(vec![0.25; 4]), Some(4)));
    let of = |name: &str| column(&metrics, "frozen_response", name);
    let frequencies = of("frequency_hz");
    assert_close(frequencies[120], 0.5 / PERIOD_S, 1e-9, 0.0);
    for (index, frequency_hz) in frequencies.iter().enumerate() {
        // sin(4 x) / (4 sin x) at half the angle, 1 + 1.5 samples late below the first zero.
        let half = PI * frequency_hz * PERIOD_S;
        let gain = (4.0 * half).sin() / (4.0 * half.sin());
        assert_close(of("gain")[index], gain.abs(), 1e-9, 1e-12);
        if *frequency_hz < 0.24 / PERIOD_S {
            assert_close(of("delay_ms")[index], 2.5e3 * PERIOD_S, 1e-9, 0.0);
            assert_close(
                of("phase_deg")[index],
                -360.0 * 2.5 * frequency_hz * PERIOD_S,
                1e-9,
                0.0,
            );
        }
        assert_close(of("gain_low")[index], of("gain_high")[index], 0.0, 1e-15);
    }
    // One pole: (1 - a) / (1 - a z^-1).
    let pole = 0.6;
    let section = Section {
        numerator: [1.0 - pole, 0.0, 0.0],
        denominator: [-pole, 0.0],
    };
    let metrics = resting(&given(WeightRule::Sections(vec![section]), None));
    let gains = column(&metrics, "frozen_response", "gain");
    for (gain, frequency_hz) in gains.iter().zip(&frequencies) {
        let cosine = (TAU * frequency_hz * PERIOD_S).cos();
        let square = (1.0 - pole).powi(2) / (1.0 - 2.0 * pole * cosine + pole * pole);
        assert_close(*gain, square.sqrt(), 1e-9, 0.0);
    }
}

#[test]
fn weights_that_wander_widen_the_frozen_response() {
    let mut filter = facts();
    filter.shape.taps = Some(2);
    filter.mean_weights = Some(vec![0.5, 0.3]);
    filter.block_weights = (0..10)
        .map(|block| vec![0.5 + 0.01 * (f64::from(block) - 4.5), 0.3])
        .collect();
    let metrics = resting(&filter);
    let of = |name: &str| column(&metrics, "frozen_response", name)[0];
    assert_close(of("gain"), 0.8, 1e-6, 0.0);
    // Student's t for 9, 2.262, times the deviation 0.030277 over the root of ten.
    assert_close(
        of("gain_high") - of("gain"),
        2.262 * 0.030_277 / 10.0_f64.sqrt(),
        1e-3,
        0.0,
    );
    assert!(of("delay_low_ms") < of("delay_ms") && of("delay_ms") < of("delay_high_ms"));
}

/// Every value the weighted sum of those before it, the newest of age 1.
fn filtered(values: &[f64], weights: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|k| {
            let aged = |(tap, weight): (usize, &f64)| weight * values[k.saturating_sub(tap + 1)];
            weights.iter().enumerate().map(aged).sum()
        })
        .collect()
}

#[test]
fn live_sines_stand_on_the_frozen_response_with_intervals_that_hold_it() {
    let tones = [7.0, 31.0, 120.0, 300.0, 480.0];
    let truth: Vec<f64> = (0..16_000)
        .map(|k| {
            let time_s = f64::from(k) * PERIOD_S;
            let tone =
                |frequency: &f64| 3600.0 * (TAU * (frequency * time_s).fract() + frequency).cos();
            tones.iter().map(tone).sum()
        })
        .collect();
    let mut raw = truth.clone();
    for (word, noise) in raw.iter_mut().zip(white(5, truth.len(), 20.0)) {
        *word += noise;
    }
    let weights = vec![0.5, 0.3, 0.15, 0.05];
    let output = filtered(&raw, &weights);
    let filter = given(WeightRule::Fixed(weights.clone()), Some(4));
    let motion = Motion::MultiSine {
        frequencies_hz: tones.to_vec(),
    };
    // The first samples have no history.
    let record = Record {
        channel_deg_per_h: &output[10..],
        ..raw_record(&raw[10..], &truth[10..])
    };
    let metrics = measure(&record, &settings(motion), Some(&filter));
    let of = |name: &str| column(&metrics, "frequency_response_vs_raw", name);
    for (tone, frequency_hz) in tones.iter().enumerate() {
        let angle = TAU * frequency_hz * PERIOD_S;
        let (real, imaginary) = weights
            .iter()
            .zip(1..)
            .fold((0.0, 0.0), |(re, im), (w, age)| {
                let phase = angle * f64::from(age);
                (re + w * phase.cos(), im + w * phase.sin())
            });
        assert_close(of("gain")[tone], f64::hypot(real, imaginary), 1e-4, 0.0);
        let delay_ms = 1e3 * imaginary.atan2(real) / (TAU * frequency_hz);
        let half_width = of("delay_high_ms")[tone] - of("delay_ms")[tone];
        assert!(half_width > 0.0);
        assert_close(of("delay_ms")[tone], delay_ms, 0.0, 2.0 * half_width);
    }
}

#[test]
fn a_filter_that_forgets_nothing_takes_as_long_to_learn_as_theory_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = repository("scenarios/audit/static-then-swing.toml");
    let path = path.to_str().unwrap();
    let run = fogbench(folder.path(), &["run", path, "-o", "out"]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let text = stdout(&run)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    assert!(
        text.contains("passes the new motion to 1 % after"),
        "{text}"
    );
    let result = summary(&folder.path().join("out"), "static-then-swing");
    let metric = "remembering.readaptation_time_s";
    // 17.2 s of the gate's theory lie in the interval, which is short.
    let (low, high) = (
        field(&result, metric, "low"),
        field(&result, metric, "high"),
    );
    assert!(
        low < 17.2 && 17.2 < high && high - low < 3.0,
        "{low} {high}"
    );
    assert!(
        folder
            .path()
            .join("out/static-then-swing/filter-response.svg")
            .exists()
    );
    // Two minutes at rest would take 69 s of swing.
    let longer = ["run", path, "-o", "longer", "--set", "warm_up_s=120.0"];
    let run = fogbench(folder.path(), &longer);
    assert_eq!(
        code(&run),
        1,
        "a gate on what is not there fails: {}",
        stderr(&run)
    );
    let text = stdout(&run)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let said = "does not learn the new motion: not within the record of";
    assert!(text.contains(said), "{text}");
    let result = summary(&folder.path().join("longer"), "static-then-swing");
    let reason = &result["channels"]["remembering"]["unavailable"]["readaptation_time_s"];
    assert!(
        reason
            .as_str()
            .unwrap()
            .starts_with("not within the record of 2"),
        "{reason}"
    );
}

#[test]
fn a_swing_from_rest_must_start_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = repository("scenarios/audit/static-then-swing.toml");
    let set = "turntable.swing.soft_start_s=0.5";
    let arguments = ["check", path.to_str().unwrap(), "--set", set];
    let run = fogbench(folder.path(), &arguments);
    assert_eq!(code(&run), 2);
    let mut transcript = Transcript::of("motion", "A swing from rest with a soft start");
    transcript.case(format!("--set {set}"), stderr(&run));
    transcript.check();
}

fn add(values: &mut [f64], others: &[f64]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value += other;
    }
}

#[test]
fn the_harmonics_of_a_table_are_no_noise_of_the_gyro() {
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let harmonic = |order: f64, amplitude: f64, delay_s: f64| {
        let faster = SwingClock {
            frequency_hz: 5.0 * order,
            ..clock
        };
        let mut values = sine(&faster, 40_000, amplitude, delay_s);
        values.iter_mut().for_each(|value| *value -= 8.47);
        values
    };
    let swing = |delay_s: f64| {
        let mut values = sine(&clock, 40_000, 3600.0, delay_s);
        for (order, amplitude) in [(3.0, 200.0), (5.0, 80.0), (7.0, 50.0)] {
            add(&mut values, &harmonic(order, amplitude, delay_s));
        }
        values
    };
    let truth = swing(0.0);
    let mut raw = swing(0.8 * PERIOD_S);
    add(&mut raw, &white(3, 40_000, 20.0));
    let output = filtered(&raw, &[0.5, 0.5]);
    let motion = Motion::Swing { frequency_hz: 5.0 };
    let record = Record {
        channel_deg_per_h: &output,
        ..raw_record(&raw, &truth)
    };
    let filter = given(WeightRule::Fixed(vec![0.5, 0.5]), Some(2));
    let metrics = measure(&record, &settings(motion.clone()), Some(&filter));
    // Relative standard error of a variance of 40 000: 0.7 %.
    assert_close(value(&metrics, "noise_gain"), 0.5, 0.02, 0.0);
    let noise = measure(&raw_record(&raw, &truth), &settings(motion), None);
    assert_close(value(&noise, "noise_std_deg_per_h"), 20.0, 0.015, 0.0);
}

/// Parts of `runs` intervals that hold `truth`, and their mean half width over 1.96 deviations of
/// the values.
fn coverage(runs: u64, truth: f64, run: impl Fn(u64) -> fogbench::metrics::Estimate) -> (f64, f64) {
    let (mut covered, mut width, mut square) = (0.0, 0.0, 0.0);
    for seed in 0..runs {
        let found = run(seed);
        covered += f64::from(u8::from(found.low <= truth && truth <= found.high));
        width += (found.high - found.low) / 2.0;
        square += (found.value - truth).powi(2);
    }
    let count = runs as f64;
    (
        covered / count,
        width / count / (1.96 * (square / count).sqrt()),
    )
}

#[test]
fn intervals_of_a_swing_hold_the_truth_and_are_no_wider_than_they_must() {
    const RUNS: u64 = 200;
    let clock = SwingClock {
        frequency_hz: 10.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let count = 8000;
    let truth = sine(&clock, count, 3600.0, 0.0);
    let clean = sine(&clock, count, 3600.0, 203e-6);
    let noisy = |seed: u64| {
        let mut values = clean.clone();
        add(&mut values, &white(90_000 + seed, count, 20.0));
        values
    };
    let (covered, width) = coverage(RUNS, 203e-6, |seed| {
        correlation_delay_s(&truth, &noisy(seed), &clock).unwrap()
    });
    // Binomial standard deviation of 200 at 0.95: 0.015.
    assert!(
        (0.90..=0.995).contains(&covered) && width < 1.25,
        "{covered} {width}"
    );
    // Noise whose strength changes from half a second to the next.
    let deviation = |k: usize| {
        if (k / 2000).is_multiple_of(2) {
            30.0
        } else {
            10.0
        }
    };
    let (covered, width) = coverage(RUNS, (500.0_f64).sqrt(), |seed| {
        let mut values = clean.clone();
        let noise = white(95_000 + seed, count, 1.0);
        for (k, (value, noise)) in values.iter_mut().zip(noise).enumerate() {
            *value += noise * deviation(k);
        }
        let record = raw_record(&values, &truth);
        let metrics = measure(
            &record,
            &settings(Motion::Swing { frequency_hz: 10.0 }),
            None,
        );
        metrics.metrics["noise_std_deg_per_h"].estimate
    });
    assert!(covered >= 0.90, "{covered} {width}");
}

#[test]
fn the_earth_rate_on_a_cross_axis_that_turns_is_no_noise() {
    const RUNS: u64 = 40;
    let count = 6000;
    // 7.3 turns of 12 deg/h, 0.8 samples late.
    let turning = |k: f64| 3.0 + 12.0 * (TAU * 7.3 * k / 6000.0).sin();
    let truth: Vec<f64> = (0..6000).map(|k| turning(f64::from(k))).collect();
    let late: Vec<f64> = (0..6000).map(|k| turning(f64::from(k) - 0.8)).collect();
    let mean = truth.iter().sum::<f64>() / count as f64;
    let still = vec![mean; count];
    let run = |seed: u64, is_turning: bool| {
        let mut raw = white(80_000 + seed, count, 20.0);
        add(&mut raw, if is_turning { &late } else { &still });
        let truth = if is_turning { &truth } else { &still };
        measure(&raw_record(&raw, truth), &settings(Motion::Steady), None)
    };
    let error = |metrics: ChannelMetrics| metrics.metrics["mean_error_deg_per_h"].estimate;
    let (turned, wide) = coverage(RUNS, 0.0, |seed| error(run(seed, true)));
    let (_, rested) = coverage(RUNS, 0.0, |seed| error(run(seed, false)));
    assert!(
        turned >= 0.85 && wide < 1.2 * rested,
        "{turned} {wide} {rested}"
    );
    let walk = |is_turning: bool| value(&run(0, is_turning), "angle_random_walk_deg_per_sqrt_h");
    assert_close(walk(true), walk(false), 0.02, 0.0);
}

#[test]
fn the_mean_of_words_that_never_change_is_said_to_be_exact_to_the_word() {
    let (words, truth) = (vec![7.2; 500], vec![7.3; 500]);
    let metrics = measure(&raw_record(&words, &truth), &settings(Motion::Steady), None);
    let mean = &metrics.metrics["mean_deg_per_h"];
    assert_close(mean.estimate.value, 7.2, 1e-12, 0.0);
    assert!(mean.fields.contains_key("exact_to_word"));
    let noisy = white(9, 500, 1.0);
    let metrics = measure(&raw_record(&noisy, &truth), &settings(Motion::Steady), None);
    assert!(
        !metrics.metrics["mean_deg_per_h"]
            .fields
            .contains_key("exact_to_word")
    );
}
