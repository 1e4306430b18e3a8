//! From a record to the table of everything it supports.

use super::catalogue::support::{check_motion, encoder_lack, support, truth_lack};
use super::estimate::reason::{NO_TRUTH, Unavailable};
use super::estimate::table::ChannelMetrics;
use super::key::metric::{Applies, MetricKey, Needs};
use super::motion::mean::{measure_mean_ratio, put_extremes};
use super::motion::multi_sine::measure_multi_sine;
use super::motion::steady::measure_steady;
use super::motion::steps::measure_steps;
use super::motion::swing::measure_swing;
use super::motion::tracking::measure_tracking;
use super::noise::spectrum::{log_binned, put_spectrum, segment_samples, welch};
use super::noise::two_runs::{TWO_RUN_NOISE_STD, put_two_runs};
use super::pipeline::PIPELINE_ONLY;
use super::pool::repeatability::repeats_lack;
use super::record::{FilterFacts, Motion, Record, SAMPLES_MIN, Settings};
use super::steps::settling::SETTLING_TIME;
use super::steps::shape::{OVERSHOOT, RISE_TIME};
use super::steps::staircase::measure_scale_factor;
use super::trial::dc_gain::put_dc_gains;
use super::trial::frozen_response::put_frozen_response;
use super::trial::rate_gain::put_rate_gains;
use super::trial::readaptation::{READAPTATION_TIME, measure_after_step, onset, put_memory};
use crate::metrics::catalogue::known_metrics;
use crate::wording::counted;

/// Time of divergence.
pub static DIVERGED_AT: MetricKey = MetricKey::new(
    "diverged_at_s",
    "s",
    Applies::Always,
    "time at which the channel failed, from the start of the warm-up; absent if it did not",
)
.heading("diverged at")
.needs(Needs::Nothing)
.closing_tables();

/// Points of the spectrum in the report.
pub(crate) const SPECTRUM_POINTS_MAX: usize = 400;

/// Measures one channel.
///
/// `filter` is `None` for raw, whose `record.channel_deg_per_h` is `record.raw_deg_per_h`. Every
/// metric of the catalogue ends up in the table or, with the reason, among the unavailable ones;
/// `diverged_at_s` and the metrics of pipelines are left to the caller, who saw the failure and
/// knows the hardware. Intervals are 95 %.
///
/// # Panics
/// If the slices of the record differ in length, an empty truth excepted, or the response of the gyro is
/// shorter than the record without being empty.
///
/// ```
/// use fogbench::metrics::catalogue::{DC_GAIN, MEAN, NOISE_STD};
/// use fogbench::metrics::{AllanOptions, Motion, Record, Settings, measure};
/// use fogbench::signal::Rates;
///
/// let words: Vec<f64> = (0..4000).map(|k| 10.0 + f64::from(k % 2)).collect();
/// let record = Record {
///     channel_deg_per_h: &words,
///     raw_deg_per_h: &words,
///     truth_deg_per_h: Rates::UNKNOWN,
///     response_deg_per_h: &[],
///     encoder_rad: None,
///     sample_period_s: 0.01,
///     first_stamp_s: 0.01,
///     drift: None,
/// };
/// let settings = Settings {
///     motion: Motion::Steady,
///     bias_averaging_time_s: 1.0,
///     fit_tau_min_s: 0.1,
///     allan: AllanOptions::default(),
///     bridges: Vec::new(),
/// };
/// let metrics = measure(&record, &settings, None);
/// assert_eq!(metrics.metric(&MEAN).unwrap().value, 10.5);
/// assert!((metrics.metric(&NOISE_STD).unwrap().value - 0.5).abs() < 1e-3);
/// // What cannot be had says why.
/// assert!(metrics.metric(&DC_GAIN).is_err());
/// ```
#[must_use]
pub fn measure(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
) -> ChannelMetrics {
    let samples = record.channel_deg_per_h.len();
    let truths = record.truth().map_or(samples, |truth| truth.len());
    assert!(
        record.raw_deg_per_h.len() == samples && truths == samples,
        "channel, raw and truth hold {samples}, {} and {truths} samples",
        record.raw_deg_per_h.len()
    );
    let answers = record.response_deg_per_h.len();
    assert!(
        answers == 0 || answers >= samples,
        "channel and response of the gyro hold {samples} and {answers} samples"
    );
    let readings = record.encoder_rad.map_or(samples, |truth| truth.len());
    assert!(
        readings == samples,
        "channel and encoder hold {samples} and {readings} samples"
    );
    let mut metrics = ChannelMetrics::default();
    match measure_motion(record, settings, filter, &mut metrics) {
        Err(reason) => refuse_rest(&reason, &mut metrics),
        Ok(()) => {
            let fixed = filter.filter(|facts| facts.given().is_some());
            if let Some(facts) =
                fixed.filter(|_| check_motion(&READAPTATION_TIME, &settings.motion).is_ok())
            {
                put_memory(facts, record.sample_period_s, &mut metrics);
            }
        }
    }
    if let Some(facts) = filter {
        put_dc_gains(record, facts, &mut metrics);
        put_rate_gains(facts, &mut metrics);
        if check_motion(&TWO_RUN_NOISE_STD, &settings.motion).is_ok() {
            put_two_runs(facts, samples, &mut metrics);
        }
        put_frozen_response(facts, record.sample_period_s, &mut metrics);
    }
    metrics.keep_finite();
    explain_missing(record, settings, filter, &mut metrics);
    metrics
}

