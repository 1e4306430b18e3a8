//! Known answers of the second-order effects of modulator, ramp and register.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use fogbench::gyro::{
    Coil, LoopModel, MotionExtremes, RateModel, cautions, expected_mean_rate_rad_per_s, facts,
    sample_period_s, spike_share,
};
use fogbench::random::Streams;
use fogbench::scenario::{Fidelity, GyroConfig, ModulationScheme, NoiseDraw, ResetSample};
use fogbench::signal::MotionSegment;
use fogbench::units::{deg_per_h_to_rad_per_s, deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};

use crate::support::assert_close;
use crate::support::gyro_cases::{allan_deviation, budget_of, silent_gyro};
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::Transcript;

fn loop_model(config: &GyroConfig) -> LoopModel {
    LoopModel::new(config, 10.0, &Streams::new(1, 0)).expect("the gyro is sound")
}

fn rate_model(config: &GyroConfig) -> RateModel {
    RateModel::new(config, 10.0, &Streams::new(1, 0)).expect("the gyro is sound")
}

fn scale_factor_s() -> f64 {
    let config = reference_gyro();
    Coil::new(&config.coil, &config.source).scale_factor_s
}

/// A silent gyro without latency at a bias depth of a quarter turn.
fn quadrature_gyro() -> GyroConfig {
    let mut config = silent_gyro();
    config.modulator.depth_deg = 90.0;
    config.controller.loop_latency_periods = 0;
    config
}

/// Mean register of the loop model over whole loop periods at a constant phase, rad.
fn mean_register(model: &mut LoopModel, phase_rad: f64, settle: u32, periods: u32) -> f64 {
    for _ in 0..settle {
        model.run_period([phase_rad; 2]);
    }
    let sum: f64 = (0..periods).map(|_| model.run_period([phase_rad; 2])).sum();
    sum / f64::from(periods)
}

/// Mean of words of a constant rate, rad/s, after `settle` words.
fn mean_word(
    mut next: impl FnMut(&MotionSegment) -> f64,
    rate: f64,
    settle: u32,
    words: u32,
) -> f64 {
    let segment = MotionSegment::constant(rate);
    for _ in 0..settle {
        next(&segment);
    }
    let sum: f64 = (0..words).map(|_| next(&segment)).sum();
    deg_per_h_to_rad_per_s(sum / f64::from(words))
}

#[test]
fn the_full_kernel_gives_the_words_of_the_plain_one_to_the_bit() {
    for (draw, latency, dac_bits, rate_deg_per_s) in [
        (NoiseDraw::Combined, 1, 16, 10.0),
        (NoiseDraw::Combined, 0, 0, -150.0),
        (NoiseDraw::Exact, 3, 12, 0.01),
        (NoiseDraw::Combined, 2, 16, 60.0),
    ] {
        let mut config = reference_gyro();
        config.noise.draw = draw;
        config.controller.loop_latency_periods = latency;
        config.modulator.dac_bits = dac_bits;
        let (mut plain, mut full) = (loop_model(&config), loop_model(&config));
        let rate = deg_per_s_to_rad_per_s(rate_deg_per_s);
        let segment = MotionSegment {
            rate_rad_per_s: [rate, 1e-4, -1e-4, 1e-5],
        };
        for word in 0..200 {
            if word == 20 {
                full.use_full_kernel();
            }
            let (left, right) = (plain.next_word(&segment), full.next_word(&segment));
            assert_eq!(left.to_bits(), right.to_bits(), "word {word}");
        }
        assert_eq!(plain.reset_count(), full.reset_count());
    }
}

#[test]
fn known_answer_k8_a_modulator_gain_error_with_resets() {
    let mut config = quadrature_gyro();
    config.modulator.gain_error_ppm = 10_000.0;
    let phase = deg_per_s_to_rad_per_s(10.0) * scale_factor_s();
    let mut model = loop_model(&config);
    model.set_loop_gain(0.02);
    let mean = mean_register(&mut model, phase, 5000, 400_000);
    assert_close((mean / phase - 1.0) * 1e6, -6.6, 0.0, 1.5);

    config.modulator.reset_sample = ResetSample::Blanked;
    for sign in [1.0, -1.0] {
        let mut model = loop_model(&config);
        model.set_loop_gain(0.02);
        let mean = mean_register(&mut model, sign * phase, 5000, 10_000);
        assert_close((mean / (sign * phase) - 1.0) * 1e6, -9900.99, 0.0, 0.1);
    }
    let rate = deg_per_s_to_rad_per_s(10.0);
    let expected = expected_mean_rate_rad_per_s(&config, rate);
    assert_close((expected / rate - 1.0) * 1e6, -9_900.990_1, 0.0, 1e-3);
}

