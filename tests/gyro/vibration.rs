//! Vibration: the loop model against the linear loop's second-order mean, and the rate model.

use fogbench::gyro::{Coil, Controller, LoopModel, RateModel};
use fogbench::random::Streams;
use fogbench::scenario::{
    GyroConfig, RandomVibrationConfig, ScenarioError, SineVibrationConfig, VibrationMotion,
    load_suite,
};
use fogbench::signal::MotionSegment;
use fogbench::units::{
    deg_per_h_to_rad_per_s, deg_per_s_to_deg_per_h, deg_per_s_to_rad_per_s, deg_to_rad,
};
use nalgebra::Complex;
use std::f64::consts::TAU;

use crate::support::assert_close;
use crate::support::gyro_cases::silent_gyro;
use crate::support::transcript::said_to_each;

/// Words of a record.
const WORDS: usize = 400;
/// Words before it: the loop settles within a few.
const SETTLING_WORDS: usize = 100;
const REST: MotionSegment = MotionSegment {
    rate_rad_per_s: [0.0; 4],
};

fn vibrating(motion: VibrationMotion, latency_periods: u32) -> GyroConfig {
    let mut config = silent_gyro();
    config.vibration.motion = motion;
    config.controller.loop_latency_periods = latency_periods;
    config
}

/// 5 g (0.5 % of the power) and 0.1 deg/s.
fn sine(frequency_hz: f64, rate_phase_deg: f64) -> SineVibrationConfig {
    SineVibrationConfig {
        frequency_hz,
        acceleration_g: 5.0,
        rate_amplitude_deg_per_s: 0.1,
        rate_phase_deg,
    }
}

fn coil(config: &GyroConfig) -> Coil {
    Coil::new(&config.coil, &config.source)
}

/// The frequency next to `near_hz` that has whole cycles in a record.
fn whole_cycles(near_hz: f64) -> f64 {
    let record_s = WORDS as f64 * 64.0 * coil(&silent_gyro()).transit_time_s;
    (near_hz * record_s).round() / record_s
}

fn loop_words(config: &GyroConfig, words: usize) -> Vec<f64> {
    let mut model = LoopModel::new(config, 10.0, &Streams::new(1, 0)).expect("a sound gyro");
    (0..words).map(|_| model.next_word(&REST)).collect()
}

fn rate_words(config: &GyroConfig, words: usize) -> Vec<f64> {
    let mut model = RateModel::new(config, 10.0, &Streams::new(1, 0)).expect("a sound gyro");
    (0..words).map(|_| model.next_word(&REST)).collect()
}

/// Mean after settling, deg/h.
fn mean(words: &[f64]) -> f64 {
    let settled = &words[SETTLING_WORDS..];
    settled.iter().sum::<f64>() / settled.len() as f64
}

/// Mean of the register, rad, for relative power Q and Sagnac phase P of a tone: second-order terms
/// of the demodulated pair at the phases that the linear loop leaves, unsimplified.
fn rectified_rad(
    config: &GyroConfig,
    frequency_hz: f64,
    power: Complex<f64>,
    phase: Complex<f64>,
) -> f64 {
    let coil = coil(config);
    let controller = Controller::new(
        config.controller.loop_bandwidth_hz,
        config.controller.loop_latency_periods,
        coil.loop_period_s(),
    )
    .expect("a stable loop");
    let (re, im) = controller.response(frequency_hz);
    let later = Complex::from_polar(1.0, TAU * frequency_hz * coil.transit_time_s);
    let (sine, cosine) = deg_to_rad(config.modulator.depth_deg).sin_cos();
    let visibility = config.source.visibility;
    let level = (1.0 + visibility * cosine) / (2.0 * visibility * sine);
    let drive = (phase + phase * later) * 0.5 + (power * later - power) * level;
    let register = Complex::new(re, im) * drive;
    let (first, second) = (phase - register, phase * later - register);
    let products = power.conj() * first + (power * later).conj() * second;
    let squares = second.norm_sqr() - first.norm_sqr();
    0.25 * products.re - 0.125 * cosine / sine * squares
}

/// Expected mean error of a sine, deg/h.
fn rectified_sine(config: &GyroConfig, sine: &SineVibrationConfig) -> f64 {
    let scale = coil(config).scale_factor_s;
    let power = Complex::new(sine.acceleration_g * config.vibration.intensity_per_g, 0.0);
    let rate = deg_per_s_to_rad_per_s(sine.rate_amplitude_deg_per_s);
    let phase = Complex::from_polar(scale * rate, deg_to_rad(sine.rate_phase_deg));
    let rad = rectified_rad(config, sine.frequency_hz, power, phase);
    rad / (scale * deg_per_h_to_rad_per_s(1.0))
}

/// Half the product of the amplitudes of power and rate, deg/h: what full rectification would give.
const PRODUCT_DEG_PER_H: f64 = 0.5 * 5e-3 * 360.0;

