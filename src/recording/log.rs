//! From a file to rate words at equal spacing.

use std::path::Path;

use super::bounds::{check_rate, check_sample_rate, check_temperature};
use super::column::{Columns, EmptyLines};
use super::csv::{self, Wanted};
use super::error::LogError;
use super::input::Input;
use super::timing::{TimeUnit, Timing, timing};
use super::unit::RateUnit;
use super::{npy, npy_heading};
use crate::units::s_to_us;
use crate::wording::counted;

/// What the user says of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFormat {
    /// Samples per second, Hz; none where a time column tells.
    pub sample_rate_hz: Option<f64>,
    /// Unit of the numbers.
    pub unit: RateUnit,
    /// Factor on the numbers before the unit: the units that one count stands for.
    pub scale: f64,
    /// Column of the numbers, by its name or its number from 1; none where there is only one.
    pub column: Option<String>,
    /// Column of the time, likewise.
    pub time_column: Option<String>,
    /// Its unit.
    pub time_unit: TimeUnit,
}

/// A recorded log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Log {
    /// Name of the file without its folder.
    pub file: String,
    /// Column of the numbers where the file has several or names its only one.
    pub column: Option<String>,
    /// Unit it was recorded in.
    pub unit: RateUnit,
    /// Rate words, deg/h; finite.
    pub rate_deg_per_h: Vec<f64>,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// What the time column says; none without one.
    pub timing: Option<Timing>,
    /// Empty lines between the samples.
    pub empty_lines: EmptyLines,
}

impl Log {
    /// Sample period, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        1.0 / self.sample_rate_hz
    }

    /// What is worth saying about how it was read.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let EmptyLines { count, first } = self.empty_lines;
        match self.timing {
            Some(timing) => vec![format!(
                "time column: {:.6} Hz, no gap, stamps within {:.3} us of equal spacing",
                timing.sample_rate_hz,
                s_to_us(timing.jitter_max_s)
            )],
            None if count > 0 => vec![format!(
                "{} between the samples, from line {first} on, passed over: the samples are taken to be \
                 equally spaced all the same",
                counted(count, "empty line")
            )],
            None => Vec::new(),
        }
    }
}

/// Columns of an assembly in one file, by name or number from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AssemblyColumns<'a> {
    /// Rates of the gyros x, y, z.
    pub gyros: [&'a str; 3],
    /// Temperature of the assembly, deg C; none where it was not recorded.
    pub temperature: Option<&'a str>,
}

/// Logs of an assembly.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AssemblyLog {
    /// Logs of the gyros x, y, z, of one length.
    pub gyros: [Log; 3],
    /// Temperature at each of their words, deg C.
    pub temperature_c: Option<Vec<f64>>,
}

/// Reads a log, NPY by its first bytes and text otherwise.
///
/// # Errors
/// [`LogError`]: whatever the file system says; a file that does not hold what `format` says of it.
pub fn read_log(path: &Path, format: &LogFormat) -> Result<Log, LogError> {
    let columns = vec![format.column.as_deref()];
    let columns = read_columns(path, columns, format.time_column.as_deref(), usize::MAX)?;
    let (timing, sample_rate_hz) = spacing(path, &columns, format)?;
    log(path, &columns, 0, format, (timing, sample_rate_hz))
}

/// Reads the logs of three gyros from one text, in one pass; `format.column` is not used.
///
/// # Errors
/// As [`read_log`]; two quantities in one column, a temperature that no assembly has.
pub fn read_assembly_log(
    path: &Path,
    format: &LogFormat,
    columns: &AssemblyColumns<'_>,
) -> Result<AssemblyLog, LogError> {
    let gyros = columns.gyros.map(Some);
    let wanted = gyros.into_iter().chain(columns.temperature.map(Some));
    let time = format.time_column.as_deref();
    let columns = read_columns(path, wanted.collect(), time, usize::MAX)?;
    let spacing = spacing(path, &columns, format)?;
    let gyro = |index: usize| log(path, &columns, index, format, spacing);
    let gyros = [gyro(0)?, gyro(1)?, gyro(2)?];
    let temperature_c = columns.data.get(3).map(|column| column.values.clone());
    for (row, &warmth) in temperature_c.iter().flatten().enumerate() {
        check_temperature(warmth).map_err(|error| LogError::at(path, columns.place(row), error))?;
    }
    Ok(AssemblyLog {
        gyros,
        temperature_c,
    })
}

