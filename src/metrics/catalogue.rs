//! The metrics a channel can have: name, unit, definition, and what a record must offer for each.

use super::delay::{CYCLES_MIN, SwingClock};
use super::record::Motion;

/// Which records a metric belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Applies {
    /// Every record.
    Always,
    /// Steady motion: at rest or turning at a constant rate.
    Steady,
    /// Swing.
    Swing,
    /// Steps.
    Steps,
    /// Steady motion or swing.
    SteadyOrSwing,
    /// Swing or steps.
    Moving,
}

/// One entry of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownMetric {
    /// Key.
    pub name: &'static str,
    /// Unit as printed.
    pub unit: &'static str,
    /// Definition in one line.
    pub definition: &'static str,
    /// Motions it is defined for.
    pub applies: Applies,
    /// Whether only filters have it.
    pub filters_only: bool,
}

const fn any(
    name: &'static str,
    unit: &'static str,
    applies: Applies,
    definition: &'static str,
) -> KnownMetric {
    KnownMetric {
        name,
        unit,
        definition,
        applies,
        filters_only: false,
    }
}

const fn filter(
    name: &'static str,
    unit: &'static str,
    applies: Applies,
    definition: &'static str,
) -> KnownMetric {
    KnownMetric {
        name,
        unit,
        definition,
        applies,
        filters_only: true,
    }
}

const CATALOGUE: &[KnownMetric] = &[
    any(
        "angle_random_walk_deg_per_sqrt_h",
        "deg/sqrt(h)",
        Applies::Steady,
        "N of the fit to the overlapping Allan variance, N^2/tau",
    ),
    any(
        "bias_instability_deg_per_h",
        "deg/h",
        Applies::Steady,
        "B of the fit to the overlapping Allan variance, (0.664 B)^2: the flicker floor over 0.664",
    ),
    any(
        "rate_random_walk_deg_per_h_per_sqrt_h",
        "deg/h/sqrt(h)",
        Applies::Steady,
        "K of the fit to the overlapping Allan variance, K^2 tau/3",
    ),
    any(
        "rate_ramp_deg_per_h_per_h",
        "deg/h/h",
        Applies::Steady,
        "R of the fit to the overlapping Allan variance, R^2 tau^2/2",
    ),
    any(
        "quantisation_arcsec",
        "arcsec",
        Applies::Steady,
        "Q of the fit to the overlapping Allan variance, 3 Q^2/tau^2",
    ),
    any(
        "bias_stability_1s_deg_per_h",
        "deg/h",
        Applies::Steady,
        "standard deviation of non-overlapping 1 s means",
    ),
    any(
        "bias_stability_10s_deg_per_h",
        "deg/h",
        Applies::Steady,
        "standard deviation of non-overlapping 10 s means",
    ),
    any(
        "bias_stability_100s_deg_per_h",
        "deg/h",
        Applies::Steady,
        "standard deviation of non-overlapping 100 s means",
    ),
    any(
        "bias_stability_deg_per_h",
        "deg/h",
        Applies::Steady,
        "standard deviation of non-overlapping means over the scenario's bias_averaging_time_s",
    ),
    any(
        "mean_deg_per_h",
        "deg/h",
        Applies::Always,
        "mean over the record (over whole cycles in a swing)",
    ),
    any(
        "mean_error_deg_per_h",
        "deg/h",
        Applies::Always,
        "mean over the record minus the mean of the true rate",
    ),
    any(
        "noise_std_deg_per_h",
        "deg/h",
        Applies::Always,
        "standard deviation of the samples about the signal: mean, fitted sine, or settled rate",
    ),
    filter(
        "mean_ratio",
        "1",
        Applies::Always,
        "mean of the channel over the mean of raw",
    ),
    filter(
        "noise_gain",
        "1",
        Applies::Always,
        "variance about the signal over that of raw",
    ),
    filter(
        "dc_gain",
        "1",
        Applies::Always,
        "response to a small added rate with the weight sequence of the unperturbed run replayed",
    ),
    filter(
        "dc_gain_adapted",
        "1",
        Applies::Always,
        "response to a small added rate present from the first sample, the filter free to adapt",
    ),
    filter(
        "dc_gain_predicted",
        "1",
        Applies::SteadyOrSwing,
        "sum of the Wiener weights for the second moments of the raw record, mean included",
    ),
    filter(
        "angle_random_walk_over_dc_gain_deg_per_sqrt_h",
        "deg/sqrt(h)",
        Applies::Steady,
        "angle random walk once the scale factor is restored",
    ),
    filter(
        "bias_stability_over_dc_gain_deg_per_h",
        "deg/h",
        Applies::Steady,
        "bias stability once the scale factor is restored",
    ),
    filter(
        "noise_delay_bound_noise_gain",
        "1",
        Applies::SteadyOrSwing,
        "least noise gain any filter of as many taps has at this delay with unit DC gain",
    ),
    filter(
        "delay_vs_raw_ms",
        "ms",
        Applies::Swing,
        "phase delay behind the raw channel at the swing frequency",
    ),
    any(
        "delay_vs_truth_ms",
        "ms",
        Applies::Swing,
        "phase delay behind the true rate at the swing frequency",
    ),
    filter(
        "delay_predicted_ms",
        "ms",
        Applies::Swing,
        "phase delay of the Wiener weights behind raw at the swing frequency, register included",
    ),
    any(
        "amplitude_ratio",
        "1",
        Applies::Swing,
        "fitted amplitude over raw's; for raw itself over the true rate's",
    ),
    any(
        "harmonic_distortion_percent",
        "%",
        Applies::Swing,
        "harmonics 2 to 5 over the fundamental, noise power subtracted",
    ),
    any(
        "tracking_error_rms_deg_per_h",
        "deg/h",
        Applies::Moving,
        "root mean square difference from the true rate at the same stamps",
    ),
    any(
        "settling_time_s",
        "s",
        Applies::Steps,
        "time after the last step until the rate stays within max(1 % of the step, 5 sigma)",
    ),
    any(
        "diverged_at_s",
        "s",
        Applies::Always,
        "time at which the channel failed, from the start of the warm-up; absent if it did not",
    ),
];

