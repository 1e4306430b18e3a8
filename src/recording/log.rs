//! From a file to rate words at equal spacing.

use std::ops::Range;
use std::path::Path;

use super::bounds::{check_rate, check_sample_rate, check_temperature};
use super::column::{Column, Columns, EmptyLines};
use super::convert::Conversion;
use super::error::LogError;
use super::format::LogFormat;
use super::input::Input;
use super::layout::columns::Selection;
use super::stretches::parts;
use super::table::{self, Wanted};
use super::text::shown;
use super::timing::{Spacing, Timing, timing};
use super::{npy, npy_heading};
use crate::wording::{counted, plain};

/// Lag-one correlation of words from which on they may be a running angle.
const ANGLE_CORRELATION: f64 = 0.999;
/// Largest lag-one correlation of the steps of an angle whose rate is noise.
const STEP_CORRELATION: f64 = 0.5;
/// Fewest words of which that is asked.
const CORRELATED_MIN: usize = 100;
/// Most stretches whose means are named.
const NAMED_STRETCHES: usize = 6;

/// A recorded log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Log {
    /// Name of the file without its folder.
    pub file: String,
    /// Column of the numbers where the file has several or names its only one.
    pub column: Option<String>,
    /// Unit it was recorded in.
    pub unit: String,
    /// Rate words, deg/h: finite, or NaN where samples are missing.
    pub rate_deg_per_h: Vec<f64>,
    /// What the column of the reference shows at the words, deg/h; empty without one.
    pub reference_deg_per_h: Vec<f64>,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// What the time column says; none without one.
    pub timing: Option<Timing>,
    /// Empty lines between the samples.
    pub empty_lines: EmptyLines,
    /// Stretches of words between which samples are missing.
    pub stretches: Vec<Stretch>,
    /// What the file was taken for, in a line; none of an array.
    pub layout: Option<String>,
    /// The same as a format: what was given, and what was found.
    pub format: LogFormat,
    /// What else is worth saying of how it was read.
    remarks: Vec<String>,
}

/// Words at equal spacing without a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// The words in the log.
    pub words: Range<usize>,
    /// Their mean, deg/h.
    pub mean_deg_per_h: f64,
}

