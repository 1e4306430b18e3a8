//! `fogbench analyze` and `fogbench filter`: a recorded log in place of table and gyro.

use std::io;
use std::path::{Path, PathBuf};

use crate::cli::commands::consent::consent;
use crate::cli::options::format::Format;
use crate::cli::options::log::{AnalyzeOptions, FilterLogOptions, LogOptions, PassForm};
use crate::cli::terminal::complaint::{self, Complaint};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::{self, Place};
use crate::experiment::{
    LogFilters, LogGates, LogInput, LogSettings, LogTemperature, LogTrial, PassError, Progress,
    SETTLE_S, compensate_log, compensate_temperature, load_log_compensation, load_log_filters,
    load_log_gates, load_own_temperature, pass_log, try_log, try_log_stream,
};
use crate::program::Programs;
use crate::recording::{
    AssemblyColumns, Log, LogError, LogFormat, LogSource, LogStream, open_live_log, open_log,
    read_assembly_log, read_unbroken_logs,
};
use crate::report::{is_calibration_toml, is_kalman_json, log_json, log_text};
use crate::scenario::{
    AllanConfig, LogChannels, ScenarioError, load_log_format, log_format_toml, slug,
};
use crate::store::SingleFile;
use crate::vocabulary::CaseAxis;
use crate::wording::printable;

/// Measures a log, and writes its noise as a linear system.
pub(in crate::cli) fn analyze(options: &AnalyzeOptions) -> io::Result<Exit> {
    let format = match format(&options.log) {
        Ok(format) => format,
        Err(exit) => return Ok(exit),
    };
    let inputs = inputs(&options.log, &format);
    if let Err(exit) = place(&options.log).check(&inputs) {
        return Ok(exit);
    }
    let files = OwnFiles::of(options);
    if let Err(exit) = files.check(&inputs) {
        return Ok(exit);
    }
    let logs = match read(&options.log, &format, open) {
        Ok(logs) => logs,
        Err(exit) => return Ok(exit),
    };
    if options.log.explain {
        return explain(&logs);
    }
    if let Some(option) = files.option()
        && logs.len() > 1
    {
        let message = format!("{option} writes one log: --column names {}", logs.len());
        return Ok(refused(&[message]));
    }
    let (exit, trials) = conclude(logs, None, &options.log, false)?;
    match &trials[..] {
        [trial] => Ok(files.write(trial).err().unwrap_or(exit)),
        _ => Ok(exit),
    }
}

/// Prints how a log was read, as a file that has it read so again.
fn explain(logs: &[ReadLog]) -> io::Result<Exit> {
    if let Some(log) = logs.first() {
        output::data(&log_format_toml(&log.format))?;
    }
    Ok(Exit::Success)
}

/// Files that stand alone and are written of one log.
struct OwnFiles<'a> {
    kalman: Option<SingleFile<'a>>,
    temperature: Option<SingleFile<'a>>,
}

impl<'a> OwnFiles<'a> {
    fn of(options: &'a AnalyzeOptions) -> Self {
        let file = |path: &'a Option<PathBuf>, is_ours: fn(&str) -> bool| {
            path.as_deref().map(|path| SingleFile {
                path,
                is_ours: Some(is_ours),
                force: options.log.force,
            })
        };
        Self {
            kalman: file(&options.kalman, is_kalman_json),
            temperature: file(&options.temperature_model, is_calibration_toml),
        }
    }

    /// Refuses what stands in their places.
    fn check(&self, inputs: &[&Path]) -> Result<(), Exit> {
        let mut both = [self.kalman, self.temperature].into_iter().flatten();
        both.try_for_each(|file| place::check_file(file, inputs))
    }

    /// The option that names one of them.
    fn option(&self) -> Option<&'static str> {
        let kalman = self.kalman.map(|_| "--kalman");
        kalman.or(self.temperature.map(|_| "--temperature-model"))
    }

    fn write(&self, trial: &LogTrial) -> Result<(), Exit> {
        let none = |option: &str, file: &SingleFile, reason: String| {
            output::talk(&format!(
                "error: no {option} {}: {reason}",
                file.path.display()
            ));
            Exit::RunFailed
        };
        if let Some(file) = self.kalman {
            let text = trial.kalman();
            let text = text.map_err(|reason| none("--kalman", &file, reason.to_string()))?;
            file.write(&text).map_err(|error| place::refused(&error))?;
            let path = file.path.display();
            output::talk(&format!("noise for a Kalman filter in {path}"));
        }
        if let Some(file) = self.temperature {
            let before = file.text().map_err(|error| place::refused(&error))?;
            let text = trial.temperature_toml(&before);
            let text =
                text.map_err(|reason| none("--temperature-model", &file, reason.to_string()))?;
            file.write(&text).map_err(|error| place::refused(&error))?;
            let path = file.path.display();
            output::talk(&format!("coefficients of the temperature in {path}"));
        }
        Ok(())
    }
}

