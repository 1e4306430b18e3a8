//! Closed-form answers for sine fits, noise-delay bounds and Wiener predictions.

use std::f64::consts::TAU;

use fogbench::metrics::{
    Motion, SwingClock, correlation_delay_s, fit_sine, fit_sine_free_frequency, fit_swing, measure,
    noise_delay_bound, noise_delay_bound_coloured, noise_power_gain, predict,
};

use crate::support::assert_close;
use crate::support::records::{PERIOD_S, raw_record, settings, shape, sine, white};

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

#[test]
fn known_answer_k23_frequency_and_phase_are_exact_without_noise() {
    for (guess_hz, count) in [(4.9, 4000), (5.2, 7000), (5.0, 3001)] {
        let clock = SwingClock {
            frequency_hz: 5.037,
            sample_period_s: PERIOD_S,
            first_stamp_s: 20.000_3,
        };
        let guess = SwingClock {
            frequency_hz: guess_hz,
            ..clock
        };
        let fit = fit_sine_free_frequency(&sine(&clock, count, 3600.0, 0.0), &guess).unwrap();
        assert_close(fit.frequency_hz, 5.037, 1e-9, 0.0);
        assert_close(fit.amplitude, 3600.0, 1e-9, 0.0);
        assert_close(fit.offset, 8.47, 0.0, 1e-6);
        let phase = TAU * 5.037 * fit.centre_s;
        let difference = (fit.phase_rad - phase) / TAU;
        assert_close(difference, difference.round(), 0.0, 1e-9);
        assert_close(
            fit.phase_at_rad(fit.centre_s + 1.0),
            fit.phase_rad + TAU * fit.frequency_hz,
            1e-12,
            0.0,
        );
    }
}

#[test]
fn known_answer_k23_an_unknown_frequency_doubles_the_error_at_the_start_but_not_at_the_centre() {
    const RUNS: u64 = 600;
    let clock = SwingClock {
        frequency_hz: 10.0,
        sample_period_s: 1e-3,
        first_stamp_s: 0.0,
    };
    let guess = SwingClock {
        frequency_hz: 10.1,
        ..clock
    };
    let (count, amplitude, noise) = (1000, 100.0, 10.0);
    let clean = sine(&clock, count, amplitude, 0.0);
    let (mut at_centre, mut at_start) = (0.0, 0.0);
    for seed in 0..RUNS {
        let mut values = white(60_000 + seed, count, noise);
        for (value, clean) in values.iter_mut().zip(&clean) {
            *value += clean;
        }
        let fit = fit_sine_free_frequency(&values, &guess).unwrap();
        let error = |time_s: f64| {
            let turns = (fit.phase_at_rad(time_s) - TAU * 10.0 * time_s) / TAU;
            TAU * (turns - turns.round())
        };
        at_centre += error(fit.centre_s).powi(2);
        at_start += error(0.0).powi(2);
    }
    let bound = (2.0 * noise * noise / (amplitude * amplitude * count as f64)).sqrt();
    // Standard error of a standard deviation of 600: 1 / sqrt(1200) = 2.9 %; three and a half.
    assert_close((at_centre / RUNS as f64).sqrt(), bound, 0.1, 0.0);
    assert_close((at_start / RUNS as f64).sqrt(), 2.0 * bound, 0.1, 0.0);
}

/// Peak of the usual correlation estimator, `sum x[k] y[k + l] / N` over whatever overlaps, s.
fn naive_correlation_delay_s(x: &[f64], y: &[f64], lag_max: usize) -> f64 {
    let about_mean = |values: &[f64]| -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect()
    };
    let (x, y) = (about_mean(x), about_mean(y));
    // Lags -lag_max ..= lag_max; a negative lag leads x.
    let product = |shift: usize| -> f64 {
        let (skip_x, skip_y) = (lag_max.saturating_sub(shift), shift.saturating_sub(lag_max));
        x[skip_x..]
            .iter()
            .zip(&y[skip_y..])
            .map(|(x, y)| x * y)
            .sum()
    };
    let products: Vec<f64> = (0..=2 * lag_max).map(product).collect();
    let best = (1..2 * lag_max)
        .max_by(|a, b| products[*a].total_cmp(&products[*b]))
        .expect("there are lags");
    let [before, at, after] = [products[best - 1], products[best], products[best + 1]];
    let part = 0.5 * (before - after) / (before - 2.0 * at + after);
    (best as f64 - lag_max as f64 + part) * PERIOD_S
}

