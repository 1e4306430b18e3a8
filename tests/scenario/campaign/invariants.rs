//! What must hold of every run, however odd its scenario.

use std::collections::BTreeMap;
use std::fs;
use std::panic;
use std::path::Path;
use std::sync::{Mutex, Once, PoisonError};

use fogbench::experiment::{Observer, Progress, SuiteOutcome};
use fogbench::report::{self, RunOutcome, RunReport};
use serde_json::Value;

use super::case::Fault;
use crate::support::tree;

/// Listens to a suite and keeps what it would print.
#[derive(Default)]
pub(crate) struct Listener {
    texts: Mutex<BTreeMap<usize, String>>,
}

impl Progress for Listener {
    fn advanced(&self, simulated_s: f64) {
        assert!(simulated_s.is_finite() && simulated_s >= 0.0);
    }
}

impl Observer for Listener {
    fn finished(&self, index: usize, run: &RunReport) {
        let text = report::table_text(run, 100, false) + &report::run_summary_json(run);
        let mut texts = self.texts.lock().unwrap_or_else(PoisonError::into_inner);
        texts.insert(index, text);
    }

    fn failed(&self, _index: usize, outcome: &RunOutcome) {
        assert!(outcome.error.is_some());
    }
}

/// Checks a suite and its folder.
pub(crate) fn check(
    outcome: &SuiteOutcome,
    listener: &Listener,
    output: &Path,
) -> Result<(), Fault> {
    if outcome.broken {
        return Err(panic_fault("internal error"));
    }
    let internal = outcome.runs.iter().filter_map(|run| run.error.as_deref());
    if let Some(error) = internal
        .into_iter()
        .find(|error| error.contains("internal"))
    {
        return Err(Fault::new("internal error", error));
    }
    let failures = failures(outcome);
    let texts = listener
        .texts
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    for text in texts.values() {
        finite_words("table", text, &failures)?;
    }
    let suite = report::suite_text(&outcome.runs, 100, false)
        + &report::comparison_text(&outcome.comparison, 100, false);
    finite_words("suite table", &suite, &failures)?;
    files(output, &failures)?;
    for run in &outcome.runs {
        pictures(run, output)?;
    }
    statuses(outcome, output)
}

/// Checks every file of an output folder.
fn files(output: &Path, failures: &[String]) -> Result<(), Fault> {
    for (path, bytes) in tree(output) {
        let name = path.to_string_lossy().into_owned();
        let last = path.file_name().unwrap_or_default().to_string_lossy();
        if last.ends_with(".npy") || path.starts_with(".fogbench") {
            continue;
        }
        if last.contains(".partial") || last.contains(".old") {
            return Err(Fault::new("left over", name));
        }
        let text = String::from_utf8(bytes)
            .map_err(|error| Fault::new(format!("no text {last}"), error.to_string()))?;
        finite_words(&last, &text, failures)?;
        if last.ends_with(".json") {
            let document = serde_json::from_str::<Value>(&text)
                .map_err(|error| Fault::new(format!("no JSON {last}"), error.to_string()))?;
            no_null(&document, &last)?;
        }
        if last.ends_with(".toml") {
            toml::from_str::<toml::Table>(&text)
                .map_err(|error| Fault::new(format!("no TOML {last}"), error.to_string()))?;
        }
        if last.ends_with(".svg") && text.len() > report::SVG_BYTES_MAX {
            let message = format!("{name} has {} bytes", text.len());
            return Err(Fault::new(format!("large {last}"), message));
        }
    }
    Ok(())
}

/// Refuses a null, which is how a number that is none would stand in JSON.
fn no_null(value: &Value, place: &str) -> Result<(), Fault> {
    match value {
        Value::Null => Err(Fault::new(format!("null in {place}"), place)),
        Value::Array(items) => items.iter().try_for_each(|item| no_null(item, place)),
        Value::Object(fields) => fields
            .iter()
            .try_for_each(|(key, item)| no_null(item, &format!("{place}/{key}"))),
        _ => Ok(()),
    }
}

/// Every picture that a run names is there.
fn pictures(run: &RunOutcome, output: &Path) -> Result<(), Fault> {
    for picture in &run.pictures {
        let path = output.join(&run.folder).join(picture);
        if !path.is_file() {
            return Err(Fault::new("missing picture", path.display().to_string()));
        }
    }
    Ok(())
}

