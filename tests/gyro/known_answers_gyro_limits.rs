//! Known answers of the limits within which the gyro's models hold.

use fogbench::gyro::{GyroError, LoopModel, MotionExtremes, cautions, facts};
use fogbench::random::Streams;
use fogbench::scenario::{Fidelity, GyroConfig, NoiseDraw};
use fogbench::signal::MotionSegment;
use fogbench::units::{deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};
use std::f64::consts::PI;

use crate::support::gyro_cases::silent_gyro;
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// Motion of one rate, reached slowly.
fn rate(deg_per_s: f64) -> MotionExtremes {
    MotionExtremes {
        rate_rad_per_s: deg_per_s_to_rad_per_s(deg_per_s),
        ..MotionExtremes::default()
    }
}

/// Motion of one jump of Sagnac phase.
fn jump(config: &GyroConfig, phase_rad: f64) -> MotionExtremes {
    let scale_factor_s = facts(config).expect("the gyro is sound").scale_factor_s;
    MotionExtremes {
        jump_rad_per_s: phase_rad / scale_factor_s,
        ..MotionExtremes::default()
    }
}

fn at_rest(config: &GyroConfig, fidelity: Fidelity) -> Result<Vec<String>, GyroError> {
    cautions(config, fidelity, &MotionExtremes::default())
}

fn loop_model(config: &GyroConfig) -> LoopModel {
    LoopModel::new(config, 1.0, &Streams::new(5, 0)).expect("the gyro is sound")
}

#[test]
fn the_reference_gyro_and_the_ideal_one_need_no_caution() {
    for config in [reference_gyro(), silent_gyro()] {
        for fidelity in [Fidelity::Loop, Fidelity::Rate] {
            let motion = MotionExtremes {
                acceleration_rad_per_s2: 70.0,
                ..rate(64.0)
            };
            assert!(cautions(&config, fidelity, &motion).unwrap().is_empty());
        }
    }
}

#[test]
fn the_rate_model_refuses_rates_beyond_the_single_fringe() {
    let config = reference_gyro();
    assert!(cautions(&config, Fidelity::Rate, &rate(200.9)).is_ok());
    let error = cautions(&config, Fidelity::Rate, &rate(210.0)).unwrap_err();
    assert_eq!(error.key(), "turntable");
    assert!(error.to_string().contains("+-200.908 deg/s"), "{error}");
    let said = cautions(&config, Fidelity::Loop, &rate(210.0)).unwrap();
    assert!(said[0].contains("200.908"), "{said:?}");
    // A bias is a rate to the loop.
    let mut biased = reference_gyro();
    biased.slow_noise.bias_deg_per_h = 3600.0;
    assert!(cautions(&biased, Fidelity::Rate, &rate(200.0)).is_err());
}

#[test]
fn the_loop_settles_on_the_right_fringe_up_to_pi_and_on_the_next_one_beyond() {
    let config = silent_gyro();
    let mut transcript = Transcript::of("gyro", "Steps of the phase around pi");
    for (phase, fringe) in [(3.0, 0.0), (3.3, 2.0 * PI), (-3.3, -2.0 * PI)] {
        let mut model = loop_model(&config);
        for _ in 0..2000 {
            model.run_period([phase; 2]);
        }
        assert_close(model.register_rad(), phase - fringe, 1e-9, 0.0);
        assert!(cautions(&config, Fidelity::Rate, &jump(&config, phase.abs())).is_err());
        let said = cautions(&config, Fidelity::Loop, &jump(&config, phase.abs())).unwrap();
        transcript.case(format!("a step of {phase} rad"), said.join("\n"));
    }
    transcript.check();
    assert!(cautions(&config, Fidelity::Rate, &jump(&config, 1.56)).is_ok());
    assert!(cautions(&config, Fidelity::Rate, &jump(&config, 1.58)).is_err());
}

#[test]
fn settling_from_a_large_step_loses_more_angle_than_a_linear_loop() {
    let mut config = silent_gyro();
    config.controller.loop_bandwidth_hz = 200.0;
    config.controller.loop_latency_periods = 0;
    let angle = |phase: f64| {
        let mut model = loop_model(&config);
        let errors = (0..4000).map(|_| phase - model.run_period([phase; 2]));
        errors.sum::<f64>() / phase
    };
    // The integral of x / sin x over 0..1, by its series 1 + 1/18 + 7/1800 + 31/105840.
    let want = 1.0 + 1.0 / 18.0 + 7.0 / 1800.0 + 31.0 / 105_840.0;
    // The sum over periods errs from the integral by about g / 2 = 0.5 % of the excess.
    assert_close(angle(1.0) / angle(1e-3), want, 0.002, 0.0);
    let said = cautions(&config, Fidelity::Rate, &jump(&config, 1.0)).unwrap();
    assert!(said[0].contains("5.6 % too little"), "{said:?}");
}

