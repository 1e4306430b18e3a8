//! A recorded log in place of table and gyro: measured as it is, or through filters.

use std::sync::OnceLock;

use rayon::prelude::*;

use super::compensation::CompensatedLog;
use super::filters::LogFilters;
use super::gates::LogGates;
use super::temperature::{FittedTemperature, Warmth};
use crate::experiment::channel_filter::{ChannelFilter, FinishedFilter};
use crate::experiment::outside::{self, Input, Outside, OutsideFilter};
use crate::experiment::pipeline_metrics;
use crate::experiment::run::{Cut, GyroRecord, Progress, RecordLength, Unfinished, allan_options};
use crate::gate::Verdict;
use crate::metrics::{
    ChannelMetrics, Dwell, Examination, Motion, Settings, Staircase, Unavailable, find_dwells,
    is_sample_or_longer, measure_present, record_fit_tau_min_s,
};
use crate::recording::{Log, LogMotion};
use crate::scenario::{AllanConfig, LogChannels, MotionConfig, WITHOUT_OUTLIERS, motion_of_log};
use crate::turntable::first_measured_index;
use crate::wording::{counted, plain};

/// Name of the log's own channel.
pub(super) const RAW: &str = "raw";
/// Name of the channel without the constant errors of its assembly.
pub(super) const COMPENSATED: &str = "compensated";

/// Time at the start of a dwell that a gyro is given to settle where nobody says so, s.
pub const SETTLE_S: f64 = 0.5;

/// What is measured and filtered.
#[derive(Clone, Debug)]
pub enum LogInput {
    /// The words of one gyro.
    Plain(Log),
    /// Those of one axis of an assembly, compensated before the filters see them.
    Compensated(CompensatedLog),
}

impl From<Log> for LogInput {
    fn from(log: Log) -> Self {
        Self::Plain(log)
    }
}

/// How a log is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogSettings {
    /// What the gyro did.
    pub motion: LogMotion,
    /// Time at the start of each dwell that is left out, s.
    pub settle_s: f64,
    /// Time at its start that metrics leave out, s.
    pub warm_up_s: f64,
    /// Averaging time of the plain `bias_stability_deg_per_h`, s.
    pub bias_averaging_time_s: f64,
    /// Shortest averaging time of the noise fit, s; none: four times as long as the fast noise is
    /// correlated, and ten samples at least unless the words are white.
    pub fit_tau_min_s: Option<f64>,
    /// Estimator and averaging times of the Allan curve.
    pub allan: AllanConfig,
    /// Temperature that its coefficients are told at, deg C; none: the mean of the log.
    pub temperature_reference_c: Option<f64>,
}

/// Why a log was not measured.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {message}")]
#[non_exhaustive]
pub struct LogTrialError {
    /// Name of the log.
    pub file: String,
    /// What is wrong.
    pub message: String,
    /// Whether it is the system that refused to read on.
    pub is_read: bool,
}

impl LogTrialError {
    /// What is wrong with a log, or with what is asked of it.
    pub(super) fn of(log: &Log, message: impl ToString) -> Self {
        Self {
            file: log.file.clone(),
            message: message.to_string(),
            is_read: false,
        }
    }
}

/// A log with everything measured on it.
pub struct LogTrial {
    pub(super) log: Log,
    pub(super) record: GyroRecord,
    pub(super) length: RecordLength,
    pub(super) motion: MotionConfig,
    pub(super) source: Option<(String, String)>,
    pub(super) filters: Vec<FinishedFilter>,
    pub(super) channels: Vec<(String, ChannelMetrics)>,
    /// Coefficients of the temperature that are significant.
    pub(super) temperature: Option<FittedTemperature>,
    pub(super) verdicts: Vec<Verdict>,
    pub(super) notes: Vec<String>,
}