/// Puts a log through the filters of a scenario and measures what they make of it.
pub(in crate::cli) fn filter(options: &FilterLogOptions) -> io::Result<Exit> {
    if let Some(form) = options.pass {
        return pass(options, form);
    }
    let format = match format(&options.log) {
        Ok(format) => format,
        Err(exit) => return Ok(exit),
    };
    let mut inputs = inputs(&options.log, &format);
    inputs.push(&options.filters);
    if let Err(exit) = place(&options.log).check(&inputs) {
        return Ok(exit);
    }
    let logs = match read(&options.log, &format, whole) {
        Ok(logs) => logs,
        Err(exit) => return Ok(exit),
    };
    if options.log.explain {
        return explain(&logs);
    }
    // All columns of a file have one rate.
    let sample_rate_hz = logs.first().map_or(1.0, |log| log.sample_rate_hz);
    let filters = match load_log_filters(&options.filters, &options.set, sample_rate_hz) {
        Ok(filters) => filters,
        Err(errors) => return Ok(refused(&errors)),
    };
    let programs = match consent(filters.programs(), options.allow_programs) {
        Ok(programs) => programs,
        Err(exit) => return Ok(exit),
    };
    let filters = Some((&filters, programs));
    conclude(logs, filters, &options.log, options.csv).map(|(exit, _)| exit)
}

/// Passes a log through the filters of a scenario while it comes in.
fn pass(options: &FilterLogOptions, form: PassForm) -> io::Result<Exit> {
    let format = match format(&options.log) {
        Ok(format) => format,
        Err(exit) => return Ok(exit),
    };
    let stream = match open_live_log(&options.log.file, &format) {
        Ok(stream) => stream,
        Err(error) => return Ok(unreadable(&error)),
    };
    tell_layout(stream.log());
    let sample_rate_hz = stream.log().sample_rate_hz;
    let filters = match load_log_filters(&options.filters, &options.set, sample_rate_hz) {
        Ok(filters) => filters,
        Err(errors) => return Ok(refused(&errors)),
    };
    let file = stream.log().file.clone();
    let width = filters.names().count();
    let mut heading = match form {
        PassForm::Text => pass_heading(&filters),
        PassForm::F8 | PassForm::F4 => String::new(),
    };
    let mut bytes = Vec::new();
    let passed = pass_log(stream, &filters, |rows| {
        bytes.clear();
        bytes.extend(std::mem::take(&mut heading).into_bytes());
        put_rows(rows, width, form, &mut bytes);
        output::bytes(&bytes)
    });
    match passed {
        Ok(notes) => {
            for note in notes {
                output::talk(&format!("{file}: {note}"));
            }
            Ok(Exit::Success)
        }
        // Whoever closed the pipe has seen enough.
        Err(PassError::Write(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            Ok(Exit::Success)
        }
        Err(PassError::Write(error)) => Err(error),
        Err(PassError::Read(error)) => Ok(unreadable(&error)),
        Err(error @ PassError::Failed { .. }) => {
            output::talk(&format!("error: {error}"));
            Ok(Exit::RunFailed)
        }
        Err(error) => Ok(refused(&[error.to_string()])),
    }
}

/// Heading of filtered words as text: names that are read as rates.
fn pass_heading(filters: &LogFilters) -> String {
    let names = filters.names().map(|name| format!("{name}_deg_per_h"));
    names.collect::<Vec<_>>().join(",") + "\n"
}

/// Appends rows of so many filtered words, exact to the last bit of the form.
fn put_rows(rows_deg_per_h: &[f64], width: usize, form: PassForm, bytes: &mut Vec<u8>) {
    match form {
        PassForm::Text => {
            for row in rows_deg_per_h.chunks_exact(width) {
                let cells: Vec<String> = row.iter().map(|word| format!("{word:?}")).collect();
                bytes.extend(cells.join(",").bytes());
                bytes.push(b'\n');
            }
        }
        PassForm::F8 => bytes.extend(rows_deg_per_h.iter().flat_map(|word| word.to_le_bytes())),
        #[expect(
            clippy::cast_possible_truncation,
            reason = "binary32 was asked for, and rates are far inside its range"
        )]
        PassForm::F4 => bytes.extend(
            rows_deg_per_h
                .iter()
                .flat_map(|word| (*word as f32).to_le_bytes()),
        ),
    }
}

/// What is measured.
enum Words {
    /// All of a log.
    Whole(Box<LogInput>),
    /// A log while it comes in.
    Stream(Box<LogStream>),
}

