//! Second-order effects together: with temperature, with noise, with vibration, and in both models.

use std::f64::consts::{PI, TAU};

use fogbench::gyro::{
    Coil, Condition, LoopModel, MotionExtremes, RateModel, cautions, expected_mean_rate_rad_per_s,
    spike_share,
};
use fogbench::random::Streams;
use fogbench::scenario::{
    Fidelity, GyroConfig, ModulationScheme, ResetSample, SineVibrationConfig, SoakConfig,
    TemperatureConfig, TemperatureRampConfig, VibrationMotion,
};
use fogbench::signal::MotionSegment;
use fogbench::units::{deg_per_h_to_rad_per_s, deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};

use crate::support::gyro_cases::{allan_deviation, budget_of, silent_gyro};
use crate::support::reference_gyro::reference_gyro;
use crate::support::{assert_close, run_audits, stdout};

fn loop_model(config: &GyroConfig) -> LoopModel {
    LoopModel::new(config, 10.0, &Streams::new(3, 0)).expect("the gyro is sound")
}

fn rate_model(config: &GyroConfig) -> RateModel {
    RateModel::new(config, 10.0, &Streams::new(4, 0)).expect("the gyro is sound")
}

fn scale_factor_s() -> f64 {
    let config = reference_gyro();
    Coil::new(&config.coil, &config.source).scale_factor_s
}

/// Standard deviation of the error of one loop period, rad: `sigma_e^2 T_L = (N Ks)^2`.
fn error_noise_rad(config: &GyroConfig) -> f64 {
    let walk = deg_per_s_to_rad_per_s(budget_of(config, "total") / 60.0);
    walk * scale_factor_s() / loop_model(config).controller().loop_period_s.sqrt()
}

/// Mean of words at a constant rate, rad/s, after `settle` words, and its error by block means.
fn mean_word(
    mut next: impl FnMut(&MotionSegment) -> f64,
    rate: f64,
    settle: usize,
    words: usize,
) -> (f64, f64) {
    const BLOCKS: usize = 40;
    let segment = MotionSegment::constant(rate);
    for _ in 0..settle {
        next(&segment);
    }
    let length = words / BLOCKS;
    let blocks: Vec<f64> = (0..BLOCKS)
        .map(|_| (0..length).map(|_| next(&segment)).sum::<f64>() / length as f64)
        .map(deg_per_h_to_rad_per_s)
        .collect();
    let count = BLOCKS as f64;
    let mean = blocks.iter().sum::<f64>() / count;
    let power: f64 = blocks.iter().map(|block| (block - mean).powi(2)).sum();
    (mean, (power / (count - 1.0) / count).sqrt())
}

// --- Half-wave voltage and temperature ---------------------------------------------------------

/// Coefficient of the half-wave voltage, 1/K: lithium niobate.
const HALF_WAVE_PER_K: f64 = 662e-6;

/// A gyro on which temperature works by the half-wave voltage alone, resets blanked.
fn drifting_gyro(temperature: TemperatureConfig) -> GyroConfig {
    let mut config = silent_gyro();
    config.modulator.depth_deg = 90.0;
    config.modulator.reset_sample = ResetSample::Blanked;
    config.controller.loop_latency_periods = 0;
    config.temperature = temperature;
    let thermal = &mut config.thermal;
    thermal.half_wave_voltage_ppm_per_k = HALF_WAVE_PER_K * 1e6;
    thermal.length_ppm_per_k = 0.0;
    thermal.diameter_ppm_per_k = 0.0;
    thermal.wavelength_feed_through = 0.0;
    thermal.compensation_ppm_per_k = 0.0;
    thermal.compensation_ppm_per_k2 = 0.0;
    thermal.bias_deg_per_h_per_k = 0.0;
    thermal.bias_deg_per_h_per_k2 = 0.0;
    thermal.bias_deg_per_h_per_c_per_min = 0.0;
    config
}

fn soak(temperature_c: f64) -> TemperatureConfig {
    TemperatureConfig::Soak(SoakConfig {
        temperature_c,
        ..SoakConfig::reference()
    })
}

