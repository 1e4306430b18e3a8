//! `fogbench analyze` and `fogbench filter`: a recorded log in place of table and gyro.

use std::io;
use std::path::{Path, PathBuf};

use crate::cli::commands::consent::consent;
use crate::cli::options::format::Format;
use crate::cli::options::log::{AnalyzeOptions, FilterLogOptions, LogOptions};
use crate::cli::terminal::complaint::{self, Complaint};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::{self, Place};
use crate::experiment::{
    LogFilters, LogInput, LogSettings, LogTrial, Progress, compensate_log, load_log_compensation,
    load_log_filters, try_log,
};
use crate::program::Programs;
use crate::recording::{AssemblyColumns, Log, LogError, LogFormat, read_assembly_log, read_log};
use crate::report::{is_kalman_json, log_json, log_text};
use crate::scenario::{AllanConfig, load_log_format};
use crate::store::SingleFile;
use crate::wording::printable;

/// Measures a log, and writes its noise as a linear system.
pub(in crate::cli) fn analyze(options: &AnalyzeOptions) -> io::Result<Exit> {
    let inputs = inputs(&options.log);
    if let Err(exit) = place(&options.log).check(&inputs) {
        return Ok(exit);
    }
    let kalman = options.kalman.as_deref().map(|path| SingleFile {
        path,
        is_ours: Some(is_kalman_json),
        force: options.log.force,
    });
    if let Some(file) = kalman
        && let Err(exit) = place::check_file(file, &inputs)
    {
        return Ok(exit);
    }
    let input = match read(&options.log) {
        Ok((input, _)) => input,
        Err(exit) => return Ok(exit),
    };
    let (exit, trial) = conclude(input, None, &options.log, false)?;
    match (kalman, trial) {
        (Some(file), Some(trial)) => Ok(write_kalman(&trial, file).err().unwrap_or(exit)),
        _ => Ok(exit),
    }
}

/// Writes the noise of a log as a linear system.
fn write_kalman(trial: &LogTrial, file: SingleFile) -> Result<(), Exit> {
    let text = trial.kalman().map_err(|error| {
        output::talk(&format!(
            "error: no --kalman {}: {error}",
            file.path.display()
        ));
        Exit::RunFailed
    })?;
    file.write(&text).map_err(|error| place::refused(&error))?;
    output::talk(&format!(
        "noise for a Kalman filter in {}",
        file.path.display()
    ));
    Ok(())
}

/// Puts a log through the filters of a scenario and measures what they make of it.
pub(in crate::cli) fn filter(options: &FilterLogOptions) -> io::Result<Exit> {
    let mut inputs = inputs(&options.log);
    inputs.push(&options.filters);
    if let Err(exit) = place(&options.log).check(&inputs) {
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
    let programs = match consent(filters.programs(), options.allow_programs) {
        Ok(programs) => programs,
        Err(exit) => return Ok(exit),
    };
    let filters = Some((&filters, programs));
    conclude(input, filters, &options.log, options.csv).map(|(exit, _)| exit)
}

/// Where the results go.
fn place(options: &LogOptions) -> Place<'_> {
    Place::new(options.output.as_deref(), "log", options.force)
}

/// Files that are read.
fn inputs(options: &LogOptions) -> Vec<&Path> {
    let calibration = options.calibration.iter();
    std::iter::once(&options.file)
        .chain(calibration)
        .map(PathBuf::as_path)
        .collect()
}

/// The words to measure and their rate, Hz: of one column, or of three and a calibration.
fn read(options: &LogOptions) -> Result<(LogInput, f64), Exit> {
    let (Some(calibration), Some(axis)) = (&options.calibration, options.axis) else {
        let log = read_log(&options.file, &format(options)?).map_err(|error| unreadable(&error))?;
        tell_layout(&log);
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
    let columns = AssemblyColumns {
        gyros: [x, y, z],
        temperature: options.temperature_column.as_deref(),
    };
    let found = read_assembly_log(&options.file, &format(options)?, &columns);
    let logs = found.map_err(|error| unreadable(&error))?;
    tell_layout(&logs.gyros[axis]);
    let sample_rate_hz = logs.gyros[axis].sample_rate_hz;
    let compensated = compensate_log(logs, &compensation, axis);
    Ok((LogInput::Compensated(compensated), sample_rate_hz))
}

/// Says what the file was taken for.
fn tell_layout(log: &Log) {
    if let Some(layout) = &log.layout {
        output::talk(&format!("{}: {layout}", log.file));
    }
}

/// Where filters of a log may be programs: whether they are started, and what they say.
struct Starting(Option<Programs>);

impl Progress for Starting {
    fn programs(&self) -> Option<&Programs> {
        self.0.as_ref()
    }

    fn program_said(&self, _run: &str, channel: &str, line: &str) {
        output::talk(&format!("{channel}: {}", printable(line)));
    }
}

/// What the layout and the options say of the log.
fn format(options: &LogOptions) -> Result<LogFormat, Exit> {
    let layout = options.layout.as_deref();
    load_log_format(layout, &options.keys.given).map_err(|errors| {
        let exit = refused(&errors);
        match layout {
            Some(layout) if !layout.is_file() => Exit::Io,
            _ => exit,
        }
    })
}

/// Says why a file was not read.
pub(in crate::cli) fn unreadable(error: &LogError) -> Exit {
    output::talk(&format!("error: {error}"));
    match error {
        LogError::Read { .. } => Exit::Io,
        LogError::Content { .. } => Exit::Usage,
    }
}

fn refused<C: Complaint>(errors: &[C]) -> Exit {
    complaint::print(errors);
    Exit::Usage
}

fn conclude(
    input: LogInput,
    filters: Option<(&LogFilters, Option<Programs>)>,
    options: &LogOptions,
    as_csv: bool,
) -> io::Result<(Exit, Option<LogTrial>)> {
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
    let (filters, programs) = filters.unzip();
    let programs = Starting(programs.flatten());
    let trial = match try_log(input, filters, &settings, &programs) {
        Ok(trial) => trial,
        Err(error) => {
            output::talk(&format!("error: {error}"));
            return Ok((Exit::Usage, None));
        }
    };
    let folder = options.output.as_deref();
    if let Err(exit) = place(options).fill(|folder| trial.write(folder, as_csv)) {
        return Ok((exit, None));
    }
    output::data(&text(&trial, options.format))?;
    if let Some(folder) = folder {
        output::talk(&format!("results in {}", folder.display()));
    }
    let exit = if trial.has_failed() {
        Exit::RunFailed
    } else {
        Exit::Success
    };
    Ok((exit, Some(trial)))
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
