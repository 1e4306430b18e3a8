//! Known answers of the temperature: network, winding, and what they do to the gyro.

use fogbench::gyro::{
    Chamber, Condition, Gyro, GyroError, Network, NetworkState, Shupe, facts, layer_integral,
    layer_order, temperature_record,
};
use fogbench::random::Streams;
use fogbench::scenario::{
    ConstantPowerConfig, ExponentialPowerConfig, Fidelity, GyroConfig, PowerConfig, SoakConfig,
    TemperatureConfig, TemperatureProfileConfig, TemperatureRampConfig, ThermalWarmUp, Winding,
};
use fogbench::signal::MotionSegment;
use fogbench::units::{deg_per_h_to_rad_per_s, rad_per_s_to_deg_per_h};

use crate::support::gyro_cases::silent_gyro;
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::said_to_each;
use crate::support::{assert_close, code, fogbench, stderr, write};

fn at(mut config: GyroConfig, temperature_c: f64) -> GyroConfig {
    config.temperature = TemperatureConfig::Soak(SoakConfig {
        temperature_c,
        ..SoakConfig::reference()
    });
    config
}

fn ramp(start_c: f64, end_c: f64, rate_c_per_min: f64, start_s: f64) -> TemperatureConfig {
    TemperatureConfig::Ramp(TemperatureRampConfig {
        start_c,
        end_c,
        rate_c_per_min,
        start_s,
        ..TemperatureRampConfig::reference()
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small non-negative count of samples"
)]
fn whole(count: f64) -> usize {
    count as usize
}

/// Temperature rates of a coil whose layers lie on a straight line.
fn line(layers: usize, inner: f64, outer: f64) -> Vec<f64> {
    let last = (layers - 1) as f64;
    (0..layers)
        .map(|layer| inner + (outer - inner) * layer as f64 / last)
        .collect()
}

const WINDINGS: [Winding; 3] = [Winding::Plain, Winding::Dipole, Winding::Quadrupole];

#[test]
fn every_layer_is_wound_once() {
    for winding in WINDINGS {
        let mut order = layer_order(winding, 16);
        order.sort_unstable();
        assert_eq!(order, (0..16).collect::<Vec<_>>(), "{winding:?}");
    }
    assert_eq!(layer_order(Winding::Dipole, 8), [6, 4, 2, 0, 1, 3, 5, 7]);
    assert_eq!(
        layer_order(Winding::Quadrupole, 8),
        [7, 4, 3, 0, 1, 2, 5, 6]
    );
}

#[test]
fn known_answer_k25_windings_have_their_closed_forms() {
    for layers in [4_usize, 16, 24, 40, 64] {
        let m = layers as f64;
        let closed = [
            -(m + 1.0) / (6.0 * m),
            -1.0 / (4.0 * (m - 1.0)),
            1.0 / (2.0 * m * (m - 1.0)),
        ];
        for (winding, want) in WINDINGS.into_iter().zip(closed) {
            let order = layer_order(winding, layers);
            let rise = layer_integral(&order, &line(layers, 0.3, 1.3));
            assert_close(rise, want, 1e-10, 0.0);
            let fall = layer_integral(&order, &line(layers, 1.3, 0.3));
            assert_close(fall, -want, 1e-10, 0.0);
            // Against the sum of the magnitudes, of order one half.
            let uniform = layer_integral(&order, &line(layers, 1.0, 1.0));
            assert!(uniform.abs() < 1e-12, "{winding:?}: {uniform}");
        }
    }
}

#[test]
fn known_answer_k25_halves_at_one_kelvin_a_minute() {
    // Two layers, plain: one half of the fibre against the other, integral L^2 / 4 per unit.
    let mut config = reference_gyro();
    config.thermal.winding = Winding::Plain;
    config.thermal.layers = 2;
    let rate = Shupe::new(&config).gradient_rad_per_k / 60.0;
    assert_close(rad_per_s_to_deg_per_h(rate), -155.80, 1e-4, 0.0);
    config.thermal.winding = Winding::Quadrupole;
    for (layers, want) in [(16, 1.30), (24, 0.564), (32, 0.314), (40, 0.200)] {
        config.thermal.layers = layers;
        let rate = Shupe::new(&config).gradient_rad_per_k / 60.0;
        assert_close(rad_per_s_to_deg_per_h(rate), want, 5e-3, 0.0);
    }
}

#[test]
fn known_answer_k25_a_midpoint_offset_feels_coil_against_leads() {
    let mut config = reference_gyro();
    config.thermal.midpoint_offset_m = 0.1;
    let shupe = Shupe::new(&config);
    let even = NetworkState::uniform(1.0 / 60.0);
    assert!(shupe.bias_rad_per_s(&even).abs() < 1e-18);
    let coil = NetworkState {
        case_c: 0.0,
        ..even
    };
    let bias = rad_per_s_to_deg_per_h(shupe.bias_rad_per_s(&coil));
    assert_close(bias, 0.1558, 1e-3, 0.0);
}

#[test]
fn known_answer_k26_the_case_steps_and_the_coil_lags() {
    let network = Network::new(&reference_gyro().thermal);
    let step = network.propagator(0.25);
    let mut state = NetworkState::uniform(25.0);
    for update in 1..=8000 {
        state = step.advance(&state, 26.0, 26.0);
        let time_s = f64::from(update) * 0.25;
        let decay = |tau_s: f64| (-time_s / tau_s).exp();
        assert_close(state.case_c - 25.0, 1.0 - decay(600.0), 0.0, 1e-11);
        let outer = 1.0 - 2.0 * decay(600.0) + decay(300.0);
        assert_close(state.outer_c - 25.0, outer, 0.0, 1e-11);
        let inner = 1.0 - 2.4 * decay(600.0) + 1.5 * decay(300.0) - 0.1 * decay(100.0);
        assert_close(state.inner_c - 25.0, inner, 0.0, 1e-11);
    }
}

#[test]
fn known_answer_k26_a_steady_ramp_leaves_a_constant_difference() {
    let network = Network::new(&reference_gyro().thermal);
    let step = network.propagator(1.0);
    let mut state = NetworkState::uniform(0.0);
    let slope = 1.0 / 60.0;
    let source = |second: i32| slope * f64::from(second);
    for second in 0..20_000 {
        state = step.advance(&state, source(second), source(second + 1));
    }
    let lag = source(20_000) - state.case_c;
    assert_close(lag, slope * 600.0, 1e-9, 0.0);
    assert_close(state.case_c - state.outer_c, slope * 300.0, 1e-9, 0.0);
    assert_close(state.outer_c - state.inner_c, slope * 100.0, 1e-9, 0.0);
    let rates = network.slopes_c_per_s(&state, source(20_000));
    assert!((rates.outer_c - rates.inner_c).abs() < 1e-9 * slope);
}

#[test]
fn equal_time_constants_are_no_special_case() {
    let network = Network {
        case_s: 100.0,
        outer_s: 100.0,
        inner_s: 100.0,
    };
    let state = network
        .propagator(200.0)
        .advance(&NetworkState::uniform(0.0), 1.0, 1.0);
    // 1 - e^-x (1 + x + x^2 / 2) at x = 2.
    assert_close(state.inner_c, 1.0 - 5.0 * (-2.0_f64).exp(), 1e-13, 0.0);
}

#[test]
fn the_chamber_follows_its_points_and_its_derivative() {
    let mut thermal = reference_gyro().thermal;
    let profile = TemperatureConfig::Profile(TemperatureProfileConfig {
        times_s: vec![0.0, 3900.0, 11_100.0, 17_100.0],
        temperatures_c: vec![25.0, -40.0, -40.0, 60.0],
        ..TemperatureProfileConfig::reference()
    });
    let chamber = Chamber::new(&profile, &thermal);
    for (time_s, want) in [(-1.0, 25.0), (1950.0, -7.5), (5000.0, -40.0), (2e4, 60.0)] {
        assert_close(chamber.temperature_c(time_s), want, 0.0, 1e-12);
    }
    assert_close(chamber.slope_c_per_s(0.0), -1.0 / 60.0, 1e-12, 0.0);
    thermal.ripple_amplitude_c = 0.5;
    let chamber = Chamber::new(&ramp(60.0, 25.0, -1.0, 100.0), &thermal);
    for time_s in [50.0, 333.0, 1999.0, 2500.0] {
        let step_s = 1e-3;
        let rise = chamber.temperature_c(time_s + step_s) - chamber.temperature_c(time_s - step_s);
        assert_close(
            chamber.slope_c_per_s(time_s),
            rise / (2.0 * step_s),
            1e-6,
            1e-9,
        );
    }
}

#[test]
fn the_reference_temperature_is_neutral_to_the_bit() {
    let condition = Condition::at_start(&reference_gyro());
    assert_eq!(condition.case_c.to_bits(), 25.0_f64.to_bits());
    assert_eq!(condition.power_ratio.to_bits(), 1.0_f64.to_bits());
    assert_eq!(condition.scale_ratio.to_bits(), 1.0_f64.to_bits());
    assert_close(condition.bias_rad_per_s, 0.0, 0.0, 0.0);
    assert_close(condition.modulator_gain_error, 0.0, 0.0, 0.0);
    assert!(temperature_record(&reference_gyro(), 0.0, 1.0).is_none());
}

#[test]
fn a_soak_has_the_polynomials_of_the_configuration() {
    let mut config = at(reference_gyro(), 60.0);
    config.thermal.half_wave_voltage_ppm_per_k = 662.0;
    let condition = Condition::at_start(&config);
    let bias = 5e-4 * 35.0 + 3e-6 * 35.0 * 35.0;
    let got = rad_per_s_to_deg_per_h(condition.bias_rad_per_s);
    assert_close(got, bias, 1e-12, 0.0);
    // Silica and spool against the wavelength, which passes one part in a hundred of 35 K.
    let scale = 10.55e-6 * 35.0 - 0.4 / 1310.0 * 0.01 * 35.0;
    assert_close(condition.scale_ratio - 1.0, scale, 0.0, 1e-12);
    assert_close(condition.power_ratio, 0.967, 1e-12, 0.0);
    let gain = condition.modulator_gain_error + 1.0;
    assert_close(gain * (1.0 + 662e-6 * 35.0), 1.0, 1e-12, 0.0);
    config.thermal.compensation_ppm_per_k = (condition.scale_ratio - 1.0) / 35.0 * 1e6;
    let compensated = Condition::at_start(&config);
    assert_close(compensated.scale_ratio, 1.0, 1e-12, 0.0);
}

#[test]
fn the_budget_at_the_papers_temperatures_is_the_papers() {
    for (temperature_c, want) in [(-40.0, 0.0065), (60.0, 0.0064)] {
        let facts = facts(&at(reference_gyro(), temperature_c)).unwrap();
        let (_, total) = *facts
            .angle_random_walk_budget_deg_per_sqrt_h
            .last()
            .unwrap();
        assert_close(total, want, 3e-3, 0.0);
    }
}

/// Delay of the words behind a steadily rising rate, s.
fn delay_s(config: &GyroConfig, fidelity: Fidelity) -> f64 {
    let mut gyro =
        Gyro::new(config, fidelity, 1.0, &Streams::new(3, 0)).expect("the gyro is sound");
    let period_s = gyro.sample_period_s();
    let slope = 0.1;
    let rise = slope * period_s;
    let mut word = 0.0;
    let mut end = 0.0;
    for _ in 0..200 {
        let start = end;
        end += rise;
        word = gyro.next_word(&MotionSegment::hermite(start, rise, end, rise));
    }
    let scale = Condition::at_start(config).scale_ratio;
    (end * scale - deg_per_h_to_rad_per_s(word)) / (slope * scale)
}

#[test]
fn less_light_lengthens_the_delay_unless_the_gain_is_held() {
    let mut config = at(silent_gyro(), -40.0);
    config.thermal.bias_deg_per_h_per_k = 0.0;
    config.thermal.bias_deg_per_h_per_k2 = 0.0;
    let nominal = facts(&at(config.clone(), 25.0)).unwrap();
    for is_held in [false, true] {
        config.controller.automatic_gain_control = is_held;
        let facts = facts(&config).unwrap();
        let ratio = if is_held { 1.0 } else { 0.853 };
        assert_close(facts.loop_gain, ratio * nominal.loop_gain, 1e-12, 0.0);
        // Nearly in proportion: the gain is a tenth of the stability limit.
        let bandwidth = ratio * nominal.loop_bandwidth_hz;
        assert_close(facts.loop_bandwidth_hz, bandwidth, 0.05, 0.0);
        for fidelity in [Fidelity::Loop, Fidelity::Rate] {
            // 1 ns of 203 us.
            assert_close(delay_s(&config, fidelity), 1e-3 * facts.delay_ms, 0.0, 1e-9);
        }
    }
}

/// A gyro of ten-second stages on a fast ramp, everything temperature does exaggerated.
fn hurried(mut config: GyroConfig) -> GyroConfig {
    config.temperature = ramp(25.0, 60.0, 300.0, 1.0);
    config.thermal.case_time_constant_s = 10.0;
    config.thermal.outer_time_constant_s = 10.0;
    config.thermal.inner_time_constant_s = 10.0;
    config.thermal.winding = Winding::Dipole;
    config.thermal.power = PowerConfig::Exponential(ExponentialPowerConfig {
        fall_k: 20.0,
        ..ExponentialPowerConfig::reference()
    });
    config
}

fn words(config: &GyroConfig, fidelity: Fidelity, seed: u64, rate: f64) -> Vec<f64> {
    let mut gyro =
        Gyro::new(config, fidelity, 16.0, &Streams::new(seed, 0)).expect("the gyro is sound");
    let segment = MotionSegment::constant(rate);
    (0..64_000).map(|_| gyro.next_word(&segment)).collect()
}

#[test]
fn loop_and_rate_model_agree_under_a_ramp_of_temperature() {
    let mut config = hurried(silent_gyro());
    let rate = deg_per_h_to_rad_per_s(1000.0);
    let exact = words(&config, Fidelity::Loop, 1, rate);
    let linear = words(&config, Fidelity::Rate, 1, rate);
    for (left, right) in exact.iter().zip(&linear).skip(100) {
        // One error of ten is weighed by another gain after an update, by 3 % of 6 deg/h at most.
        assert_close(*left, *right, 3e-5, 0.0);
    }
    let record = temperature_record(&config, 0.0, 16.0).unwrap();
    let scale = record.scale_ratio[200];
    let at = (record.time_s[200] * facts(&config).unwrap().output_rate_hz).round();
    let want = 1000.0 * scale + record.bias_deg_per_h[200];
    // The condition is a quarter of a second wide.
    let word = linear[whole(at)];
    assert!((want - 1000.0).abs() > 5.0, "nothing happens: {want}");
    assert_close(word - 1000.0, want - 1000.0, 0.04, 0.0);

    // Noise grows as the light fades: by the same in both models, and by more than half.
    config = hurried(reference_gyro());
    config.controller.automatic_gain_control = true;
    let deviation = |words: &[f64]| {
        let differences: f64 = words
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).powi(2))
            .sum();
        (differences / words.len() as f64).sqrt()
    };
    let [exact, linear] = [Fidelity::Loop, Fidelity::Rate].map(|fidelity| {
        let words = words(&config, fidelity, 2, 0.0);
        (deviation(&words[..4000]), deviation(&words[56_000..]))
    });
    assert!(linear.1 > 1.2 * linear.0, "{linear:?}");
    // A standard error of 1 % and less for 8000 words; the sum of two, five sigma.
    assert_close(exact.1, linear.1, 0.06, 0.0);
}