/// Every metric a channel can have, in the order tables print them.
#[must_use]
pub fn known_metrics() -> &'static [KnownMetric] {
    CATALOGUE
}

/// The entry of a name.
pub(crate) fn find(name: &str) -> Option<&'static KnownMetric> {
    CATALOGUE.iter().find(|known| known.name == name)
}

/// The name that is fewest edits away.
fn nearest(name: &str) -> &'static str {
    CATALOGUE
        .iter()
        .min_by_key(|known| edit_distance(name, known.name))
        .map_or("", |known| known.name)
}

/// Levenshtein distance.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

/// Fewest blocks of which a bias stability is given.
pub(crate) const BLOCKS_MIN: usize = 5;

/// Fewest samples of which an angle random walk can be fitted: eight tau points up to a ninth.
const FIT_SAMPLES_MIN: f64 = 900.0;

/// Shortest record, s, of which B, K or R can be fitted: the fit must reach 10 s.
const SLOW_NOISE_DURATION_MIN_S: f64 = 90.0;

/// Whether a record of this length and motion can ever support a metric.
///
/// A metric may still be missing from a particular record whose noise does not show it.
///
/// # Errors
/// The reason, in words: unknown name (with the nearest known one), wrong motion or channel, or too
/// short a record (with the length it takes).
pub fn support(
    metric: &str,
    duration_s: f64,
    sample_period_s: f64,
    motion: &Motion,
    is_filter: bool,
    bias_averaging_time_s: f64,
) -> Result<(), String> {
    let Some(known) = find(metric) else {
        return Err(format!(
            "`{metric}` is not a metric; the nearest is `{}`",
            nearest(metric)
        ));
    };
    if known.filters_only && !is_filter {
        return Err(format!(
            "`{metric}` compares a filter with the raw channel; raw itself has none"
        ));
    }
    check_motion(known, motion)?;
    let needed_s = match metric {
        "angle_random_walk_deg_per_sqrt_h"
        | "angle_random_walk_over_dc_gain_deg_per_sqrt_h"
        | "quantisation_arcsec" => FIT_SAMPLES_MIN * sample_period_s,
        "bias_instability_deg_per_h"
        | "rate_random_walk_deg_per_h_per_sqrt_h"
        | "rate_ramp_deg_per_h_per_h" => SLOW_NOISE_DURATION_MIN_S,
        "bias_stability_1s_deg_per_h" => BLOCKS_MIN as f64,
        "bias_stability_10s_deg_per_h" => BLOCKS_MIN as f64 * 10.0,
        "bias_stability_100s_deg_per_h" => BLOCKS_MIN as f64 * 100.0,
        "bias_stability_deg_per_h" | "bias_stability_over_dc_gain_deg_per_h" => {
            BLOCKS_MIN as f64 * bias_averaging_time_s
        }
        _ => 0.0,
    };
    if duration_s < needed_s * (1.0 - 1e-9) {
        return Err(format!(
            "`{metric}` needs a record of at least {needed_s} s; this one has {duration_s} s"
        ));
    }
    match motion {
        Motion::Swing { frequency_hz } => {
            check_cycles(metric, duration_s, sample_period_s, *frequency_hz)
        }
        _ => Ok(()),
    }
}