#[test]
fn known_answer_k8_a_reset_makes_the_register_jump_by_gain_times_half_the_error() {
    let mut config = quadrature_gyro();
    config.modulator.gain_error_ppm = 10_000.0;
    for sign in [1.0, -1.0] {
        let phase = sign * 0.002;
        let mut model = loop_model(&config);
        model.set_loop_gain(0.02);
        // A turn of the ramp takes 3110 half periods; a settled loop waits for its reset.
        let mut before = 0.0;
        for _ in 0..4000 {
            let resets = model.reset_count();
            before = model.register_rad();
            model.run_period([phase; 2]);
            if model.reset_count() > resets && resets > 0 {
                break;
            }
        }
        let jump = model.register_rad() - before;
        assert_close(jump, sign * 0.02 * PI * 0.01, 0.01, 0.0);
    }
}

#[test]
fn known_answer_k9_the_second_loop_takes_its_share_at_every_reset() {
    for reset_sample in [ResetSample::Demodulated, ResetSample::Blanked] {
        for (sign, gain_error_ppm) in [(1.0, 10_000.0), (-1.0, 10_000.0), (1.0, -10_000.0)] {
            let mut config = quadrature_gyro();
            config.modulator.gain_error_ppm = gain_error_ppm;
            config.modulator.reset_sample = reset_sample;
            config.controller.second_loop_gain = 0.05;
            let mut model = loop_model(&config);
            model.set_loop_gain(0.3);
            let phase = sign * deg_per_s_to_rad_per_s(10.0) * scale_factor_s();
            mean_register(&mut model, phase, 100, 1);
            let (start, resets) = (model.modulator_gain_error(), model.reset_count());
            mean_register(&mut model, phase, 600, 1);
            let count = (model.reset_count() - resets) as f64;
            assert!(count > 20.0);
            let left = model.modulator_gain_error() / start;
            assert_close(left, 0.95_f64.powf(count), 0.02, 0.0);

            let mut at_rest = loop_model(&config);
            mean_register(&mut at_rest, 0.0, 10_000, 1);
            let held = at_rest.modulator_gain_error();
            assert_close(held, gain_error_ppm * 1e-6, 1e-12, 0.0);
        }
    }
}

fn four_state(scheme: ModulationScheme, depth_deg: f64) -> GyroConfig {
    let mut config = silent_gyro();
    config.modulator.scheme = scheme;
    config.modulator.depth_deg = depth_deg;
    config.controller.loop_latency_periods = 0;
    config
}

const FOUR_STATE: [ModulationScheme; 2] =
    [ModulationScheme::FourState, ModulationScheme::FourStateHalf];

#[test]
fn known_answer_k10_four_states_tell_phase_error_and_gain_error_apart() {
    for scheme in FOUR_STATE {
        for depth_deg in [90.0, 120.0, 150.0] {
            for error in [1e-3, -1e-3] {
                let mut config = four_state(scheme, depth_deg);
                config.controller.second_loop_gain = 1.0;
                let mut model = loop_model(&config);
                model.set_loop_gain(1.0);
                assert_close(model.run_period([error; 4]), error, 0.0, 1e-6);
                assert_close(model.modulator_gain_error(), 0.0, 0.0, 1e-6);

                config.modulator.gain_error_ppm = error * 1e6;
                let mut model = loop_model(&config);
                model.set_loop_gain(1.0);
                assert_close(model.run_period([0.0; 4]), 0.0, 0.0, 1e-6);
                // (1 + e)(1 - e_hat) - 1 with e_hat = e + e^2 a cot a to second order.
                let a = PI - depth_deg.to_radians();
                let left = -error * error * (1.0 + a / a.tan());
                assert_close(model.modulator_gain_error(), left, 0.0, 2e-8);
            }
        }
    }
}

#[test]
fn known_answer_k10_the_second_loop_of_four_states_works_at_rest() {
    for scheme in FOUR_STATE {
        let mut config = four_state(scheme, 120.0);
        config.controller.second_loop_gain = 0.01;
        config.modulator.gain_error_ppm = 500.0;
        let mut model = loop_model(&config);
        for _ in 0..300 {
            model.run_period([0.0; 4]);
        }
        assert_close(
            model.modulator_gain_error(),
            5e-4 * 0.99_f64.powi(300),
            0.01,
            0.0,
        );
    }
}