/// A log that was read, or is.
struct ReadLog {
    words: Words,
    sample_rate_hz: f64,
    /// Name of the column, where the file has several.
    column: Option<String>,
    format: LogFormat,
}

impl From<Log> for ReadLog {
    fn from(log: Log) -> Self {
        Self {
            sample_rate_hz: log.sample_rate_hz,
            column: log.column.clone(),
            format: log.format.clone(),
            words: Words::Whole(Box::new(log.into())),
        }
    }
}

impl ReadLog {
    /// The log without what the temperature does to its words; one that streams has no temperature.
    fn without(self, temperature: &LogTemperature) -> Self {
        let words = match self.words {
            Words::Whole(input) => match *input {
                LogInput::Plain(log) => {
                    let compensated = compensate_temperature(log, temperature);
                    Words::Whole(Box::new(LogInput::Compensated(compensated)))
                }
                compensated => Words::Whole(Box::new(compensated)),
            },
            stream => stream,
        };
        Self { words, ..self }
    }
}

impl From<Box<LogStream>> for ReadLog {
    fn from(stream: Box<LogStream>) -> Self {
        let log = stream.log();
        Self {
            sample_rate_hz: log.sample_rate_hz,
            column: log.column.clone(),
            format: log.format.clone(),
            words: Words::Stream(stream),
        }
    }
}

/// Reads a log, or opens one that is too long to be kept.
fn open(path: &Path, format: &LogFormat) -> Result<Vec<ReadLog>, LogError> {
    Ok(match open_log(path, format)? {
        LogSource::Whole(logs) => told(logs),
        LogSource::Stream(stream) => {
            tell_layout(stream.log());
            vec![stream.into()]
        }
    })
}

/// Reads a log as a whole.
fn whole(path: &Path, format: &LogFormat) -> Result<Vec<ReadLog>, LogError> {
    read_unbroken_logs(path, format).map(told)
}

/// Says what the file was taken for.
fn told(logs: Vec<Log>) -> Vec<ReadLog> {
    if let Some(log) = logs.first() {
        tell_layout(log);
    }
    logs.into_iter().map(ReadLog::from).collect()
}

/// Where the results go.
fn place(options: &LogOptions) -> Place<'_> {
    Place::new(options.output.as_deref(), "log", options.force)
}

/// Files that are read.
fn inputs<'a>(options: &'a LogOptions, format: &'a LogFormat) -> Vec<&'a Path> {
    let others = [&options.gates, &options.layout];
    std::iter::once(&options.file)
        .chain(others.into_iter().flatten())
        .map(PathBuf::as_path)
        .chain(format.calibration.as_deref().map(Path::new))
        .collect()
}

/// The words to measure: of each column that is named, or of three and a calibration.
fn read(
    options: &LogOptions,
    format: &LogFormat,
    reader: fn(&Path, &LogFormat) -> Result<Vec<ReadLog>, LogError>,
) -> Result<Vec<ReadLog>, Exit> {
    match (&format.calibration, format.axis, &options.columns[..]) {
        (Some(calibration), Some(axis), [x, y, z]) => {
            let path = Path::new(calibration);
            let log = compensated(options, format, (path, axis), [x, y, z])?;
            Ok(vec![log])
        }
        (.., []) => {
            let temperature = load_own_temperature(format).map_err(|errors| {
                let calibration = format.calibration.as_deref().map(Path::new);
                refused_file(calibration, &errors)
            })?;
            let logs = reader(&options.file, format).map_err(|error| unreadable(&error))?;
            Ok(match temperature {
                Some(temperature) => logs
                    .into_iter()
                    .map(|log| log.without(&temperature))
                    .collect(),
                None => logs,
            })
        }
        (.., columns) => {
            let count = columns.len();
            let message = format!("--columns names {count} columns: expected three, of x, y and z");
            Err(refused(&[message]))
        }
    }
}

/// One axis of an assembly without the errors that a calibration has found.
fn compensated(
    options: &LogOptions,
    format: &LogFormat,
    (calibration, axis): (&Path, CaseAxis),
    gyros: [&str; 3],
) -> Result<ReadLog, Exit> {
    let compensation = load_log_compensation(calibration, options.compensation_form)
        .map_err(|errors| refused_file(Some(calibration), &errors))?;
    let columns = AssemblyColumns {
        gyros,
        temperature: format.temperature_column.as_deref(),
    };
    let found = read_assembly_log(&options.file, format, &columns);
    let logs = found.map_err(|error| unreadable(&error))?;
    let axis = axis as usize;
    tell_layout(&logs.gyros[axis]);
    let Log {
        sample_rate_hz,
        ref format,
        ..
    } = logs.gyros[axis];
    Ok(ReadLog {
        sample_rate_hz,
        column: None,
        format: format.clone(),
        words: Words::Whole(Box::new(LogInput::Compensated(compensate_log(
            logs,
            &compensation,
            axis,
        )))),
    })
}

