//! Records and settings that the tests of the metrics share.

use std::f64::consts::TAU;

use fogbench::metrics::{
    AllanOptions, Applies, ChannelMetrics, FilterFacts, Motion, Record, Settings, SwingClock,
};
use fogbench::random::Streams;
use fogbench::signal::{FilterShape, Rates, WeightRule};

/// Sample period of the gyro under test, s.
pub(crate) const PERIOD_S: f64 = 64.0 * 3.916_576e-6;

/// Standard normal draws of a source.
pub(crate) fn normals(seed: u64, source: &str, count: usize) -> Vec<f64> {
    let mut values = vec![0.0; count];
    Streams::new(seed, 0)
        .stream(source)
        .fill_normal(&mut values);
    values
}

pub(crate) fn white(seed: u64, count: usize, deviation: f64) -> Vec<f64> {
    let mut values = normals(seed, "white", count);
    for value in &mut values {
        *value *= deviation;
    }
    values
}

/// Samples of `offset + amplitude cos(2 pi f (t - delay))` at the stamps of a clock.
pub(crate) fn sine(clock: &SwingClock, count: usize, amplitude: f64, delay_s: f64) -> Vec<f64> {
    (0..count)
        .map(|k| {
            let time_s = clock.first_stamp_s + k as f64 * clock.sample_period_s;
            8.47 + amplitude * (TAU * ((time_s - delay_s) * clock.frequency_hz).fract()).cos()
        })
        .collect()
}

pub(crate) fn shape(
    taps: usize,
    newest_age_samples: usize,
    desired_weights: Vec<f64>,
) -> FilterShape {
    FilterShape {
        taps: Some(taps),
        newest_age_samples,
        register_samples: 1,
        rule: WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one: false,
            forgetting_factor: None,
        },
    }
}

pub(crate) fn facts() -> FilterFacts {
    FilterFacts {
        shape: shape(10, 1, vec![0.5, 0.5]),
        dc_gain: Some(0.8),
        dc_gain_adapted: None,
        block_weights: Vec::new(),
        block_dc_gains_adapted: Vec::new(),
        learning: None,
        weights_of_other_runs: Vec::new(),
        two_runs: None,
        mean_weights: None,
        added_rate_deg_per_h: 1.0,
        rate_gains: Vec::new(),
        latency_s: 0.0,
    }
}

pub(crate) fn settings(motion: Motion) -> Settings {
    Settings {
        motion,
        bias_averaging_time_s: 2.0,
        fit_tau_min_s: 10.0 * PERIOD_S,
        allan: AllanOptions::default(),
        bridges: Vec::new(),
    }
}

/// The record of an unfiltered gyro of [`PERIOD_S`] from time 0 on.
pub(crate) fn raw_record<'a>(raw: &'a [f64], truth: &'a [f64]) -> Record<'a> {
    Record {
        channel_deg_per_h: raw,
        raw_deg_per_h: raw,
        truth_deg_per_h: Rates::Words(truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 0.0,
        drift: None,
    }
}

pub(crate) fn value(metrics: &ChannelMetrics, name: &str) -> f64 {
    metrics.metrics[name].estimate.value
}

pub(crate) fn every_metric_is_answered(metrics: &ChannelMetrics) {
    let known = fogbench::metrics::known_metrics().iter();
    // Those of estimates are no metrics of a record, logs are examined beside it, twins run where a scenario
    // asks for it, and fixed-point words are those of some pipelines.
    let of_record = |applies| {
        !matches!(
            applies,
            Applies::Calibration | Applies::Log | Applies::Twins | Applies::FixedPoint
        )
    };
    for known in known.filter(|known| of_record(known.applies)) {
        let answered = metrics.metrics.contains_key(known.name)
            != metrics.unavailable.contains_key(known.name);
        assert!(
            answered != (known.name == "diverged_at_s"),
            "{}",
            known.name
        );
    }
    for (name, metric) in &metrics.metrics {
        let estimate = metric.estimate;
        let ordered = estimate.low <= estimate.value && estimate.value <= estimate.high;
        assert!(ordered && estimate.high.is_finite(), "{name}: {estimate:?}");
    }
}