impl Log {
    /// Sample period, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        1.0 / self.sample_rate_hz
    }

    /// Holds a reference against the words: of an angle, or beside one, the first word has no partner.
    fn take_reference(&mut self, reference: &Self) -> Result<(), ReferenceError> {
        if self.has_gaps() || reference.has_gaps() {
            return Err(ReferenceError::Gaps);
        }
        let (words, rates) = (&mut self.rate_deg_per_h, &reference.rate_deg_per_h);
        let count = words.len().min(rates.len());
        words.drain(..words.len() - count);
        self.reference_deg_per_h = rates[rates.len() - count..].to_vec();
        self.stretches = vec![Stretch::of(words, 0..count)];
        let name = reference.column.as_deref().unwrap_or_default();
        self.remarks.push(format!(
            "the true rate is what column {} shows, in {}",
            shown(name),
            reference.unit
        ));
        Ok(())
    }

    /// Whether samples are missing between the words.
    #[must_use]
    pub fn has_gaps(&self) -> bool {
        self.stretches.len() > 1 || self.rate_deg_per_h.iter().any(|word| word.is_nan())
    }

    /// Moves every stretch to the mean of all words, so that noise is measured about each one's own.
    pub fn take_about_common_mean(&mut self) {
        if self.stretches.len() < 2 {
            return;
        }
        let present = self.rate_deg_per_h.iter().filter(|word| !word.is_nan());
        let (sum, count) = present.fold((0.0, 0.0), |(sum, count), word| (sum + word, count + 1.0));
        for stretch in &self.stretches {
            let step = sum / count - stretch.mean_deg_per_h;
            for word in &mut self.rate_deg_per_h[stretch.words.clone()] {
                *word += step;
            }
        }
    }

    /// What is worth saying about how it was read.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let EmptyLines { count, first } = self.empty_lines;
        let mut notes = Vec::new();
        match self.timing {
            Some(timing) => notes.push(timing.note(self.stretches.len())),
            None if count > 0 => notes.push(format!(
                "{} between the samples, from line {first} on, passed over: the samples are taken to be \
                 equally spaced all the same",
                counted(count, "empty line")
            )),
            None => {}
        }
        notes.extend(self.remarks.iter().cloned());
        notes.extend(self.stretches_note());
        notes
    }

    /// What is said of several stretches: how long they are, their means and the largest step between two.
    fn stretches_note(&self) -> Option<String> {
        if self.stretches.len() < 2 {
            let missing = self
                .rate_deg_per_h
                .iter()
                .filter(|word| word.is_nan())
                .count();
            return (missing > 0).then(|| {
                format!(
                    "{} missing: nothing is put in their place, and no sum spans one",
                    counted(missing, "sample")
                )
            });
        }
        let named = self.stretches.iter().take(NAMED_STRETCHES).map(|stretch| {
            format!(
                "{:.4} ({})",
                stretch.mean_deg_per_h,
                counted(stretch.words.len(), "sample")
            )
        });
        let more = self.stretches.len().saturating_sub(NAMED_STRETCHES);
        let more = match more {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let steps = self.stretches.windows(2);
        let steps = steps.map(|two| two[1].mean_deg_per_h - two[0].mean_deg_per_h);
        let largest = steps.fold(
            0.0_f64,
            |most, step| if step.abs() > most.abs() { step } else { most },
        );
        Some(format!(
            "{} with gaps between them are pooled: no sum spans a gap, and each is taken about its own mean. \
             Means {}{more} deg/h; the largest step from one to the next is {largest:.4} deg/h",
            counted(self.stretches.len(), "part"),
            named.collect::<Vec<_>>().join(", ")
        ))
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

/// Reads the log of one column, NPY by its first bytes and text otherwise.
///
/// # Errors
/// [`LogError`]: whatever the file system says; a file that does not hold what `format` says of it;
/// several columns.
pub fn read_log(path: &Path, format: &LogFormat) -> Result<Log, LogError> {
    let mut logs = read_logs(path, format)?;
    match (logs.pop(), logs.len()) {
        (Some(log), 0) => Ok(log),
        (_, others) => {
            let count = others + 1;
            let message = format!("{count} columns are named with --column: expected one here");
            Err(LogError::of_file(path, message))
        }
    }
}

/// Reads the logs of the columns that a format names, in one pass.
///
/// # Errors
/// As [`read_log`].
pub fn read_logs(path: &Path, format: &LogFormat) -> Result<Vec<Log>, LogError> {
    let selection = Selection::Named(format.column.as_deref().unwrap_or_default());
    let mut columns = read_columns(path, selection, format)?;
    let mut data = std::mem::take(&mut columns.data);
    let reference = match format.reference_column {
        Some(_) => data.pop(),
        None => None,
    };
    let spacing = spacing(path, &columns, &data, format)?;
    let logs = data.into_iter();
    let mut logs = logs
        .map(|column| log(path, &columns, column, format, &spacing))
        .collect::<Result<Vec<Log>, LogError>>()?;
    if let Some(column) = reference {
        let format = format.of_reference(column.unit);
        let reference = log(path, &columns, column, &format, &spacing)?;
        for log in &mut logs {
            log.take_reference(&reference)
                .map_err(|error| LogError::of_file(path, error))?;
        }
    }
    Ok(logs)
}

/// Why a reference is not held against the words.
#[derive(Debug, thiserror::Error)]
enum ReferenceError {
    #[error(
        "samples are missing, and a reference is compared word by word: --rows, or --from-s and --to-s, takes \
         a part without gaps"
    )]
    Gaps,
}

/// Reads the logs of three gyros from one text, in one pass; `format.column` is not used.
///
/// # Errors
/// As [`read_log`]; two quantities in one column, a temperature that no assembly has, missing samples.
pub fn read_assembly_log(
    path: &Path,
    format: &LogFormat,
    columns: &AssemblyColumns<'_>,
) -> Result<AssemblyLog, LogError> {
    let wanted = columns.gyros.into_iter().chain(columns.temperature);
    let selection = Selection::Each(wanted.collect());
    let mut columns = read_columns(path, selection, format)?;
    let mut data = std::mem::take(&mut columns.data);
    let spacing = spacing(path, &columns, &data, format)?;
    let temperature = (data.len() > 3).then(|| data.remove(3));
    let logs = data
        .into_iter()
        .map(|column| log(path, &columns, column, format, &spacing));
    let logs = logs.collect::<Result<Vec<Log>, LogError>>()?;
    if let Some(gappy) = logs.iter().find(|log| log.has_gaps()) {
        let message = format!(
            "column {}: samples are missing, which an assembly is not compensated over: --rows or --to-s \
             takes a part without",
            gappy.column.as_deref().unwrap_or_default()
        );
        return Err(LogError::of_file(path, message));
    }
    let gyros = logs
        .try_into()
        .map_err(|_| LogError::of_file(path, "expected three gyros"))?;
    let temperature_c = match temperature {
        Some(column) => {
            for (row, &warmth) in column.values.iter().enumerate() {
                check_temperature(warmth)
                    .map_err(|error| LogError::at(path, columns.place(row), error))?;
            }
            let rows = spacing.stretches[0].clone();
            Some(column.values[rows].to_vec())
        }
        None => None,
    };
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
    let column: Vec<String> = column.map(str::to_owned).into_iter().collect();
    let format = LogFormat::default();
    let wanted = Wanted {
        columns: Selection::Named(&column),
        needs_time: false,
        format: &format,
        samples_max,
    };
    let columns = read_wanted(path, &wanted)?;
    let column = columns.data.into_iter().next();
    Ok(column.map(|column| column.values).unwrap_or_default())
}

