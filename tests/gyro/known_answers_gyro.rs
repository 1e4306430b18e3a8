//! Known answers of the gyro's loop: closed forms that the models must meet without noise.

use fogbench::gyro::{Coil, Controller, GyroError, LoopModel, RateModel, facts, gain_limit};
use fogbench::random::Streams;
use fogbench::scenario::GyroConfig;
use fogbench::signal::MotionSegment;
use fogbench::units::{
    deg_per_h_to_rad_per_s, deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s,
    rad_to_arcsec,
};
use std::f64::consts::{FRAC_PI_2, TAU};

use crate::plain_loop::PlainLoop;
use crate::support::assert_close;
use crate::support::gyro_cases::{budget_of, silent_gyro};
use crate::support::reference_gyro::reference_gyro;

fn model(config: &GyroConfig) -> LoopModel {
    LoopModel::new(config, 10.0, &Streams::new(1, 0)).expect("the gyro is sound")
}

/// An ideal, silent gyro with a given gain and latency.
fn silent_model(gain: f64, latency_periods: u32) -> LoopModel {
    let mut config = silent_gyro();
    config.controller.loop_latency_periods = latency_periods;
    let mut model = model(&config);
    model.set_loop_gain(gain);
    model
}

#[test]
fn known_answer_k1_geometry_of_the_reference_coil() {
    let config = reference_gyro();
    let coil = Coil::new(&config.coil, &config.source);
    assert_close(coil.scale_factor_s, 0.895_933_7, 1e-6, 0.0);
    assert_close(
        rad_per_s_to_deg_per_s(coil.single_fringe_rate_rad_per_s()),
        200.907_7,
        1e-6,
        0.0,
    );
    assert_close(coil.transit_time_s, 3.916_576e-6, 1e-6, 0.0);
    assert_close(
        rad_to_arcsec(coil.angle_per_reset_rad()),
        5.665_467,
        1e-6,
        0.0,
    );
    let facts = facts(&config).unwrap();
    assert_close(facts.proper_frequency_khz, 127.663, 1e-5, 0.0);
    assert_close(facts.output_rate_hz, 3989.45, 1e-5, 0.0);
}

#[test]
fn the_reference_budget_is_six_thousandths() {
    let config = reference_gyro();
    for (source, walk) in [
        ("shot", 0.00183),
        ("thermal", 0.00457),
        ("amplifier", 0.00151),
        ("rin", 0.00096),
        ("adc", 0.00294),
        ("total", 0.00600),
    ] {
        // The figures are given to 1e-5.
        assert_close(budget_of(&config, source), walk, 0.0, 1e-5);
    }
}

#[test]
fn known_answer_k2_demodulation_returns_the_sine_of_the_phase_error() {
    for (depth_deg, power_uw) in [(60.0, 0.87), (90.0, 5.0), (120.0, 0.1), (150.0, 0.87)] {
        let mut config = silent_gyro();
        config.modulator.depth_deg = depth_deg;
        config.source.power_uw = power_uw;
        config.controller.loop_latency_periods = 0;
        for phase in [
            -2.5, -0.7, -0.04, -0.031, -1e-3, 0.0, 1e-6, 0.02, 0.032, 0.9, 3.0,
        ] {
            // Unit gain and a ramp at rest: the register becomes the demodulated error.
            let mut model = model(&config);
            model.set_loop_gain(1.0);
            let error: f64 = model.run_period([phase, phase]);
            assert_close(error, phase.sin(), 0.0, 1e-12);
        }
    }
    // Beyond 180 deg the slope is negative: the loop would run away, the gyro is refused.
    let mut config = silent_gyro();
    config.modulator.depth_deg = 240.0;
    assert!(matches!(facts(&config), Err(GyroError::NoSlope { .. })));
}