#[test]
fn known_answer_k8_a_soak_scales_the_output_by_the_half_wave_voltage() {
    let rate = deg_per_s_to_rad_per_s(10.0);
    for temperature_c in [-40.0, 60.0] {
        let config = drifting_gyro(soak(temperature_c));
        let kelvin = Condition::at_start(&config).case_c - config.thermal.reference_c;
        assert!(kelvin.abs() > 30.0);
        // The phase applied falls as the voltage of pi grows, and with it what a step is worth:
        // -eps / (1 + eps) of eps = 1 / (1 + v x) - 1 is v x itself.
        let eps = (1.0 + HALF_WAVE_PER_K * kelvin).recip() - 1.0;
        let want = 1.0 - eps / (1.0 + eps);
        assert_close(want, 1.0 + HALF_WAVE_PER_K * kelvin, 1e-12, 0.0);
        let expected = expected_mean_rate_rad_per_s(&config, rate);
        assert_close(expected / rate, want, 1e-12, 0.0);
        let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
        assert_close(model.modulator_gain_error(), eps, 1e-12, 0.0);
        assert_close(twin.modulator_gain_error(), eps, 1e-12, 0.0);
        let (word, _) = mean_word(|segment| model.next_word(segment), rate, 100, 40);
        assert_close(word / rate, want, 1e-9, 0.0);
        let (word, _) = mean_word(|segment| twin.next_word(segment), rate, 100, 40);
        assert_close(word / rate, want, 1e-9, 0.0);
    }
}

#[test]
fn known_answer_k9_the_second_loop_corrects_the_half_wave_voltage_of_a_soak() {
    const SHARE: f64 = 0.02;
    let rate = deg_per_s_to_rad_per_s(10.0);
    let segment = MotionSegment::constant(rate);
    let mut config = drifting_gyro(soak(60.0));
    config.controller.second_loop_gain = SHARE;
    let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
    // From rest the first resets see a loop that has not settled.
    for _ in 0..20 {
        model.next_word(&segment);
        twin.next_word(&segment);
    }
    let (start, twin_start) = (model.modulator_gain_error(), twin.modulator_gain_error());
    let resets = model.reset_count();
    for _ in 0..40 {
        model.next_word(&segment);
        twin.next_word(&segment);
    }
    let count = (model.reset_count() - resets) as f64;
    let time_s = 40.0 * model.sample_period_s();
    let turn_s = TAU / (rate * scale_factor_s()) * 0.5 * model.controller().loop_period_s;
    assert_close(count, time_s / turn_s, 0.02, 1.0);
    // Time constant 1 / (g2 f_r) = 7.8 ms: K9 allows 2 %.
    let left = model.modulator_gain_error() / start;
    assert_close(left, (1.0 - SHARE).powf(count), 0.02, 0.0);
    let left = twin.modulator_gain_error() / twin_start;
    assert_close(left, (1.0 - SHARE).powf(time_s / turn_s), 0.02, 0.0);
    // Sixty time constants later nothing is left.
    for words in [
        mean_word(|segment| model.next_word(segment), rate, 2000, 40),
        mean_word(|segment| twin.next_word(segment), rate, 2000, 40),
    ] {
        assert_close(words.0 / rate, 1.0, 1e-9, 0.0);
    }
    assert_close(
        expected_mean_rate_rad_per_s(&config, rate),
        rate,
        1e-12,
        0.0,
    );
}

#[test]
fn both_models_follow_the_half_wave_voltage_up_a_ramp() {
    let config = drifting_gyro(TemperatureConfig::Ramp(TemperatureRampConfig {
        start_c: 25.0,
        end_c: 60.0,
        rate_c_per_min: 60.0,
        ..TemperatureRampConfig::reference()
    }));
    let segment = MotionSegment::constant(deg_per_s_to_rad_per_s(10.0));
    let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
    let words = 16_000_u32;
    let (mut looped, mut rated) = (0.0, 0.0);
    for _ in 0..words {
        looped = model.next_word(&segment);
        rated = twin.next_word(&segment);
    }
    let time_s = f64::from(words) * model.sample_period_s();
    // The case starts as 1 K/s t^2 / (2 tau_c); a condition is held for a quarter of a second.
    let tau_s = config.thermal.case_time_constant_s;
    let kelvin = time_s * time_s / (2.0 * tau_s);
    let want = (1.0 + HALF_WAVE_PER_K * kelvin).recip() - 1.0;
    let held = 0.25 * 2.0 / time_s + time_s / (3.0 * tau_s);
    assert_close(model.modulator_gain_error(), want, held, 0.0);
    assert_close(
        twin.modulator_gain_error(),
        model.modulator_gain_error(),
        1e-12,
        0.0,
    );
    assert_close(looped, rated, 1e-9, 0.0);
}

// --- Dead band under noise ---------------------------------------------------------------------

const COUPLING_RAD: f64 = 1e-3;

