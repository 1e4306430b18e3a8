//! Which metrics matter for which motion, and how they are headed.

use crate::gate::{estimate_text, plain};
use crate::metrics::{ChannelMetrics, Metric};
use crate::scenario::MotionConfig;
use std::collections::BTreeSet;

/// Digits of an interval's half width in tables.
pub(crate) const DIGITS: i32 = 2;

/// One column of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Column {
    /// Metric key.
    pub(crate) key: String,
    /// Heading.
    pub(crate) title: String,
}

const STATIC: &[(&str, &str)] = &[
    ("angle_random_walk_deg_per_sqrt_h", "ARW"),
    (
        "angle_random_walk_over_dc_gain_deg_per_sqrt_h",
        "ARW / DC gain",
    ),
    ("weight_noise_ratio", "weight noise"),
    ("bias_stability_deg_per_h", "bias stability"),
    (
        "bias_stability_over_dc_gain_deg_per_h",
        "bias stability / DC gain",
    ),
    ("bias_instability_deg_per_h", "bias instability"),
    ("bias_repeatability_deg_per_h", "bias repeatability"),
    ("mean_deg_per_h", "mean"),
    ("mean_error_deg_per_h", "mean error"),
    ("mean_ratio", "mean / raw mean"),
    ("dc_gain", "DC gain"),
    ("dc_gain_predicted", "DC gain predicted"),
    ("dc_gain_adapted", "DC gain adapted"),
    ("noise_std_deg_per_h", "noise std"),
    ("noise_gain", "noise power gain"),
    ("noise_delay_bound_noise_gain", "least at this delay"),
    ("delay_at_dc_ms", "delay at DC"),
];

/// Columns of the same records that need no word where they are absent: most gyros show none.
const STATIC_IF_SHOWN: &[(&str, &str)] = &[
    ("rate_random_walk_deg_per_h_per_sqrt_h", "rate random walk"),
    ("rate_ramp_deg_per_h_per_h", "rate ramp"),
    ("quantisation_arcsec", "quantisation"),
];

const SWING: &[(&str, &str)] = &[
    ("delay_vs_raw_ms", "delay vs raw"),
    ("delay_predicted_ms", "predicted"),
    ("delay_vs_truth_ms", "delay vs truth"),
    ("delay_vs_encoder_ms", "delay vs encoder"),
    ("amplitude_ratio", "amplitude ratio"),
    ("harmonic_distortion_percent", "harmonic distortion"),
    ("tracking_error_rms_deg_per_h", "tracking error rms"),
    ("noise_std_deg_per_h", "noise std"),
    ("noise_gain", "noise power gain"),
    ("noise_delay_bound_noise_gain", "least at this delay"),
    ("dc_gain", "DC gain"),
    ("dc_gain_predicted", "DC gain predicted"),
    ("readaptation_time_s", "readaptation"),
];

const MULTI_SINE: &[(&str, &str)] = &[
    ("delay_vs_raw_ms", "delay vs raw"),
    ("delay_vs_truth_ms", "delay vs truth"),
    ("amplitude_ratio", "amplitude ratio"),
    ("bandwidth_hz", "bandwidth"),
    ("tracking_error_rms_deg_per_h", "tracking error rms"),
    ("noise_std_deg_per_h", "noise std"),
    ("noise_gain", "noise power gain"),
    ("dc_gain", "DC gain"),
];

const STEPS: &[(&str, &str)] = &[
    ("settling_time_s", "settling time"),
    ("rise_time_s", "rise time"),
    ("overshoot_percent", "overshoot"),
    ("mean_deg_per_h", "mean"),
    ("mean_error_deg_per_h", "mean error"),
    ("mean_ratio", "mean / raw mean"),
    ("scale_factor_error_ppm", "scale factor error"),
    ("scale_factor_nonlinearity_ppm", "nonlinearity"),
    (
        "scale_factor_nonlinearity_of_reading_ppm",
        "nonlinearity of reading",
    ),
    ("scale_factor_asymmetry_ppm", "asymmetry"),
    (
        "scale_factor_repeatability_ppm",
        "scale factor repeatability",
    ),
    ("threshold_deg_per_h", "threshold"),
    ("dead_band_deg_per_h", "dead band"),
    ("resolution_deg_per_h", "resolution"),
    ("tracking_error_rms_deg_per_h", "tracking error rms"),
    ("noise_std_deg_per_h", "noise std"),
    ("noise_gain", "noise power gain"),
    ("dc_gain", "DC gain"),
    ("settled_gain", "settled gain"),
    ("readaptation_time_s", "readaptation"),
];

/// A record of many rates: what filters do to a constant, and what the estimates are worth.
const CAMPAIGN: &[(&str, &str)] = &[
    ("dc_gain", "DC gain"),
    ("dc_gain_predicted", "DC gain predicted"),
    ("bias_error_rms_deg_per_h", "bias error rms"),
    ("scale_factor_error_rms_ppm", "scale factor error rms"),
];

const STATIC_HEADLINE: &[&str] = &[
    "angle_random_walk_deg_per_sqrt_h",
    "bias_stability_deg_per_h",
    "mean_deg_per_h",
    "dc_gain",
];
const SWING_HEADLINE: &[&str] = &["delay_vs_raw_ms", "amplitude_ratio", "noise_std_deg_per_h"];
const MULTI_SINE_HEADLINE: &[&str] = &["delay_vs_truth_ms", "bandwidth_hz", "noise_std_deg_per_h"];
const STEPS_HEADLINE: &[&str] = &[
    "settling_time_s",
    "mean_error_deg_per_h",
    "scale_factor_error_ppm",
    "noise_std_deg_per_h",
];