#[test]
fn known_answer_k3_a_constant_rate_is_returned_to_a_billionth() {
    for rate_deg_per_s in [-199.0, -50.0, -1.0, 0.004, 10.0, 120.0, 199.9] {
        for latency in [0, 1, 3] {
            let gain = 0.1;
            let mut model = silent_model(gain, latency);
            let phase = deg_per_s_to_rad_per_s(rate_deg_per_s) * reference_coil().scale_factor_s;
            // 50 / g periods to settle; a start near pi takes as long again to leave it.
            for _ in 0..1000 {
                model.run_period([phase, phase]);
            }
            let mean = (0..100)
                .map(|_| model.run_period([phase, phase]))
                .sum::<f64>()
                / 100.0;
            assert_close(mean, phase, 1e-9, 0.0);
        }
    }
    // Beyond the first fringe the loop locks a turn away: the check can fail.
    let phase = 3.3;
    let mut model = silent_model(0.1, 1);
    for _ in 0..5000 {
        model.run_period([phase, phase]);
    }
    assert_close(model.register_rad(), phase - TAU, 1e-9, 0.0);
    assert!(model.unlocked_half_periods() > 0);
}

fn reference_coil() -> Coil {
    let config = reference_gyro();
    Coil::new(&config.coil, &config.source)
}

#[test]
fn known_answer_k4_resets_count_the_angle() {
    let coil = reference_coil();
    for (rate_deg_per_s, dac_bits) in [(50.0, 0), (-50.0, 16), (199.0, 12), (-1.0, 16)] {
        let mut config = silent_gyro();
        config.modulator.dac_bits = dac_bits;
        let mut model = model(&config);
        let rate = deg_per_s_to_rad_per_s(rate_deg_per_s);
        let phase = coil.scale_factor_s * rate;
        for _ in 0..5000 {
            model.run_period([phase, phase]);
        }
        let before = model.reset_count();
        let periods = 20_000_u32;
        for _ in 0..periods {
            model.run_period([phase, phase]);
        }
        let angle = rate.abs() * f64::from(periods) * coil.loop_period_s();
        let resets = (model.reset_count() - before) as f64;
        assert_close(resets, angle / coil.angle_per_reset_rad(), 0.0, 1.0);
    }
}

/// Amplitude ratio and phase of the register against a small sine of the Sagnac phase.
///
/// The register is stamped at the end of its period, the input at the start of each half.
fn measured_response(model: &mut LoopModel, periods_per_cycle: u32) -> (f64, f64) {
    const AMPLITUDE_RAD: f64 = 1e-3;
    let step = TAU / f64::from(periods_per_cycle);
    let sine = |period: f64| AMPLITUDE_RAD * (step * period).sin();
    let (mut in_phase, mut quadrature) = (0.0, 0.0);
    let settle = 40 * periods_per_cycle.max(500);
    let settle = settle - settle % periods_per_cycle;
    let cycles = 4 * periods_per_cycle;
    for period in 0..settle + cycles {
        let start = f64::from(period % periods_per_cycle);
        let register = model.run_period([sine(start), sine(start + 0.5)]);
        if period >= settle {
            let stamp = step * (start + 1.0);
            in_phase += register * stamp.sin();
            quadrature += register * stamp.cos();
        }
    }
    let scale = 2.0 / (f64::from(cycles) * AMPLITUDE_RAD);
    (
        scale * in_phase.hypot(quadrature),
        quadrature.atan2(in_phase),
    )
}