fn coupled(mut config: GyroConfig) -> GyroConfig {
    config.modulator.cross_coupling_urad = COUPLING_RAD * 1e6;
    config
}

#[test]
fn known_answer_k11_realistic_noise_leaves_the_dead_band_as_it_is() {
    let config = coupled(reference_gyro());
    for (input, words) in [(0.9_f64, 8000), (1.25, 40_000), (-2.0, 20_000)] {
        let rate = input * COUPLING_RAD / scale_factor_s();
        let want = expected_mean_rate_rad_per_s(&config, rate);
        // K11 allows 0.5 % of the half width; 0.36 deg/h over sqrt(s) leave less than 0.2 deg/h.
        let width = COUPLING_RAD / scale_factor_s();
        let noise = deg_per_s_to_rad_per_s(budget_of(&config, "total") / 60.0);
        let time_s = words as f64 * loop_model(&config).sample_period_s();
        let allowed = 0.005 * width + 3.0 * noise / time_s.sqrt();
        assert!(allowed < 0.01 * width);
        let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
        let (word, _) = mean_word(|segment| model.next_word(segment), rate, 2000, words);
        assert_close(word, want, 0.0, allowed);
        let (word, _) = mean_word(|segment| twin.next_word(segment), rate, 2000, words);
        assert_close(word, want, 0.0, allowed);
    }
}

/// Mean of `du = (phi + a sin u) dt + sqrt(2 D) dW` per unit of time.
///
/// `2 pi D (1 - e^(-2 pi phi / D)) / int_0^2pi dx int_x^(x + 2pi) dy e^((V(y) - V(x)) / D)` with the
/// potential `V = a cos u - phi u` (Stratonovich, Topics in the Theory of Random Noise II, 1967).
fn noisy_adler(phase: f64, dead: f64, diffusion: f64) -> f64 {
    const POINTS: usize = 400;
    let step = TAU / POINTS as f64;
    let potential = |u: f64| (dead * u.cos() - phase * u) / diffusion;
    // Periodic in x, so that the rectangle rule is exact there; y by the midpoint of each step.
    let integral: f64 = (0..POINTS)
        .map(|i| {
            let x = i as f64 * step;
            let inner: f64 = (0..POINTS)
                .map(|j| (potential(x + (j as f64 + 0.5) * step) - potential(x)).exp())
                .sum();
            inner * step * step
        })
        .sum();
    TAU * diffusion * (1.0 - (-TAU * phase / diffusion).exp()) / integral
}

#[test]
fn known_answer_strong_noise_rounds_the_dead_band_in_both_models() {
    let mut config = coupled(reference_gyro());
    // White phase noise S (one-sided) walks the ramp: D = S / 4 tau per half period, a fifth of a.
    let tau_s = Coil::new(&config.coil, &config.source).transit_time_s;
    let diffusion = COUPLING_RAD / 5.0;
    config.noise.technical_phase_urad_per_sqrt_hz = (4.0 * tau_s * diffusion).sqrt() * 1e6;
    config.controller.loop_bandwidth_hz = 8000.0;
    for input in [0.5, 1.0, 1.5] {
        let phase = input * COUPLING_RAD;
        let want = noisy_adler(phase, COUPLING_RAD, diffusion);
        let sharp = (input * input - 1.0_f64).max(0.0).sqrt() * COUPLING_RAD;
        assert!(want - sharp > 0.02 * COUPLING_RAD, "{want} {sharp}");
        let rate = phase / scale_factor_s();
        let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
        for (word, deviation) in [
            mean_word(|segment| model.next_word(segment), rate, 1000, 200_000),
            mean_word(|segment| twin.next_word(segment), rate, 1000, 200_000),
        ] {
            let allowed = 4.0 * deviation * scale_factor_s() + 0.01 * COUPLING_RAD;
            assert!(allowed < 0.1 * COUPLING_RAD, "{allowed}");
            assert_close(word * scale_factor_s(), want, 0.0, allowed);
        }
    }
}

// --- Second loop under noise -------------------------------------------------------------------

