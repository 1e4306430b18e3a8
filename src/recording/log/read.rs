//! From a file to rate words at equal spacing.

use std::ops::Range;
use std::path::Path;

use super::format::LogFormat;
use super::gaps::Gaps;
use super::rates::{Neighbours, Taken, Words, angle_remark};
use super::record::Log;
use super::stretches::parts;
use crate::recording::bounds::{check_sample_rate, check_temperature};
use crate::recording::column::{Column, Columns};
use crate::recording::error::LogError;
use crate::recording::input::Input;
use crate::recording::layout::Asked;
use crate::recording::layout::columns::Selection;
use crate::recording::layout::words::WordKind;
use crate::recording::log::rows::LogRows;
use crate::recording::npy::{archive, array};
use crate::recording::text::lines::shown;
use crate::recording::text::table::{self, Wanted};
use crate::recording::time::timing::{Spacing, timing};
use crate::recording::unit::convert::Conversion;

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
    one_of(path, read_logs(path, format)?)
}

/// As [`read_log`], for what needs every word: a complaint about a gap names no way to go on with it.
///
/// # Errors
/// As [`read_log`].
pub fn read_unbroken_log(path: &Path, format: &LogFormat) -> Result<Log, LogError> {
    one_of(path, read_unbroken_logs(path, format)?)
}

fn one_of(path: &Path, mut logs: Vec<Log>) -> Result<Log, LogError> {
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
    logs_with(path, format, Gaps::of(format, false))
}

/// As [`read_logs`] and [`read_unbroken_log`].
///
/// # Errors
/// As [`read_log`].
pub fn read_unbroken_logs(path: &Path, format: &LogFormat) -> Result<Vec<Log>, LogError> {
    logs_with(path, format, Gaps::of(format, true))
}

fn logs_with(path: &Path, format: &LogFormat, gaps: Gaps) -> Result<Vec<Log>, LogError> {
    let wanted = wanted_by(format, gaps);
    logs_of(path, read_wanted(path, &wanted)?, &wanted)
}

/// What a format asks for of a log.
pub(super) fn wanted_by(format: &LogFormat, gaps: Gaps) -> Wanted<'_> {
    Wanted {
        columns: Selection::Named(format.column.as_deref().unwrap_or_default()),
        needs_time: true,
        gaps,
        format,
        samples_max: format.rows.and_then(LogRows::last).unwrap_or(usize::MAX),
    }
}

/// The logs of columns that were read.
pub(super) fn logs_of(
    path: &Path,
    mut columns: Columns,
    wanted: &Wanted<'_>,
) -> Result<Vec<Log>, LogError> {
    let format = wanted.format;
    let mut data = std::mem::take(&mut columns.data);
    let temperature = match format.temperature_column {
        Some(_) => data.pop(),
        None => None,
    };
    let reference = match format.reference_column {
        Some(_) => data.pop(),
        None => None,
    };
    // Stamps and numbers have nothing to do with each other yet.
    let (spacing, neighbours) = rayon::join(
        || spacing(path, &columns, &data, wanted),
        || -> Vec<Neighbours> {
            let values = data.iter().map(|column| Neighbours::of(&column.values));
            values.collect()
        },
    );
    let spacing = spacing?;
    let logs = data.into_iter().zip(neighbours);
    let mut logs = logs
        .map(|(column, neighbours)| log(path, &columns, (column, neighbours), format, &spacing))
        .collect::<Result<Vec<Log>, LogError>>()?;
    if let Some(column) = temperature {
        for log in &mut logs {
            // A word of a running angle stands at the end of its step: the first row has none.
            let without_word = usize::from(log.format.kind == Some(WordKind::Angle));
            log.temperature_c = temperatures(path, &columns, (&column, without_word), &spacing)?;
        }
    }
    if let Some(column) = reference {
        let format = format.of_reference(column.unit);
        let neighbours = Neighbours::of(&column.values);
        let reference = log(path, &columns, (column, neighbours), &format, &spacing)
            .map_err(LogError::of_reference)?;
        for log in &mut logs {
            log.take_reference(&reference)
                .map_err(|error| LogError::of_file(path, error))?;
        }
    }
    Ok(logs)
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
    let gyros = columns.gyros.map(|name| Asked::by(name, "columns"));
    let temperature = columns
        .temperature
        .map(|name| Asked::by(name, "temperature_column"));
    let asked = gyros.into_iter().chain(temperature);
    let wanted = Wanted {
        columns: Selection::Each(asked.collect()),
        ..wanted_by(format, Gaps::Refused)
    };
    let mut columns = read_wanted(path, &wanted)?;
    let mut data = std::mem::take(&mut columns.data);
    let spacing = spacing(path, &columns, &data, &wanted)?;
    let temperature = (data.len() > 3).then(|| data.remove(3));
    let logs = data.into_iter().map(|column| {
        let neighbours = Neighbours::of(&column.values);
        log(path, &columns, (column, neighbours), format, &spacing)
    });
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
    let temperature_c = temperature
        .map(|column| temperatures(path, &columns, (&column, 0), &spacing))
        .transpose()?;
    Ok(AssemblyLog {
        gyros,
        temperature_c,
    })
}