#[test]
fn known_answer_k5_the_loop_has_the_transfer_function_of_its_difference_equation() {
    let loop_period_s = reference_coil().loop_period_s();
    for (gain, latency) in [(0.05, 0), (0.05, 2), (0.3, 0), (0.3, 2)] {
        for frequency_hz in [10.0, 500.0, 2000.0] {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "64 to 12766"
            )]
            let periods_per_cycle = (1.0 / (frequency_hz * loop_period_s)).round() as u32;
            let frequency_hz = 1.0 / (f64::from(periods_per_cycle) * loop_period_s);
            let mut model = silent_model(gain, latency);
            let (ratio, phase) = measured_response(&mut model, periods_per_cycle);
            let controller = *model.controller();
            let (re, im) = controller.response(frequency_hz);
            // The pair averages the input over its two instants, half a period apart: a cosine
            // and a quarter period of lead.
            let quarter = 0.25 * TAU * frequency_hz * loop_period_s;
            assert_close(ratio, re.hypot(im) * quarter.cos(), 2e-4, 0.0);
            let delay_error_s = (phase - im.atan2(re) - quarter) / (TAU * frequency_hz);
            assert_close(delay_error_s, 0.0, 0.0, 1e-7);
            if frequency_hz < 11.0 {
                let delay_s = -phase / (TAU * frequency_hz);
                assert_close(delay_s, controller.delay_s(), 0.0, 1e-7);
            }
        }
    }
}

#[test]
fn the_loop_gain_gives_the_asked_bandwidth_exactly() {
    let loop_period_s = reference_coil().loop_period_s();
    for latency in 0..=3 {
        for bandwidth_hz in [1.0, 500.0, 2000.0, 4000.0] {
            let controller = Controller::new(bandwidth_hz, latency, loop_period_s).unwrap();
            let (re, im) = controller.response(bandwidth_hz);
            assert_close(re * re + im * im, 0.5, 1e-9, 0.0);
            let (re, im) = controller.response(0.5 * bandwidth_hz);
            assert!(re * re + im * im > 0.5);
        }
    }
    // The gain grows with the bandwidth up to the last stable one: the crossing is the first.
    for latency in 0..=3 {
        let gains = (1..600).map_while(|step| {
            let bandwidth_hz = 100.0 * f64::from(step);
            let controller = Controller::new(bandwidth_hz, latency, loop_period_s);
            controller.ok().map(|controller| controller.gain)
        });
        assert!(gains.is_sorted_by(|lower, upper| lower < upper));
    }
    // Gains and -3 dB frequencies without latency, to the digits of the table they come from.
    for (gain, bandwidth_hz) in [(0.05, 1042.4), (0.1, 2142.7), (0.5, 14685.0)] {
        let controller = Controller::new(bandwidth_hz, 0, loop_period_s).unwrap();
        assert_close(controller.gain, gain, 1e-4, 0.0);
    }
}

#[test]
fn a_bandwidth_that_the_latency_does_not_allow_is_refused() {
    let loop_period_s = reference_coil().loop_period_s();
    let error =
        |bandwidth_hz, latency| Controller::new(bandwidth_hz, latency, loop_period_s).unwrap_err();
    assert!(matches!(
        error(70_000.0, 0),
        GyroError::BandwidthAboveNyquist { .. }
    ));
    assert!(matches!(error(50_000.0, 1), GyroError::UnstableLoop { .. }));
    assert!(matches!(
        error(2000.0, 4),
        GyroError::LatencyOutOfRange { .. }
    ));
    let text = error(50_000.0, 1).to_string();
    assert!(text.contains("stable only below 1.0000"), "{text}");
}

#[test]
fn known_answer_k6_the_loop_oscillates_above_its_gain_limit_only() {
    for (latency, limit) in [(0, 2.0), (1, 1.0), (2, 0.618_034), (3, 0.445_042)] {
        assert_close(gain_limit(latency), limit, 1e-6, 0.0);
        let swing_after = |factor: f64| {
            let mut model = silent_model(factor * gain_limit(latency), latency);
            model.run_period([1e-3, 1e-3]);
            for _ in 0..5000 {
                model.run_period([0.0, 0.0]);
            }
            (0..50).fold(0.0_f64, |swing, _| {
                swing.max(model.run_period([0.0, 0.0]).abs())
            })
        };
        assert!(swing_after(0.98) < 1e-9, "latency {latency}");
        // The sine of the fringe bounds the oscillation.
        let swing = swing_after(1.02);
        assert!((0.05..6.3).contains(&swing), "latency {latency}: {swing}");
    }
}

