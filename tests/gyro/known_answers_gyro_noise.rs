//! Known answers of the gyro's noise: closed-form budget and colour.

use fogbench::gyro::{
    Coil, LoopModel, NOISE_SOURCES, NoiseSource, RateModel, facts, optimum_depth_rad,
    relative_intensity_noise_per_hz,
};
use fogbench::random::Streams;
use fogbench::scenario::{GyroConfig, NoiseConfig, NoiseDraw};
use fogbench::signal::MotionSegment;
use fogbench::units::{
    deg_per_h_sqrt_s_to_deg_per_sqrt_h, deg_per_sqrt_h_to_deg_per_h_sqrt_s, rad_to_deg,
};
use std::f64::consts::PI;

use crate::support::assert_close;
use crate::support::gyro_cases::{allan_deviation, budget_of, off, on};
use crate::support::reference_gyro::{gyro, reference_gyro};

/// Relative standard error of an overlapping Allan deviation of white rate noise.
///
/// Degrees of freedom of white frequency noise, NIST SP 1065, table 5; the deviation's error is
/// half of the variance's, `sqrt(2 / edf) / 2`.
fn white_relative_error(count: usize, factor: usize) -> f64 {
    let (n, m) = (count as f64 + 1.0, factor as f64);
    let edf =
        (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0);
    (0.5 / edf).sqrt()
}

fn loop_words(config: &GyroConfig, seed: u64, time_s: f64) -> Vec<f64> {
    let mut model =
        LoopModel::new(config, time_s, &Streams::new(seed, 0)).expect("the gyro is sound");
    words(time_s, model.sample_period_s(), |segment| {
        model.next_word(segment)
    })
}

fn rate_words(config: &GyroConfig, seed: u64, time_s: f64) -> Vec<f64> {
    let mut model =
        RateModel::new(config, time_s, &Streams::new(seed, 0)).expect("the gyro is sound");
    words(time_s, model.sample_period_s(), |segment| {
        model.next_word(segment)
    })
}

/// Words at rest, the first fifty, in which the loop settles, left out.
fn words(time_s: f64, period_s: f64, mut word: impl FnMut(&MotionSegment) -> f64) -> Vec<f64> {
    let rest = MotionSegment::constant(0.0);
    for _ in 0..50 {
        word(&rest);
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count"
    )]
    let count = (time_s / period_s) as usize;
    (0..count).map(|_| word(&rest)).collect()
}

/// Angle random walk at averaging factor `m`, deg/sqrt(h), and its relative standard error.
fn random_walk(config: &GyroConfig, words: &[f64], factor: usize) -> (f64, f64) {
    let time_s = factor as f64 * fogbench::gyro::sample_period_s(config);
    (
        deg_per_h_sqrt_s_to_deg_per_sqrt_h(allan_deviation(words, factor) * time_s.sqrt()),
        white_relative_error(words.len(), factor),
    )
}

/// The reference gyro with a fast loop, so that 80 samples (20 ms) are long against its settling.
fn fast_gyro() -> GyroConfig {
    let mut config = reference_gyro();
    config.controller.loop_bandwidth_hz = 8000.0;
    config
}

/// Averaging factor and time of the fast gyro's random walk. The loop still takes
/// `1.5 (T_L / g) / 20 ms` = 0.26 % of the variance, a tenth of the standard error.
const FACTOR: usize = 80;

/// Every noise source that is drawn.
fn drawn() -> impl Iterator<Item = NoiseSource> {
    let sources = NOISE_SOURCES.into_iter();
    sources.filter(|source| source.key.starts_with("gyro.noise."))
}

/// One source on, the others that are drawn off, each source drawn on its own.
fn only(name: &str) -> NoiseConfig {
    let mut settings: Vec<String> = drawn()
        .map(|source| {
            if source.name() == name {
                on(&source)
            } else {
                off(&source)
            }
        })
        .collect();
    settings.push("noise.draw = \"exact\"".to_owned());
    gyro(&settings).noise
}

