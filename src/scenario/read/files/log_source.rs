//! The log that a scenario measures in place of table and gyro: how long it is and how it is stamped.
//!
//! It is read whole when the scenario is, so that what is wrong with it is said before the first run,
//! and again when it runs: nothing of it is kept in between.

use crate::recording::{Log, LogFacts, LogFormat, read_log, read_unbroken_log};
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::message::excerpt::bounded;
use crate::scenario::read::files::named_files::{LOG as TABLE, NamedFile};
use crate::scenario::read::files::temperature_source::{check_axis, load_log_temperature};
use crate::scenario::read::resolved::Resolved;
use crate::seal::digest_of_words;
use crate::wording::option_of;

const FILE_KEY: &str = "log.file";
const SEGMENTS_KEY: &str = "log.segments";
const CALIBRATION_KEY: &str = "log.calibration";
const FILTER: &str = "filter";
const DURATION: &str = "duration_s";
const WARM_UP: &str = "warm_up_s";
/// Relative slack of a duration that is a whole number of samples.
const SLACK: f64 = 1e-9;

/// Reads the log of a scenario, if it has one, and enters how long it is unless less is asked for.
///
/// # Errors
/// A log that cannot be read or is not what is said of it, or is shorter than is asked for.
pub(crate) fn read_into(
    root: &mut Table,
    sources: &Sources,
    named: &[NamedFile],
) -> Result<Option<LogFacts>, ScenarioError> {
    let Some(node) = root.get(TABLE) else {
        return Ok(None);
    };
    // What was read from an array of tables or was written nowhere has no place.
    let mark = node.mark.unwrap_or(Mark {
        source: 0,
        start: 0,
    });
    let complain = |mark: Mark, message: String| sources.error(mark, message);
    let table = node.as_table().cloned().unwrap_or_default();
    let format: LogFormat =
        from_table(&table).map_err(|error| complain(mark, format!("{TABLE}: {error}")))?;
    let Some(file) = named.iter().find(|file| file.key == FILE_KEY) else {
        let message = format!("{FILE_KEY} is required: expected the log that is measured");
        return Err(complain(mark, message));
    };
    let place = table.get("file").and_then(|node| node.mark);
    let place = place.unwrap_or(mark);
    let format = found(format, named);
    let checked = check_axis(&format).map_err(|error| vec![error]);
    checked
        .and_then(|()| load_log_temperature(&format))
        .map_err(|errors| {
            let place = ["calibration", "axis"]
                .iter()
                .find_map(|key| table.get(*key)?.mark);
            let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
            complain(place.unwrap_or(mark), in_keys(&said.join("; ")))
        })?;
    // A filter needs every word.
    let read = match root.contains_key(FILTER) {
        true => read_unbroken_log,
        false => read_log,
    };
    let log = read(&file.path, &format).map_err(|error| {
        let asking = error.key().and_then(|key| table.get(key)?.mark);
        let said = in_keys(&error.to_string());
        complain(asking.unwrap_or(place), format!("{FILE_KEY}: {said}"))
    })?;
    let facts = LogFacts {
        digest: digest_of_log(&log),
        ..log.facts()
    };
    enter_length(root, &facts)
        .map_err(|(mark, error)| complain(mark.unwrap_or(place), error.to_string()))?;
    Ok(Some(facts))
}

/// Digest of the words of a log, of its true rate and of a temperature that it has: a log that was read again
/// is the same by it.
pub(crate) fn digest_of_log(log: &Log) -> String {
    let words = [&log.rate_deg_per_h, &log.reference_deg_per_h].into_iter();
    let temperature = Some(&log.temperature_c).filter(|own| !own.is_empty());
    let parts = words.chain(temperature);
    let digests: Vec<String> = parts.map(|words| digest_of_words(words)).collect();
    digests.join(" ")
}

/// Gives the scenario of a log a duration where the log was not read, as something else is wrong.
pub(crate) fn make_up_length(root: &mut Table) {
    if root.contains_key(TABLE) {
        let (value, mark) = (Value::Float(1.0), None);
        root.entry(DURATION.to_owned())
            .or_insert(Node { value, mark });
    }
}

/// The format with the paths by which its files are found.
fn found(format: LogFormat, named: &[NamedFile]) -> LogFormat {
    let path = |key: &str| {
        let file = named.iter().find(|file| file.key == key)?;
        Some(file.path.to_string_lossy().into_owned())
    };
    LogFormat {
        segments: path(SEGMENTS_KEY),
        calibration: path(CALIBRATION_KEY),
        ..format
    }
}

/// Why a log is too short.
#[derive(Debug, thiserror::Error)]
enum LengthError {
    #[error("{WARM_UP} = {warm_up_s:?} s leaves no sample of {FILE_KEY}, which holds {log_s} s")]
    NothingLeft { warm_up_s: f64, log_s: f64 },
    #[error(
        "{DURATION} = {duration_s:?} s is more than {FILE_KEY} holds behind {WARM_UP}, {left_s} s: leave it \
         out to measure all of it"
    )]
    TooShort { duration_s: f64, left_s: f64 },
}

/// Enters warm-up and duration where nobody wrote them.
fn enter_length(root: &mut Table, facts: &LogFacts) -> Result<(), (Option<Mark>, LengthError)> {
    let mut number = |key: &str, default: f64| {
        let node = root.entry(key.to_owned()).or_insert(Node {
            value: Value::Float(default),
            mark: None,
        });
        let value = match node.value {
            Value::Integer(whole) => whole.to_string().parse().unwrap_or(default),
            Value::Float(value) => value,
            _ => default,
        };
        (value, node.mark)
    };
    let (warm_up_s, warm_up_mark) = number(WARM_UP, 0.0);
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    let log_s = facts.samples as f64 / facts.sample_rate_hz;
    let left_s = log_s - warm_up_s;
    if left_s * facts.sample_rate_hz < 1.0 - SLACK {
        return Err((warm_up_mark, LengthError::NothingLeft { warm_up_s, log_s }));
    }
    let (duration_s, duration_mark) = number(DURATION, left_s);
    if duration_s > left_s * (1.0 + SLACK) {
        return Err((duration_mark, LengthError::TooShort { duration_s, left_s }));
    }
    Ok(())
}

/// What is said of options, of keys: `--time-unit` is `log.time_unit` here.
fn in_keys(message: &str) -> String {
    let mut names: Vec<&str> = LogFormat::TABLE.rows.iter().map(|row| row.name).collect();
    // The longest first, as some begin others.
    names.sort_by_key(|name| std::cmp::Reverse(name.len()));
    let said = names.into_iter().fold(message.to_owned(), |said, name| {
        said.replace(&option_of(name), &format!("{TABLE}.{name}"))
    });
    bounded(&said).into_owned()
}

impl Resolved {
    /// The log that takes the place of table and gyro: where it is found, and how it is read.
    #[must_use]
    pub(crate) fn log_source(&self) -> Option<(&NamedFile, LogFormat)> {
        let format = self.scenario.log.clone()?;
        Some((self.named_file(FILE_KEY)?, found(format, &self.named_files)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::RateUnit;

    #[test]
    fn a_log_of_as_many_other_words_has_another_digest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let digest = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let format = LogFormat {
                rate_hz: Some(100.0),
                unit: Some(RateUnit::DEG_PER_H.into()),
                ..LogFormat::default()
            };
            digest_of_log(&read_log(&path, &format).unwrap())
        };
        let first = digest("1.5\n2.5\n");
        assert_eq!(first, digest("1.50\n2.50\n"));
        assert_ne!(first, digest("1.5\n2.6\n"));
    }
}