#[test]
fn known_answer_the_shupe_pulse_integrates_to_the_difference_it_leaves() {
    // The bias integrates to S n c_T L / D (To - Ti): its whole pulse at the start of a ramp.
    let mut config = silent_gyro();
    config.output.half_periods_per_sample = 4096;
    config.temperature = ramp(0.0, 100.0, 1.0, 60.0);
    config.thermal.bias_deg_per_h_per_k = 0.0;
    config.thermal.bias_deg_per_h_per_k2 = 0.0;
    config.thermal.bias_deg_per_h_per_c_per_min = 0.0;
    config.thermal.power = PowerConfig::Constant(ConstantPowerConfig {});
    // No change of the scale factor, of which length and diameter have equal shares.
    config.thermal.diameter_ppm_per_k = -config.thermal.length_ppm_per_k;
    config.thermal.wavelength_nm_per_k = 0.0;
    for winding in WINDINGS {
        config.thermal.winding = winding;
        let streams = Streams::new(1, 0);
        let mut gyro = Gyro::new(&config, Fidelity::Rate, 5000.0, &streams).unwrap();
        let period_s = gyro.sample_period_s();
        let count = whole(5000.0 / period_s);
        let rest = MotionSegment::constant(0.0);
        let angle: f64 = (0..count)
            .map(|_| deg_per_h_to_rad_per_s(gyro.next_word(&rest)) * period_s)
            .sum();
        let time_s: f64 = 4940.0;
        let decay = |tau_s: f64| (-time_s / tau_s).exp();
        // Ramp response of To - Ti = tau_i dTi/dt, dTi/dt being the step response of the cascade.
        let left = 100.0 / 60.0 * (1.0 - 2.4 * decay(600.0) + 1.5 * decay(300.0));
        let want = Shupe::new(&config).gradient_rad_per_k * left;
        assert_close(angle, want, 1e-5, 0.0);
    }
}