#[test]
fn each_source_is_switched_by_its_key_and_counts_once_in_the_total() {
    let all: Vec<String> = NOISE_SOURCES
        .iter()
        .map(|source| {
            if source.key == "gyro.adc.bits" {
                "adc.bits = 12".to_owned()
            } else {
                on(source)
            }
        })
        .collect();
    let budget = |settings: &[String]| {
        let facts = fogbench::gyro::facts(&gyro(settings)).expect("the gyro is sound");
        facts.angle_random_walk_budget_deg_per_sqrt_h
    };
    let full = budget(&all);
    let names: Vec<&str> = NOISE_SOURCES.iter().map(|source| source.name()).collect();
    let shown: Vec<&str> = full.iter().map(|(name, _)| *name).collect();
    assert_eq!(shown, [names.as_slice(), &["rate_word", "total"]].concat());
    for (index, source) in NOISE_SOURCES.iter().enumerate() {
        let mut settings = all.clone();
        settings[index] = off(source);
        let without = budget(&settings);
        let mut squares = 0.0;
        for ((name, before), (_, after)) in full.iter().zip(&without).take(names.len()) {
            assert!(*before > 0.0, "{name}");
            let want = if *name == source.name() { 0.0 } else { *before };
            assert_close(*after, want, 1e-12, 0.0);
            squares += after * after;
        }
        // The words round to a step of their own, which no source of the detector touches.
        let (_, rounding) = without[names.len()];
        let (_, total) = without[names.len() + 1];
        assert_close(total, squares.sqrt().hypot(rounding), 1e-12, 0.0);
    }
}

#[test]
fn known_answer_k13_each_source_alone_has_its_closed_form() {
    let depths_deg = [90.0, 120.0, 135.0];
    let cases = drawn().flat_map(|source| depths_deg.map(|depth_deg| (source.name(), depth_deg)));
    for (source, depth_deg) in cases {
        let mut config = fast_gyro();
        config.noise = only(source);
        config.modulator.depth_deg = depth_deg;
        config.adc.bits = 0;
        config.adc.samples_per_half_period = 3;
        let want = budget_of(&config, source);
        assert_close(budget_of(&config, "total"), want, 1e-12, 0.0);
        let (got, error) = random_walk(&config, &loop_words(&config, 11, 16.0), FACTOR);
        assert!(error < 0.025);
        assert_close(got, want, 3.0 * error, 0.0);
        // The check can fail: a one-sided density taken for a two-sided one is sqrt(2) off.
        assert!((got - want * 2.0_f64.sqrt()).abs() > 3.0 * error * want);
    }
}

#[test]
fn known_answer_k13_technical_noise_knows_neither_gate_nor_slope_nor_draw() {
    let mut config = fast_gyro();
    config.noise = only("technical");
    config.adc.bits = 0;
    // N = sqrt(S1 / 2) / Ks with Ks = 0.8959337 s; 1 rad/sqrt(s) is 3437.747 deg/sqrt(h).
    let want = 2e-6 / 2.0_f64.sqrt() / 0.895_933_7 * 3437.747;
    for (gate_duty, power_uw, visibility) in [(0.7, 0.87, 0.95), (0.3, 5.0, 0.5)] {
        config.detector.gate_duty = gate_duty;
        config.source.power_uw = power_uw;
        config.source.visibility = visibility;
        assert_close(budget_of(&config, "technical"), want, 1e-6, 0.0);
        config.noise.draw = NoiseDraw::Combined;
        let combined = loop_words(&config, 16, 16.0);
        config.noise.draw = NoiseDraw::Exact;
        let exact = loop_words(&config, 16, 16.0);
        for words in [combined, exact, rate_words(&config, 16, 16.0)] {
            let (got, error) = random_walk(&config, &words, FACTOR);
            assert_close(got, want, 3.0 * error, 0.0);
        }
    }
}

#[test]
fn known_answer_k13_all_sources_together_at_three_modulation_depths() {
    for (depth_deg, want) in [(90.0, 0.00558), (120.0, 0.00600), (135.0, 0.00716)] {
        let mut config = fast_gyro();
        config.modulator.depth_deg = depth_deg;
        assert_close(budget_of(&config, "total"), want, 0.0, 1e-5);
        config.noise.draw = NoiseDraw::Exact;
        config.noise.technical_phase_urad_per_sqrt_hz = 2.0;
        config.adc.samples_per_half_period = 4;
        let want = budget_of(&config, "total");
        let (got, error) = random_walk(&config, &loop_words(&config, 12, 10.0), FACTOR);
        assert_close(got, want, 3.0 * error, 0.0);
    }
}