/// As [`measure`] for raw words of which some are missing (NaN): a log with gaps, or without its outliers.
pub(crate) fn measure_present(record: &Record, settings: &Settings) -> ChannelMetrics {
    let mut metrics = ChannelMetrics::default();
    let words = record.channel_deg_per_h.iter();
    let measured = enough_samples(words.filter(|word| !word.is_nan()).count())
        .and_then(|()| measure_words(record, settings, None, &mut metrics));
    if let Err(reason) = measured {
        refuse_rest(&reason, &mut metrics);
    }
    metrics.keep_finite();
    explain_missing(record, settings, None, &mut metrics);
    metrics
}

fn measure_motion(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), Unavailable> {
    let values = record.channel_deg_per_h;
    enough_samples(values.len())?;
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        return Err(format!("sample {index} of the record is not finite").into());
    }
    measure_words(record, settings, filter, metrics)
}

/// Refuses a record of too few samples.
fn enough_samples(samples: usize) -> Result<(), Unavailable> {
    if samples >= SAMPLES_MIN {
        return Ok(());
    }
    Err(format!(
        "the record holds {}; metrics need {SAMPLES_MIN}",
        counted(samples, "sample")
    )
    .into())
}

fn measure_words(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), Unavailable> {
    let values = record.channel_deg_per_h;
    let segment = segment_samples(values.len());
    let (spectrum, measured) = rayon::join(
        || welch(values, record.sample_period_s, segment),
        || {
            put_extremes(record, metrics);
            measure_by_motion(record, settings, filter, metrics)
        },
    );
    put_spectrum(log_binned(&spectrum, SPECTRUM_POINTS_MAX), metrics);
    measured
}

/// What the motion of a record lets measure.
fn measure_by_motion(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), Unavailable> {
    match &settings.motion {
        Motion::MultiSine { .. } | Motion::General | Motion::Steps { .. }
            if record.truth().is_none() =>
        {
            Err(NO_TRUTH.into())
        }
        Motion::Steady => {
            measure_steady(record, settings, filter, metrics);
            Ok(())
        }
        Motion::Swing { frequency_hz } => {
            measure_swing(record, *frequency_hz, false, filter, metrics)
        }
        Motion::SwingFromRest { frequency_hz } => {
            measure_swing(record, *frequency_hz, true, filter, metrics)
        }
        Motion::MultiSine { frequencies_hz } => {
            measure_multi_sine(record, frequencies_hz, filter, metrics)
        }
        Motion::General => {
            measure_tracking(record, None, filter, metrics);
            if let Some(facts) = filter {
                let all = 0..record.channel_deg_per_h.len();
                measure_mean_ratio(record, all, facts, metrics);
                match onset(&record.truth_deg_per_h.words()) {
                    Some(start) => measure_after_step(record, start, facts, metrics),
                    None => {
                        metrics.miss(&READAPTATION_TIME, "the motion does not end at a new rate")
                    }
                }
            }
            Ok(())
        }
        Motion::Steps {
            last_step_index,
            step_deg_per_h,
            staircase,
        } => {
            measure_steps(record, *last_step_index, *step_deg_per_h, filter, metrics);
            measure_scale_factor(record, staircase, metrics);
            if staircase.is_found {
                for key in [&SETTLING_TIME, &RISE_TIME, &OVERSHOOT] {
                    metrics.withdraw(key, "the transitions of a reference are no steps");
                }
            }
            Ok(())
        }
    }
}

/// Gives one reason to everything that is still missing.
fn refuse_rest(reason: &Unavailable, metrics: &mut ChannelMetrics) {
    for known in known_metrics() {
        let is_own = **known == DIVERGED_AT
            || matches!(
                known.applies,
                Applies::Pipeline | Applies::FixedPoint | Applies::Log | Applies::Twins
            );
        if !is_own && metrics.get(known).is_none() {
            metrics.miss(known, reason.clone());
        }
    }
}

/// Gives a reason to every metric of the catalogue that has neither a value nor a reason yet.
fn explain_missing(
    record: &Record,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let of = Recorded {
        samples: record.channel_deg_per_h.len(),
        sample_period_s: record.sample_period_s,
        has_truth: record.truth().is_some(),
        has_encoder: record.encoder_rad.is_some(),
    };
    explain_absence(of, settings, filter, metrics);
}

/// What a record holds, its samples left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorded {
    /// How many samples it has.
    pub(crate) samples: usize,
    /// Sample period, s.
    pub(crate) sample_period_s: f64,
    /// Whether the true rate is known.
    pub(crate) has_truth: bool,
    /// Whether the table has an encoder.
    pub(crate) has_encoder: bool,
}

/// Gives a reason to every metric of the catalogue that has neither a value nor a reason yet.
pub(crate) fn explain_absence(
    record: Recorded,
    settings: &Settings,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let is_filter = filter.is_some();
    let hidden = filter.and_then(|facts| facts.shape.hidden_reason());
    let duration_s = record.samples as f64 * record.sample_period_s;
    for known in known_metrics() {
        if **known == DIVERGED_AT
            || matches!(
                known.applies,
                Applies::Calibration | Applies::FixedPoint | Applies::Log | Applies::Twins
            )
            || metrics.get(known).is_some()
            || metrics.why_unavailable(known).is_some()
        {
            continue;
        }
        let reason = support(
            known.name,
            duration_s,
            record.sample_period_s,
            &settings.motion,
            is_filter,
            settings.bias_averaging_time_s,
        )
        .err()
        .or_else(|| truth_lack(known, record.has_truth, is_filter).map(Unavailable::from))
        .or_else(|| repeats_lack(known, 1))
        .or_else(|| encoder_lack(known, record.has_encoder).map(Unavailable::from))
        .unwrap_or_else(|| match known.applies {
            Applies::Pipeline => PIPELINE_ONLY.into(),
            _ => hidden.unwrap_or("the record is too short for it").into(),
        });
        metrics.miss(known, reason);
    }
}
