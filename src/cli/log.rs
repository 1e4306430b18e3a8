//! `fogbench analyze` and `fogbench filter`: a recorded log in place of table and gyro.

use std::io;

use super::arguments::Format;
use super::exit::Exit;
use super::log_arguments::{AnalyzeOptions, FilterLogOptions, LogOptions};
use super::{output, place};
use crate::experiment::{
    LogFilters, LogInput, LogSettings, LogTrial, compensate_log, load_log_compensation,
    load_log_filters, try_log,
};
use crate::recording::{Log, LogError, LogFormat, read_column, read_log};
use crate::report::{log_json, log_text};
use crate::scenario::AllanConfig;

/// Measures a log.
pub(super) fn analyze(options: &AnalyzeOptions) -> io::Result<Exit> {
    if let Err(exit) = place::check(options.log.output.as_deref(), options.log.force) {
        return Ok(exit);
    }
    let input = match read(&options.log) {
        Ok((input, _)) => input,
        Err(exit) => return Ok(exit),
    };
    conclude(input, None, &options.log, false)
}

/// Puts a log through the filters of a scenario and measures what they make of it.
pub(super) fn filter(options: &FilterLogOptions) -> io::Result<Exit> {
    if let Err(exit) = place::check(options.log.output.as_deref(), options.log.force) {
        return Ok(exit);
    }
    let (input, sample_rate_hz) = match read(&options.log) {
        Ok(read) => read,
        Err(exit) => return Ok(exit),
    };
    let filters = match load_log_filters(&options.filters, &options.set, sample_rate_hz) {
        Ok(filters) => filters,
        Err(errors) => return Ok(refused(&errors)),
    };
    conclude(input, Some(&filters), &options.log, options.csv)
}

/// The words to measure and their rate, Hz: of one column, or of three and a calibration.
fn read(options: &LogOptions) -> Result<(LogInput, f64), Exit> {
    let (Some(calibration), Some(axis)) = (&options.calibration, options.axis) else {
        let log = read_one(options, options.column.clone())?;
        let sample_rate_hz = log.sample_rate_hz;
        return Ok((log.into(), sample_rate_hz));
    };
    let [x, y, z] = &options.columns[..] else {
        let count = options.columns.len();
        let message = format!("--columns names {count} columns: expected three, of x, y and z");
        return Err(refused(&[message]));
    };
    let form = options.compensation_form;
    let compensation = load_log_compensation(calibration, form).map_err(|errors| {
        let exit = refused(&errors);
        if calibration.is_file() {
            exit
        } else {
            Exit::Io
        }
    })?;
    let read = |column: &String| read_one(options, Some(column.clone()));
    let logs = [read(x)?, read(y)?, read(z)?];
    let sample_rate_hz = logs[axis].sample_rate_hz;
    let temperature = options.temperature_column.as_ref();
    let temperature = temperature
        .map(|column| read_column(&options.file, column).map_err(unreadable))
        .transpose()?;
    let compensated = compensate_log(logs, temperature.as_deref(), &compensation, axis)
        .map_err(|message| refused(&[message]))?;
    Ok((LogInput::Compensated(compensated), sample_rate_hz))
}

fn read_one(options: &LogOptions, column: Option<String>) -> Result<Log, Exit> {
    let format = LogFormat {
        sample_rate_hz: options.rate_hz,
        unit: options.unit,
        scale: options.scale,
        column,
        time_column: options.time.clone(),
        time_unit: options.time_unit,
    };
    read_log(&options.file, &format).map_err(unreadable)
}

#[expect(clippy::needless_pass_by_value, reason = "it takes what map_err gives")]
fn unreadable(error: LogError) -> Exit {
    output::talk(&format!("error: {error}"));
    match error {
        LogError::Read { .. } => Exit::Io,
        LogError::Content { .. } => Exit::Usage,
    }
}

fn refused<E: std::fmt::Display>(errors: &[E]) -> Exit {
    for error in errors {
        output::talk(&format!("error: {error}"));
    }
    Exit::Usage
}

fn conclude(
    input: LogInput,
    filters: Option<&LogFilters>,
    options: &LogOptions,
    as_csv: bool,
) -> io::Result<Exit> {
    let settings = LogSettings {
        motion: options.motion,
        warm_up_s: options.warm_up_s,
        bias_averaging_time_s: options.bias_averaging_time_s,
        fit_tau_min_s: options.fit_tau_min_s,
        allan: AllanConfig {
            estimator: options.allan_estimator,
            averaging_times: options.averaging_times,
        },
    };
    let trial = match try_log(input, filters, &settings) {
        Ok(trial) => trial,
        Err(error) => {
            output::talk(&format!("error: {error}"));
            return Ok(Exit::Usage);
        }
    };
    let folder = options.output.as_deref();
    if let Some(path) = folder
        && let Err(exit) = place::fill(path, options.force, |folder| trial.write(folder, as_csv))
    {
        return Ok(exit);
    }
    output::data(&text(&trial, options.format))?;
    if let Some(folder) = folder {
        output::talk(&format!("results in {}", folder.display()));
    }
    Ok(if trial.has_failed() {
        Exit::RunFailed
    } else {
        Exit::Success
    })
}

fn text(trial: &LogTrial, format: Format) -> String {
    trial.with_report(|report| match format {
        Format::Text => log_text(report, output::width(), output::colour()),
        Format::Json => log_json(report),
        Format::Jsonl => {
            let document = log_json(report);
            let line: String = document.lines().map(str::trim_start).collect();
            format!("{line}\n")
        }
    })
}