#[test]
fn a_sine_is_rectified_by_the_residual_phase_of_the_loop() {
    for latency_periods in [0, 1, 3] {
        for near_hz in [20.0, 300.0, 1500.0, 3500.0, 20_000.0, 100_000.0] {
            for phase_deg in [0.0, 90.0, 210.0] {
                let sine = sine(whole_cycles(near_hz), phase_deg);
                let config = vibrating(VibrationMotion::Sine(sine.clone()), latency_periods);
                let want = rectified_sine(&config, &sine);
                let words = loop_words(&config, SETTLING_WORDS + WORDS);
                // The next order of a single tone's mean is the fourth, 1e-4 of this.
                assert_close(mean(&words), want, 0.01, 2e-4 * PRODUCT_DEG_PER_H);
            }
        }
    }
    // The cases are no zeros: within the band it is the quadrature that is rectified.
    let slow = sine(whole_cycles(300.0), 90.0);
    let config = vibrating(VibrationMotion::Sine(slow.clone()), 1);
    let want = rectified_sine(&config, &slow).abs();
    assert!(want > 0.1 * PRODUCT_DEG_PER_H, "{want} deg/h");
}

#[test]
fn power_alone_and_rate_alone_are_rectified_too() {
    let both = |acceleration_g: f64, rate: f64| SineVibrationConfig {
        acceleration_g,
        rate_amplitude_deg_per_s: rate,
        ..sine(whole_cycles(3000.0), 0.0)
    };
    // 5 % of the power; 5 deg/s. Each is a second-order error of its own.
    for sine in [both(50.0, 0.0), both(0.0, 5.0)] {
        let config = vibrating(VibrationMotion::Sine(sine.clone()), 1);
        let want = rectified_sine(&config, &sine);
        assert!(want.abs() > 0.05, "{want} deg/h");
        let words = loop_words(&config, SETTLING_WORDS + WORDS);
        assert_close(mean(&words), want, 0.03, 0.0);
    }
}

#[test]
fn a_tone_that_never_turns_leaves_words_that_are_numbers() {
    let tone = VibrationMotion::Sine(sine(1e-322, 0.0));
    let words = rate_words(&vibrating(tone, 1), 8);
    assert!(words.iter().all(|word| word.is_finite()), "{words:?}");
}

#[test]
fn the_rate_model_has_the_tone_and_its_mean() {
    for latency_periods in [0, 1, 3] {
        // In band, at the edge of the loop, and beyond the Nyquist frequency of 1995 Hz.
        for near_hz in [20.0, 1500.0, 3500.0] {
            let mut config = vibrating(
                VibrationMotion::Sine(sine(whole_cycles(near_hz), 30.0)),
                latency_periods,
            );
            config.vibration.rate_error_deg_per_h_per_g = 2.0;
            let looped = loop_words(&config, SETTLING_WORDS + WORDS);
            let rated = rate_words(&config, SETTLING_WORDS + WORDS);
            let swing = |words: &[f64]| {
                let settled = &words[SETTLING_WORDS..];
                settled
                    .iter()
                    .fold(0.0_f64, |max, word| max.max(word.abs()))
            };
            assert!(swing(&rated) > 1.0, "{near_hz} Hz: {} deg/h", swing(&rated));
            let apart: Vec<f64> = looped.iter().zip(&rated).map(|(a, b)| a - b).collect();
            // Left out: the second harmonic, half a per cent of power times the phase left over.
            let allowed = 2.0 * PRODUCT_DEG_PER_H + 1e-3 * swing(&rated);
            assert!(
                swing(&apart) < allowed,
                "{near_hz} Hz: {} deg/h",
                swing(&apart)
            );
            assert_close(mean(&apart), 0.0, 0.0, 0.01 * PRODUCT_DEG_PER_H);
        }
    }
}

#[test]
fn acceleration_turns_into_rate_by_its_coefficient() {
    let sine = SineVibrationConfig {
        acceleration_g: 5.0,
        rate_amplitude_deg_per_s: 0.0,
        ..sine(whole_cycles(50.0), 0.0)
    };
    let mut config = vibrating(VibrationMotion::Sine(sine), 1);
    config.vibration.intensity_per_g = 0.0;
    config.vibration.rate_error_deg_per_h_per_g = 4.0;
    let words = loop_words(&config, SETTLING_WORDS + WORDS);
    let power: f64 = words[SETTLING_WORDS..].iter().map(|word| word * word).sum();
    // 20 deg/h of amplitude, at 50 Hz under a loop of 2 kHz.
    assert_close((2.0 * power / WORDS as f64).sqrt(), 20.0, 2e-3, 0.0);
}

fn random(from_hz: f64, to_hz: f64, coherent: bool) -> RandomVibrationConfig {
    RandomVibrationConfig {
        from_hz,
        to_hz,
        acceleration_psd_g2_per_hz: 0.04,
        rate_psd_deg2_per_s2_per_hz: 4e-6,
        tones: 64,
        coherent,
        ..RandomVibrationConfig::reference()
    }
}