/// The suite's summary says of each run what the run's own summary says.
fn statuses(outcome: &SuiteOutcome, output: &Path) -> Result<(), Fault> {
    let suite = json(&output.join("summary.json"))?;
    let entries = suite["runs"].as_array().cloned().unwrap_or_default();
    if entries.len() != outcome.runs.len() {
        return Err(Fault::new("runs missing", suite["runs"].to_string()));
    }
    for (entry, run) in entries.iter().zip(&outcome.runs) {
        if entry["status"] != run.status().as_str() || entry["folder"] != run.folder.as_str() {
            return Err(Fault::new("wrong status", entry.to_string()));
        }
        if run.error.is_some() {
            continue;
        }
        let summary = json(&output.join(&run.folder).join("summary.json"))?;
        let channels = summary["channels"].as_object().cloned().unwrap_or_default();
        for (name, channel) in channels {
            let is_told = entry["failed_channels"].get(&name).is_some();
            if is_told != channel["error"].is_object() {
                let message = format!("{name}: {}", channel["error"]);
                return Err(Fault::new("failed channel not told", message));
            }
        }
    }
    Ok(())
}

/// A JSON file.
pub(crate) fn json(path: &Path) -> Result<Value, Fault> {
    let text = fs::read_to_string(path)
        .map_err(|error| Fault::new("missing file", format!("{}: {error}", path.display())))?;
    serde_json::from_str(&text).map_err(|error| Fault::new("no JSON", error.to_string()))
}

/// Refuses texts in which a number is none, but for what a failed channel says of its end.
fn finite_words(place: &str, text: &str, failures: &[String]) -> Result<(), Fault> {
    let no_number = ["inf", "NaN", "nan", "infinity", "Infinity"];
    if !no_number.iter().any(|word| text.contains(word)) {
        return Ok(());
    }
    // Tables wrap their lines.
    let mut flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for failure in failures {
        flat = flat.replace(failure.as_str(), "");
    }
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    for word in flat.split(|c| !is_word(c)) {
        if no_number.contains(&word) {
            let at = word.as_ptr().addr() - flat.as_ptr().addr();
            let before: String = flat[..at].chars().rev().take(160).collect();
            let before: String = before.chars().rev().collect();
            let after: String = flat[at..].chars().take(80).collect();
            return Err(Fault::new(format!("{word} in {place}"), before + &after));
        }
    }
    Ok(())
}

/// What the failed channels say of their ends.
fn failures(outcome: &SuiteOutcome) -> Vec<String> {
    let channels = outcome.runs.iter().flat_map(|run| &run.channels);
    let failed = channels.filter_map(|channel| channel.failure.as_ref());
    failed.map(|failure| failure.message.clone()).collect()
}

/// The same files with the same bytes; the bookkeeping of the output folder stands outside.
pub(crate) fn same(kind: &str, left: &Path, right: &Path) -> Result<(), Fault> {
    let files = |folder: &Path| {
        let mut files = tree(folder);
        files.retain(|(path, _)| !path.starts_with(".fogbench"));
        files
    };
    let (left, right) = (files(left), files(right));
    let names = |files: &[(std::path::PathBuf, Vec<u8>)]| {
        let names = files.iter().map(|(path, _)| path.display().to_string());
        names.collect::<Vec<_>>()
    };
    if names(&left) != names(&right) {
        let message = format!("{:?} and {:?}", names(&left), names(&right));
        return Err(Fault::new(format!("{kind}: other files"), message));
    }
    for ((path, first), (_, second)) in left.iter().zip(&right) {
        if first != second {
            let key = format!("{kind}: other bytes");
            return Err(Fault::new(key, path.display().to_string()));
        }
    }
    Ok(())
}

/// Where panics happened, and what they said.
static PANICS: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Keeps the place of every panic from now on.
pub(crate) fn watch_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let earlier = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let place = info.location().map(ToString::to_string).unwrap_or_default();
            let payload = info.payload();
            let text = payload.downcast_ref::<&str>().copied();
            let message = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
            let message = message.unwrap_or_default().to_owned();
            let mut panics = PANICS.lock().unwrap_or_else(PoisonError::into_inner);
            panics.push((place, message));
            drop(panics);
            earlier(info);
        }));
    });
}

/// Starts a new list of panics.
pub(crate) fn forget_panics() {
    PANICS
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clear();
}

/// The first panic since the list was started.
pub(crate) fn panic_fault(kind: &str) -> Fault {
    let panics = PANICS.lock().unwrap_or_else(PoisonError::into_inner);
    let (place, message) = panics.first().cloned().unwrap_or_default();
    Fault::new(format!("{kind} at {place}"), message)
}