#[test]
fn a_cold_start_warms_up_and_a_settled_one_does_not() {
    let mut config = silent_gyro();
    config.thermal.self_heating_c = 8.0;
    assert_close(Condition::at_start(&config).coil_c, 33.0, 1e-14, 0.0);
    assert!(temperature_record(&config, 0.0, 3600.0).is_none());
    config.thermal.warm_up = ThermalWarmUp::Cold;
    let record = temperature_record(&config, 0.0, 600.0).unwrap();
    assert_close(record.case_c[0], 25.0, 1e-14, 0.0);
    let want = 33.0 - 8.0 * (-1.0_f64).exp();
    assert_close(*record.case_c.last().unwrap(), want, 1e-9, 0.0);
}

#[test]
fn power_that_vanishes_or_makes_the_loop_oscillate_is_refused() {
    let mut config = reference_gyro();
    config.temperature = ramp(25.0, 150.0, 1.0, 0.0);
    if let PowerConfig::Quadratic(points) = &mut config.thermal.power {
        points.hot_ratio = 0.2;
    }
    let error = facts(&config).unwrap_err();
    assert!(matches!(error, GyroError::NoPower { .. }), "{error}");
    config.thermal.power = PowerConfig::Exponential(ExponentialPowerConfig {
        fall_k: 10.0,
        ..ExponentialPowerConfig::reference()
    });
    config.temperature = ramp(25.0, -30.0, -1.0, 0.0);
    config.adc.bits = 0;
    let error = facts(&config).unwrap_err();
    assert!(
        matches!(error, GyroError::UnstableAtPower { .. }),
        "{error}"
    );
    config.controller.automatic_gain_control = true;
    assert!(facts(&config).is_ok());
}