/// The temperatures at the words of every stretch, one that is missing between two.
///
/// * `without_word`: rows at the start of a stretch that have no word.
///
/// # Errors
/// A temperature that no gyro has.
fn temperatures(
    path: &Path,
    columns: &Columns,
    (column, without_word): (&Column, usize),
    spacing: &Spacing,
) -> Result<Vec<f64>, LogError> {
    let mut temperature_c = Vec::new();
    for rows in &spacing.stretches {
        let rows = rows.start + without_word..rows.end;
        if rows.is_empty() {
            continue;
        }
        if !temperature_c.is_empty() {
            temperature_c.push(f64::NAN);
        }
        for row in rows {
            let warmth = column.values[row];
            // The reader lets a missing number pass only where that is a gap.
            if !warmth.is_nan() {
                check_temperature(warmth)
                    .map_err(|error| LogError::at(path, columns.place(row), error))?;
            }
            temperature_c.push(warmth);
        }
    }
    Ok(temperature_c)
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
        gaps: Gaps::Unsaid,
        format: &format,
        samples_max,
    };
    let columns = read_wanted(path, &wanted)?;
    let column = columns.data.into_iter().next();
    Ok(column.map(|column| column.values).unwrap_or_default())
}

/// Reads columns of a text or an array; there is a sample.
fn read_wanted(path: &Path, wanted: &Wanted<'_>) -> Result<Columns, LogError> {
    let input = Input::open(path)?;
    let columns = if archive::is_archive(&input, wanted.format) {
        archive::read(path, &input, wanted)?
    } else if array::is_array(&input, wanted.format) {
        array::read(path, input, wanted)?
    } else {
        table::read(path, input, wanted)?
    };
    with_samples(path, columns, wanted.format)
}