fn check_motion(known: &KnownMetric, motion: &Motion) -> Result<(), String> {
    let fits = match (known.applies, motion) {
        (Applies::Always, _)
        | (Applies::Steady | Applies::SteadyOrSwing, Motion::Steady)
        | (Applies::Swing | Applies::SteadyOrSwing | Applies::Moving, Motion::Swing { .. })
        | (Applies::Steps | Applies::Moving, Motion::Steps { .. }) => true,
        _ => false,
    };
    if fits {
        return Ok(());
    }
    let wanted = match known.applies {
        Applies::Always => "any motion",
        Applies::Steady => "a table at rest or at constant rate",
        Applies::Swing => "a swing",
        Applies::Steps => "steps",
        Applies::SteadyOrSwing => "a swing or a table at rest or at constant rate",
        Applies::Moving => "a swing or steps",
    };
    Err(format!("`{}` is defined for {wanted} only", known.name))
}

fn check_cycles(
    metric: &str,
    duration_s: f64,
    sample_period_s: f64,
    frequency_hz: f64,
) -> Result<(), String> {
    let clock = SwingClock {
        frequency_hz,
        sample_period_s,
        first_stamp_s: 0.0,
    };
    let samples = super::interval::round_to_count((duration_s / sample_period_s).floor());
    let cycles = clock.whole_cycles(samples);
    let independent = ["dc_gain", "dc_gain_adapted", "diverged_at_s"].contains(&metric);
    if cycles < CYCLES_MIN && !independent {
        return Err(format!(
            "`{metric}` needs {CYCLES_MIN} whole cycles of {frequency_hz} Hz; {duration_s} s hold \
             {cycles}"
        ));
    }
    if frequency_hz * sample_period_s > 0.25 && !independent {
        return Err(format!(
            "`{metric}` needs four samples per cycle of {frequency_hz} Hz"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 1.0 / 3989.45;

    fn ask(metric: &str, duration_s: f64, motion: &Motion, is_filter: bool) -> Result<(), String> {
        support(metric, duration_s, PERIOD_S, motion, is_filter, 100.0)
    }

    #[test]
    fn a_misspelt_metric_is_answered_with_the_nearest() {
        let answer = ask("delay_vs_row_ms", 20.0, &Motion::Steady, true).unwrap_err();
        assert!(answer.contains("`delay_vs_raw_ms`"), "{answer}");
    }

    #[test]
    fn support_knows_motion_channel_and_duration() {
        let swing = Motion::Swing { frequency_hz: 5.0 };
        assert!(ask("delay_vs_raw_ms", 20.0, &swing, true).is_ok());
        assert!(ask("delay_vs_raw_ms", 20.0, &swing, false).is_err());
        assert!(ask("delay_vs_raw_ms", 0.4, &swing, true).is_err());
        assert!(ask("delay_vs_raw_ms", 20.0, &Motion::Steady, true).is_err());
        assert!(ask("bias_stability_deg_per_h", 499.0, &Motion::Steady, false).is_err());
        assert!(ask("bias_stability_deg_per_h", 500.0, &Motion::Steady, false).is_ok());
        assert!(ask("settling_time_s", 1.0, &swing, false).is_err());
    }
}
