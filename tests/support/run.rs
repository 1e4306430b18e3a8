//! A small run with every kind of record, for the tests of gates and reports.

use fogbench::metrics::{ChannelFailure, ChannelMetrics, Estimate, Metric};
use fogbench::scenario::{PublishedConfig, Scenario};
use fogbench::signal::GyroFacts;
use std::collections::BTreeMap;

use super::reference_gyro::scenario_with;

/// What the reader makes of a scenario that gives nothing but a motion, e.g. `static = {}`.
pub(crate) fn default_scenario(motion: &str) -> Scenario {
    scenario_with("", motion)
}

/// A scenario whose motion is the given table, with two published figures.
pub(crate) fn scenario(motion: &str) -> Scenario {
    let published = |metric: &str, value: f64, unit: &str, source: &str| PublishedConfig {
        metric: metric.to_owned(),
        value,
        unit: unit.to_owned(),
        source: source.to_owned(),
        ..PublishedConfig::reference()
    };
    Scenario {
        published: vec![
            published("rls.delay_vs_raw_ms", 0.25, "ms", "paper, section 4.2"),
            published(
                "lms.angle_random_walk_deg_per_sqrt_h",
                0.006,
                "deg/sqrt(h)",
                "paper, table 2",
            ),
        ],
        ..default_scenario(motion)
    }
}

/// A gyro like the one of the paper.
pub(crate) fn gyro() -> GyroFacts {
    GyroFacts {
        scale_factor_s: 0.895_934,
        single_fringe_range_deg_per_s: 200.9,
        transit_time_us: 3.916_58,
        proper_frequency_khz: 127.66,
        output_rate_hz: 3989.45,
        loop_gain: 0.0937,
        loop_bandwidth_hz: 2000.0,
        delay_ms: 0.203,
        angle_random_walk_budget_deg_per_sqrt_h: vec![
            ("shot", 0.001_83),
            ("thermal", 0.004_57),
            ("amplifier", 0.001_51),
            ("rin", 0.000_96),
            ("adc", 0.002_94),
            ("total", 0.006),
        ],
        replaced_noise_sources: Vec::new(),
    }
}

/// A channel from keys, `value, low, high` and units.
pub(crate) fn channel(metrics: &[(&str, [f64; 3], &'static str)]) -> ChannelMetrics {
    let mut channel = ChannelMetrics::default();
    for (key, [value, low, high], unit) in metrics {
        let estimate = Estimate::with_interval(*value, *low, *high);
        let metric = Metric::new(estimate, unit);
        channel.metrics.insert((*key).to_owned(), metric);
    }
    channel
}

/// A curve from its columns.
pub(crate) fn curve(columns: &[(&str, Vec<f64>)]) -> BTreeMap<String, Vec<f64>> {
    columns
        .iter()
        .map(|(name, values)| ((*name).to_owned(), values.clone()))
        .collect()
}

/// Channels `raw`, `lms` and `rls`, and `bad`, which diverged.
pub(crate) fn channels() -> Vec<(String, ChannelMetrics)> {
    let arw = "angle_random_walk_deg_per_sqrt_h";
    let mut raw = channel(&[
        (arw, [0.006_012, 0.005_95, 0.006_074], "deg/sqrt(h)"),
        ("delay_vs_truth_ms", [0.203, 0.201, 0.205], "ms"),
        ("noise_gain", [1.0, 1.0, 1.0], "1"),
    ]);
    raw.curves.insert(
        "allan".to_owned(),
        curve(&[
            ("tau_s", vec![0.25, 1.0]),
            ("deviation_deg_per_h", vec![0.72, 0.36]),
            ("low_deg_per_h", vec![0.71, 0.35]),
            ("high_deg_per_h", vec![0.73, 0.37]),
        ]),
    );
    let lms = channel(&[
        (arw, [0.005_9, 0.005_84, 0.005_97], "deg/sqrt(h)"),
        ("delay_vs_raw_ms", [0.376, 0.375, 0.377], "ms"),
        ("dc_gain", [1.0, 1.0, 1.0], "1"),
    ]);
    let mut rls = channel(&[
        (arw, [0.002_9, 0.002_87, 0.002_93], "deg/sqrt(h)"),
        ("delay_vs_raw_ms", [0.34, 0.339, 0.341], "ms"),
        ("dc_gain", [0.49, 0.49, 0.49], "1"),
    ]);
    rls.metrics.insert(
        "bias_stability_deg_per_h".to_owned(),
        Metric::new(Estimate::with_interval(0.0606, 0.0495, 0.0782), "deg/h")
            .with("averaging_time_s", 100.0)
            .with("count", 36.0),
    );
    rls.unavailable.insert(
        "rate_random_walk_deg_per_h_per_sqrt_h".to_owned(),
        "the record is too short".into(),
    );
    let mut bad = channel(&[("diverged_at_s", [1.5, 1.5, 1.5], "s")]);
    bad.error = Some(ChannelFailure {
        kind: "diverged".to_owned(),
        sample: 5984,
        message: "a weight became infinite".to_owned(),
    });
    [("raw", raw), ("lms", lms), ("rls", rls), ("bad", bad)]
        .map(|(name, metrics)| (name.to_owned(), metrics))
        .to_vec()
}