/// A log without a sample, with what was said of it that may leave it none.
pub(super) fn no_sample(path: &Path, format: &LogFormat) -> LogError {
    let skipped = format.skip_lines.filter(|lines| *lines > 0);
    let skipped = skipped.map(|lines| format!("--skip-lines {lines}"));
    let encoding = format.encoding.map(|it| format!("--encoding {it}"));
    let comment = format.comment.as_deref();
    let comment = comment.map(|mark| format!("--comment {}", shown(mark)));
    let said = [
        (skipped, "skip_lines"),
        (encoding, "encoding"),
        (comment, "comment"),
    ];
    let said = said
        .into_iter()
        .filter_map(|(said, key)| Some((said?, key)));
    let (said, keys): (Vec<String>, Vec<&'static str>) = said.unzip();
    match said.is_empty() {
        true => LogError::of_file(path, "holds no sample"),
        false => LogError::of_file(
            path,
            format!("holds no sample, read with {}", said.join(", ")),
        ),
    }
    .about(keys.first().copied())
}

/// Columns that hold a sample.
pub(super) fn with_samples(
    path: &Path,
    columns: Columns,
    format: &LogFormat,
) -> Result<Columns, LogError> {
    match columns.rows() {
        0 => Err(no_sample(path, format)),
        _ => Ok(columns),
    }
}

/// What the time column says, the sample rate, and the stretches of rows that are taken.
pub(super) fn spacing(
    path: &Path,
    columns: &Columns,
    data: &[Column],
    wanted: &Wanted<'_>,
) -> Result<Spacing, LogError> {
    let format = wanted.format;
    let rows = data.first().map_or(0, |column| column.values.len());
    let stretches = parts(path, columns, rows, format)?;
    let spacing = match &columns.time {
        Some(time) => timing(path, columns, time, (format, wanted.gaps), &stretches),
        None => by_rate(path, columns, format, stretches),
    };
    let spacing = spacing.map_err(|error| with_units(path, data, format, error))?;
    check_sample_rate(spacing.sample_rate_hz).map_err(|error| match &columns.time {
        Some(time) => {
            let name = shown(&time.name);
            let way_out = format!("{error}: --time-unit says what the stamps of column {name} are");
            LogError::of_file(path, way_out)
        }
        None => LogError::of_file(path, error),
    })?;
    Ok(spacing)
}

fn by_rate(
    path: &Path,
    columns: &Columns,
    format: &LogFormat,
    stretches: Vec<Range<usize>>,
) -> Result<Spacing, LogError> {
    let Some(sample_rate_hz) = format.rate_hz else {
        let unread = columns.unread_time.as_deref().unwrap_or_default();
        let message = format!(
            "the sample rate is not known: give --rate-hz, or a time column with --time{unread}"
        );
        return Err(LogError::of_file(path, message));
    };
    Ok(Spacing {
        timing: None,
        sample_rate_hz,
        stretches,
        spanned: Vec::new(),
        notes: Vec::new(),
        steps: None,
    })
}

/// A complaint about the time, with that about the unit of the numbers if there is one as well.
fn with_units(path: &Path, data: &[Column], format: &LogFormat, error: LogError) -> LogError {
    let unit = data
        .iter()
        .find_map(|column| Conversion::of(format, column).err());
    match (error, unit) {
        (
            LogError::Content {
                place,
                message,
                key,
            },
            Some(unit),
        ) => LogError::Content {
            place,
            message: format!("{message}; {unit}"),
            key,
        },
        (LogError::Read { .. }, Some(unit)) => LogError::of_file(path, unit),
        (error, None) => error,
    }
}

/// One of the columns as a log.
pub(super) fn log(
    path: &Path,
    columns: &Columns,
    (column, neighbours): (Column, Neighbours),
    format: &LogFormat,
    spacing: &Spacing,
) -> Result<Log, LogError> {
    let conversion = Conversion::of(format, &column).map_err(|error| {
        let doubts = spacing.notes.iter().map(|note| format!("; {note}"));
        let message = format!("{error}{}", doubts.collect::<String>());
        LogError::of_file(path, message).about(error.key())
    })?;
    let mut remarks = spacing.notes.clone();
    remarks.extend(columns.note.clone());
    remarks.extend(angle_remark(neighbours, &conversion));
    let name = path.file_name().unwrap_or(path.as_os_str());
    let words = Words {
        path,
        columns,
        conversion,
        spacing,
        gap_aware: format.gap_aware.unwrap_or(0) as usize,
    };
    let column_name = column.name.clone();
    let Taken {
        words: rate_deg_per_h,
        stretches,
        bridges,
    } = words.of(column.values)?;
    if rate_deg_per_h.is_empty() {
        return Err(no_sample(path, format));
    }
    Ok(Log {
        file: name.to_string_lossy().into_owned(),
        column: column_name,
        unit: conversion.shown(),
        rate_deg_per_h,
        reference_deg_per_h: Vec::new(),
        temperature_c: Vec::new(),
        sample_rate_hz: spacing.sample_rate_hz,
        timing: spacing.timing,
        lines_between: columns.lines_between,
        stretches,
        bridges,
        gaps_in_time: spacing.stretches.len() - 1 + spacing.spanned.len(),
        layout: columns.layout.clone(),
        format: LogFormat {
            unit: Some(conversion.given()),
            kind: Some(conversion.kind()),
            ..columns.found.as_ref().unwrap_or(format).clone()
        },
        remarks,
    })
}