#[test]
fn known_answer_k7_a_small_step_is_answered_geometrically() {
    let gain: f64 = 0.05;
    let mut model = silent_model(gain, 0);
    let step_rad = 1e-4;
    for period in 1..200 {
        let register = model.run_period([step_rad, step_rad]);
        // The sine of the fringe is short by step^2 / 6 = 2e-9 of the error.
        assert_close(
            register,
            step_rad * (1.0 - (1.0 - gain).powi(period)),
            0.0,
            1e-6 * step_rad,
        );
    }
}

/// Sine rate of 1 deg/s as segments, and the delay of the words behind it, s, by projection.
fn swing_delay_s(
    frequency_hz: f64,
    sample_period_s: f64,
    mut word: impl FnMut(&MotionSegment) -> f64,
) -> f64 {
    let amplitude = deg_per_s_to_rad_per_s(1.0);
    let omega = TAU * frequency_hz;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few thousand"
    )]
    let per_cycle = (1.0 / (frequency_hz * sample_period_s)).round() as u32;
    let (mut in_phase, mut quadrature) = (0.0, 0.0);
    // Normal equations of the sine and cosine, as the cycle is not a whole number of samples.
    let (mut ss, mut sc, mut cc) = (0.0, 0.0, 0.0);
    for sample in 0..4 * per_cycle {
        let (start, end) = (
            f64::from(sample) * sample_period_s,
            f64::from(sample + 1) * sample_period_s,
        );
        let rate = |time: f64| amplitude * (omega * time).sin();
        let slope = |time: f64| amplitude * omega * sample_period_s * (omega * time).cos();
        let segment = MotionSegment::hermite(rate(start), slope(start), rate(end), slope(end));
        let word = word(&segment);
        if sample >= per_cycle {
            let (sine, cosine) = (omega * end).sin_cos();
            in_phase += word * sine;
            quadrature += word * cosine;
            ss += sine * sine;
            sc += sine * cosine;
            cc += cosine * cosine;
        }
    }
    let sine = (in_phase * cc - quadrature * sc) / (ss * cc - sc * sc);
    let cosine = (quadrature * ss - in_phase * sc) / (ss * cc - sc * sc);
    -cosine.atan2(sine) / omega
}

#[test]
fn known_answer_k30_words_of_a_swing_lag_by_the_delay_of_loop_and_average() {
    for (bandwidth_hz, delay_us) in [(500.0, 442.0), (1000.0, 283.0), (2000.0, 203.0)] {
        let mut config = silent_gyro();
        config.controller.loop_bandwidth_hz = bandwidth_hz;
        config.controller.loop_latency_periods = 0;
        let facts_delay_s = facts(&config).unwrap().delay_ms * 1e-3;
        assert_close(facts_delay_s, delay_us * 1e-6, 0.0, 1e-6);
    }
    for latency in [0, 1] {
        let mut config = silent_gyro();
        config.controller.loop_latency_periods = latency;
        let streams = Streams::new(1, 0);
        let delay_s = facts(&config).unwrap().delay_ms * 1e-3;
        let mut loop_model = model(&config);
        let mut rate_model = RateModel::new(&config, 1.0, &streams).unwrap();
        let period_s = loop_model.sample_period_s();
        let measured = swing_delay_s(5.0, period_s, |segment| loop_model.next_word(segment));
        assert_close(measured, delay_s, 0.0, 1e-7);
        let measured = swing_delay_s(5.0, period_s, |segment| rate_model.next_word(segment));
        assert_close(measured, delay_s, 0.0, 1e-7);
        // The average of 32 registers alone: 121.4 us more than a single register.
        config.output.half_periods_per_sample = 2;
        let mut single = model(&config);
        let register_s = swing_delay_s(5.0, single.sample_period_s(), |segment| {
            single.next_word(segment)
        });
        assert_close(measured - register_s, 121.4e-6, 0.0, 1e-7);
    }
}