/// Measures a log, and what filters make of its words.
///
/// The words enter the filters from the first on, as a run's do, and leave them the same to the
/// bit; metrics use the samples from `ceil(warm_up_s f)` on. What needs the true rate is
/// unavailable. Compensated words are a channel of their own and what the filters are given.
///
/// # Errors
/// A warm-up that leaves no sample; an averaging time shorter than one; a swing too fast for the sample
/// rate; a filter that has the name
/// of the compensated channel; a listener that stops it.
pub fn try_log(
    input: impl Into<LogInput>,
    filters: Option<&LogFilters>,
    settings: &LogSettings,
    progress: &dyn Progress,
) -> Result<LogTrial, LogTrialError> {
    let (mut log, compensated, mut notes) = match input.into() {
        LogInput::Plain(log) => (log, None, Vec::new()),
        LogInput::Compensated(CompensatedLog { log, words, notes }) => (log, Some(words), notes),
    };
    let sample_period_s = log.sample_period_s();
    let length = record_length(&log, log.rate_deg_per_h.len(), settings)?;
    let is_compensated = compensated.is_some();
    let clash = filters.and_then(|filters| clash(filters, is_compensated, &log));
    if let Some(message) = clash.or_else(|| refusal_of_gaps(&log, filters, settings)) {
        return Err(LogTrialError::of(&log, message));
    }
    let warmth = Warmth::of(&log, length.warm_up, settings);
    notes.splice(0..0, log.notes());
    log.take_about_common_mean();
    let record = GyroRecord {
        truth_deg_per_h: std::mem::take(&mut log.reference_deg_per_h).into(),
        response_deg_per_h: None,
        raw_deg_per_h: std::mem::take(&mut log.rate_deg_per_h),
        compensated_deg_per_h: compensated,
    };
    let input = input_of(&record, length, sample_period_s);
    let finished = run(filters, &input, progress);
    let finished = finished.map_err(|unfinished| LogTrialError::of(&log, unfinished))?;
    let measured = &record.raw_deg_per_h[length.warm_up..];
    let reference = record.truth_deg_per_h.words().get(length.warm_up..);
    let motion = metric_motion(settings, reference.unwrap_or_default(), sample_period_s);
    let motion = motion.map_err(|reason| LogTrialError::of(&log, reason))?;
    let metric_settings = Settings {
        bridges: log.bridges_behind(length.warm_up),
        ..metric_settings(settings, motion, measured, sample_period_s)
    };
    let cut = Cut {
        record: &record,
        encoder_rad: None,
        length,
        sample_period_s,
        settings: &metric_settings,
        drift: None,
        motion: OnceLock::new(),
        black_box: filters.and_then(|filters| filters.resolved().scenario.trial.black_box),
    };
    let mut channels = measured_channels(&cut, &finished, settings.fit_tau_min_s.is_some());
    let temperature = warmth.as_ref().and_then(Warmth::fitted);
    if let Some(warmth) = warmth {
        warmth.enter(&cut, &mut channels);
    }
    notes.extend(notes_on(
        filters,
        &finished,
        &record.raw_deg_per_h,
        sample_period_s,
    ));
    Ok(LogTrial {
        channels,
        temperature,
        verdicts: Vec::new(),
        motion: motion_of_log(settings.motion),
        source: filters.map(LogFilters::source),
        filters: finished,
        log,
        record,
        length,
        notes,
    })
}

/// The channels of a log: its words, those without the errors of its assembly, those of the filters.
fn measured_channels(
    cut: &Cut,
    filters: &[FinishedFilter],
    is_tau_given: bool,
) -> Vec<(String, ChannelMetrics)> {
    let raw = &cut.record.raw_deg_per_h;
    let (raw, others): (_, Vec<_>) = rayon::join(
        || {
            let measure = || match raw.iter().any(|word| word.is_nan()) {
                true => measure_present(&cut.of(raw, raw), cut.settings),
                false => cut.measure_raw(),
            };
            examined(RAW, measure, raw, cut, is_tau_given)
        },
        || {
            let filters = filters.par_iter();
            filters
                .map(|filter| (filter.name.clone(), cut.measure_filter(filter)))
                .collect()
        },
    );
    let compensated = cut.record.compensated_deg_per_h.as_deref().map(|words| {
        let measure = || match words.iter().any(|word| word.is_nan()) {
            true => measure_present(&cut.of(words, words), cut.settings),
            false => cut.measure_compensated(),
        };
        examined(COMPENSATED, measure, words, cut, is_tau_given)
    });
    let own = raw.into_iter().chain(compensated.into_iter().flatten());
    own.chain(others).collect()
}

