//! Known answers of the rate output: rounded words and counted pulses.

use fogbench::gyro::{LoopModel, RateModel};
use fogbench::random::Streams;
use fogbench::scenario::{GyroConfig, OutputQuantisation};
use fogbench::signal::MotionSegment;
use fogbench::units::deg_per_h_to_rad_per_s;

use crate::support::gyro_cases::allan_deviation;
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, repository, stderr};

/// Words about the vertical Earth rate, which with the noise of the gyro is the dither.
fn words(config: &GyroConfig, count: usize) -> Vec<f64> {
    let streams = Streams::new(5, 0);
    let mut model = RateModel::new(config, 1.0, &streams).expect("the gyro is sound");
    let rate = MotionSegment::constant(deg_per_h_to_rad_per_s(8.47));
    (0..count).map(|_| model.next_word(&rate)).collect()
}

/// Allan variance that rounding adds at an averaging factor, and its standard error.
///
/// Both records have the same noise of variance s^2, so that the difference q^2 errs by
/// `sqrt((4 s^2 q^2 + 2 q^4) / edf)` only, with 1.5 m-fold overlapping degrees of freedom.
fn excess(plain: &[f64], rounded: &[f64], factor: usize) -> (f64, f64) {
    let noise = allan_deviation(plain, factor).powi(2);
    let excess = allan_deviation(rounded, factor).powi(2) - noise;
    let freedom = 1.5 * plain.len() as f64 / factor as f64;
    let error = ((4.0 * noise * excess + 2.0 * excess * excess) / freedom).sqrt();
    (excess, error)
}

#[test]
fn known_answer_k22_counted_pulses_are_an_angle_quantisation() {
    const COUNT: usize = 3_000_000;
    let mut config = reference_gyro();
    let plain = words(&config, COUNT);
    config.output.quantisation = OutputQuantisation::AngleCarry;
    let counted = words(&config, COUNT);
    let period_s = fogbench::gyro::sample_period_s(&config);
    let pulse_deg_per_h = config.output.angle_lsb_arcsec / period_s;
    let mut behind_arcsec = 0.0_f64;
    for (plain, counted) in plain.iter().zip(&counted) {
        let pulses = counted / pulse_deg_per_h;
        assert_close(pulses, pulses.round(), 0.0, 1e-9);
        behind_arcsec += (plain - counted) * period_s;
        assert!(behind_arcsec.abs() <= 0.5 * config.output.angle_lsb_arcsec + 1e-6);
    }
    let variance_arcsec2 = config.output.angle_lsb_arcsec.powi(2) / 12.0;
    for factor in [8, 16] {
        let tau_s = factor as f64 * period_s;
        let (got, error) = excess(&plain, &counted, factor);
        let want = 3.0 * variance_arcsec2 / (tau_s * tau_s);
        assert!(3.0 * error < 0.05 * want, "{error} of {want}");
        assert_close(got, want, 0.05, 0.0);
    }
}

#[test]
fn known_answer_k22_rounded_words_are_an_angle_random_walk() {
    const COUNT: usize = 4_000_000;
    let mut config = reference_gyro();
    let plain = words(&config, COUNT);
    // 27 deg/h beside 19 deg/h of noise: the rounding error is white and of no relation to it.
    config.output.rate_lsb_deg_per_s = 0.0075;
    let rounded = words(&config, COUNT);
    let period_s = fogbench::gyro::sample_period_s(&config);
    let walk = 27.0 * (period_s / 12.0).sqrt();
    for factor in [8, 16, 32] {
        let (got, error) = excess(&plain, &rounded, factor);
        let want = walk * walk / (factor as f64 * period_s);
        assert!(3.0 * error < 0.05 * want, "{error} of {want}");
        assert_close(got, want, 0.05, 0.0);
    }
}

#[test]
fn both_models_count_pulses() {
    let mut config = reference_gyro();
    config.output.quantisation = OutputQuantisation::AngleCarry;
    config.output.angle_lsb_arcsec = 0.5;
    let streams = Streams::new(1, 0);
    let mut model = LoopModel::new(&config, 1.0, &streams).expect("the gyro is sound");
    let rate = MotionSegment::constant(deg_per_h_to_rad_per_s(3600.0));
    let sum: f64 = (0..4000).map(|_| model.next_word(&rate)).sum();
    let period_s = fogbench::gyro::sample_period_s(&config);
    // An arcsecond per second, less the lag of the loop: whole pulses.
    let pulses = sum * period_s / 0.5;
    assert_close(pulses, pulses.round(), 0.0, 1e-6);
    assert_close(pulses, 2.0 * 3600.0 * 4000.0 * period_s, 0.0, 3.0);
}

#[test]
fn a_step_that_nothing_reads_is_refused() {
    let scenario = repository("scenarios/quick/static.toml");
    let scenario = scenario.to_str().expect("UTF-8");
    let mut transcript = Transcript::of("gyro", "Steps of a word that nothing reads");
    for sets in [
        ["gyro.output.angle_lsb_arcsec=0.5", "seed=1"],
        [
            "gyro.output.quantisation=angle-carry",
            "gyro.output.rate_lsb_deg_per_s=0.01",
        ],
    ] {
        let arguments = ["check", scenario, "--set", sets[0], "--set", sets[1]];
        let output = fogbench(&repository("."), &arguments);
        assert_eq!(code(&output), 2);
        transcript.case(arguments[2..].join(" "), stderr(&output));
    }
    transcript.check();
    let allowed = "gyro.output.quantisation=angle-carry";
    let output = fogbench(&repository("."), &["check", scenario, "--set", allowed]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}
