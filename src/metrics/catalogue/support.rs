//! Whether a record of given length and motion can support a metric at all.

use super::list::find;
use super::names::unknown_of_channel;
use crate::metrics::allan::entry::SLOW_NOISE_DURATION_MIN_S;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::reason::{NO_TRUTH, Unavailable, too_short};
use crate::metrics::key::metric::{Against, Applies, MetricKey, Needs};
use crate::metrics::noise::bias_stability::{BLOCKS_MIN, averaging_lack};
use crate::metrics::record::{Motion, SAMPLES_MIN};
use crate::metrics::sine::fit::{CYCLES_MIN, SwingClock};
use crate::metrics::steps::scale_factor::{RATES_MIN, RATES_PER_SENSE_MIN};
use crate::metrics::steps::settling::{STEP_SAMPLES_MIN, tail_start};
use crate::metrics::steps::staircase::lack;
use crate::wording::plain;

/// Fewest samples of which an angle random walk can be fitted: eight tau points up to a ninth.
const FIT_SAMPLES_MIN: f64 = 900.0;

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
) -> Result<(), Unavailable> {
    let Some(known) = find(metric) else {
        let complaint = unknown_of_channel(metric, is_filter);
        return Err(complaint.unwrap_or_default().into());
    };
    if known.filters_only && !is_filter {
        return Err(format!(
            "`{metric}` compares a filter with the raw channel; raw itself has none"
        )
        .into());
    }
    check_motion(known, motion)?;
    let averaging_time_s = match known.needs {
        Needs::Blocks(averaging_time_s) => Some(averaging_time_s),
        Needs::ScenarioBlocks => Some(bias_averaging_time_s),
        _ => None,
    };
    if let Some(lack) = averaging_time_s.and_then(|it| averaging_lack(it, sample_period_s)) {
        return Err(format!("`{metric}`: {lack}").into());
    }
    let needed_s = match known.needs {
        Needs::AllanFit => FIT_SAMPLES_MIN * sample_period_s,
        Needs::SlowNoiseFit => SLOW_NOISE_DURATION_MIN_S,
        _ => averaging_time_s.map_or(0.0, |it| BLOCKS_MIN as f64 * it),
    };
    if duration_s < needed_s * (1.0 - 1e-9) {
        return Err(too_short(metric, needed_s, duration_s));
    }
    if known.needs == Needs::Nothing {
        return Ok(());
    }
    let samples = samples_in_record(duration_s, sample_period_s);
    if samples < SAMPLES_MIN {
        return Err(format!(
            "`{metric}` needs a record of at least {SAMPLES_MIN} samples; {} s hold \
             {samples}",
            plain(duration_s)
        )
        .into());
    }
    if known.needs == Needs::Samples {
        return Ok(());
    }
    match motion {
        Motion::Swing { frequency_hz } | Motion::SwingFromRest { frequency_hz } => {
            check_cycles(metric, samples, sample_period_s, *frequency_hz)
        }
        Motion::MultiSine { frequencies_hz } => {
            if known.needs == Needs::TwoSines && frequencies_hz.len() < 2 {
                return Err(format!("`{metric}` needs two sines or more").into());
            }
            let lowest_hz = frequencies_hz.first().copied().unwrap_or(0.0);
            check_cycles(metric, samples, sample_period_s, lowest_hz)
        }
        Motion::Steps {
            last_step_index,
            staircase,
            ..
        } => match lack(known, staircase, samples) {
            Some(reason) => Err(format!("`{metric}`: {reason}").into()),
            None => check_tail(known, samples, *last_step_index),
        },
        Motion::Steady | Motion::General => Ok(()),
    }
}

/// What a record must offer to have a metric, beyond its motion, in words; empty for nothing.
#[must_use]
pub fn requirement(key: &MetricKey) -> String {
    match key.needs {
        Needs::Nothing => String::new(),
        Needs::Samples => format!("{SAMPLES_MIN} samples"),
        Needs::Record => format!(
            "{SAMPLES_MIN} samples, and {CYCLES_MIN} whole cycles where the motion has some"
        ),
        Needs::AllanFit => format!("{FIT_SAMPLES_MIN} samples"),
        Needs::SlowNoiseFit => format!("{SLOW_NOISE_DURATION_MIN_S} s"),
        Needs::Blocks(averaging_time_s) => format!("{BLOCKS_MIN} blocks of {averaging_time_s} s"),
        Needs::ScenarioBlocks => {
            format!("{BLOCKS_MIN} blocks of the scenario's bias_averaging_time_s")
        }
        Needs::TwoSines => "two sines or more".to_owned(),
        Needs::Step => format!("{STEP_SAMPLES_MIN} samples after the last step"),
        Needs::SettledStep => {
            format!("{SAMPLES_MIN} samples in the last quarter after the last step")
        }
        Needs::Dwells => format!("settled dwells at {RATES_MIN} distinct rates"),
        Needs::DwellsOfBothSenses => {
            format!("settled dwells at {RATES_PER_SENSE_MIN} distinct rates of each sense")
        }
    }
}

/// Why a record without an encoder can never have a metric; nothing for other metrics.
#[must_use]
pub fn encoder_lack(key: &MetricKey, has_encoder: bool) -> Option<&'static str> {
    (key.against == Against::Encoder && !has_encoder)
        .then_some("the table has no encoder: give turntable.encoder.resolution_arcsec")
}

