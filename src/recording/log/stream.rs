//! Logs too long to be kept: their words while they come in.

use std::path::{Path, PathBuf};

use super::format::LogFormat;
use super::gaps::Gaps;
use super::rates::{Neighbours, rate_of};
use super::read::{log, logs_of, no_sample, spacing, wanted_by, with_samples};
use super::record::Log;
use crate::recording::column::Columns;
use crate::recording::error::{LogError, Place};
use crate::recording::input::Input;
use crate::recording::layout::words::MissingWords;
use crate::recording::npy::archive;
use crate::recording::npy::array::{self, ArrayWords};
use crate::recording::npy::heading::ArrayHeading;
use crate::recording::npy::number::Missing;
use crate::recording::text::head::{HEAD_LINES, LIVE_HEAD_LINES};
use crate::recording::text::lines::shown;
use crate::recording::text::table::{Rows, Wanted};
use crate::recording::time::timing::Spacing;
use crate::recording::unit::convert::Conversion;

/// Most words of a log from a pipe that are kept: a longer one streams.
const KEPT_WORDS: usize = 10_000_000;

/// Most words of a file that are kept.
const FILE_WORDS_KEPT: usize = 100_000_000;

/// Words that are read at a time.
const BLOCK: usize = 1 << 17;

/// The same where words are wanted as they come: none waits for the next one, and all before a fault are had.
const LIVE_BLOCK: usize = 1;

/// A log, whole or while it comes in.
pub enum LogSource {
    /// All of it, one log for each column.
    Whole(Vec<Log>),
    /// Its first words, and the rest as it is read.
    Stream(Box<LogStream>),
}

/// A log of one column of which the first words were read.
pub struct LogStream {
    path: PathBuf,
    /// What is known of the log, its first words among it.
    log: Log,
    conversion: Conversion,
    spacing: Spacing,
    rest: Rest,
    /// Rows that were read before the block that is read now.
    rows_before: usize,
    /// Words that are read at a time.
    block: usize,
}

/// What is still to be read.
enum Rest {
    Array(Box<(ArrayWords, Input)>),
    Text(Box<Rows>),
}

/// How much of a log is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    /// Most words of a pipe, and the first words of a log that streams.
    pub(crate) words: usize,
    /// Most words of a file.
    pub(crate) of_file: usize,
}

/// Opens a log: one of many words as a stream, if what is asked for of it streams.
///
/// # Errors
/// As [`read_log`](super::read::read_log), as far as it is read.
pub fn open_log(path: &Path, format: &LogFormat) -> Result<LogSource, LogError> {
    let kept = Kept {
        words: KEPT_WORDS,
        of_file: FILE_WORDS_KEPT,
    };
    open_keeping(path, format, kept)
}

/// As [`open_log`], of which so much is kept.
pub(crate) fn open_keeping(
    path: &Path,
    format: &LogFormat,
    kept: Kept,
) -> Result<LogSource, LogError> {
    let mut input = Input::open(path)?;
    let wanted = wanted_by(format, Gaps::of(format, false));
    let most = match input.length() {
        Some(_) => kept.of_file,
        None => kept.words,
    };
    if archive::is_archive(&input, format) {
        let columns = with_samples(path, archive::read(path, &input, &wanted)?, format)?;
        return logs_of(path, columns, &wanted).map(LogSource::Whole);
    }
    if array::is_array(&input, format) {
        let heading = array::read_heading(path, &mut input, format)?;
        return open_array(path, heading, input, &wanted, (most, kept.words));
    }
    if streams(format) {
        input.let_go_on();
    }
    let Some(mut rows) = Rows::open(path, input, &wanted, HEAD_LINES)? else {
        return Err(no_sample(path, format));
    };
    let may_go_on = streams(format);
    let goes_on = rows.read_up_to(if may_go_on { most } else { wanted.samples_max })?;
    if !goes_on || !may_go_on {
        let columns = with_samples(path, rows.into_columns(), format)?;
        return logs_of(path, columns, &wanted).map(LogSource::Whole);
    }
    let columns = rows.take();
    let found = Found::of(path, columns, &wanted)?;
    let stream = found.with(path, Rest::Text(Box::new(rows)));
    Ok(LogSource::Stream(Box::new(stream)))
}

