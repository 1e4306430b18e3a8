//! Page of the metrics: the rows of the catalogue, grouped by where they are computed.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use fogbench::metrics::{MetricKey, known_metrics, requirement};

use crate::support::repository;

const HEAD: &str = "\
# Metrics

<!-- Generated from the declarations in src/metrics by the test `generated_page_of_the_metrics`. -->

Rates are in deg/h. An interval is a 95 % confidence interval for the ensemble value: the mean over seeds
of records of this length and warm-up in the same scenario; see [intervals](intervals.md). A metric that a record cannot support is left out and named with its reason; it is never guessed. `raw` is
what a filter is given: the output of the gyro, or with a `[compensation]` the compensated output.

- *Bias stability* is the standard deviation of non-overlapping means (the practice of GJB 2426A) and
  depends on the averaging time; *bias instability* is the flicker coefficient B, the floor of the Allan
  deviation over 0.664. The two words are never mixed.
- *Truth* is the inertial rate of the gyro's input axis: what the table really does, servo included, plus
  the projection of Earth rate.
- A value without an interval says `exact`, or why a single record gives none; `repeats` gives it.
- A gate passes when the whole interval lies inside its limits, fails when it lies outside, and is
  *inconclusive*, which fails too unless the gate allows it, when the interval reaches over a limit.

The tables say for which motions a metric is defined (*filters* where raw has none), what the record must
offer, which value is the better one ([comparing](compare.md)), and how independent repeats are pooled (*mean*: what has degrees of freedom as root of the mean
square). In `summary.json` a metric stands under `channels.<name>.<key>`; see [results](output.md). The
source file of a metric declares it beside its computation.
";

/// Path of the file that declares a metric, from the root of the repository.
fn declaration(key: &MetricKey, sources: &BTreeMap<String, String>) -> String {
    let literal = format!("\"{}\",", key.name);
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let declares = |text: &&String| {
        text.match_indices(&literal).any(|(at, _)| {
            let call = text[..at].trim_end().strip_suffix('(');
            call.is_some_and(|call| call.trim_end_matches(is_name).ends_with("MetricKey::"))
        })
    };
    let mut found = sources.iter().filter(|(_, text)| declares(text));
    let path = found.next().map(|(path, _)| path.clone());
    path.unwrap_or_else(|| panic!("no file of src/metrics declares {}", key.name))
}

fn read_sources(folder: &str, sources: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(repository(folder))
        .expect("a folder is readable")
        .flatten()
    {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{folder}/{name}");
        if entry.path().is_dir() {
            read_sources(&path, sources);
        } else if Path::new(&name).extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(entry.path()).expect("a source file is readable");
            sources.insert(path, text);
        }
    }
}

/// First sentence of the documentation of a module.
fn subject(text: &str) -> String {
    let doc: Vec<&str> = text
        .lines()
        .map_while(|line| line.strip_prefix("//!"))
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let doc = doc.join(" ");
    let first = doc.split_inclusive(". ").next();
    first.unwrap_or_default().trim().to_owned()
}

/// Module of `src/metrics` that holds a file: its folder there, or the file itself.
fn room(path: &str) -> &str {
    let inside = path.strip_prefix("src/metrics/").unwrap_or(path);
    inside.split(['/', '.']).next().unwrap_or_default()
}

/// Metrics of a module with the files that declare them.
struct Room<'a> {
    name: String,
    keys: Vec<(&'a MetricKey, String)>,
}

fn rooms(sources: &BTreeMap<String, String>) -> Vec<Room<'static>> {
    let mut rooms: Vec<Room> = Vec::new();
    for key in known_metrics() {
        let file = declaration(key, sources);
        let name = room(&file);
        if let Some(room) = rooms.iter_mut().find(|room| room.name == name) {
            room.keys.push((key, file));
        } else {
            rooms.push(Room {
                name: name.to_owned(),
                keys: vec![(key, file)],
            });
        }
    }
    rooms
}

/// Row of a metric that `file` declares.
fn row(key: &MetricKey, file: &str) -> String {
    let only = if key.filters_only { "filters; " } else { "" };
    let records = key.applies.words().trim_end_matches(',');
    let reference = match key.reference() {
        "" => String::new(),
        reference => format!("; against {reference}"),
    };
    let pooling = key.pooling();
    let pooling = pooling.split(';').next().unwrap_or_default();
    let source = file.rsplit('/').next().unwrap_or_default();
    let cells = [
        format!("`{}`", key.name),
        key.unit.to_owned(),
        key.definition.to_owned(),
        format!("{only}{records}{reference}"),
        requirement(key),
        key.better.as_str().to_owned(),
        pooling.to_owned(),
        format!("[{source}](../{file})"),
    ];
    format!("| {} |\n", cells.join(" | "))
}

/// Markdown page of the metrics.
pub(crate) fn page() -> String {
    let mut sources = BTreeMap::new();
    read_sources("src/metrics", &mut sources);
    let mut page = HEAD.to_owned();
    for Room { name, keys } in rooms(&sources) {
        let folder = format!("src/metrics/{name}/mod.rs");
        let file = format!("src/metrics/{name}.rs");
        let module = sources.get(&folder).or_else(|| sources.get(&file));
        let doc = subject(module.expect("a module has a file"));
        write!(page, "\n## {name}\n\n{doc}\n\n").expect("a string takes it");
        page.push_str("| key | unit | definition | defined for | needs | better | repeats | source |\n|---|---|---|---|---|---|---|---|\n");
        for (key, file) in keys {
            page.push_str(&row(key, &file));
        }
    }
    page
}