#[test]
fn four_states_have_the_controller_delay_and_return_constant_rates() {
    for (scheme, half_periods) in [(FOUR_STATE[0], 4.0), (FOUR_STATE[1], 2.0)] {
        let config = four_state(scheme, 120.0);
        let mut model = loop_model(&config);
        let controller = *model.controller();
        let coil = Coil::new(&config.coil, &config.source);
        let period_s = half_periods * coil.transit_time_s;
        assert_close(controller.loop_period_s, period_s, 1e-12, 0.0);
        // A ramp of the phase: the register, stamped at its update, lags by the delay.
        let slope = 1e-6;
        let mut period = 0.0;
        for _ in 0..2000 {
            let phases = [0.0, 0.25, 0.5, 0.75].map(|state| slope * (period + state));
            model.run_period(phases);
            period += 1.0;
        }
        let lag_s = (period - model.register_rad() / slope) * period_s;
        assert_close(lag_s, controller.delay_s(), 1e-5, 0.0);

        for phase in [-2.5, 0.01, 1.7] {
            let mut model = loop_model(&config);
            for _ in 0..2000 {
                model.run_period([phase; 4]);
            }
            assert_close(model.register_rad(), phase, 1e-9, 0.0);
        }
    }
}

#[test]
fn four_states_have_the_budget_of_two() {
    const WORDS: usize = 20_000;
    const FACTOR: usize = 32;
    for scheme in FOUR_STATE {
        let mut config = reference_gyro();
        config.modulator.scheme = scheme;
        let mut model = loop_model(&config);
        let segment = MotionSegment::constant(1e-3);
        let words: Vec<f64> = (0..WORDS).map(|_| model.next_word(&segment)).collect();
        let tau_h = FACTOR as f64 * model.sample_period_s() / 3600.0;
        let walk = allan_deviation(&words, FACTOR) * tau_h.sqrt();
        let budget = budget_of(&config, "total");
        assert_close(budget, budget_of(&reference_gyro(), "total"), 1e-12, 0.0);
        // About 3 n / 4 m degrees of freedom: three standard errors of the deviation.
        let freedom = 0.75 * WORDS as f64 / FACTOR as f64;
        assert_close(walk, budget, 3.0 / (2.0 * freedom).sqrt(), 0.0);
    }
}

#[test]
fn a_word_of_four_states_is_whole_loop_periods() {
    let mut config = four_state(ModulationScheme::FourState, 120.0);
    config.output.half_periods_per_sample = 62;
    let mut transcript = Transcript::of("gyro", "A word of 62 half periods of four states");
    let error = facts(&config).unwrap_err();
    transcript.case("half_periods_per_sample = 62", error);
    transcript.check();
    config.modulator.scheme = ModulationScheme::FourStateHalf;
    assert!(facts(&config).is_ok());
}

const COUPLING_RAD: f64 = 1e-3;

fn coupled_gyro() -> GyroConfig {
    let mut config = silent_gyro();
    config.modulator.cross_coupling_urad = COUPLING_RAD * 1e6;
    config.modulator.cross_coupling_phase_deg = 30.0;
    config
}

#[test]
fn known_answer_k11_the_dead_band_is_that_of_adlers_equation() {
    let config = coupled_gyro();
    for input in [0.5_f64, 0.99, -0.9] {
        let mut model = loop_model(&config);
        let mean = mean_register(&mut model, input * COUPLING_RAD, 150_000, 50_000);
        assert_close(mean / COUPLING_RAD, 0.0, 0.0, 1e-4);
    }
    for input in [1.25_f64, -2.0, 5.0] {
        let beat = input.signum() * (input * input - 1.0).sqrt();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a few million periods"
        )]
        let periods = (1000.0 * TAU / (2.0 * beat.abs() * COUPLING_RAD)) as u32;
        let mut model = loop_model(&config);
        let mean = mean_register(&mut model, input * COUPLING_RAD, 5000, periods);
        assert_close(mean / COUPLING_RAD, beat, 0.005, 0.0);
        let rate = input * COUPLING_RAD / scale_factor_s();
        let expected = expected_mean_rate_rad_per_s(&config, rate) * scale_factor_s();
        assert_close(expected / COUPLING_RAD, beat, 1e-12, 0.0);
    }
}