#[test]
fn thermal_laws_that_leave_small_changes_are_refused() {
    let refused = |config: &GyroConfig| {
        let error = facts(config).unwrap_err();
        assert!(
            matches!(error, GyroError::ThermalLawTooSteep { .. }),
            "{error}"
        );
        error.key()
    };
    // 1 - 5000 ppm/K of 125 K: the modulator would overshoot its states by a factor of 2.7.
    let mut config = reference_gyro();
    config.temperature = ramp(25.0, 150.0, 1.0, 0.0);
    config.thermal.power = PowerConfig::Constant(ConstantPowerConfig {});
    config.thermal.half_wave_voltage_ppm_per_k = 662.0;
    assert!(facts(&config).is_ok());
    config.thermal.half_wave_voltage_ppm_per_k = -5000.0;
    let key = "gyro.thermal.half_wave_voltage_ppm_per_k";
    assert_eq!(refused(&config), key);

    // 10 nm/K of 125 K on 1310 nm would all but halve the scale factor twice over.
    config.thermal.half_wave_voltage_ppm_per_k = 0.0;
    config.thermal.wavelength_nm_per_k = 10.0;
    config.thermal.wavelength_feed_through = 1.0;
    assert_eq!(refused(&config), "gyro.thermal");

    // -10 ppm/K^2 of 125 K and -4000 ppm/K of it divide by 0.34.
    config.thermal.wavelength_nm_per_k = 0.0;
    config.thermal.compensation_ppm_per_k = -4000.0;
    config.thermal.compensation_ppm_per_k2 = -10.0;
    let key = "gyro.thermal.compensation_ppm_per_k";
    assert_eq!(refused(&config), key);
}