#[test]
fn a_random_band_has_the_power_of_its_density() {
    let band = random(10.0, 300.0, false);
    let words = rate_words(&vibrating(VibrationMotion::Random(band), 1), 40_000);
    let mean = mean(&words);
    let power: f64 = words.iter().map(|word| (word - mean).powi(2)).sum::<f64>() / 40_000.0;
    // sqrt(4e-6 x 290) deg/s; power over 10 s scatters by 1 / sqrt(290 x 10) = 1.9 %, three of it,
    // and loop and averager change it by 1.5 % at most.
    let want = deg_per_s_to_deg_per_h((4e-6_f64 * 290.0).sqrt());
    assert_close(power, want * want, 0.07, 0.0);
}

#[test]
fn a_coherent_band_is_rectified_as_the_integral_of_its_tones() {
    let (from_hz, to_hz) = (500.0, 3000.0);
    let parts = 1000;
    let words = SETTLING_WORDS + 12_000;
    let record_s = 12_000.0 * 64.0 * coil(&silent_gyro()).transit_time_s;
    let mut means = Vec::new();
    for coherent in [true, false] {
        let config = vibrating(VibrationMotion::Random(random(from_hz, to_hz, coherent)), 1);
        let scale = coil(&config).scale_factor_s;
        let width_hz = (to_hz - from_hz) / f64::from(parts);
        let zero = Complex::new(0.0, 0.0);
        let power = Complex::new(1e-3 * (2.0 * 0.04 * width_hz).sqrt(), 0.0);
        let rate = deg_per_s_to_rad_per_s((2.0 * 4e-6 * width_hz).sqrt());
        let phase = Complex::new(scale * rate, 0.0);
        let sum: f64 = (0..parts)
            .map(|part| from_hz + (f64::from(part) + 0.5) * width_hz)
            .map(|frequency_hz| {
                let rectified = |power, phase| rectified_rad(&config, frequency_hz, power, phase);
                if coherent {
                    rectified(power, phase)
                } else {
                    rectified(power, zero) + rectified(zero, phase)
                }
            })
            .sum();
        let want = sum / (scale * deg_per_h_to_rad_per_s(1.0));
        let got = mean(&loop_words(&config, words));
        let rms = deg_per_s_to_deg_per_h((4e-6_f64 * (to_hz - from_hz)).sqrt());
        // The mean of the tones themselves, and of their beats: power rms 1 %, 2.5 kHz wide.
        let leak = rms / (TAU * from_hz * record_s) / 8.0;
        let beats = 0.01 * rms / ((to_hz - from_hz) * record_s).sqrt();
        assert_close(got, want, 0.02, 3.0 * (leak + beats));
        means.push((want, 3.0 * (leak + beats)));
    }
    let [(coherent, tolerance), (incoherent, _)] = means[..] else {
        panic!("two cases")
    };
    assert!(
        coherent - incoherent > 5.0 * tolerance,
        "{coherent} {incoherent} {tolerance}"
    );
}

/// What the reader says to a scenario of 20 s with this text.
fn refused(text: &str) -> Vec<ScenarioError> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = folder.path().join("x.toml");
    std::fs::write(&file, format!("name = \"x\"\nduration_s = 20.0\n{text}")).expect("writable");
    load_suite(&[file], &[]).err().unwrap_or_default()
}

#[test]
fn vibrations_that_make_no_sense_are_refused_with_the_reason() {
    let sine = "[gyro.vibration.sine]\nfrequency_hz = 300.0\n";
    let random = "[gyro.vibration.random]\nfrom_hz = 20.0\n";
    assert!(refused(sine).is_empty());
    assert!(refused(&format!("{random}to_hz = 2000.0\n")).is_empty());
    let bare = "[gyro.vibration]\nintensity_per_g = 0.5\n";
    assert!(refused(&format!("{bare}{sine}")).is_empty());
    let cases = [
        bare.to_owned(),
        format!("{random}to_hz = 20.0\n"),
        sine.replace("300.0", "99999.0") + "[gyro.coil]\nlength_m = 1600.0\n",
        format!("{sine}acceleration_g = 0.0\n"),
        format!("{random}to_hz = 99.0\nrate_phase_deg = 5.0\n"),
        format!("{sine}acceleration_g = 2.0\n{bare}"),
        format!("{sine}[gyro.modulator]\nscheme = \"four-state\"\n"),
        format!(
            "{random}to_hz = 99.0\n[gyro.modulator]\nhalf_period_mismatch = 1e-3\n\
             [gyro.detector]\ngate_spikes = false\ngate_duty = 1.0\n"
        ),
    ];
    said_to_each("motion", "Vibrations that make no sense", cases, |text| {
        let errors = refused(text);
        let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
        texts.join("\n")
    });
}