/// Why a log with gaps is not measured as it is asked for; nothing of one without.
fn refusal_of_gaps(
    log: &Log,
    filters: Option<&LogFilters>,
    settings: &LogSettings,
) -> Option<String> {
    let needs = match (filters, settings.motion) {
        (Some(_), _) => "a filter needs every word",
        (None, LogMotion::Swing { .. }) => "the phase of a swing needs every word",
        (None, LogMotion::Dwells) => "a reference is compared word by word",
        (None, LogMotion::Static) => return None,
    };
    log.has_gaps().then(|| {
        format!(
            "samples are missing ({}), and {needs}: --rows, or --from-s and --to-s, takes a part without gaps",
            counted(log.stretches.len(), "part")
        )
    })
}

/// What is wrong with the name of a filter that a channel of the log has.
fn clash(filters: &LogFilters, is_compensated: bool, log: &Log) -> Option<String> {
    let channels = LogChannels {
        is_compensated,
        has_temperature: !log.temperature_c.is_empty(),
    };
    let own = channels.names();
    let mut names = filters.configs().iter().map(|it| &it.name);
    let taken = names.find(|name| own.contains(name))?;
    Some(format!(
        "a filter is named `{taken}`, as is a channel of the log"
    ))
}

/// How the words of a log, those behind the warm-up, are measured.
pub(super) fn metric_settings(
    settings: &LogSettings,
    motion: Motion,
    measured: &[f64],
    sample_period_s: f64,
) -> Settings {
    let fit_tau_min_s = settings.fit_tau_min_s;
    Settings {
        motion,
        bias_averaging_time_s: settings.bias_averaging_time_s,
        fit_tau_min_s: fit_tau_min_s
            .unwrap_or_else(|| record_fit_tau_min_s(measured, sample_period_s)),
        allan: allan_options(settings.allan),
        bridges: Vec::new(),
    }
}

/// A measured channel, and beside it what it measures without its outliers, if it has any.
fn examined(
    name: &str,
    measure: impl FnOnce() -> ChannelMetrics + Send,
    words: &[f64],
    cut: &Cut,
    is_tau_given: bool,
) -> Vec<(String, ChannelMetrics)> {
    let (first, settings) = (cut.length.warm_up, cut.settings);
    let record = cut.of(words, words);
    let (mut metrics, found) = rayon::join(measure, || Examination::of(&record, settings));
    let rest = found.enter(&record, settings, is_tau_given, first, &mut metrics);
    let rest = rest.map(|rest| (format!("{name}{WITHOUT_OUTLIERS}"), rest));
    std::iter::once((name.to_owned(), metrics))
        .chain(rest)
        .collect()
}

/// What the filters are given of a log.
fn input_of(record: &GyroRecord, length: RecordLength, sample_period_s: f64) -> Input<'_> {
    let is_compensated = record.compensated_deg_per_h.is_some();
    Input {
        words_deg_per_h: record.filter_input_deg_per_h(),
        channel: if is_compensated { COMPENSATED } else { RAW },
        length,
        sample_period_s,
    }
}

/// What the reader must know of the filters.
fn notes_on(
    filters: Option<&LogFilters>,
    finished: &[FinishedFilter],
    raw_deg_per_h: &[f64],
    sample_period_s: f64,
) -> Vec<String> {
    let mut notes = filters.map_or_else(Vec::new, |filters| filters.warnings(raw_deg_per_h));
    for filter in finished {
        notes.extend(pipeline_metrics::notes(filter, sample_period_s));
        notes.extend(outside::note(filter));
    }
    notes
}

