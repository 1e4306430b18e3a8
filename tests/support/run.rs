//! A small run with every kind of record, for the tests of gates and reports.

use fogbench::metrics::{ChannelFailure, ChannelMetrics, Estimate, Metric};
use fogbench::scenario::Scenario;
use fogbench::signal::GyroFacts;
use std::collections::BTreeMap;

/// Everything but the motion; `MOTION` stands for its table.
const SCENARIO: &str = r#"
schema = 1
name = "fixture"
description = "A fixture with every kind of record."
seed = 1
repeats = 1
duration_s = 3600.0
warm_up_s = 60.0
fidelity = "loop"
bias_averaging_time_s = 100.0
[turntable]
servo = { ideal = {} }
site = { latitude_deg = 34.27, axis_elevation_deg = 90.0, axis_azimuth_deg = 0.0 }
MOTION
[gyro]
coil = { length_m = 800.0, diameter_mm = 70.0, group_index = 1.4677 }
source = { wavelength_nm = 1310.0, power_uw = 0.87, linewidth_nm = 35.0, polarisation_degree = 1.0, visibility = 0.95 }
modulator = { depth_deg = 120.0, dac_bits = 16, scheme = "two-state", gain_error_ppm = 0.0, reset_sample = "demodulated", cross_coupling_urad = 0.0, cross_coupling_phase_deg = 0.0, dither_deg = 0.0, dither_interval_periods = 16, half_period_mismatch = 0.0, intensity_modulation = 0.0 }
detector = { responsivity_a_per_w = 0.9, dark_current_na = 0.0, transimpedance_kohm = 20.0, post_gain = 10.0, voltage_noise_nv_per_sqrt_hz = 6.0, current_noise_pa_per_sqrt_hz = 0.0, gate_duty = 0.7, gate_spikes = true }
adc = { bits = 12, range_v = 2.0, samples_per_half_period = 8 }
controller = { loop_bandwidth_hz = 2000.0, loop_latency_periods = 1, second_loop_gain = 0.0, step_bits = 0, step_limit_deg = 0.0 }
noise = { shot = true, thermal = true, amplifier = true, rin = true, draw = "combined" }
slow_noise = { bias_deg_per_h = 0.0, bias_instability_deg_per_h = 0.045, rate_random_walk_deg_per_h_per_sqrt_h = 0.005, rate_ramp_deg_per_h_per_h = 0.0 }
temperature = { soak = { temperature_c = 25.0 } }
output = { half_periods_per_sample = 64, rate_lsb_deg_per_s = 1e-4 }
[[published]]
metric = "rls.delay_vs_raw_ms"
value = 0.25
unit = "ms"
source = "paper, section 4.2"
[[published]]
metric = "lms.angle_random_walk_deg_per_sqrt_h"
value = 0.006
unit = "deg/sqrt(h)"
source = "paper, table 2"
[output]
samples = "none"
"#;

/// A scenario whose motion is the given table, e.g. `static = {}`.
pub(crate) fn scenario(motion: &str) -> Scenario {
    toml::from_str(&SCENARIO.replace("MOTION", motion)).expect("the fixture is a scenario")
}

/// A gyro like the one of the paper.
pub(crate) fn gyro() -> GyroFacts {
    GyroFacts {
        scale_factor_s: 0.895_934,
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
    }
}

/// A channel from keys, `value, low, high` and units.
pub(crate) fn channel(metrics: &[(&str, [f64; 3], &'static str)]) -> ChannelMetrics {
    ChannelMetrics {
        metrics: metrics
            .iter()
            .map(|(key, [value, low, high], unit)| {
                let estimate = Estimate::with_interval(*value, *low, *high);
                ((*key).to_owned(), Metric::new(estimate, unit))
            })
            .collect(),
        ..ChannelMetrics::default()
    }
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
        "the record is too short".to_owned(),
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