#[test]
fn an_acceleration_that_outruns_the_loop_is_refused() {
    let config = reference_gyro();
    let facts = facts(&config).unwrap();
    let lag_s = 2.0 * facts.transit_time_us * 1e-6 / facts.loop_gain;
    for (phase, is_held) in [(1.5, true), (1.6, false)] {
        let motion = MotionExtremes {
            acceleration_rad_per_s2: phase / (facts.scale_factor_s * lag_s),
            ..rate(200.0)
        };
        assert_eq!(cautions(&config, Fidelity::Rate, &motion).is_ok(), is_held);
    }
}

/// Noise of a converter that the rate model refuses: LSB and slopes.
fn refused(config: &GyroConfig) -> (f64, f64, f64) {
    match at_rest(config, Fidelity::Rate) {
        Err(GyroError::ConverterTooCoarse {
            noise_lsb,
            slope_min,
            slope_max,
            ..
        }) => (noise_lsb, slope_min, slope_max),
        other => panic!("not refused for its converter: {other:?}"),
    }
}

#[test]
fn a_converter_with_too_little_noise_is_refused_by_one_model_and_said_by_the_other() {
    let mut config = reference_gyro();
    config.adc.bits = 10;
    let (noise_lsb, slope_min, slope_max) = refused(&config);
    assert_close(noise_lsb, 0.129, 0.0, 5e-4);
    assert!(slope_min < 0.01 && slope_max > 3.0);
    for draw in [NoiseDraw::Combined, NoiseDraw::Exact] {
        config.noise.draw = draw;
        let said = at_rest(&config, Fidelity::Loop).unwrap();
        assert_eq!(said.len(), 1);
        assert!(said[0].contains("0.129 LSB"), "{said:?}");
        assert!(said[0].contains("0.432 LSB"), "{said:?}");
        // 0.129 / sqrt(8) under a step of 1 / sqrt(8).
        let is_combined = draw == NoiseDraw::Combined;
        assert_eq!(said[0].contains("0.354 LSB under 0.04"), is_combined);
    }
    config.adc.bits = 0;
    assert!(at_rest(&config, Fidelity::Rate).unwrap().is_empty());
}

#[test]
fn known_answer_the_slope_of_a_coarse_converter_sets_the_lag_of_the_loop() {
    // Johnson noise alone, 0.35 LSB in one sample per half period: the slope is
    // 1 -+ 2 exp(-2 pi^2 s^2) = 0.822 at a code and 1.178 between two codes.
    let mut config = silent_gyro();
    config.noise.thermal = true;
    config.noise.draw = NoiseDraw::Exact;
    config.adc.samples_per_half_period = 1;
    config.adc.bits = 12;
    config.controller.loop_bandwidth_hz = 500.0;
    config.controller.loop_latency_periods = 0;
    config.adc.range_v *= refused(&config).0 / 0.35;
    let ripple = 2.0 * (-2.0 * PI * PI * 0.35_f64.powi(2)).exp();
    let (noise_lsb, slope_min, slope_max) = refused(&config);
    assert_close(noise_lsb, 0.35, 1e-9, 0.0);
    assert_close(slope_min, 1.0 - ripple, 0.0, 2e-4);
    assert_close(slope_max, 1.0 + ripple, 0.0, 2e-4);

    // One LSB in nA of photocurrent; the level of the bias point in LSB, dark current left out.
    let lsb_na = config.adc.range_v / 4096.0 / 200e3 * 1e9;
    let bias_na = 0.9 * 870.0 * (1.0 - 0.95 * 0.5);
    let slope_na = 0.9 * 870.0 * 0.95 * (PI / 3.0).sin();
    let gain = facts(&config).unwrap().loop_gain;
    let lag_rad = 0.05 * lsb_na / slope_na;
    let lag_at = |position: f64| {
        let mut config = config.clone();
        let level = bias_na / lsb_na;
        config.detector.dark_current_na = (level.ceil() + position - level) * lsb_na;
        let mut model = loop_model(&config);
        let (mut phase, mut sum) = (0.0, 0.0);
        for period in 0..405_000 {
            phase += lag_rad * gain;
            let register = model.run_period([phase; 2]);
            if period >= 5000 {
                sum += phase - register;
            }
        }
        sum / 400_000.0 / lag_rad
    };
    // Stamped after the update: (1 - g) of the error before it, 1 / slope. The register's own
    // noise (0.035 LSB) and the lag (0.05 LSB) smear the ripple by 4 %.
    // One pair has sqrt(0.35^2 + 1/12) / sqrt(2) LSB: 1 % of the lag over 400 000 periods.
    let smeared = 0.96 * ripple;
    assert_close(lag_at(0.0), 1.0 / (1.0 - smeared) - gain, 0.045, 0.0);
    assert_close(lag_at(0.5), 1.0 / (1.0 + smeared) - gain, 0.045, 0.0);
}