#[test]
fn known_answer_k13_the_converter_adds_its_rounding() {
    for (draw, time_s) in [(NoiseDraw::Combined, 60.0), (NoiseDraw::Exact, 8.0)] {
        let mut config = fast_gyro();
        config.noise.draw = draw;
        let want = budget_of(&config, "adc");
        let rounded = loop_words(&config, 13, time_s);
        let (with, error) = random_walk(&config, &rounded, FACTOR);
        config.adc.bits = 0;
        let (without, _) = random_walk(&config, &loop_words(&config, 13, time_s), FACTOR);
        // Same noise, so that the difference of variances errs by the converter's part and its
        // product with the rest only: Var = (4 s^2 q^2 + 2 q^4) / edf.
        let edf = 0.5 / (error * error);
        let rest = budget_of(&config, "total");
        let variance_error = ((4.0 * rest * rest * want * want + 2.0 * want.powi(4)) / edf).sqrt();
        assert_close(
            with * with - without * without,
            want * want,
            0.0,
            3.0 * variance_error,
        );
        assert!(3.0 * variance_error < 0.5 * want * want);
    }
}

#[test]
fn known_answer_k13_the_random_walk_does_not_depend_on_the_loop_gain() {
    let mut results = Vec::new();
    for (bandwidth_hz, latency) in [(1000.0, 1), (2000.0, 0), (8000.0, 1)] {
        let mut config = reference_gyro();
        config.controller.loop_bandwidth_hz = bandwidth_hz;
        config.controller.loop_latency_periods = latency;
        config.noise.draw = NoiseDraw::Exact;
        config.adc.samples_per_half_period = 1;
        // Ideal: rounding errors depend on the register, and so would not be the same noise.
        config.adc.bits = 0;
        let (got, error) = random_walk(&config, &loop_words(&config, 14, 40.0), 800);
        assert_close(got, budget_of(&config, "total"), 3.0 * error, 0.0);
        results.push(got);
    }
    // Same noise: at 0.2 s the walks differ by 1.5 (T_L / g) / 0.2 s, about 0.1 %, alone.
    assert_close(results[0], results[2], 0.01, 0.0);
    assert_close(results[1], results[2], 0.01, 0.0);
}

#[test]
fn the_combined_draw_is_held_to_the_exact_path() {
    let mut config = fast_gyro();
    let (combined, first) = random_walk(&config, &loop_words(&config, 15, 12.0), FACTOR);
    config.noise.draw = NoiseDraw::Exact;
    let (exact, second) = random_walk(&config, &loop_words(&config, 15, 12.0), FACTOR);
    assert_close(combined, exact, 3.0 * first.hypot(second), 0.0);
}

#[test]
fn known_answer_k14_sources_scale_with_power_as_their_statistics_say() {
    let mut config = reference_gyro();
    config.detector.dark_current_na = 0.0;
    let walk = |power_uw: f64, source: &str| {
        let mut config = config.clone();
        config.source.power_uw = power_uw;
        budget_of(&config, source)
    };
    for (source, exponent) in [
        ("thermal", -1.0),
        ("amplifier", -1.0),
        ("adc", -1.0),
        ("shot", -0.5),
        ("rin", 0.0),
    ] {
        let ratio = walk(2.61, source) / walk(0.87, source);
        assert_close(ratio, 3.0_f64.powf(exponent), 1e-12, 0.0);
    }
}