#[test]
fn known_answer_the_noise_of_the_second_loop_is_that_of_its_estimates() {
    const SHARE: f64 = 0.05;
    let mut config = reference_gyro();
    config.adc.bits = 0;
    config.modulator.dac_bits = 0;
    config.modulator.reset_sample = ResetSample::Blanked;
    config.controller.second_loop_gain = SHARE;
    config.controller.loop_latency_periods = 0;
    let mut model = loop_model(&config);
    for _ in 0..2000 {
        model.run_period([0.5; 2]);
    }
    // So slow a loop adds nothing to the difference of two errors.
    model.set_loop_gain(0.005);
    let (mut sum, mut power, mut largest) = (0.0, 0.0, 0.0_f64);
    let mut resets = model.reset_count();
    let start = resets;
    while resets < start + 40_000 {
        model.run_period([0.5; 2]);
        if model.reset_count() > resets {
            resets = model.reset_count();
            let error = model.modulator_gain_error();
            sum += error;
            power += error * error;
            largest = largest.max(error.abs());
        }
    }
    let count = (resets - start) as f64;
    // eps' = (1 - g2) eps - g2 n, n being the difference of two errors over pi.
    let estimate = error_noise_rad(&config) * 2.0_f64.sqrt() / PI;
    let want = estimate * (SHARE / (2.0 - SHARE)).sqrt();
    // A first-order sequence of coefficient rho has (1 - rho^2) / (1 + rho^2) of its values' worth
    // for its power, (1 - rho) / (1 + rho) for its mean.
    let rho = 1.0 - SHARE;
    let worth = count * (1.0 - rho * rho) / (1.0 + rho * rho);
    let rms = (power / count).sqrt();
    assert_close(rms, want, 3.0 / (2.0 * worth).sqrt() + 0.01, 0.0);
    let worth = count * (1.0 - rho) / (1.0 + rho);
    assert_close(sum / count, 0.0, 0.0, 4.0 * want / worth.sqrt());
    assert!(largest < 6.0 * want, "{largest} {want}");
}

#[test]
fn the_second_loop_of_four_states_stays_bounded_under_noise_at_rest() {
    const SHARE: f64 = 0.01;
    for scheme in FOUR_STATE {
        let mut config = reference_gyro();
        config.adc.bits = 0;
        config.modulator.scheme = scheme;
        config.controller.second_loop_gain = SHARE;
        config.modulator.gain_error_ppm = 5000.0;
        let mut model = loop_model(&config);
        for _ in 0..2000 {
            model.run_period([0.0; 4]);
        }
        let periods = 40_000_u32;
        let mut power = 0.0;
        for _ in 0..periods {
            model.run_period([0.0; 4]);
            power += model.modulator_gain_error().powi(2);
        }
        // One estimate a period: the noise of the rate's demodulation over pi.
        let estimate = error_noise_rad(&config) / PI;
        let want = estimate * (SHARE / (2.0 - SHARE)).sqrt();
        let rho = 1.0 - SHARE;
        let worth = f64::from(periods) * (1.0 - rho * rho) / (1.0 + rho * rho);
        let rms = (power / f64::from(periods)).sqrt();
        assert_close(rms, want, 3.0 / (2.0 * worth).sqrt() + 0.01, 0.0);
    }
}

/// Out of lock the estimates of the second loop mean nothing; multiplied up they once reached infinity.
#[test]
fn the_second_loop_stays_in_its_range_where_lock_is_lost() {
    let mut config = reference_gyro();
    config.source.power_uw = 1e5;
    config.detector.transimpedance_kohm = 0.0028;
    config.modulator.depth_deg = 179.0;
    config.adc.samples_per_half_period = 1;
    config.controller.second_loop_gain = 1.0;
    config.noise.technical_phase_urad_per_sqrt_hz = 26_000.0;
    let mut model = loop_model(&config);
    for _ in 0..1000 {
        let word = model.next_word(&MotionSegment::constant(0.0));
        assert!(word.is_finite(), "{word}");
        let error = model.modulator_gain_error();
        assert!((-0.5..=1.0).contains(&error), "{error}");
    }
    assert!(model.unlocked_half_periods() > 0, "the loop is out of lock");
}

// --- Both models -------------------------------------------------------------------------------

/// Words of both models under a motion of all four coefficients, from rest.
fn compare(config: &GyroConfig) {
    let (mut model, mut twin) = (loop_model(config), rate_model(config));
    let mut largest = 0.0_f64;
    for word in 0..400_u32 {
        let rate = 2e-4 * f64::from(word % 7);
        let segment = MotionSegment {
            rate_rad_per_s: [rate, 1e-3, -4e-4, 2e-4],
        };
        let (left, right) = (model.next_word(&segment), twin.next_word(&segment));
        largest = largest.max((left - right).abs());
    }
    // Phase errors of 1e-3 rad depart from their sine by their third power, 2e-7 of them.
    let swing = rad_per_s_to_deg_per_h(1e-3);
    assert!(largest < 2e-6 * swing, "{largest} of {swing} deg/h");
}