/// Opens a log of one column whose words are wanted as they come, all at its sample rate.
///
/// No word waits for the next one, but for those of the lines from which the layout is found.
///
/// # Errors
/// What needs the whole log, a sample rate that is not given, whatever is wrong with the first words.
pub fn open_live_log(path: &Path, format: &LogFormat) -> Result<LogStream, LogError> {
    let refuse = |error: NotLive| LogError::of_file(path, error);
    if let Some(option) = whole_for(format) {
        return Err(refuse(NotLive::Whole(option)));
    }
    if format.rate_hz.is_none() {
        return Err(refuse(NotLive::NoRate));
    }
    let mut input = Input::open(path)?;
    input.let_go_on();
    let wanted = wanted_by(format, Gaps::Passed);
    if archive::is_archive(&input, format) {
        return Err(refuse(NotLive::Columns("an archive")));
    }
    let (columns, rest) = if array::is_array(&input, format) {
        let heading = array::read_heading(path, &mut input, format)?;
        if !heading.is_plain_row() {
            return Err(refuse(NotLive::Columns("an array of several columns")));
        }
        let heading = heading.plain;
        array::check_columns(path, &heading, &wanted)?;
        let may_end = input.length().is_none();
        let mut words =
            ArrayWords::new(path, heading, may_end, Missing::of(&wanted)).at_a_time(LIVE_BLOCK);
        let mut values = Vec::new();
        words.read(&mut input, &mut values)?;
        let mut columns = words.columns(values);
        columns.note = None;
        (columns, Rest::Array(Box::new((words, input))))
    } else {
        let Some(mut rows) = Rows::open(path, input, &wanted, LIVE_HEAD_LINES)? else {
            return Err(no_sample(path, format));
        };
        rows.read_head(usize::MAX)?;
        rows.read_up_to(1)?;
        (rows.take(), Rest::Text(Box::new(rows)))
    };
    let columns = with_samples(path, columns, format)?;
    let stream = Found::of(path, columns, &wanted)?.with(path, rest);
    Ok(LogStream {
        block: LIVE_BLOCK,
        ..stream
    })
}

/// Why words are not passed on as they come.
#[derive(Debug, thiserror::Error)]
enum NotLive {
    #[error(
        "{0} needs the whole log, and words that are passed on as they come are not kept: leave one of them \
         out"
    )]
    Whole(&'static str),
    #[error("filters are built for a sample rate before the first word comes: give --rate-hz")]
    NoRate,
    #[error("{0} is read as a whole: pass on words of one column, as with --dtype, or text")]
    Columns(&'static str),
}

/// Whether a log streams under a format: one column, all of it, without gaps, a reference or a temperature.
fn streams(format: &LogFormat) -> bool {
    whole_for(format).is_none()
}

/// What is asked for that a log must be kept for, as an option.
fn whole_for(format: &LogFormat) -> Option<&'static str> {
    let column = format.column.as_deref().unwrap_or_default();
    let is_one = column.len() < 2 && column.iter().all(|name| !name.contains('*'));
    let asked = [
        (!is_one, "--column with several columns"),
        (format.rows.is_some(), "--rows"),
        (format.from_s.is_some(), "--from-s"),
        (format.to_s.is_some(), "--to-s"),
        (format.segments.is_some(), "--segments"),
        (format.split_gaps == Some(true), "--split-gaps"),
        (format.gap_aware.is_some(), "--gap-aware"),
        (format.missing == Some(MissingWords::Gap), "--missing gap"),
        (format.reference_column.is_some(), "--reference-column"),
        (format.temperature_column.is_some(), "--temperature-column"),
    ];
    let mut asked = asked.into_iter().filter(|(is_asked, _)| *is_asked);
    asked.next().map(|(_, option)| option)
}