/// Every filter over the whole log.
fn run(
    filters: Option<&LogFilters>,
    input: &Input,
    progress: &dyn Progress,
) -> Result<Vec<FinishedFilter>, Unfinished> {
    let Some(filters) = filters else {
        return Ok(Vec::new());
    };
    let configs = filters.configs().par_iter().enumerate();
    configs
        .map(|(index, config)| {
            if let Some(outside) = Outside::of(&config.kind) {
                let filter = OutsideFilter::of_log(filters.resolved(), index);
                return filter.run(outside, input, progress);
            }
            let (name, period_s) = (config.name.clone(), input.sample_period_s);
            let mut filter = ChannelFilter::new(name, &config.kind, input.length, period_s, false);
            filter.process(input.words_deg_per_h);
            Ok(filter.finish())
        })
        .collect()
}

/// Parts of a log of so many samples: those that are left out, those that are measured.
pub(super) fn record_length(
    log: &Log,
    samples: usize,
    settings: &LogSettings,
) -> Result<RecordLength, LogTrialError> {
    let refuse = |message: String| LogTrialError {
        file: log.file.clone(),
        message,
        is_read: false,
    };
    let warm_up = first_measured_index(settings.warm_up_s, log.sample_period_s());
    let warm_up = usize::try_from(warm_up).unwrap_or(usize::MAX);
    if warm_up >= samples {
        return Err(refuse(format!(
            "--warm-up-s {} leaves no sample: {} at {} Hz",
            settings.warm_up_s,
            counted(samples, "sample"),
            plain(log.sample_rate_hz)
        )));
    }
    let averaging_time_s = settings.bias_averaging_time_s;
    if !is_sample_or_longer(averaging_time_s, log.sample_period_s()) {
        return Err(refuse(format!(
            "--bias-averaging-time-s {averaging_time_s} is shorter than a sample: allowed from {} s \
             on at {} Hz",
            log.sample_period_s(),
            log.sample_rate_hz
        )));
    }
    if let LogMotion::Swing { frequency_hz } = settings.motion
        && frequency_hz > 0.25 * log.sample_rate_hz
    {
        return Err(refuse(format!(
            "a swing of {frequency_hz} Hz needs four samples a cycle: the log has {} Hz",
            plain(log.sample_rate_hz)
        )));
    }
    Ok(RecordLength {
        warm_up,
        measured: samples - warm_up,
    })
}

/// The motion of a log as the metrics see it.
///
/// # Errors
/// Dwells without a reference, or one that has none.
pub(super) fn metric_motion(
    settings: &LogSettings,
    reference_deg_per_h: &[f64],
    sample_period_s: f64,
) -> Result<Motion, Unavailable> {
    match settings.motion {
        LogMotion::Static => Ok(Motion::Steady),
        LogMotion::Swing { frequency_hz } => Ok(Motion::Swing { frequency_hz }),
        LogMotion::Dwells if reference_deg_per_h.is_empty() => {
            Err("dwells are found in what the table did: --reference-column names it".into())
        }
        LogMotion::Dwells => {
            let dwells = find_dwells(reference_deg_per_h, sample_period_s, settings.settle_s)?;
            let mut last = dwells.iter().rev();
            let (last, before) = (last.next(), last.next());
            let rate = |dwell: Option<&Dwell>| dwell.map_or(0.0, |it| it.rate_deg_per_h);
            Ok(Motion::Steps {
                last_step_index: last.map_or(0, |dwell| dwell.samples.start),
                step_deg_per_h: rate(last) - rate(before.or(last)),
                staircase: Staircase {
                    settle_s: settings.settle_s,
                    is_found: true,
                    dwells,
                    ..Staircase::default()
                },
            })
        }
    }
}

impl LogTrial {
    /// Channels, `raw` first.
    #[must_use]
    pub fn channels(&self) -> &[(String, ChannelMetrics)] {
        &self.channels
    }

    /// Holds gates against what was measured.
    pub fn judge(&mut self, gates: &LogGates) {
        self.verdicts = gates.judge(&self.channels);
    }

    /// Whether a gate was not accepted.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        self.verdicts.iter().any(|verdict| !verdict.accepted)
    }

    /// Whether a filter failed.
    #[must_use]
    pub fn has_failed(&self) -> bool {
        let mut channels = self.channels.iter();
        channels.any(|(_, metrics)| metrics.error.is_some())
    }
}