#[test]
fn known_answer_k24_a_correlation_over_an_inner_window_finds_the_delay_the_usual_one_does_not() {
    let delay_s = 250e-6;
    for (frequency_hz, count) in [(5.0, 7979), (10.0, 3990), (7.3, 5600)] {
        for first_stamp_s in [0.0, 20.000_3, 20.037] {
            let clock = SwingClock {
                frequency_hz,
                sample_period_s: PERIOD_S,
                first_stamp_s,
            };
            let truth = sine(&clock, count, 3600.0, 0.0);
            let late = sine(&clock, count, 1800.0, delay_s);
            let found = correlation_delay_s(&truth, &late, &clock).unwrap();
            assert_close(found.value, delay_s, 0.0, 5e-6);
            let led = correlation_delay_s(&late, &truth, &clock).unwrap();
            assert_close(led.value, -delay_s, 0.0, 5e-6);
        }
    }
    // One second of 5 Hz: the usual estimator is off by more than 50 us; the inner window holds
    // fewer whole cycles and is still right.
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let (truth, late) = (
        sine(&clock, 3989, 3600.0, 0.0),
        sine(&clock, 3989, 3600.0, delay_s),
    );
    let naive = naive_correlation_delay_s(&truth, &late, 100);
    assert!((naive - delay_s).abs() > 50e-6, "{naive}");
    let inner = correlation_delay_s(&truth, &late, &clock).unwrap();
    assert_close(inner.value, delay_s, 0.0, 10e-6);
}

#[test]
fn a_correlation_needs_cycles_and_a_delay_within_a_quarter_of_one() {
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let truth = sine(&clock, 8000, 1.0, 0.0);
    assert!(correlation_delay_s(&truth[..2500], &truth[..2500], &clock).is_err());
    let opposed = sine(&clock, 8000, 1.0, 0.1);
    assert!(correlation_delay_s(&truth, &opposed, &clock).is_err());
    let far = sine(&clock, 8000, 1.0, 0.04);
    let found = correlation_delay_s(&truth, &far, &clock).unwrap();
    assert_close(found.value, 0.04, 0.0, 5e-6);
}

#[test]
fn shared_noise_moves_the_peak_of_a_correlation_but_not_a_sine_fit() {
    let clock = SwingClock {
        frequency_hz: 10.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let count = 40_000;
    let truth = sine(&clock, count, 3600.0, 0.0);
    let noise = white(13, count, 40.0);
    let raw: Vec<f64> = truth
        .iter()
        .zip(&noise)
        .map(|(rate, noise)| rate + noise)
        .collect();
    // One sample late with all of raw's noise, which is one sample late as well, and one more with
    // half of it: the mean of two samples, 1.5 samples late.
    let mean: Vec<f64> = (0..count)
        .map(|k| (raw[k.saturating_sub(1)] + raw[k.saturating_sub(2)]) / 2.0)
        .collect();
    let late_s = 1.5 * PERIOD_S;
    let behind_truth = correlation_delay_s(&truth, &mean, &clock).unwrap();
    let fit = |values: &[f64]| fit_swing(values, &clock).unwrap();
    assert_close(
        fit(&mean).delay_behind_s(&fit(&raw)).value,
        late_s,
        0.0,
        1e-6,
    );
    // Standard deviation sqrt(2 / 40000) 28 / 3600 / (2 pi 10) = 0.9 us.
    assert_close(behind_truth.value, late_s, 0.0, 5e-6);
}

#[test]
fn both_estimators_of_a_noisy_swing_agree() {
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
    };
    let truth = sine(&clock, 40_000, 3600.0, 0.0);
    let mut raw = sine(&clock, 40_000, 3600.0, 203e-6);
    for (word, noise) in raw.iter_mut().zip(white(12, 40_000, 23.0)) {
        *word += noise;
    }
    let record = raw_record(&raw, &truth);
    let metrics = measure(
        &record,
        &settings(Motion::Swing { frequency_hz: 5.0 }),
        None,
    );
    let fitted = metrics.metrics["delay_vs_truth_ms"].estimate;
    let correlated = metrics.metrics["delay_by_correlation_ms"].estimate;
    // Standard deviation of the fit: sqrt(2 / 40000) 23 / 3600 / (2 pi 5) = 1.4 us; the correlation
    // has somewhat more.
    assert_close(fitted.value, 0.203, 0.0, 0.006);
    assert_close(correlated.value, fitted.value, 0.0, 0.008);
    assert!(correlated.high > correlated.value && correlated.high - correlated.low < 0.02);
}