#[test]
fn known_answer_k11_ramp_dither_removes_the_dead_band_and_leaves_a_known_noise() {
    let mut config = coupled_gyro();
    config.modulator.dither_deg = 180.0;
    config.modulator.dither_interval_periods = 8;
    config.output.half_periods_per_sample = 4096;
    let half_periods = 4096.0;
    let words = 1000_u32;
    let rate = 0.5 * COUPLING_RAD / scale_factor_s();
    let mut model = loop_model(&config);
    let segment = MotionSegment::constant(rate);
    model.next_word(&segment);
    let phases: Vec<f64> = (0..words)
        .map(|_| deg_per_h_to_rad_per_s(model.next_word(&segment)) * scale_factor_s())
        .collect();
    let count = f64::from(words);
    let mean = phases.iter().sum::<f64>() / count;
    let variance = phases
        .iter()
        .map(|phase| (phase - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0);
    let correlation = (-0.5 * PI * PI).exp();
    let predicted = 0.5 * COUPLING_RAD.powi(2) * (16.0 / half_periods) * (1.0 + correlation)
        / (1.0 - correlation);
    assert_close(variance, predicted, 5.0 * (2.0 / count).sqrt(), 0.0);
    assert_close(
        mean,
        0.5 * COUPLING_RAD,
        0.0,
        5.0 * (predicted / count).sqrt(),
    );

    let mut rate_twin = rate_model(&config);
    let words: Vec<f64> = (0..1000)
        .map(|_| deg_per_h_to_rad_per_s(rate_twin.next_word(&segment)) * scale_factor_s())
        .collect();
    let mean = words.iter().sum::<f64>() / count;
    let variance = words.iter().map(|word| (word - mean).powi(2)).sum::<f64>() / (count - 1.0);
    assert_close(variance, predicted, 5.0 * (2.0 / count).sqrt(), 0.0);
}

/// A silent gyro whose averager takes in the spikes of a mismatched half period.
fn mismatched_gyro(mismatch: f64) -> GyroConfig {
    let mut config = silent_gyro();
    config.controller.loop_latency_periods = 0;
    config.modulator.half_period_mismatch = mismatch;
    config.detector.gate_spikes = false;
    config.detector.gate_duty = 1.0;
    config
}

#[test]
fn averaged_spikes_weaken_the_gain_and_gated_ones_do_not() {
    for mismatch in [0.01_f64, -0.01, 0.001] {
        let mut config = mismatched_gyro(mismatch);
        let mut model = loop_model(&config);
        model.set_loop_gain(1.0);
        let gain = model.run_period([1e-4; 2]) / 1e-4_f64.sin();
        let plateau = if mismatch > 0.0 {
            1.0 / (1.0 + mismatch)
        } else {
            (1.0 + 2.0 * mismatch) / (1.0 + mismatch)
        };
        assert_close(gain, plateau, 1e-9, 0.0);
        assert_close(1.0 - spike_share(mismatch), plateau, 1e-12, 0.0);
        config.detector.gate_spikes = true;
        let mut gated = loop_model(&config);
        gated.set_loop_gain(1.0);
        assert_close(gated.run_period([1e-4; 2]), 1e-4_f64.sin(), 1e-12, 0.0);
    }
}

#[test]
fn intensity_modulation_of_averaged_spikes_is_a_bias() {
    for mismatch in [1e-3_f64, -1e-3] {
        for intensity in [1e-3, -2e-3] {
            for phase in [0.0_f64, 0.4] {
                let mut config = mismatched_gyro(mismatch);
                config.modulator.intensity_modulation = intensity;
                let visibility = config.source.visibility;
                let share = spike_share(mismatch);
                let bias = -intensity * share / (1.0 - share) * (1.0 + visibility * phase.cos())
                    / (visibility * (TAU / 3.0).sin());
                let mut model = loop_model(&config);
                let register = mean_register(&mut model, phase, 2000, 1);
                // The spike itself sees the register, bias included, when the half period is short.
                assert_close(register - phase, bias, 1e-5, 1e-12);
                let rate = phase / scale_factor_s();
                let expected = expected_mean_rate_rad_per_s(&config, rate) * scale_factor_s();
                assert_close(expected - phase, bias, 1e-9, 1e-15);
                let mut twin = rate_model(&config);
                let word = mean_word(|segment| twin.next_word(segment), rate, 20, 5);
                assert_close(word * scale_factor_s() - phase, bias, 1e-9, 1e-12);
                config.detector.gate_spikes = true;
                let mut gated = loop_model(&config);
                assert_close(
                    mean_register(&mut gated, phase, 2000, 1),
                    phase,
                    1e-9,
                    1e-12,
                );
            }
        }
    }
    // Unit visibility and a small mismatch: 2 m delta / sin phi_m, 0.53 deg/h for 1e-3 each.
    let mut config = mismatched_gyro(1e-3);
    config.source.visibility = 1.0;
    config.modulator.intensity_modulation = 1e-3;
    let bias = rad_per_s_to_deg_per_h(expected_mean_rate_rad_per_s(&config, 0.0));
    assert_close(bias, -0.53, 0.01, 0.0);
}

#[test]
fn the_clock_of_a_mismatched_gyro_is_its_half_period() {
    let nominal = reference_gyro();
    let mut config = reference_gyro();
    config.modulator.half_period_mismatch = 5e-3;
    let ratio = sample_period_s(&config) / sample_period_s(&nominal);
    assert_close(ratio, 1.005, 1e-12, 0.0);
    assert_close(
        loop_model(&config).sample_period_s(),
        sample_period_s(&config),
        1e-12,
        0.0,
    );
    assert_close(
        rate_model(&config).sample_period_s(),
        sample_period_s(&config),
        1e-12,
        0.0,
    );
    let period = loop_model(&config).controller().loop_period_s;
    let coil = Coil::new(&config.coil, &config.source);
    assert_close(period, 1.005 * coil.loop_period_s(), 1e-12, 0.0);
}

#[test]
fn a_step_cut_to_whole_bits_has_a_dead_zone_of_one_bit() {
    let mut config = silent_gyro();
    config.controller.loop_latency_periods = 0;
    config.controller.step_bits = 12;
    let lsb = TAU / 4096.0;
    let gain = 0.05;
    for (input, held) in [(0.2, 1.0), (0.8, 1.0), (10.5, 11.0), (-3.7, -3.0)] {
        let mut model = loop_model(&config);
        model.set_loop_gain(gain);
        let mean = mean_register(&mut model, input * lsb, 5000, 5000);
        // The register hovers about the bit above, within the gain's share of a bit.
        assert_close(mean / lsb, held, 0.0, gain);
    }
}

#[test]
fn under_noise_a_cut_step_is_a_bias_of_half_a_bit_in_both_models() {
    let mut config = reference_gyro();
    // Errors in whole converter levels would leave the register on a few fractions of a bit.
    config.adc.bits = 0;
    config.controller.step_bits = 16;
    let half_bit = 0.5 * TAU / 65_536.0 / scale_factor_s();
    let rate = deg_per_s_to_rad_per_s(0.003);
    let period_s = sample_period_s(&config);
    let walk = budget_of(&config, "total") / 60.0;
    let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
    for mean in [
        mean_word(|segment| model.next_word(segment), rate, 50, 20_000),
        mean_word(|segment| twin.next_word(segment), rate, 50, 20_000),
    ] {
        let sigma = deg_per_s_to_rad_per_s(walk / (20_000.0 * period_s).sqrt());
        assert_close(mean - rate, half_bit, 0.0, 5.0 * sigma);
        assert!(half_bit > 10.0 * sigma);
    }
    config.controller.step_bits = 8;
    let motion = MotionExtremes::default();
    let refusal = cautions(&config, Fidelity::Rate, &motion).unwrap_err();
    assert_eq!(refusal.key(), "gyro.controller.step_bits");
    assert!(cautions(&config, Fidelity::Loop, &motion).is_ok());
}

#[test]
fn known_answer_k12_rounding_the_ramp_leaves_no_mean_error() {
    let mut config = silent_gyro();
    config.modulator.dac_bits = 12;
    let lsb = TAU / 4096.0;
    for half_periods in [20_000_u32, 200_000] {
        for phase in [1.234e-4, -0.0207] {
            let mut model = loop_model(&config);
            let mean = mean_register(&mut model, phase, 5000, half_periods / 2);
            assert_close(mean, phase, 0.0, 4.0 * lsb / f64::from(half_periods));
        }
    }
}

#[test]
fn a_step_limit_holds_the_register_and_is_counted() {
    let mut config = silent_gyro();
    config.controller.step_limit_deg = 90.0;
    let mut model = loop_model(&config);
    let held = mean_register(&mut model, 2.0, 2000, 10);
    assert_close(held, FRAC_PI_2, 1e-12, 0.0);
    let faults = model.loop_faults();
    assert!(faults.saturated_steps > 1000);
    let mut transcript = Transcript::of("gyro", "A register at its limit");
    transcript.case("step_limit_deg = 90.0, 2 rad", faults.notes().join("\n"));
    transcript.check();
    let motion = MotionExtremes {
        rate_rad_per_s: 2.0 / scale_factor_s(),
        ..MotionExtremes::default()
    };
    let refusal = cautions(&config, Fidelity::Rate, &motion).unwrap_err();
    assert_eq!(refusal.key(), "gyro.controller.step_limit_deg");
}

#[test]
fn a_wrong_fringe_is_reported_as_a_multiple_of_two_pi() {
    let config = silent_gyro();
    let two_fringes = TAU / scale_factor_s();
    let mut transcript = Transcript::of("gyro", "Words of a wrong fringe");
    for (rate_deg_per_s, turns) in [(250.0, -1.0), (-250.0, 1.0), (650.0, -2.0)] {
        let mut model = loop_model(&config);
        let rate = deg_per_s_to_rad_per_s(rate_deg_per_s);
        let mean = mean_word(|segment| model.next_word(segment), rate, 50, 5);
        assert_close(mean - rate, turns * two_fringes, 1e-9, 0.0);
        let faults = model.loop_faults();
        assert!(faults.wrong_fringe_words > 5);
        assert_close(
            deg_per_s_to_rad_per_s(faults.fringe_error_deg_per_s),
            turns * two_fringes,
            1e-12,
            0.0,
        );
        let given = format!("a turn at {rate_deg_per_s} deg/s");
        transcript.case(given, faults.notes().join("\n"));
    }
    transcript.check();
    let mut model = loop_model(&config);
    mean_word(|segment| model.next_word(segment), 3.0, 50, 5);
    assert_eq!(model.loop_faults().wrong_fringe_words, 0);
}

#[test]
fn the_rate_model_follows_a_gain_error_and_its_correction() {
    let rate = deg_per_s_to_rad_per_s(10.0);
    let mut config = quadrature_gyro();
    config.modulator.gain_error_ppm = 10_000.0;
    config.modulator.reset_sample = ResetSample::Blanked;
    let mut twin = rate_model(&config);
    let word = mean_word(|segment| twin.next_word(segment), rate, 20, 10);
    assert_close((word / rate - 1.0) * 1e6, -9900.99, 0.0, 0.1);

    config.controller.second_loop_gain = 0.02;
    let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
    for words in [5, 20, 40] {
        let left = mean_word(|segment| model.next_word(segment), rate, words, 1);
        let right = mean_word(|segment| twin.next_word(segment), rate, words, 1);
        // Resets are whole: one more or less is 2 % of what is left of the error.
        let tolerance = 0.03 * model.modulator_gain_error();
        assert_close(left / rate, right / rate, 0.0, tolerance);
        let (error, twin_error) = (model.modulator_gain_error(), twin.modulator_gain_error());
        assert_close(twin_error, error, 0.05, 0.0);
    }
}

#[test]
fn a_drift_of_the_gain_comes_on_top_of_the_configured_error() {
    let mut config = quadrature_gyro();
    config.modulator.reset_sample = ResetSample::Blanked;
    config.modulator.gain_error_ppm = 1000.0;
    let rate = deg_per_s_to_rad_per_s(10.0);
    let want = 1.0 / (1.001 * 1.002);
    let mut model = loop_model(&config);
    model.set_modulator_gain_error(2e-3);
    let word = mean_word(|segment| model.next_word(segment), rate, 100, 10);
    assert_close(word / rate, want, 1e-9, 0.0);
    let mut twin = rate_model(&config);
    twin.set_modulator_gain_error(2e-3);
    let word = mean_word(|segment| twin.next_word(segment), rate, 100, 10);
    assert_close(word / rate, want, 1e-9, 0.0);
}

#[test]
fn known_answer_k11_the_rate_model_has_the_same_dead_band() {
    let config = coupled_gyro();
    for input in [0.5_f64, 1.25, -2.0] {
        let rate = input * COUPLING_RAD / scale_factor_s();
        let want = expected_mean_rate_rad_per_s(&config, rate);
        let mut twin = rate_model(&config);
        let word = mean_word(|segment| twin.next_word(segment), rate, 5000, 60_000);
        let allowed = 0.005 * COUPLING_RAD / scale_factor_s();
        assert_close(word, want, 0.0, allowed);
    }
}
