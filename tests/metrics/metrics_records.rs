//! Records of odd lengths and known weights: reasons instead of numbers, never a panic.

use std::f64::consts::TAU;

use fogbench::metrics::{
    ChannelMetrics, FilterFacts, Motion, NoiseDelayBound, Record, Settings, known_metrics, measure,
    noise_delay_bound, support,
};
use fogbench::signal::Rates;

use crate::support::assert_close;
use crate::support::records::{
    PERIOD_S, every_metric_is_answered, facts, settings, shape, value, white,
};

/// What `measure` says of a channel beside its raw record, the true rate being 8.47 deg/h.
fn measured(
    raw: &[f64],
    channel: &[f64],
    settings: &Settings,
    facts: Option<&FilterFacts>,
) -> ChannelMetrics {
    let truth = vec![8.47; raw.len()];
    let record = Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: raw,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 1.0,
        drift: None,
    };
    measure(&record, settings, facts)
}

#[test]
fn records_of_every_length_are_measured_or_refused_and_support_agrees() {
    let noise = white(1, 600, 22.8);
    let facts = facts();
    for count in 1..=600_usize {
        for motion in [
            Motion::Steady,
            Motion::Swing {
                frequency_hz: 100.0,
            },
            Motion::Steps {
                last_step_index: count / 3,
                step_deg_per_h: 100.0,
                staircase: fogbench::metrics::Staircase::default(),
            },
        ] {
            let raw: Vec<f64> = noise[..count]
                .iter()
                .enumerate()
                .map(|(k, noise)| match motion {
                    Motion::Swing { .. } => {
                        noise + 3600.0 * (TAU * 100.0 * PERIOD_S * k as f64).cos()
                    }
                    Motion::Steps {
                        last_step_index, ..
                    } if k >= last_step_index => noise + 100.0,
                    _ => *noise,
                })
                .collect();
            let halved: Vec<f64> = raw.iter().map(|value| value / 2.0).collect();
            let settings = settings(motion.clone());
            for (channel, facts) in [(&raw, None), (&halved, Some(&facts))] {
                let metrics = measured(&raw, channel, &settings, facts);
                every_metric_is_answered(&metrics);
                let duration_s = count as f64 * PERIOD_S;
                for known in known_metrics() {
                    let supported = support(
                        known.name,
                        duration_s,
                        PERIOD_S,
                        &motion,
                        facts.is_some(),
                        settings.bias_averaging_time_s,
                    );
                    assert!(
                        supported.is_ok() || !metrics.metrics.contains_key(known.name),
                        "{} of {count} samples, {motion:?}: {supported:?}",
                        known.name
                    );
                }
            }
        }
    }
}

#[test]
fn a_constant_output_is_said_not_to_vary() {
    let raw = white(2, 20_000, 22.8);
    let constant = vec![8.1; raw.len()];
    let metrics = measured(&raw, &constant, &settings(Motion::Steady), Some(&facts()));
    every_metric_is_answered(&metrics);
    let reason = metrics.unavailable["angle_random_walk_deg_per_sqrt_h"].as_str();
    assert_eq!(reason, "the output does not vary over the record");
}

/// White noise of 3.6 deg/h about 8.47 deg/h at 100 Hz through a gain that is redrawn about one half
/// every 0.1 s with the given relative deviation.
fn through_a_wandering_gain(deviation: f64) -> ChannelMetrics {
    let raw: Vec<f64> = white(3, 100_000, 3.6)
        .iter()
        .map(|noise| 8.47 + noise)
        .collect();
    let wander = white(4, 10_000, deviation);
    let output: Vec<f64> = raw
        .iter()
        .enumerate()
        .map(|(k, value)| 0.5 * (1.0 + wander[k / 10]) * value)
        .collect();
    let truth = vec![8.47; raw.len()];
    let record = Record {
        channel_deg_per_h: &output,
        raw_deg_per_h: &raw,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: 0.01,
        first_stamp_s: 0.0,
        drift: None,
    };
    let facts = FilterFacts {
        dc_gain: Some(0.5),
        // One weight reaches back no further than its sample.
        shape: shape(1, 0, vec![1.0]),
        ..facts()
    };
    let settings = Settings {
        fit_tau_min_s: 0.1,
        ..settings(Motion::Steady)
    };
    measure(&record, &settings, Some(&facts))
}

