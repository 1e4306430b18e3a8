//! `fogbench analyze` and `fogbench filter`: a recorded log in place of table and gyro.

use std::io;
use std::path::Path;

use super::arguments::Format;
use super::exit::Exit;
use super::log_arguments::{AnalyzeOptions, FilterLogOptions, LogOptions};
use super::output;
use crate::experiment::{LogFilters, LogSettings, LogTrial, load_log_filters, try_log};
use crate::recording::{Log, LogError, LogFormat, read_log};
use crate::report::{log_json, log_text};
use crate::scenario::AllanConfig;

/// Measures a log.
pub(super) fn analyze(options: &AnalyzeOptions) -> io::Result<Exit> {
    let log = match read(&options.log) {
        Ok(log) => log,
        Err(exit) => return Ok(exit),
    };
    let folder = options.log.output.as_deref();
    conclude(log, None, &options.log, folder, false)
}

/// Puts a log through the filters of a scenario and measures what they make of it.
pub(super) fn filter(options: &FilterLogOptions) -> io::Result<Exit> {
    let log = match read(&options.log) {
        Ok(log) => log,
        Err(exit) => return Ok(exit),
    };
    let filters = match load_log_filters(&options.filters, &options.set, log.sample_rate_hz) {
        Ok(filters) => filters,
        Err(errors) => {
            for error in &errors {
                output::talk(&format!("error: {error}"));
            }
            return Ok(Exit::Usage);
        }
    };
    let folder = options.log.output.as_deref();
    conclude(log, Some(&filters), &options.log, folder, options.csv)
}

fn read(options: &LogOptions) -> Result<Log, Exit> {
    let format = LogFormat {
        sample_rate_hz: options.rate_hz,
        unit: options.unit,
        scale: options.scale,
        column: options.column.clone(),
        time_column: options.time.clone(),
        time_unit: options.time_unit,
    };
    read_log(&options.file, &format).map_err(|error| {
        output::talk(&format!("error: {error}"));
        match error {
            LogError::Read { .. } => Exit::Io,
            LogError::Content { .. } => Exit::Usage,
        }
    })
}

fn conclude(
    log: Log,
    filters: Option<&LogFilters>,
    options: &LogOptions,
    folder: Option<&Path>,
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
    let trial = match try_log(log, filters, &settings) {
        Ok(trial) => trial,
        Err(error) => {
            output::talk(&format!("error: {error}"));
            return Ok(Exit::Usage);
        }
    };
    if let Some(folder) = folder {
        trial.write(folder, as_csv)?;
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