#[test]
fn known_answer_k15_the_optimum_depth_is_where_the_budget_is_least() {
    let mut config = reference_gyro();
    config.source.visibility = 1.0;
    config.detector.dark_current_na = 0.0;
    config.adc.bits = 0;
    // At 90 deg the bias current is R P0: the squared walks are in the ratio A : B : C.
    config.modulator.depth_deg = 90.0;
    let square = |source| budget_of(&config, source).powi(2);
    let beta = (square("thermal") + square("amplifier")) / (square("shot") + 2.0 * square("rin"));
    let want = optimum_depth_rad(beta);
    let mut best = (f64::INFINITY, 0.0);
    for step in 1600..3000 {
        config.modulator.depth_deg = rad_to_deg(1e-3 * f64::from(step));
        let total = budget_of(&config, "total");
        if total < best.0 {
            best = (total, 1e-3 * f64::from(step));
        }
    }
    assert_close(best.1, want, 0.0, 1e-3);
    assert_close(optimum_depth_rad(1e12), 0.5 * PI, 1e-3, 0.0);
}

#[test]
fn known_answer_k16_intensity_noise_of_a_gaussian_line() {
    let mut source = reference_gyro().source;
    source.linewidth_nm = 40.0;
    assert_close(
        relative_intensity_noise_per_hz(&source),
        1.901e-13,
        1e-3,
        0.0,
    );
    // Two independent polarisations share the power: half the noise; (1 + P^2) / 2 between.
    for (degree, share) in [(0.0, 0.5), (0.6, 0.68)] {
        source.polarisation_degree = degree;
        assert_close(
            relative_intensity_noise_per_hz(&source),
            share * 1.901e-13,
            1e-3,
            0.0,
        );
    }
}

/// Autocovariance of the words at lags 0, 1, ... for unit error noise per loop period.
///
/// From the impulse response of the difference equation, independent of the models: register
/// autocovariance `R[k] = sum_n h[n] h[n+k]`, averaged over two blocks of `periods`.
fn word_autocovariance(gain: f64, latency: usize, periods: usize, lags: usize) -> Vec<f64> {
    let length = periods * (lags + 1) + 4000;
    let mut response: Vec<f64> = Vec::with_capacity(length);
    let mut errors = vec![0.0; latency];
    let mut register = 0.0;
    for period in 0..length {
        errors.push(if period == 0 { 1.0 } else { 0.0 } - register);
        register += gain * errors[period];
        response.push(register);
    }
    let covariance = |lag: usize| -> f64 {
        response
            .iter()
            .zip(&response[lag..])
            .map(|(a, b)| a * b)
            .sum()
    };
    let table: Vec<f64> = (0..periods * (lags + 1)).map(covariance).collect();
    (0..lags)
        .map(|lag| {
            let mut sum = 0.0;
            for first in 0..periods {
                for second in 0..periods {
                    sum += table[(lag * periods + second).abs_diff(first)];
                }
            }
            sum / (periods * periods) as f64
        })
        .collect()
}

fn sample_autocovariance(words: &[f64], lag: usize) -> f64 {
    let pairs = words.len() - lag;
    words
        .iter()
        .zip(&words[lag..])
        .map(|(a, b)| a * b)
        .sum::<f64>()
        / pairs as f64
}

#[test]
fn known_answer_k30_both_models_have_the_colour_of_the_loop() {
    for (bandwidth_hz, latency, published) in [
        (1000.0, 0, Some((0.40, 16.0))),
        (2000.0, 0, Some((0.21, 19.0))),
        (2000.0, 1, None),
        (500.0, 3, None),
    ] {
        let mut config = reference_gyro();
        config.controller.loop_bandwidth_hz = bandwidth_hz;
        config.controller.loop_latency_periods = latency;
        let gain = facts(&config).unwrap().loop_gain;
        let theory = word_autocovariance(gain, latency as usize, 32, 5);
        let coil = Coil::new(&config.coil, &config.source);
        let walk_deg_per_h = deg_per_sqrt_h_to_deg_per_h_sqrt_s(budget_of(&config, "total"));
        let unit = walk_deg_per_h * walk_deg_per_h / coil.loop_period_s();
        if let Some((correlation, deviation_deg_per_h)) = published {
            assert_close(theory[1] / theory[0], correlation, 0.0, 0.02);
            assert_close((unit * theory[0]).sqrt(), deviation_deg_per_h, 0.0, 0.1);
        }
        for words in [loop_words(&config, 21, 12.0), rate_words(&config, 22, 50.0)] {
            // Bartlett: the variance of a sample autocovariance is at most that of the variance,
            // (2 / n) sum_k R[k]^2.
            let sum: f64 = theory[0].powi(2) + 2.0 * theory[1..].iter().map(|r| r * r).sum::<f64>();
            let error = (2.0 * sum / words.len() as f64).sqrt();
            for (lag, want) in theory.iter().enumerate() {
                let got = sample_autocovariance(&words, lag) / unit;
                assert_close(got, *want, 0.0, 4.0 * error);
            }
            assert!(4.0 * error < 0.06 * theory[0]);
        }
    }
}

