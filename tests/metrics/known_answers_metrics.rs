//! Closed-form answers for whole records: what `measure` and `aggregate` enter.

use std::f64::consts::TAU;

use fogbench::metrics::{
    ChannelMetrics, Motion, Record, SwingClock, aggregate, measure, noise_delay_bound, support,
};
use fogbench::signal::Rates;
use fogbench::units;

use crate::support::assert_close;
use crate::support::records::{
    PERIOD_S, every_metric_is_answered, facts, raw_record, settings, sine, value, white,
};

/// A channel that is the two-sample mean of raw, one sample late, as a filter of known answers.
fn two_sample_mean(raw: &[f64]) -> Vec<f64> {
    (0..raw.len())
        .map(|k| match k {
            0 | 1 => raw[0],
            _ => 0.5 * (raw[k - 1] + raw[k - 2]),
        })
        .collect()
}

fn steady(seed: u64, samples: usize) -> [ChannelMetrics; 2] {
    let mut raw = white(seed, samples, 22.8);
    for value in &mut raw {
        *value += 8.47;
    }
    let filtered = two_sample_mean(&raw);
    let truth = vec![8.4; raw.len()];
    let record = |channel| Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: &raw,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 1.0,
        drift: None,
    };
    let settings = settings(Motion::Steady);
    [
        measure(&record(&raw[..]), &settings, None),
        measure(&record(&filtered[..]), &settings, Some(&facts())),
    ]
}

#[test]
fn a_steady_record_is_measured_as_theory_says() {
    let samples = 200_000;
    let [raw, filtered] = steady(9, samples);
    every_metric_is_answered(&raw);
    every_metric_is_answered(&filtered);
    // sqrt(1/2n) = 0.16 % on a standard deviation; five of them.
    assert_close(value(&raw, "noise_std_deg_per_h"), 22.8, 0.008, 0.0);
    assert_close(value(&filtered, "noise_gain"), 0.5, 0.01, 0.0);
    assert_close(value(&filtered, "mean_ratio"), 1.0, 1e-3, 0.0);
    let walk = units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(22.8 * PERIOD_S.sqrt());
    for channel in [&raw, &filtered] {
        let metric = &channel.metrics["angle_random_walk_deg_per_sqrt_h"];
        assert!(
            metric.estimate.low < walk && walk < metric.estimate.high,
            "{metric:?}"
        );
        assert!(metric.estimate.high / metric.estimate.low < 1.1);
    }
    let walk_name = "angle_random_walk_deg_per_sqrt_h";
    assert_close(
        value(&filtered, "angle_random_walk_over_dc_gain_deg_per_sqrt_h"),
        value(&filtered, walk_name) / 0.8,
        1e-12,
        0.0,
    );
    // The mean of n white samples: s / sqrt(n).
    let error = &raw.metrics["mean_error_deg_per_h"].estimate;
    let predicted = 22.8 / (samples as f64).sqrt();
    // Of noise that is white and no other is known of, the interval is its own.
    let widening = (error.high - error.low) / (2.0 * 1.96 * predicted);
    assert!((0.7..1.4).contains(&widening), "{widening}");
    assert_close(error.value, 0.07, 0.0, 4.0 * predicted);
    // Desired in reach: the prediction is the mean itself, and the bound at 1.5 samples is met.
    assert_close(value(&filtered, "dc_gain_predicted"), 1.0, 1e-9, 0.0);
    let bound = value(&filtered, "noise_delay_bound_noise_gain");
    assert_close(bound, noise_delay_bound(10, 1, 1.5).unwrap(), 0.05, 0.0);
}

#[test]
fn repeats_are_pooled_and_narrow_the_interval() {
    let repeats: Vec<ChannelMetrics> = (0..6)
        .map(|seed| steady(100 + seed, 60_000)[1].clone())
        .collect();
    let pooled = aggregate(&repeats);
    every_metric_is_answered(&pooled);
    let name = "angle_random_walk_deg_per_sqrt_h";
    let width = |metrics: &ChannelMetrics| {
        let estimate = metrics.metrics[name].estimate;
        estimate.high - estimate.low
    };
    let single: f64 = repeats.iter().map(width).sum::<f64>() / 6.0;
    assert_close(width(&pooled), single / 6.0_f64.sqrt(), 0.25, 0.0);
    assert_close(pooled.metrics[name].fields["repeats"], 6.0, 0.0, 0.0);
    let stability = "bias_stability_deg_per_h";
    let squares: f64 = repeats.iter().map(|r| value(r, stability).powi(2)).sum();
    assert_close(
        value(&pooled, stability),
        (squares / 6.0).sqrt(),
        1e-12,
        0.0,
    );
}

