//! Whether a record of given length and motion can support a metric at all.

use super::catalogue::{Applies, KnownMetric, find, known_metrics};
use super::delay::{CYCLES_MIN, SwingClock};
use super::interval::round_to_count;
use super::record::Motion;

/// The name that is fewest edits away.
fn nearest(name: &str) -> &'static str {
    known_metrics()
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
            check_cycles(known, duration_s, sample_period_s, *frequency_hz)
        }
        _ => Ok(()),
    }
}

fn check_motion(known: &KnownMetric, motion: &Motion) -> Result<(), String> {
    let fits = matches!(
        (known.applies, motion),
        (Applies::Always | Applies::Pipeline, _)
            | (Applies::Steady | Applies::SteadyOrSwing, Motion::Steady)
            | (
                Applies::Swing | Applies::SteadyOrSwing | Applies::Moving,
                Motion::Swing { .. }
            )
            | (Applies::Steps | Applies::Moving, Motion::Steps { .. })
    );
    if fits {
        return Ok(());
    }
    let wanted = match known.applies {
        Applies::Always | Applies::Pipeline => "any motion",
        Applies::Steady => "a table at rest or at constant rate",
        Applies::Swing => "a swing",
        Applies::Steps => "steps",
        Applies::SteadyOrSwing => "a swing or a table at rest or at constant rate",
        Applies::Moving => "a swing or steps",
    };
    Err(format!("`{}` is defined for {wanted} only", known.name))
}

fn check_cycles(
    known: &KnownMetric,
    duration_s: f64,
    sample_period_s: f64,
    frequency_hz: f64,
) -> Result<(), String> {
    let clock = SwingClock {
        frequency_hz,
        sample_period_s,
        first_stamp_s: 0.0,
    };
    let samples = round_to_count((duration_s / sample_period_s).floor());
    let cycles = clock.whole_cycles(samples);
    let metric = known.name;
    let independent = known.applies == Applies::Pipeline
        || ["dc_gain", "dc_gain_adapted", "diverged_at_s"].contains(&metric);
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