const SCALE_FACTOR_HEADLINE: &[&str] = &[
    "scale_factor_error_ppm",
    "scale_factor_nonlinearity_ppm",
    "scale_factor_nonlinearity_of_reading_ppm",
    "scale_factor_asymmetry_ppm",
];

const GENERAL_HEADLINE: &[&str] = &[
    "tracking_error_rms_deg_per_h",
    "mean_error_deg_per_h",
    "bias_error_rms_deg_per_h",
    "scale_factor_error_rms_ppm",
];

/// Metrics of every motion that stand last: how a channel failed, what a pipeline costs.
const ALWAYS: &[(&str, &str)] = &[
    ("predicted_failure_s", "predicted failure"),
    ("diverged_at_s", "diverged at"),
    ("latency_us", "latency"),
    ("sample_period_us", "pipeline period"),
];

fn known(motion: &MotionConfig) -> &'static [(&'static str, &'static str)] {
    match motion {
        MotionConfig::Static(_) | MotionConfig::Rotation(_) => STATIC,
        MotionConfig::Swing(_) => SWING,
        MotionConfig::MultiSine(_) => MULTI_SINE,
        MotionConfig::Steps(_)
        | MotionConfig::ScaleFactorTest(_)
        | MotionConfig::Trapezoid(_)
        | MotionConfig::Chirp(_)
        | MotionConfig::Script(_) => STEPS,
        MotionConfig::Calibration(_) => CAMPAIGN,
    }
}

/// Heading of a metric that has none of its own: its key without underscores.
fn title_of(motion: &MotionConfig, key: &str) -> String {
    known(motion)
        .iter()
        .chain(STATIC_IF_SHOWN)
        .chain(ALWAYS)
        .find(|(other, _)| *other == key)
        .map_or_else(|| key.replace('_', " "), |(_, title)| (*title).to_owned())
}

/// Heading of a metric whatever the motion; its averaging time stands beside the unit.
pub(crate) fn heading_of(key: &str) -> String {
    let key = match key {
        "bias_stability_1s_deg_per_h"
        | "bias_stability_10s_deg_per_h"
        | "bias_stability_100s_deg_per_h" => "bias_stability_deg_per_h",
        other => other,
    };
    let all = [STATIC, SWING, MULTI_SINE, STEPS, ALWAYS];
    let mut known = all.iter().copied().flatten();
    known
        .find(|(other, _)| *other == key)
        .map_or_else(|| key.replace('_', " "), |(_, title)| (*title).to_owned())
}

/// The columns that at least one channel fills, in a fixed order; any other prediction of theory
/// stands behind the known ones.
pub(crate) fn columns(motion: &MotionConfig, channels: &[(String, ChannelMetrics)]) -> Vec<Column> {
    let present: BTreeSet<&str> = channels
        .iter()
        .flat_map(|(_, metrics)| metrics.metrics.keys())
        .map(String::as_str)
        .collect();
    let mut keys: Vec<&str> = known(motion).iter().map(|(key, _)| *key).collect();
    let predictions = present
        .iter()
        .copied()
        .filter(|key| key.contains("predict"));
    keys.extend(predictions);
    keys.extend(STATIC_IF_SHOWN.iter().map(|(key, _)| *key));
    keys.extend(ALWAYS.iter().map(|(key, _)| *key));
    let mut seen = BTreeSet::new();
    keys.into_iter()
        .filter(|key| present.contains(key) && seen.insert(*key))
        .map(|key| Column {
            key: key.to_owned(),
            title: title_of(motion, key),
        })
        .collect()
}

/// Whether the table of this motion has a column for the metric.
pub(crate) fn matters(motion: &MotionConfig, key: &str) -> bool {
    known(motion).iter().any(|(column, _)| *column == key)
}

/// Unit of a column, with the averaging time where that defines the metric.
pub(crate) fn unit_text(metric: &Metric) -> String {
    let unit = if metric.unit == "1" { "" } else { metric.unit };
    match metric.fields.get("averaging_time_s") {
        Some(time) if unit.is_empty() => format!("{} s", plain(*time)),
        Some(time) => format!("{unit}, {} s", plain(*time)),
        None => unit.to_owned(),
    }
}

/// A metric with its interval and, where the fitted noise makes one expect a value, that beside it.
pub(crate) fn value_text(metric: &Metric) -> String {
    let text = estimate_text(&metric.estimate, DIGITS);
    match metric.fields.get("expected_deg_per_h") {
        Some(expected) => {
            // Three digits.
            let rounded = format!("{expected:.2e}").parse().unwrap_or(*expected);
            format!("{text}, expected {}", plain(rounded))
        }
        None => text,
    }
}

/// The few figures of a channel that stand for it in the suite's table: heading, value and unit.
pub(crate) fn headline(motion: &MotionConfig, metrics: &ChannelMetrics) -> Vec<(String, String)> {
    let keys = match motion {
        MotionConfig::Static(_) => STATIC_HEADLINE,
        MotionConfig::Swing(_) => SWING_HEADLINE,
        MotionConfig::Trapezoid(_)
        | MotionConfig::Chirp(_)
        | MotionConfig::Script(_)
        | MotionConfig::Calibration(_) => GENERAL_HEADLINE,
        MotionConfig::MultiSine(_) => MULTI_SINE_HEADLINE,
        MotionConfig::ScaleFactorTest(_) => SCALE_FACTOR_HEADLINE,
        MotionConfig::Steps(_) | MotionConfig::Rotation(_) => STEPS_HEADLINE,
    };
    keys.iter()
        .filter_map(|key| {
            let metric = metrics.metrics.get(*key)?;
            let value = value_text(metric);
            let text = format!("{value} {}", unit_text(metric));
            Some((title_of(motion, key), text.trim_end().to_owned()))
        })
        .collect()
}