#[test]
fn a_swing_record_is_measured_as_theory_says() {
    let clock = SwingClock {
        frequency_hz: 5.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: 20.0,
    };
    let samples = 80_000;
    let truth = sine(&clock, samples, 3600.0, 0.0);
    let gyro = sine(&clock, samples, 3600.0, 203e-6);
    let noise = white(12, samples, 19.0);
    let raw: Vec<f64> = gyro.iter().zip(&noise).map(|(a, b)| a + b).collect();
    let filtered = two_sample_mean(&raw);
    let record = |channel| Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: &raw,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 20.0,
        drift: None,
    };
    let settings = settings(Motion::Swing { frequency_hz: 5.0 });
    let of_raw = measure(&record(&raw[..]), &settings, None);
    let of_filter = measure(&record(&filtered[..]), &settings, Some(&facts()));
    every_metric_is_answered(&of_raw);
    every_metric_is_answered(&of_filter);
    // Cramer-Rao bound of one series: sqrt(2/80000) x 19/3600 / 2 pi 5 = 0.84 us.
    assert_close(
        value(&of_raw, "delay_vs_truth_ms"),
        0.203,
        0.0,
        4.0 * 0.84e-3,
    );
    let late = units::s_to_ms(1.5 * PERIOD_S);
    // Noise common to both cancels but for its move by 1.5 samples of an 800-sample cycle.
    assert_close(value(&of_filter, "delay_vs_raw_ms"), late, 0.0, 1e-4);
    assert_close(value(&of_filter, "delay_predicted_ms"), late, 0.0, 1e-6);
    let interval = of_filter.metrics["delay_vs_raw_ms"].estimate;
    assert!(interval.high - interval.low < 1e-4, "{interval:?}");
    assert_close(value(&of_filter, "amplitude_ratio"), 1.0, 1e-4, 0.0);
    assert_close(value(&of_filter, "noise_gain"), 0.5, 0.03, 0.0);
    assert_close(value(&of_raw, "noise_std_deg_per_h"), 19.0, 0.01, 0.0);
    // Lag w d A / sqrt(2) of the motion and the noise, in quadrature.
    let lag = TAU * 5.0 * 203e-6 * 3600.0 / 2.0_f64.sqrt();
    let tracking = value(&of_raw, "tracking_error_rms_deg_per_h");
    assert_close(tracking, lag.hypot(19.0), 0.02, 0.0);
    assert!(value(&of_raw, "harmonic_distortion_percent") < 0.01);
}

#[test]
fn a_step_record_settles() {
    let mut raw = white(5, 8000, 1.0);
    let mut truth = vec![0.0; 8000];
    for k in 4000..8000_i32 {
        let index = usize::try_from(k).unwrap();
        truth[index] = 3600.0;
        raw[index] += 3600.0 * (1.0 - (-f64::from(k - 3999) / 20.0).exp());
    }
    let motion = Motion::Steps {
        last_step_index: 4000,
        step_deg_per_h: 3600.0,
        staircase: fogbench::metrics::Staircase::default(),
    };
    let record = raw_record(&raw, &truth);
    let metrics = measure(&record, &settings(motion), None);
    every_metric_is_answered(&metrics);
    // ln(100) time constants of 20 samples are 92.1 samples; noise of 1 in a band of 36 moves the
    // crossing by a few samples at most.
    let expected = 92.1 * PERIOD_S;
    assert_close(
        value(&metrics, "settling_time_s"),
        expected,
        0.0,
        5.0 * PERIOD_S,
    );
    assert_close(value(&metrics, "noise_std_deg_per_h"), 1.0, 0.1, 0.0);
}

#[test]
fn a_record_too_short_or_not_finite_gives_reasons_and_no_numbers() {
    for raw in [vec![1.0; 10], vec![f64::NAN; 1000]] {
        let record = Record {
            channel_deg_per_h: &raw,
            raw_deg_per_h: &raw,
            truth_deg_per_h: Rates::Words(&raw),
            response_deg_per_h: &[],
            encoder_rad: None,
            sample_period_s: PERIOD_S,
            first_stamp_s: 0.0,
            drift: None,
        };
        let metrics = measure(&record, &settings(Motion::Steady), None);
        assert!(metrics.metrics.is_empty());
        every_metric_is_answered(&metrics);
    }
}

#[test]
fn support_agrees_with_what_measure_delivers() {
    let [_, filtered] = steady(1, 60_000);
    let duration_s = 60_000.0 * PERIOD_S;
    for known in fogbench::metrics::known_metrics() {
        let supported = support(known.name, duration_s, PERIOD_S, &Motion::Steady, true, 2.0);
        if filtered.metrics.contains_key(known.name) {
            assert!(supported.is_ok(), "{}: {supported:?}", known.name);
        }
    }
}

#[test]
fn a_noise_free_record_has_no_noise_gain_and_no_false_numbers() {
    let raw = vec![8.1; 20_000];
    let record = Record {
        channel_deg_per_h: &raw,
        raw_deg_per_h: &raw,
        truth_deg_per_h: Rates::Words(&raw),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
        drift: None,
    };
    let metrics = measure(&record, &settings(Motion::Steady), Some(&facts()));
    every_metric_is_answered(&metrics);
    assert!(metrics.unavailable.contains_key("noise_gain"));
    assert!(value(&metrics, "noise_std_deg_per_h") < 1e-9);
    assert_close(value(&metrics, "mean_ratio"), 1.0, 1e-12, 0.0);
}