/// Reads the first numbers of a file as they stand, at most `samples_max`: a stimulus.
///
/// * `column`: of a text, by its name or its number from 1; none where there is only one.
///
/// # Errors
/// As [`read_log`].
pub fn read_stimulus(
    path: &Path,
    column: Option<&str>,
    samples_max: usize,
) -> Result<Vec<f64>, LogError> {
    let columns = read_columns(path, vec![column], None, samples_max)?;
    let column = columns.data.into_iter().next();
    Ok(column.map(|column| column.values).unwrap_or_default())
}

/// Reads columns of a text, or the array of an NPY file; there is a sample.
fn read_columns(
    path: &Path,
    columns: Vec<Option<&str>>,
    time: Option<&str>,
    samples_max: usize,
) -> Result<Columns, LogError> {
    let input = Input::open(path)?;
    let columns = if input.starts_with(npy_heading::MAGIC) {
        let named = columns.iter().flatten().next().copied().or(time);
        if let Some(name) = named {
            let message = format!("an NPY file has no columns: leave `{name}` out");
            return Err(LogError::of_file(path, message));
        }
        npy::read(path, input, samples_max)?
    } else {
        let wanted = Wanted {
            columns,
            time,
            samples_max,
        };
        csv::read(path, input, &wanted)?
    };
    if columns.rows() == 0 {
        return Err(LogError::of_file(path, "holds no sample"));
    }
    Ok(columns)
}

/// What the time column says, and the sample rate, Hz.
fn spacing(
    path: &Path,
    columns: &Columns,
    format: &LogFormat,
) -> Result<(Option<Timing>, f64), LogError> {
    let given = format.sample_rate_hz;
    let timing = match &columns.time {
        Some(time) => Some(timing(path, columns, time, format.time_unit, given)?),
        None => None,
    };
    let from_column = timing.map(|timing| timing.sample_rate_hz);
    let Some(sample_rate_hz) = given.or(from_column) else {
        let message = "the sample rate is not known: give --rate-hz, or a time column with --time";
        return Err(LogError::of_file(path, message));
    };
    check_sample_rate(sample_rate_hz).map_err(|error| LogError::of_file(path, error))?;
    Ok((timing, sample_rate_hz))
}

/// One of the columns as a log.
fn log(
    path: &Path,
    columns: &Columns,
    index: usize,
    format: &LogFormat,
    (timing, sample_rate_hz): (Option<Timing>, f64),
) -> Result<Log, LogError> {
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(Log {
        file: name.to_string_lossy().into_owned(),
        column: columns.data[index].name.clone(),
        unit: format.unit,
        rate_deg_per_h: rates(path, columns, index, format, sample_rate_hz)?,
        sample_rate_hz,
        timing,
        empty_lines: columns.empty_lines,
    })
}

/// The numbers in deg/h.
fn rates(
    path: &Path,
    columns: &Columns,
    index: usize,
    format: &LogFormat,
    sample_rate_hz: f64,
) -> Result<Vec<f64>, LogError> {
    let values = columns.data[index].values.iter().enumerate();
    let rates = values.map(|(row, &value)| {
        let rate = format
            .unit
            .to_deg_per_h(value * format.scale, sample_rate_hz);
        let unit = format.unit;
        let message = match check_rate(rate) {
            Ok(()) => return Ok(rate),
            Err(error) if rate.is_finite() => format!("{value:?} {unit}: {error}"),
            Err(_) => format!("{value:?} {unit} is not a finite rate in deg/h"),
        };
        Err(LogError::at(path, columns.place(row), message))
    });
    rates.collect()
}