/// Reads columns of a log, all of its samples.
fn read_columns(
    path: &Path,
    columns: Selection<'_>,
    format: &LogFormat,
) -> Result<Columns, LogError> {
    let wanted = Wanted {
        columns,
        needs_time: true,
        format,
        samples_max: usize::MAX,
    };
    read_wanted(path, &wanted)
}

/// Reads columns of a text or an array; there is a sample.
fn read_wanted(path: &Path, wanted: &Wanted<'_>) -> Result<Columns, LogError> {
    let input = Input::open(path)?;
    let columns = if input.starts_with(npy_heading::MAGIC) {
        let length = input.length();
        npy::read(path, input, length, wanted)?
    } else {
        table::read(path, input, wanted)?
    };
    if columns
        .data
        .first()
        .is_none_or(|column| column.values.is_empty())
    {
        return Err(LogError::of_file(path, "holds no sample"));
    }
    Ok(columns)
}

/// What the time column says, the sample rate, and the stretches of rows that are taken.
fn spacing(
    path: &Path,
    columns: &Columns,
    data: &[Column],
    format: &LogFormat,
) -> Result<Spacing, LogError> {
    let rows = data.first().map_or(0, |column| column.values.len());
    let stretches = parts(path, columns, rows, format)?;
    let spacing = match &columns.time {
        Some(time) => timing(path, columns, time, format, &stretches),
        None => by_rate(path, format, stretches),
    };
    let spacing = spacing.map_err(|error| with_units(path, data, format, error))?;
    check_sample_rate(spacing.sample_rate_hz).map_err(|error| LogError::of_file(path, error))?;
    Ok(spacing)
}

fn by_rate(
    path: &Path,
    format: &LogFormat,
    stretches: Vec<Range<usize>>,
) -> Result<Spacing, LogError> {
    let Some(sample_rate_hz) = format.rate_hz else {
        let message = "the sample rate is not known: give --rate-hz, or a time column with --time";
        return Err(LogError::of_file(path, message));
    };
    Ok(Spacing {
        timing: None,
        sample_rate_hz,
        stretches,
        notes: Vec::new(),
    })
}

/// A complaint about the time, with that about the unit of the numbers if there is one as well.
fn with_units(path: &Path, data: &[Column], format: &LogFormat, error: LogError) -> LogError {
    let unit = data
        .iter()
        .find_map(|column| Conversion::of(format, column).err());
    match (error, unit) {
        (LogError::Content { place, message }, Some(unit)) => LogError::Content {
            place,
            message: format!("{message}; {unit}"),
        },
        (LogError::Read { .. }, Some(unit)) => LogError::of_file(path, unit),
        (error, None) => error,
    }
}

/// One of the columns as a log.
fn log(
    path: &Path,
    columns: &Columns,
    column: Column,
    format: &LogFormat,
    spacing: &Spacing,
) -> Result<Log, LogError> {
    let conversion = Conversion::of(format, &column).map_err(|error| {
        let doubts = spacing.notes.iter().map(|note| format!("; {note}"));
        let message = format!("{error}{}", doubts.collect::<String>());
        LogError::of_file(path, message)
    })?;
    let mut remarks = spacing.notes.clone();
    remarks.extend(angle_remark(&column.values, &conversion));
    let name = path.file_name().unwrap_or(path.as_os_str());
    let words = Words {
        path,
        columns,
        conversion,
        spacing,
    };
    let column_name = column.name.clone();
    let (rate_deg_per_h, stretches) = words.of(column.values)?;
    if rate_deg_per_h.is_empty() {
        return Err(LogError::of_file(path, "holds no sample"));
    }
    Ok(Log {
        file: name.to_string_lossy().into_owned(),
        column: column_name,
        unit: conversion.shown(),
        rate_deg_per_h,
        reference_deg_per_h: Vec::new(),
        sample_rate_hz: spacing.sample_rate_hz,
        timing: spacing.timing,
        empty_lines: columns.empty_lines,
        stretches,
        layout: columns.layout.clone(),
        format: LogFormat {
            unit: Some(conversion.given()),
            kind: Some(conversion.kind()),
            ..columns.found.as_ref().unwrap_or(format).clone()
        },
        remarks,
    })
}