#[test]
fn the_rate_model_holds_its_random_walk_at_any_sample_length() {
    for half_periods in [2, 64, 4096, 200_000] {
        let mut config = reference_gyro();
        config.controller.loop_latency_periods = 3;
        config.output.half_periods_per_sample = half_periods;
        let period_s = fogbench::gyro::sample_period_s(&config);
        let count = if half_periods == 2 {
            400_000.0
        } else {
            20_000.0
        };
        // Long against the settling time of 80 us.
        let factor = if half_periods == 2 { 2000 } else { 64 };
        let words = rate_words(&config, 23, count * period_s);
        let (got, error) = random_walk(&config, &words, factor);
        assert_close(got, budget_of(&config, "total"), 3.0 * error + 0.01, 0.0);
    }
}

#[test]
fn slow_noise_and_fast_noise_meet_in_the_words() {
    for fidelity_words in [loop_words, rate_words] {
        let mut config = reference_gyro();
        config.slow_noise.bias_deg_per_h = 100.0;
        let words = fidelity_words(&config, 3, 1.0);
        let mean = words.iter().sum::<f64>() / words.len() as f64;
        // The mean of a second errs by N / sqrt(1 s) = 0.36 deg/h.
        assert_close(mean, 100.0, 0.0, 4.0 * 0.36);
    }
}

#[test]
fn streams_decide_the_words() {
    let config = reference_gyro();
    let first = loop_words(&config, 1, 0.01);
    assert_eq!(first, loop_words(&config, 1, 0.01));
    assert_ne!(first, loop_words(&config, 2, 0.01));
}

#[test]
fn the_rounding_of_the_words_stands_in_the_budget() {
    // A coil of 5 km has so little noise that steps of 4e-4 deg/s count; in steps of 2e-3 deg/s few words
    // move at all.
    for (lsb_deg_per_s, seed) in [(4e-4, 1), (2e-3, 2)] {
        let mut config = gyro(&[
            "coil.length_m = 5000.0".to_owned(),
            "coil.diameter_mm = 200.0".to_owned(),
            "source.wavelength_nm = 1550.0".to_owned(),
            "controller.loop_bandwidth_hz = 2000.0".to_owned(),
            "modulator.dac_bits = 0".to_owned(),
            format!("output.rate_lsb_deg_per_s = {lsb_deg_per_s}"),
        ]);
        config.slow_noise.bias_instability_deg_per_h = 0.0;
        config.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h = 0.0;
        let (total, rounding) = (budget_of(&config, "total"), budget_of(&config, "rate_word"));
        let detection = (total * total - rounding * rounding).sqrt();
        // The rates that the words round stand anywhere between two steps.
        let mut model = RateModel::new(&config, 400.0, &Streams::new(seed, 0)).unwrap();
        let step = fogbench::units::deg_per_s_to_rad_per_s(lsb_deg_per_s);
        let mut variances = Vec::new();
        for place in 0..8 {
            let rest = MotionSegment::constant(step * f64::from(place) / 8.0);
            let words: Vec<f64> = (0..20_050).map(|_| model.next_word(&rest)).collect();
            let (walk, _) = random_walk(&config, &words[50..], 20);
            variances.push(walk * walk);
        }
        let measured = (variances.iter().sum::<f64>() / 8.0).sqrt();
        // 160 000 words in twenties: 1.0 %.
        assert_close(measured, total, 0.03, 0.0);
        assert!(total > 1.05 * detection, "{total} {detection}");
    }
}
