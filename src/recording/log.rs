//! From a file to rate words at equal spacing.

use std::fs;
use std::path::Path;

use super::bounds::{check_rate, check_sample_rate};
use super::column::Columns;
use super::error::LogError;
use super::timing::{TimeUnit, Timing, timing};
use super::unit::RateUnit;
use super::{csv, npy};
use crate::units::s_to_us;

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
        let Some(timing) = self.timing else {
            return Vec::new();
        };
        vec![format!(
            "time column: {:.6} Hz, no gap, stamps within {:.3} us of equal spacing",
            timing.sample_rate_hz,
            s_to_us(timing.jitter_max_s)
        )]
    }
}

/// Reads a log, NPY by its first bytes and text otherwise.
///
/// # Errors
/// [`LogError`]: whatever the file system says; a file that does not hold what `format` says of it.
pub fn read_log(path: &Path, format: &LogFormat) -> Result<Log, LogError> {
    let bytes = fs::read(path).map_err(|source| LogError::read(path, source))?;
    let columns = if bytes.starts_with(npy::MAGIC) {
        let named = format.column.as_deref().or(format.time_column.as_deref());
        if let Some(name) = named {
            let message = format!("an NPY file has no columns: leave `{name}` out");
            return Err(LogError::of_file(path, message));
        }
        npy::read(path, &bytes)?
    } else {
        let (column, time) = (format.column.as_deref(), format.time_column.as_deref());
        csv::read(path, &bytes, column, time)?
    };
    drop(bytes);
    if columns.data.values.is_empty() {
        return Err(LogError::of_file(path, "holds no sample"));
    }
    let timing = match &columns.time {
        Some(time) => {
            let given = format.sample_rate_hz;
            Some(timing(path, &columns, time, format.time_unit, given)?)
        }
        None => None,
    };
    let from_column = timing.map(|timing| timing.sample_rate_hz);
    let Some(sample_rate_hz) = format.sample_rate_hz.or(from_column) else {
        let message = "the sample rate is not known: give --rate-hz, or a time column with --time";
        return Err(LogError::of_file(path, message));
    };
    check_sample_rate(sample_rate_hz).map_err(|message| LogError::of_file(path, message))?;
    let rate_deg_per_h = rates(path, &columns, format, sample_rate_hz)?;
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(Log {
        file: name.to_string_lossy().into_owned(),
        column: columns.data.name,
        unit: format.unit,
        rate_deg_per_h,
        sample_rate_hz,
        timing,
    })
}

/// Reads one more column of a text as it stands, such as a temperature beside the rates.
///
/// # Errors
/// As [`read_log`].
pub fn read_column(path: &Path, column: &str) -> Result<Vec<f64>, LogError> {
    let bytes = fs::read(path).map_err(|source| LogError::read(path, source))?;
    if bytes.starts_with(npy::MAGIC) {
        let message = format!("an NPY file has no columns: leave `{column}` out");
        return Err(LogError::of_file(path, message));
    }
    Ok(csv::read(path, &bytes, Some(column), None)?.data.values)
}

/// The numbers in deg/h.
fn rates(
    path: &Path,
    columns: &Columns,
    format: &LogFormat,
    sample_rate_hz: f64,
) -> Result<Vec<f64>, LogError> {
    let values = columns.data.values.iter().enumerate();
    let rates = values.map(|(row, &value)| {
        let rate = format
            .unit
            .to_deg_per_h(value * format.scale, sample_rate_hz);
        check_rate(rate).map(|()| rate).map_err(|message| {
            let message = format!("{value:?} {}: {message}", format.unit);
            LogError::at(path, columns.place(row), message)
        })
    });
    rates.collect()
}