/// Lag of the words of both models behind an acceleration, s.
fn lags(config: &GyroConfig) -> [f64; 2] {
    let acceleration = 0.02;
    let (mut model, mut twin) = (loop_model(config), rate_model(config));
    let period_s = model.sample_period_s();
    let rise = acceleration * period_s;
    let mut rate = 0.0;
    let (mut looped, mut rated) = (0.0, 0.0);
    for _ in 0..400 {
        let segment = MotionSegment {
            rate_rad_per_s: [rate, rise, 0.0, 0.0],
        };
        looped = model.next_word(&segment);
        rated = twin.next_word(&segment);
        rate += rise;
    }
    [looped, rated].map(|word| (rate - deg_per_h_to_rad_per_s(word)) / acceleration)
}

#[test]
fn averaged_spikes_slow_both_models_alike() {
    for mismatch in [0.01_f64, -0.01] {
        let mut config = silent_gyro();
        config.modulator.half_period_mismatch = mismatch;
        config.detector.gate_spikes = false;
        config.detector.gate_duty = 1.0;
        compare(&config);
        let controller = *rate_model(&config).controller();
        let periods = 32.0;
        let gated = controller.word_delay_s(periods);
        let gain = controller.gain * (1.0 - spike_share(mismatch));
        let want = gated + controller.loop_period_s * (gain.recip() - controller.gain.recip());
        assert!(want > 1.003 * gated);
        for lag in lags(&config) {
            assert_close(lag, want, 1e-5, 0.0);
        }
    }
}

const FOUR_STATE: [ModulationScheme; 2] =
    [ModulationScheme::FourState, ModulationScheme::FourStateHalf];

#[test]
fn four_states_have_bandwidth_and_delay_alike_in_both_models() {
    for scheme in FOUR_STATE {
        for latency_periods in [0, 2] {
            let mut config = silent_gyro();
            config.modulator.scheme = scheme;
            config.controller.loop_latency_periods = latency_periods;
            compare(&config);
            let controller = *rate_model(&config).controller();
            let bandwidth_hz = config.controller.loop_bandwidth_hz;
            assert_close(controller.bandwidth_hz(), bandwidth_hz, 1e-9, 0.0);
            let word_s = loop_model(&config).sample_period_s();
            let want = controller.word_delay_s(word_s / controller.loop_period_s);
            for lag in lags(&config) {
                assert_close(lag, want, 1e-5, 0.0);
            }
        }
    }
}

#[test]
fn four_states_have_the_noise_of_their_budget_in_both_models() {
    const WORDS: usize = 20_000;
    const FACTOR: usize = 32;
    for scheme in FOUR_STATE {
        let mut config = reference_gyro();
        config.modulator.scheme = scheme;
        let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
        let segment = MotionSegment::constant(1e-3);
        let looped: Vec<f64> = (0..WORDS).map(|_| model.next_word(&segment)).collect();
        let rated: Vec<f64> = (0..WORDS).map(|_| twin.next_word(&segment)).collect();
        let tau_h = FACTOR as f64 * model.sample_period_s() / 3600.0;
        let walk = allan_deviation(&rated, FACTOR) * tau_h.sqrt();
        // About 3 n / 4 m degrees of freedom: three standard errors of the deviation.
        let freedom = 0.75 * WORDS as f64 / FACTOR as f64;
        let allowed = 3.0 / (2.0 * freedom).sqrt();
        assert_close(walk, budget_of(&config, "total"), allowed, 0.0);
        // Colour of the loop: neighbouring words, five standard errors of 1 / sqrt(n) each.
        let neighbours = [correlation(&looped), correlation(&rated)];
        assert!(neighbours[0] > 0.1, "{neighbours:?}");
        let allowed = 5.0 * (2.0 / WORDS as f64).sqrt();
        assert_close(neighbours[0], neighbours[1], 0.0, allowed);
    }
}

/// Correlation of neighbouring words.
fn correlation(words: &[f64]) -> f64 {
    let mean = words.iter().sum::<f64>() / words.len() as f64;
    let power: f64 = words.iter().map(|word| (word - mean).powi(2)).sum();
    let pairs = words.windows(2);
    let product: f64 = pairs.map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    product / power
}

// --- Vibration ---------------------------------------------------------------------------------