#[test]
fn temperatures_that_make_no_sense_are_refused() {
    let tables = [
        "[gyro.temperature.ramp]\nstart_c = 25.0\nend_c = 60.0\nrate_c_per_min = -1.0\n",
        "[gyro.temperature.ramp]\nstart_c = 25.0\nend_c = 25.0\nrate_c_per_min = 1.0\n",
        "[gyro.temperature.profile]\ntimes_s = [0.0, 5.0]\ntemperatures_c = [1.0]\n",
        "[gyro.temperature.profile]\ntimes_s = [0.0, 5.0, 5.0]\ntemperatures_c = [1.0, 2.0, 3.0]\n",
        "[gyro.thermal]\nlayers = 42\n",
        "[gyro.thermal]\nwarm_up = \"cold\"\n",
        "[gyro.thermal]\nmidpoint_offset_m = 401.0\n",
        "[gyro.thermal]\nreference_c = 60.0\n",
    ];
    let folder = tempfile::tempdir().unwrap();
    said_to_each("gyro", "Temperatures that make no sense", tables, |text| {
        let scenario = format!("name = \"x\"\nduration_s = 1.0\n{text}");
        write(folder.path(), "x.toml", &scenario);
        let output = fogbench(folder.path(), &["check", "x.toml"]);
        assert_eq!(code(&output), 2, "{text}");
        stderr(&output)
    });
}