/// Says what is wrong with a file that is named beside the log.
fn refused_file<C: Complaint>(file: Option<&Path>, errors: &[C]) -> Exit {
    let exit = refused(errors);
    match file {
        Some(file) if !file.is_file() => Exit::Io,
        _ => exit,
    }
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
    load_log_format(layout, &options.keys.given).map_err(|errors| refused_file(layout, &errors))
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

/// The gates to hold against logs, which are read alike.
fn gates(options: &LogOptions, logs: &[ReadLog]) -> Result<Option<LogGates>, Vec<ScenarioError>> {
    let Some((path, log)) = options.gates.as_deref().zip(logs.first()) else {
        return Ok(None);
    };
    load_log_gates(path, LogChannels::from(&log.format)).map(Some)
}

/// Measures every log, writes and prints the results.
fn conclude(
    logs: Vec<ReadLog>,
    filters: Option<(&LogFilters, Option<Programs>)>,
    options: &LogOptions,
    as_csv: bool,
) -> io::Result<(Exit, Vec<LogTrial>)> {
    let (filters, programs) = filters.unzip();
    let programs = Starting(programs.flatten());
    let gates = match gates(options, &logs) {
        Ok(gates) => gates,
        Err(errors) => return Ok((refused(&errors), Vec::new())),
    };
    let is_one = logs.len() == 1;
    let (mut trials, mut taken) = (Vec::new(), Vec::new());
    for log in logs {
        let settings = settings(options, &log.format);
        let trial = match log.words {
            Words::Whole(input) => try_log(*input, filters, &settings, &programs),
            Words::Stream(stream) => try_log_stream(*stream, &settings, &programs),
        };
        let mut trial = match trial {
            Ok(trial) => trial,
            Err(error) => {
                output::talk(&format!("error: {error}"));
                let exit = if error.is_read { Exit::Io } else { Exit::Usage };
                return Ok((exit, trials));
            }
        };
        if let Some(gates) = &gates {
            trial.judge(gates);
        }
        let folder = options.output.as_ref().map(|folder| match &log.column {
            Some(column) if !is_one => folder.join(own_name(column, &mut taken)),
            _ => folder.clone(),
        });
        let place = Place::new(folder.as_deref(), "log", options.force);
        if let Err(exit) = place.fill(|folder| trial.write(folder, as_csv)) {
            return Ok((exit, trials));
        }
        if is_one || options.format != Format::Json {
            output::data(&text(&trial, options.format)?)?;
        }
        if let Some(folder) = folder {
            output::talk(&format!("results in {}", folder.display()));
        }
        trials.push(trial);
    }
    if !is_one && options.format == Format::Json {
        let documents = trials.iter().map(|it| text(it, options.format));
        let documents: Vec<String> = documents.collect::<io::Result<_>>()?;
        let documents: Vec<&str> = documents.iter().map(|text| text.trim_end()).collect();
        output::data(&format!("[{}]\n", documents.join(",\n")))?;
    }
    let exits = trials
        .iter()
        .map(|trial| match (trial.has_failed(), trial.is_refused()) {
            (true, _) => Exit::RunFailed,
            (false, true) => Exit::GateFailed,
            (false, false) => Exit::Success,
        });
    let exit = exits.fold(Exit::Success, Exit::worst);
    Ok((exit, trials))
}

/// Name of the folder of a column, that of no other one.
fn own_name(column: &str, taken: &mut Vec<String>) -> String {
    let name = slug(column);
    let is_own = !name.is_empty() && !taken.contains(&name);
    let name = match is_own {
        true => name,
        false => format!("{name}-{}", taken.len() + 1),
    };
    taken.push(name.clone());
    name
}

fn settings(options: &LogOptions, format: &LogFormat) -> LogSettings {
    LogSettings {
        motion: format.motion.unwrap_or_default(),
        settle_s: format.settle_s.unwrap_or(SETTLE_S),
        warm_up_s: options.warm_up_s,
        bias_averaging_time_s: options.bias_averaging_time_s,
        fit_tau_min_s: format.fit_tau_min_s,
        allan: AllanConfig {
            estimator: options.allan_estimator,
            averaging_times: options.averaging_times,
        },
        temperature_reference_c: format.temperature_reference_c,
    }
}

fn text(trial: &LogTrial, format: Format) -> io::Result<String> {
    trial.with_report(|report| {
        format.of(
            || log_text(report, output::width(), output::colour()),
            || log_json(report),
        )
    })
}
