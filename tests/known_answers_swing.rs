//! Closed-form answers for sine fits, noise-delay bounds and Wiener predictions.

use std::f64::consts::TAU;

use fogbench::metrics::{
    SwingClock, fit_sine, fit_swing, noise_delay_bound, noise_delay_bound_coloured,
    noise_power_gain, predict,
};

use crate::support::assert_close;
use crate::support::records::{PERIOD_S, shape, sine, white};

#[test]
fn known_answer_k23_noise_free_sine_fit_is_right_to_a_nanosecond_for_any_window() {
    for frequency_hz in [5.0, 10.0, 7.3] {
        for count in [3000, 3989, 5001, 17_000] {
            let clock = SwingClock {
                frequency_hz,
                sample_period_s: PERIOD_S,
                first_stamp_s: 20.000_3,
            };
            let reference = fit_swing(&sine(&clock, count, 3600.0, 0.0), &clock).unwrap();
            let delayed = sine(&clock, count, 1800.0, 250e-6);
            let fit = fit_swing(&delayed, &clock).unwrap();
            assert_close(fit.delay_behind_s(&reference).value, 250e-6, 0.0, 1e-9);
            assert_close(fit.amplitude_over(&reference).value, 0.5, 1e-9, 0.0);
            assert_close(fit.whole.offset, 8.47, 0.0, 1e-6);
            let direct = fit_sine(&delayed, &clock).unwrap();
            assert_close(direct.amplitude, 1800.0, 1e-9, 0.0);
        }
    }
}

#[test]
fn known_answer_k23_noisy_sine_fit_reaches_the_cramer_rao_bound() {
    const RUNS: u64 = 800;
    let clock = SwingClock {
        frequency_hz: 10.0,
        sample_period_s: 1e-3,
        first_stamp_s: 0.0,
    };
    let (count, amplitude, noise) = (1000, 100.0, 10.0);
    let clean = sine(&clock, count, amplitude, 0.0);
    let reference = fit_swing(&clean, &clock).unwrap();
    let (mut square, mut covered) = (0.0, 0);
    for seed in 0..RUNS {
        let mut values = white(40_000 + seed, count, noise);
        for (value, clean) in values.iter_mut().zip(&clean) {
            *value += clean;
        }
        let delay = fit_swing(&values, &clock)
            .unwrap()
            .delay_behind_s(&reference);
        square += delay.value * delay.value;
        covered += i32::from(delay.low <= 0.0 && 0.0 <= delay.high);
    }
    let bound =
        (2.0 * noise * noise / (amplitude * amplitude * count as f64)).sqrt() / (TAU * 10.0);
    // Standard error of a standard deviation of 800: 1 / sqrt(1600) = 2.5 %; four of them.
    assert_close((square / RUNS as f64).sqrt(), bound, 0.1, 0.0);
    // Ten sub-blocks, Student t: 0.95 x 800 = 760, binomial standard deviation 6.2.
    assert!(
        (760 - 25..=760 + 25).contains(&covered),
        "{covered} of {RUNS}"
    );
}

#[test]
fn delays_are_unwrapped_into_half_a_period() {
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let reference = fit_swing(&sine(&clock, 8000, 1.0, 0.0), &clock).unwrap();
    for (delay_s, wanted_s) in [(0.09, 0.09), (0.11, -0.09), (0.2, 0.0), (-0.03, -0.03)] {
        let fit = fit_swing(&sine(&clock, 8000, 1.0, delay_s), &clock).unwrap();
        assert_close(fit.delay_behind_s(&reference).value, wanted_s, 0.0, 1e-9);
    }
}

#[test]
fn coloured_bound_is_the_white_formula_on_white_noise() {
    for taps in 2..=6 {
        for step in -10..=20_i32 {
            let delay = 0.37 * f64::from(step);
            let mut autocovariance = vec![0.0; taps];
            autocovariance[0] = 3.0;
            let solved = noise_delay_bound_coloured(taps, 2, delay, &autocovariance).unwrap();
            assert_close(
                solved,
                noise_delay_bound(taps, 2, delay).unwrap(),
                1e-9,
                0.0,
            );
        }
    }
    assert_eq!(noise_delay_bound(1, 1, 1.0), Some(1.0));
    assert_eq!(noise_delay_bound(1, 1, 2.0), None);
    assert_eq!(noise_delay_bound_coloured(1, 2, 2.0, &[1.0]), Some(1.0));
}

#[test]
fn no_filter_of_unit_gain_beats_the_coloured_bound_at_its_own_delay() {
    let autocovariance = [1.0, 0.5, 0.2, 0.1, 0.0];
    let draws = white(77, 5 * 200, 1.0);
    for weights in draws.chunks_exact(5) {
        let sum: f64 = weights.iter().sum();
        let unit: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let delay: f64 = unit
            .iter()
            .zip(2..)
            .map(|(w, age)| w * f64::from(age))
            .sum();
        let bound = noise_delay_bound_coloured(5, 2, delay, &autocovariance).unwrap();
        assert!(noise_power_gain(&unit, &autocovariance) >= bound * (1.0 - 1e-6));
    }
}

#[test]
fn wiener_prediction_of_white_noise_with_a_mean_has_the_published_dc_gain() {
    // Four-tap one-step predictor: sum w = 4 m^2 / (s^2 + 4 m^2).
    let (mean, noise) = (8.47_f64, 22.8_f64);
    let mut second_moment = vec![mean * mean; 12];
    second_moment[0] += noise * noise;
    let prediction = predict(&shape(4, 2, vec![1.0]), &second_moment).unwrap();
    let expected = 4.0 * mean * mean / (noise * noise + 4.0 * mean * mean);
    assert_close(prediction.dc_gain(), expected, 1e-9, 0.0);
    assert_close(expected, 0.355, 0.0, 1e-3);
    // Without the mean there is nothing to predict.
    let mut centred = vec![0.0; 12];
    centred[0] = noise * noise;
    let blind = predict(&shape(4, 2, vec![1.0]), &centred).unwrap();
    assert!(blind.dc_gain().abs() < 1e-12);
}

#[test]
fn wiener_prediction_of_a_two_sample_mean_is_that_mean_and_delays_by_1_5_samples() {
    let mut second_moment: Vec<f64> = (0..16)
        .map(|lag| 6.5e6 * (TAU * 5.0 * PERIOD_S * f64::from(lag)).cos() + 70.0)
        .collect();
    second_moment[0] += 400.0;
    second_moment[1] += 80.0;
    // Weights may use the current sample (age 0), the register makes it age 1.
    let prediction = predict(&shape(10, 1, vec![0.5, 0.5]), &second_moment).unwrap();
    assert_close(prediction.weights().unwrap()[0], 0.5, 0.0, 1e-9);
    assert_close(prediction.weights().unwrap()[1], 0.5, 0.0, 1e-9);
    assert!(
        prediction.weights().unwrap()[2..]
            .iter()
            .all(|weight| weight.abs() < 1e-9)
    );
    assert_close(prediction.delay_at_dc_samples(), 1.5, 0.0, 1e-7);
    assert_close(
        prediction.delay_s(5.0, PERIOD_S),
        1.5 * PERIOD_S,
        0.0,
        1e-12,
    );
}