fn vibrating(mut config: GyroConfig) -> GyroConfig {
    config.vibration.motion = VibrationMotion::Sine(SineVibrationConfig {
        frequency_hz: 300.0,
        acceleration_g: 5.0,
        rate_amplitude_deg_per_s: 0.1,
        rate_phase_deg: 30.0,
    });
    config
}

#[test]
fn vibration_is_the_same_in_both_kernels_to_the_bit() {
    for latency in [0, 1, 3] {
        let mut config = vibrating(reference_gyro());
        config.controller.loop_latency_periods = latency;
        let (mut plain, mut full) = (loop_model(&config), loop_model(&config));
        full.use_full_kernel();
        let segment = MotionSegment::constant(deg_per_s_to_rad_per_s(5.0));
        for word in 0..200 {
            let (left, right) = (plain.next_word(&segment), full.next_word(&segment));
            assert_eq!(left.to_bits(), right.to_bits(), "word {word}");
        }
    }
}

#[test]
fn vibration_of_a_mismatched_gyro_keeps_its_frequency_in_both_models() {
    for mismatch in [0.01, -0.01] {
        let mut config = vibrating(silent_gyro());
        config.modulator.half_period_mismatch = mismatch;
        let (mut model, mut twin) = (loop_model(&config), rate_model(&config));
        let rest = MotionSegment::constant(0.0);
        let (mut apart, mut swing, mut sum) = (0.0_f64, 0.0_f64, 0.0);
        for word in 0..4000 {
            let (left, right) = (model.next_word(&rest), twin.next_word(&rest));
            if word >= 100 {
                apart = apart.max((left - right).abs());
                swing = swing.max(right.abs());
                sum += left - right;
            }
        }
        // Half the product of the amplitudes of power and rate bounds what is rectified; the rate
        // model leaves the second harmonic out, not the mean.
        let product = 0.5 * 5e-3 * 360.0;
        assert!(swing > 300.0, "{swing} deg/h");
        assert!(apart < 2.0 * product + 1e-3 * swing, "{apart} deg/h");
        assert_close(sum / 3900.0, 0.0, 0.0, 0.02 * product);
    }
}

#[test]
fn the_rate_model_refuses_a_dead_band_that_vibration_narrows() {
    let config = coupled(vibrating(silent_gyro()));
    let motion = MotionExtremes::default();
    let refusal = cautions(&config, Fidelity::Rate, &motion).expect_err("a swinging ramp");
    assert_eq!(refusal.key(), "gyro.modulator.cross_coupling_urad");
    assert!(cautions(&config, Fidelity::Loop, &motion).is_ok());

    // The ramp swings by s = Ks W / (w tau): J0(s) = 1 - s^2 / 4 of the coupling is left.
    let coil = Coil::new(&config.coil, &config.source);
    let rate = deg_per_s_to_rad_per_s(0.1);
    let swing = scale_factor_s() * rate / (TAU * 300.0 * coil.transit_time_s);
    let left = 1.0 - 0.25 * swing * swing + swing.powi(4) / 64.0;
    assert!(left < 0.99);
    let (low, high) = (left - 0.004, left + 0.004);
    for (factor, is_locked) in [(low, true), (high, false)] {
        let mut model = loop_model(&config);
        let rate = factor * COUPLING_RAD / scale_factor_s();
        let (word, _) = mean_word(|segment| model.next_word(segment), rate, 4000, 40_000);
        let is_still = word.abs() < 0.01 * COUPLING_RAD / scale_factor_s();
        assert_eq!(is_still, is_locked, "{factor}: {word}");
    }
}

// --- Shipped scenarios -------------------------------------------------------------------------

#[test]
fn the_shipped_dead_bands_and_errors_of_two_pi_pass() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let files = [
        "dead-band",
        "dead-band-dithered",
        "dead-band-locked",
        "two-pi-error",
        "two-pi-error-second-loop",
        "two-pi-error-demodulated",
    ];
    let output = run_audits(folder.path(), &files);
    // The jumps of the dithered ramp are no loss of lock.
    assert!(!stdout(&output).contains("out of lock"));
    // The line of theory is drawn where the mean is wrong, and there alone.
    for (name, is_drawn) in [
        ("dead-band", true),
        ("dead-band-dithered", false),
        ("two-pi-error", true),
        ("two-pi-error-second-loop", false),
    ] {
        let path = folder.path().join("out").join(name).join("response.svg");
        let picture = std::fs::read_to_string(path).expect("a picture");
        assert_eq!(picture.contains("raw, theory"), is_drawn, "{name}");
    }
}