#[test]
fn known_answer_a_converter_without_noise_has_a_dead_zone() {
    let mut config = silent_gyro();
    config.adc.bits = 12;
    config.noise.draw = NoiseDraw::Exact;
    let said = at_rest(&config, Fidelity::Loop).unwrap();
    assert!(said[0].contains("0.000 LSB of noise"), "{said:?}");
    assert_eq!(
        at_rest(&config, Fidelity::Rate).unwrap_err().key(),
        "gyro.adc.bits"
    );
    let lsb_na = 2.0 / 4096.0 / 200e3 * 1e9;
    let level = (0.9 * 870.0 * (1.0 - 0.95 * 0.5) + config.detector.dark_current_na) / lsb_na;
    let to_threshold = 0.5 - (level - level.round()).abs();
    let edge_rad = to_threshold * lsb_na / (0.9 * 870.0 * 0.95 * (PI / 3.0).sin());
    for (factor, is_dead) in [(0.9, true), (1.1, false), (-0.9, true), (-1.1, false)] {
        let mut model = loop_model(&config);
        for _ in 0..1000 {
            model.run_period([factor * edge_rad; 2]);
        }
        assert_eq!(model.register_rad().abs() < 1e-15, is_dead, "{factor}");
    }
}

#[test]
fn the_rate_model_refuses_a_ramp_converter_coarser_than_the_noise() {
    for bits in [1, 2, 4, 8] {
        let mut config = reference_gyro();
        config.modulator.dac_bits = bits;
        let error = at_rest(&config, Fidelity::Rate).unwrap_err();
        assert_eq!(error.key(), "gyro.modulator.dac_bits", "{error}");
        assert!(at_rest(&config, Fidelity::Loop).unwrap().is_empty());
    }
    for (bits, count) in [(0, 0), (10, 1), (12, 0), (16, 0)] {
        let mut config = reference_gyro();
        config.modulator.dac_bits = bits;
        let said = at_rest(&config, Fidelity::Rate).unwrap();
        assert_eq!(said.len(), count, "{bits} bits: {said:?}");
    }
}

#[test]
fn the_rounding_of_the_ramp_stays_within_its_bound() {
    let mut config = silent_gyro();
    config.modulator.dac_bits = 10;
    config.controller.loop_bandwidth_hz = 8000.0;
    let mut model = loop_model(&config);
    let motion = MotionSegment::constant(deg_per_s_to_rad_per_s(0.011_71));
    let words: Vec<f64> = (0..4100).map(|_| model.next_word(&motion)).collect();
    let words = &words[100..];
    let mean = words.iter().sum::<f64>() / 4000.0;
    let power = words.iter().map(|word| (word - mean).powi(2)).sum::<f64>() / 4000.0;
    // L^2 / 12 at both ends of the sum over 64 half periods, less what the loop smooths.
    let step_rad = 2.0 * PI / 1024.0;
    let scale_factor_s = facts(&config).unwrap().scale_factor_s;
    let bound = rad_per_s_to_deg_per_h(step_rad / (6.0_f64.sqrt() * 64.0 * scale_factor_s));
    assert_close(bound, 9.01, 0.0, 0.02);
    assert!(power.sqrt() < 1.05 * bound, "{} {bound}", power.sqrt());
    assert!(power.sqrt() > 0.15 * bound, "{} {bound}", power.sqrt());
    // The mean is right: rounding telescopes.
    assert_close(mean, 0.011_71 * 3600.0, 0.0, 2.0 * bound / 60.0);
}

#[test]
fn check_points_at_the_key_that_breaks_the_rate_model_and_tells_of_a_caution() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let head = "schema = 1\nname = \"x\"\nduration_s = 20.0\n";
    let coarse = "[gyro.adc]\nbits = 10\n";
    let cases = [
        ("rate", coarse, 2),
        ("loop", coarse, 0),
        ("rate", "[turntable.rotation]\nrate_deg_per_s = 210.0\n", 2),
        ("rate", "[gyro.modulator]\ndac_bits = 4\n", 2),
        (
            "rate",
            "[turntable.steps]\nrates_deg_per_s = [-125.0, 125.0]\ndwell_s = 10.0\n",
            2,
        ),
    ];
    let mut transcript = Transcript::of("gyro", "Gyros and motions beyond the rate model");
    for (fidelity, more, want) in cases {
        let text = format!("{head}fidelity = \"{fidelity}\"\n{more}");
        write(folder.path(), "x.toml", &text);
        let output = fogbench(folder.path(), &["check", "x.toml"]);
        let all = format!("{}{}", stdout(&output), stderr(&output));
        assert_eq!(code(&output), want, "{all}");
        transcript.case(format!("fidelity = \"{fidelity}\"\n{more}"), all);
    }
    transcript.check();
}