#[test]
fn weight_noise_of_a_wandering_gain_is_what_its_variance_says() {
    let still = through_a_wandering_gain(0.0);
    assert_close(value(&still, "weight_noise_ratio"), 1.0, 1e-9, 0.0);
    // AVAR at 1 s: noise 0.36^2 (1 + s^2), mean times gain 8.47^2 s^2 / 10.
    let s: f64 = 0.15;
    let excess = s * s * (1.0 + 8.47 * 8.47 / 10.0 / (0.36 * 0.36));
    let expected = (1.0 + excess).sqrt();
    let wandering = through_a_wandering_gain(s);
    let metric = &wandering.metrics["weight_noise_ratio"];
    // Numerator and denominator have 1500 degrees of freedom each and share half their noise:
    // relative standard error at most sqrt(2 / (2 x 1500)) = 2.6 %; four of them.
    assert_close(metric.estimate.value, expected, 0.104, 0.0);
    assert!(
        metric.estimate.low < expected && expected < metric.estimate.high,
        "{expected} {metric:?}"
    );
    assert!(
        metric.estimate.low > 1.3 && metric.estimate.high < 1.75,
        "{metric:?}"
    );
    assert_close(metric.fields["averaging_time_s"], 1.0, 0.0, 0.0);
}

#[test]
fn weight_noise_of_a_short_record_takes_the_longest_time_with_twenty_degrees_of_freedom() {
    // edf = 1.5 T / tau - 2 = 20 at T / tau = 14.7.
    let raw = white(5, 8000, 22.8);
    let metrics = measured(&raw, &raw, &settings(Motion::Steady), Some(&facts()));
    let time_s = metrics.metrics["weight_noise_ratio"].fields["averaging_time_s"];
    assert_close(time_s, 8000.0 * PERIOD_S / 14.67, 0.01, 0.0);
}

#[test]
fn the_bound_stands_at_the_delay_of_the_weights_that_ran() {
    let raw: Vec<f64> = white(6, 200_000, 22.8)
        .iter()
        .map(|noise| 8.47 + noise)
        .collect();
    let of = |mean_weights: Option<Vec<f64>>| {
        let facts = FilterFacts {
            shape: shape(4, 2, vec![1.0]),
            mean_weights,
            ..facts()
        };
        measured(&raw, &raw, &settings(Motion::Steady), Some(&facts))
    };
    // Ages 2 to 5: (2 x 0.3 + 3 x 0.1) / 0.4 = 2.25 samples.
    let ran = of(Some(vec![0.3, 0.1, 0.0, 0.0]));
    let name = "noise_delay_bound_noise_gain";
    let wanted = noise_delay_bound(4, 1, 2.25).unwrap();
    assert_close(value(&ran, name), wanted, 0.03, 0.0);
    assert_close(
        ran.metrics[name].fields["delay_ms"],
        2.25e3 * PERIOD_S,
        1e-9,
        0.0,
    );
    assert_close(value(&ran, "delay_at_dc_ms"), 2.25e3 * PERIOD_S, 1e-9, 0.0);
    // The output is raw itself: its noise over the bound is one over the bound.
    let over = value(&ran, "noise_gain_over_bound");
    assert_close(over, 1.0 / value(&ran, name), 1e-9, 0.0);
    assert_close(ran.metrics[name].fields["first_age_samples"], 0.0, 0.0, 0.0);
    // The curve is the bound at every delay: about 3 % of colour in white noise.
    let curve = &ran.curves["noise_delay_bound"];
    for (index, delay_ms) in curve["delay_ms"].iter().enumerate() {
        let delay = delay_ms / 1e3 / PERIOD_S;
        let wanted = NoiseDelayBound::white(4, 1).unwrap().at(delay).unwrap();
        let wanted = wanted.noise_gain;
        assert_close(curve["white_noise_gain"][index], wanted, 1e-9, 0.0);
        assert_close(curve["noise_gain"][index], wanted, 0.05, 0.0);
    }
    // Without them the Wiener weights of white noise with a mean, all alike, stand in: 3.5 samples.
    let predicted = of(None).metrics[name].fields["delay_ms"];
    assert_close(predicted, 3.5e3 * PERIOD_S, 0.05, 0.0);
}
