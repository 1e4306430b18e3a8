//! A recorded log that is too long to be kept, measured while it comes in.

use super::trial::{
    LogSettings, LogTrial, LogTrialError, RAW, metric_motion, metric_settings, record_length,
};
use crate::experiment::run::{GyroRecord, Progress, RecordLength};
use crate::metrics::WordStream;
use crate::recording::{LogError, LogStream};
use crate::scenario::motion_of_log;
use crate::signal::RateRecord;
use crate::wording::counted;

/// Measures a log while it comes in.
///
/// # Errors
/// What does not stream, a warm-up longer than the words that are kept, whatever is wrong with a word; a
/// listener that stops it.
pub fn try_log_stream(
    mut stream: LogStream,
    settings: &LogSettings,
    progress: &dyn Progress,
) -> Result<LogTrial, LogTrialError> {
    let file = stream.log().file.clone();
    let refuse = |message: String| LogTrialError {
        file: file.clone(),
        message,
        is_read: false,
    };
    let sample_period_s = stream.log().sample_period_s();
    let mut words = stream.take_first_words();
    let warm_up = record_length(stream.log(), words.len(), settings)?.warm_up;
    let first = &words[warm_up..];
    let motion = metric_motion(settings, &[], sample_period_s)
        .map_err(|reason| refuse(reason.to_string()))?;
    let metric_settings = metric_settings(settings, motion, first, sample_period_s);
    let mut measured = WordStream::new(first, sample_period_s, metric_settings)
        .map_err(|lack| refuse(format!("{lack}: give a part of it, as with --rows")))?;
    measured.extend(first);
    words = Vec::new();
    loop {
        if progress.should_stop() {
            return Err(refuse("stopped".to_owned()));
        }
        stream.read(&mut words).map_err(|error| match error {
            LogError::Content { place, message, .. } => LogTrialError {
                file: place,
                ..refuse(message)
            },
            error => LogTrialError {
                is_read: true,
                ..refuse(error.to_string())
            },
        })?;
        if words.is_empty() {
            break;
        }
        measured.extend(&words);
    }
    let samples = measured.samples();
    let channels = vec![(RAW.to_owned(), measured.finish(warm_up))];
    let log = stream.into_log();
    let mut notes = log.notes();
    notes.push(format!(
        "{} were measured as they came in: what is not measured so is named with the reason, and there is no \
         record without outliers",
        counted(samples, "word")
    ));
    Ok(LogTrial {
        channels,
        temperature: None,
        verdicts: Vec::new(),
        motion: motion_of_log(settings.motion),
        source: None,
        filters: Vec::new(),
        log,
        record: GyroRecord {
            truth_deg_per_h: RateRecord::default(),
            response_deg_per_h: None,
            raw_deg_per_h: Vec::new(),
            compensated_deg_per_h: None,
        },
        length: RecordLength {
            warm_up,
            measured: samples,
        },
        notes,
    })
}