fn open_array(
    path: &Path,
    heading: ArrayHeading,
    mut input: Input,
    wanted: &Wanted<'_>,
    (most, first): (usize, usize),
) -> Result<LogSource, LogError> {
    let format = wanted.format;
    let is_long = heading.plain.rows > most as u64;
    if !is_long || !heading.is_plain_row() || !streams(format) {
        let columns = array::read_behind(path, &heading, input, wanted)?;
        let columns = with_samples(path, columns, format)?;
        return logs_of(path, columns, wanted).map(LogSource::Whole);
    }
    array::check_columns(path, &heading.plain, wanted)?;
    let may_end = input.length().is_none();
    input.let_go_on();
    let mut words = ArrayWords::new(path, heading.plain, may_end, Missing::of(wanted));
    let mut values = Vec::new();
    let mut goes_on = true;
    while goes_on && values.len() < first {
        goes_on = words.read(&mut input, &mut values)?;
    }
    let columns = with_samples(path, words.columns(values), format)?;
    if !goes_on {
        return logs_of(path, columns, wanted).map(LogSource::Whole);
    }
    let found = Found::of(
        path,
        Columns {
            note: None,
            ..columns
        },
        wanted,
    )?;
    let stream = found.with(path, Rest::Array(Box::new((words, input))));
    Ok(LogSource::Stream(Box::new(stream)))
}

/// What the first words of a log say of it.
struct Found {
    log: Log,
    conversion: Conversion,
    spacing: Spacing,
}

impl Found {
    fn of(path: &Path, mut columns: Columns, wanted: &Wanted<'_>) -> Result<Self, LogError> {
        let format = wanted.format;
        let data = std::mem::take(&mut columns.data);
        let spacing = spacing(path, &columns, &data, wanted)?;
        let Some(column) = data.into_iter().next() else {
            return Err(no_sample(path, format));
        };
        let conversion = Conversion::of(format, &column);
        let neighbours = Neighbours::of(&column.values);
        let log = log(path, &columns, (column, neighbours), format, &spacing)?;
        let conversion = conversion.map_err(|error| LogError::of_file(path, error))?;
        if conversion.running.is_some() {
            let way_out = match wanted.gaps {
                Gaps::Passed => "",
                _ => ": --rows takes a part of it",
            };
            let message = format!("a running angle does not stream{way_out}");
            return Err(LogError::of_file(path, message));
        }
        Ok(Self {
            log,
            conversion,
            spacing,
        })
    }

    fn with(self, path: &Path, rest: Rest) -> LogStream {
        LogStream {
            path: path.to_owned(),
            rows_before: self.log.rate_deg_per_h.len(),
            log: self.log,
            conversion: self.conversion,
            spacing: self.spacing,
            rest,
            block: BLOCK,
        }
    }
}

impl LogStream {
    /// What is known of the log; its words are those that were read first, until they are taken.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Takes the first words, deg/h.
    pub fn take_first_words(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.log.rate_deg_per_h)
    }

    /// Reads the next words, deg/h, in place of those of the buffer; none at the end.
    ///
    /// # Errors
    /// Whatever is wrong with them, at its place.
    pub fn read(&mut self, words: &mut Vec<f64>) -> Result<(), LogError> {
        words.clear();
        match &mut self.rest {
            Rest::Array(array) => {
                let (array, input) = &mut **array;
                while words.len() < self.block && array.read(input, words)? {}
                if words.is_empty() {
                    self.log.remark(array.early_end());
                }
            }
            Rest::Text(rows) => {
                rows.read_up_to(self.block)?;
                rows.take_values(words);
                check_steps(&self.path, rows, &self.spacing)?;
            }
        }
        let rate_hz = self.spacing.sample_rate_hz;
        for (row, word) in words.iter_mut().enumerate() {
            *word = rate_of(&self.conversion, rate_hz, *word).map_err(|error| {
                let place = match &self.rest {
                    Rest::Array(_) => Place::Index(self.rows_before + row),
                    Rest::Text(rows) => rows.columns().place(row),
                };
                LogError::at(&self.path, place, error)
            })?;
        }
        self.rows_before += words.len();
        if let Rest::Text(rows) = &mut self.rest {
            rows.clear();
        }
        Ok(())
    }

    /// What is known of the log, once all of its words were read.
    #[must_use]
    pub fn into_log(mut self) -> Log {
        if let Rest::Text(rows) = &self.rest {
            self.log.lines_between = rows.columns().lines_between;
        }
        self.log
    }
}