/// Numbers of a column on their way to words.
struct Words<'a> {
    path: &'a Path,
    columns: &'a Columns,
    conversion: Conversion,
    spacing: &'a Spacing,
}

impl Words<'_> {
    /// The words of every stretch, a missing one between two, and where they stand.
    fn of(&self, mut values: Vec<f64>) -> Result<(Vec<f64>, Vec<Stretch>), LogError> {
        let rows = &self.spacing.stretches;
        if matches!(&rows[..], [all] if *all == (0..values.len()))
            && self.conversion.running.is_none()
        {
            for (row, value) in values.iter_mut().enumerate() {
                *value = self.rate(*value, row)?;
            }
            let stretches = vec![Stretch::of(&values, 0..values.len())];
            return Ok((values, stretches));
        }
        let (mut words, mut stretches) = (Vec::new(), Vec::new());
        for rows in rows {
            let first = words.len() + usize::from(!words.is_empty());
            let taken = self.taken(&values, rows)?;
            if taken.is_empty() {
                continue;
            }
            if first > words.len() {
                words.push(f64::NAN);
            }
            words.extend(taken);
            stretches.push(Stretch::of(&words, first..words.len()));
        }
        Ok((words, stretches))
    }

    /// The words of some rows: one less of a running angle.
    fn taken(&self, values: &[f64], rows: &Range<usize>) -> Result<Vec<f64>, LogError> {
        let numbers = &values[rows.clone()];
        let Some(angle) = self.conversion.running else {
            let words = numbers.iter().zip(rows.clone());
            return words.map(|(number, row)| self.rate(*number, row)).collect();
        };
        let turn = angle.turn() / self.conversion.scale.abs();
        let turns_over = is_within_turn(values, turn);
        let steps = numbers.windows(2).zip(rows.clone().skip(1));
        let words = steps.map(|(pair, row)| {
            let step = pair[1] - pair[0];
            let step = match turns_over && step.abs() > 0.5 * turn {
                true => step - turn * step.signum(),
                false => step,
            };
            self.rate(step, row)
        });
        words.collect()
    }

    /// The rate of a number, deg/h.
    fn rate(&self, number: f64, row: usize) -> Result<f64, LogError> {
        if number.is_nan() {
            return Ok(number);
        }
        let rate = self
            .conversion
            .rate_deg_per_h(number, self.spacing.sample_rate_hz);
        let unit = self.conversion.unit;
        let message = match check_rate(rate) {
            Ok(()) => return Ok(rate),
            Err(error) if rate.is_finite() => format!("{number:?} {unit}: {error}"),
            Err(_) => format!("{number:?} {unit} is not a finite rate in deg/h"),
        };
        Err(LogError::at(self.path, self.columns.place(row), message))
    }
}

impl Stretch {
    pub(super) fn of(words: &[f64], range: Range<usize>) -> Self {
        let present = words[range.clone()].iter().filter(|word| !word.is_nan());
        let (sum, count) = present.fold((0.0, 0.0), |(sum, count), word| (sum + word, count + 1.0));
        Self {
            words: range,
            mean_deg_per_h: sum / count,
        }
    }
}

/// Whether all angles lie within one turn, as those of an encoder do.
fn is_within_turn(angles: &[f64], turn: f64) -> bool {
    let present = angles.iter().filter(|angle| !angle.is_nan());
    let (least, most) = present.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), angle| (least.min(*angle), most.max(*angle)),
    );
    most - least <= turn
}

/// What is said of numbers that were called rates and look like an angle that runs on.
fn angle_remark(values: &[f64], conversion: &Conversion) -> Option<String> {
    if conversion.running.is_some() || values.len() < CORRELATED_MIN {
        return None;
    }
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let (words, steps) = (lag_one(values.iter().copied())?, lag_one(steps)?);
    (words > ANGLE_CORRELATION && steps.abs() < STEP_CORRELATION).then(|| {
        format!(
            "each number follows the one before it (correlation {}) and the steps do not: this may be a \
             running angle rather than a rate; --kind angle with a unit of angle takes it for one",
            plain((words * 1e6).round() / 1e6)
        )
    })
}

/// Correlation of neighbours about the mean; nothing of numbers that do not vary.
fn lag_one(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let (sum, count) = values
        .clone()
        .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    let mean = sum / count;
    let square: f64 = values.clone().map(|value| (value - mean).powi(2)).sum();
    // By the steps, as the ends of an angle that runs on are far from its mean.
    let pairs = values.clone().zip(values.skip(1));
    let steps: f64 = pairs.map(|(one, next)| (next - one).powi(2)).sum();
    (square > 0.0).then(|| 1.0 - 0.5 * steps / square)
}