/// Why a record without its true rate can never have a metric; nothing for other metrics.
///
/// The amplitude of raw has nothing but the true rate to be compared with; a filter's has raw.
#[must_use]
pub fn truth_lack(key: &MetricKey, has_truth: bool, is_filter: bool) -> Option<&'static str> {
    match key.against {
        _ if has_truth => None,
        Against::Encoder => Some("a recorded log brings no angle of an encoder"),
        Against::Truth => Some(NO_TRUTH),
        Against::TruthForRaw => (!is_filter).then_some(NO_TRUTH),
        Against::Nothing => None,
    }
}

/// Whole samples in a duration; a duration made from a count gives that count back.
fn samples_in_record(duration_s: f64, sample_period_s: f64) -> usize {
    round_to_count((duration_s / sample_period_s * (1.0 + 1e-12)).floor())
}

/// Whether enough samples follow the last step.
fn check_tail(key: &MetricKey, samples: usize, last_step_index: usize) -> Result<(), Unavailable> {
    let after = samples.saturating_sub(last_step_index);
    let (found, needed) = match key.needs {
        Needs::Step => (after, STEP_SAMPLES_MIN),
        Needs::SettledStep => (
            samples.saturating_sub(tail_start(samples, last_step_index)),
            SAMPLES_MIN,
        ),
        _ => return Ok(()),
    };
    if found >= needed {
        return Ok(());
    }
    let part = if found == after {
        "after the last step"
    } else {
        "in the last quarter after the last step"
    };
    Err(format!(
        "`{}` needs {needed} samples {part}; there are {found}",
        key.name
    )
    .into())
}

/// Whether a metric is defined for a motion.
///
/// # Errors
/// The motions it is defined for, in words.
pub(crate) fn check_motion(known: &MetricKey, motion: &Motion) -> Result<(), Unavailable> {
    let fits = matches!(
        (known.applies, motion),
        (
            Applies::Always | Applies::Pipeline | Applies::FixedPoint | Applies::Twins,
            _
        ) | (
            Applies::Steady | Applies::SteadyOrSwing | Applies::Separable,
            Motion::Steady
        ) | (
            Applies::Swing
                | Applies::Tones
                | Applies::SteadyOrSwing
                | Applies::Moving
                | Applies::Separable,
            Motion::Swing { .. } | Motion::SwingFromRest { .. }
        ) | (
            Applies::Tones | Applies::MultiSine | Applies::Moving | Applies::Separable,
            Motion::MultiSine { .. }
        ) | (
            Applies::Steps | Applies::Moving | Applies::Separable,
            Motion::Steps { .. }
        ) | (
            Applies::Onset,
            Motion::Steps { .. } | Motion::SwingFromRest { .. } | Motion::General
        ) | (Applies::Moving, Motion::General)
    );
    if fits {
        return Ok(());
    }
    let wanted = known.applies.words();
    Err(format!("`{}` is defined for {wanted} only", known.name).into())
}

fn check_cycles(
    metric: &str,
    samples: usize,
    sample_period_s: f64,
    frequency_hz: f64,
) -> Result<(), Unavailable> {
    let clock = SwingClock {
        frequency_hz,
        sample_period_s,
        first_stamp_s: 0.0,
    };
    let cycles = clock.whole_cycles(samples);
    if cycles < CYCLES_MIN {
        return Err(format!(
            "`{metric}` needs {CYCLES_MIN} whole cycles of {} Hz; {samples} samples \
             hold {cycles}",
            plain(frequency_hz)
        )
        .into());
    }
    if frequency_hz * sample_period_s > 0.25 {
        return Err(format!(
            "`{metric}` needs four samples per cycle of {} Hz",
            plain(frequency_hz)
        )
        .into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::known_metrics;
    use crate::metrics::record::Staircase;

    const PERIOD_S: f64 = 1.0 / 3989.45;

    fn ask(
        metric: &str,
        duration_s: f64,
        motion: &Motion,
        is_filter: bool,
    ) -> Result<(), Unavailable> {
        support(metric, duration_s, PERIOD_S, motion, is_filter, 100.0)
    }

    #[test]
    fn a_misspelt_metric_is_answered_with_the_nearest() {
        let answer = ask("delay_vs_row_ms", 20.0, &Motion::Steady, true).unwrap_err();
        assert!(answer.as_str().contains("`delay_vs_raw_ms`"), "{answer}");
    }

    #[test]
    fn a_record_of_fewer_samples_than_measure_needs_supports_no_metric_of_its_words() {
        for known in known_metrics() {
            for motion in [
                Motion::Steady,
                Motion::Swing {
                    frequency_hz: 900.0,
                },
                Motion::General,
                Motion::Steps {
                    last_step_index: 0,
                    step_deg_per_h: 1.0,
                    staircase: Staircase::default(),
                },
            ] {
                let short = ask(known.name, 63.0 * PERIOD_S, &motion, true);
                let refused = short.is_err() || known.needs == Needs::Nothing;
                assert!(refused, "{} {motion:?}", known.name);
            }
        }
        let mean = |samples: f64| ask("mean_deg_per_h", samples * PERIOD_S, &Motion::Steady, false);
        assert!(mean(64.0).is_ok() && mean(63.99).is_err());
    }

    #[test]
    fn noise_after_a_step_needs_its_quarter() {
        let after = |samples: f64| {
            let motion = Motion::Steps {
                last_step_index: 100,
                step_deg_per_h: 1.0,
                staircase: Staircase::default(),
            };
            ask(
                "noise_std_deg_per_h",
                (100.0 + samples) * PERIOD_S,
                &motion,
                false,
            )
        };
        assert!(after(256.0).is_ok() && after(250.0).is_err());
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