/// Holds the stamps of a block, that of the row before it first, against the spacing of the first rows.
fn check_steps(path: &Path, rows: &Rows, spacing: &Spacing) -> Result<(), LogError> {
    let columns = rows.columns();
    let (Some(time), Some(steps)) = (&columns.time, spacing.steps) else {
        return Ok(());
    };
    for (row, pair) in time.stamps.windows(2).enumerate() {
        steps.check(pair[1] - pair[0]).map_err(|error| {
            let message = format!("column {}: {error}", shown(&time.name));
            LogError::at(path, columns.place(row), message)
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::layout::words::WordType;
    use crate::recording::log::read::read_log;
    use crate::recording::unit::kinds::RateUnit;

    const KEPT: Kept = Kept {
        words: 1000,
        of_file: 1000,
    };

    fn format() -> LogFormat {
        LogFormat {
            unit: Some(RateUnit::DEG_PER_H.into()),
            ..LogFormat::default()
        }
    }

    fn scratch(content: &[u8]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        std::fs::write(&path, content).unwrap();
        (folder, path)
    }

    /// All words of a log that streams, and the log.
    fn streamed(path: &Path, format: &LogFormat) -> Result<(Vec<f64>, Log), LogError> {
        let LogSource::Stream(mut stream) = open_keeping(path, format, KEPT)? else {
            panic!("it is kept");
        };
        let mut words = stream.take_first_words();
        assert!(words.len() >= KEPT.words && words.len() < KEPT.words + BLOCK);
        let mut block = Vec::new();
        loop {
            stream.read(&mut block)?;
            if block.is_empty() {
                return Ok((words, stream.into_log()));
            }
            words.extend_from_slice(&block);
        }
    }

    #[test]
    fn words_that_stand_alone_are_those_of_the_whole_file() {
        let counts = (0..300_000_u32).map(|k| i16::try_from(k % 251).unwrap() - 125);
        let bytes: Vec<u8> = counts.flat_map(i16::to_be_bytes).collect();
        let (_folder, path) = scratch(&bytes);
        let format = LogFormat {
            dtype: Some(WordType::I2Be),
            scale: Some(0.25),
            rate_hz: Some(100.0),
            ..format()
        };
        let whole = read_log(&path, &format).unwrap();
        assert_eq!(whole.rate_deg_per_h[3..4], [0.25 * (3.0 - 125.0)]);
        assert_eq!(streamed(&path, &format).unwrap().0, whole.rate_deg_per_h);
        std::fs::write(&path, &bytes[..4001]).unwrap();
        let error = read_log(&path, &format).unwrap_err().to_string();
        assert!(
            error.ends_with("ends within a number: 1 of its 2 bytes are there"),
            "{error}"
        );
    }

    #[test]
    fn empty_lines_are_told_wherever_they_stand() {
        let text = "1\n2\n".repeat(100_000);
        let text = format!("{text}\n{text}");
        let (_folder, path) = scratch(text.as_bytes());
        let format = LogFormat {
            rate_hz: Some(100.0),
            ..format()
        };
        let (_, log) = streamed(&path, &format).unwrap();
        let notes = log.notes().concat();
        assert!(
            notes.contains("1 empty line between the samples, from line 200001 on"),
            "{notes}"
        );
    }

    #[test]
    fn rows_of_a_text_are_those_of_the_whole_file_and_their_stamps_are_checked() {
        use std::fmt::Write as _;
        let mut text = "time_s,rate\n".to_owned();
        for k in 0..200_000 {
            writeln!(text, "{}.{:02},{}", k / 100, k % 100, (k * 37) % 101).unwrap();
        }
        let (_folder, path) = scratch(text.as_bytes());
        let whole = read_log(&path, &format()).unwrap();
        let (words, log) = streamed(&path, &format()).unwrap();
        assert_eq!(words, whole.rate_deg_per_h);
        assert!((log.sample_rate_hz / whole.sample_rate_hz - 1.0).abs() < 1e-9);
        let gap = text.replace("1900.50,", "1901.50,");
        std::fs::write(&path, gap).unwrap();
        let error = streamed(&path, &format()).unwrap_err().to_string();
        assert!(
            error.contains("log:190052: column time_s: gap of 1.010000000 s"),
            "{error}"
        );
        let word = text.replace("1900.50,", "1900.50,x");
        std::fs::write(&path, word).unwrap();
        let error = streamed(&path, &format()).unwrap_err().to_string();
        assert!(error.contains("log:190052: column rate: `x"), "{error}");
    }
}