#[test]
fn without_noise_both_models_answer_a_changing_rate_alike() {
    for latency in 0..=3 {
        let mut config = silent_gyro();
        config.controller.loop_latency_periods = latency;
        let mut loop_model = model(&config);
        let mut rate_model = RateModel::new(&config, 1.0, &Streams::new(1, 0)).unwrap();
        // Steps and slopes of 1 deg/h: what the fringe is not straight, (x0^2 - x1^2) cot(phi_m)
        // / 4 within a pair, is 1e-9 deg/h there.
        let unit = deg_per_h_to_rad_per_s(1.0);
        for sample in 0..60 {
            let step = if sample < 20 { 0.0 } else { unit };
            let segment = MotionSegment {
                rate_rad_per_s: [step, 0.5 * unit, -unit, 0.25 * unit],
            };
            let (got, want) = (
                rate_model.next_word(&segment),
                loop_model.next_word(&segment),
            );
            assert_close(got, want, 0.0, 1e-8);
        }
    }
}

#[test]
fn the_loop_model_agrees_with_the_plain_loop_word_by_word() {
    for (latency, dac_bits) in [(0, 16), (1, 16), (1, 12), (3, 8)] {
        let mut config = reference_gyro();
        config.controller.loop_latency_periods = latency;
        config.modulator.dac_bits = dac_bits;
        let streams = Streams::new(5, 0);
        let mut model = LoopModel::new(&config, 1.0, &streams).unwrap();
        let mut plain = PlainLoop::new(&config, model.controller().gain, &streams);
        for sample in 0..2000_u32 {
            // Up to 20 deg/s and through zero, with a jump that leaves the small-phase range.
            let start = deg_per_s_to_rad_per_s(20.0 - 0.02 * f64::from(sample));
            let segment = MotionSegment::hermite(start, 1e-4, start - 1e-4, -2e-4);
            let got = model.next_word(&segment);
            let want = rad_per_s_to_deg_per_h(plain.next_word_rad_per_s(&segment.rate_rad_per_s));
            assert_close(got, want, 1e-9, 1e-6);
        }
        assert!(model.reset_count() > 100);
    }
}

#[test]
fn rate_words_are_whole_least_significant_bits() {
    let mut config = reference_gyro();
    config.output.rate_lsb_deg_per_s = 1e-4;
    let mut rounded = model(&config);
    config.output.rate_lsb_deg_per_s = 0.0;
    let mut free = model(&config);
    let segment = MotionSegment::constant(deg_per_s_to_rad_per_s(1.0));
    for _ in 0..100 {
        let word = rounded.next_word(&segment);
        assert_close((word / 0.36).round() * 0.36, word, 1e-12, 0.0);
        assert_close(word, free.next_word(&segment), 0.0, 0.18 + 1e-9);
    }
}

#[test]
fn a_saturated_converter_is_counted_and_a_bias_point_beyond_it_refused() {
    let mut config = reference_gyro();
    // Fringe maximum 0.3053 V, bias point 0.0822 V.
    config.adc.range_v = 0.0825;
    let mut model = model(&config);
    let segment = MotionSegment::constant(0.0);
    for _ in 0..10 {
        model.next_word(&segment);
    }
    assert!(model.saturated_half_periods() > 0);
    config.adc.range_v = 0.08;
    assert!(matches!(
        facts(&config),
        Err(GyroError::ConverterRange { .. })
    ));
    config.output.half_periods_per_sample = 3;
    assert!(RateModel::new(&config, 1.0, &Streams::new(1, 0)).is_err());
}

#[test]
fn a_full_scale_fringe_is_exact_near_and_far() {
    // Phase errors on both sides of the switch from polynomial to library cosine.
    let mut config = silent_gyro();
    config.controller.loop_latency_periods = 0;
    for phase in [0.031_249, 0.031_251, FRAC_PI_2] {
        let mut model = model(&config);
        model.set_loop_gain(1.0);
        assert_close(
            model.run_period([phase, phase]),
            f64::sin(phase),
            0.0,
            1e-15,
        );
    }
}
