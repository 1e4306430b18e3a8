//! Folders of fogbench 0.1.0, which have no record: known by the tool's name in them and by the names of
//! the files it wrote.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::files::read_text;

/// Files of a run, a log or a calibration.
const FILES: [&str; 11] = [
    "summary.json",
    "manifest.toml",
    "allan.csv",
    "psd.csv",
    "runs.csv",
    "autocovariance.csv",
    "scale-factor.csv",
    "calibration.toml",
    "calibration.svg",
    "groups.csv",
    "thermal.svg",
];
/// Pictures of a gyro; those of an assembly begin with the axis.
const PICTURES: [&str; 12] = [
    "rate.svg",
    "before-after.svg",
    "allan.svg",
    "swing.svg",
    "bode.svg",
    "response.svg",
    "scale-factor.svg",
    "spectrum.svg",
    "thermal.svg",
    "noise-delay.svg",
    "rate-gain.svg",
    "filter-response.svg",
];
const SAMPLES: &str = "samples/";
/// First line of a table over several scenarios.
const TABLE_HEADING: &str = "row,base,metric,unit,published,value,low,high,confidence,folder\n";

/// Whether 0.1.0 wrote a file of this name into a folder of results, `/` between the parts.
pub(super) fn is_file_name(name: &str) -> bool {
    if let Some(sample) = name.strip_prefix(SAMPLES) {
        let stem = sample
            .strip_suffix(".npy")
            .or_else(|| sample.strip_suffix(".csv"));
        return stem.is_some_and(|stem| !stem.is_empty() && !stem.contains('/'));
    }
    let picture = ["x-", "y-", "z-"]
        .iter()
        .find_map(|axis| name.strip_prefix(axis));
    FILES.contains(&name) || PICTURES.contains(&picture.unwrap_or(name))
}

/// Whether the folder of a run, a log or a calibration names the tool, in every file that ought to.
pub(super) fn names_the_tool(folder: &Path) -> bool {
    let present = ["summary.json", "manifest.toml", "calibration.toml"].map(|name| {
        let path = folder.join(name);
        path.is_file().then(|| is_named_in(name, &path))
    });
    present.contains(&Some(true)) && !present.contains(&Some(false))
}

/// Whether one of these files names the tool.
fn is_named_in(name: &str, path: &Path) -> bool {
    if name == "summary.json" {
        return json(path)
            .is_some_and(|summary| is_ours(&summary) && summary.get("runs").is_none());
    }
    let text = text_of(path).unwrap_or_default();
    let table: toml::Table = text.parse().unwrap_or_default();
    let word = |table: &str, key: &str, all: &toml::Table| {
        Some(all.get(table)?.get(key)?.as_str()?.to_owned())
    };
    if name == "manifest.toml" {
        return word("tool", "name", &table).is_some_and(|name| name == "fogbench");
    }
    word("provenance", "tool", &table).is_some_and(|tool| tool.starts_with("fogbench "))
}

/// Files of a suite of 0.1.0 in an output folder; none where the summary is not its own.
pub(super) fn suite_files(output: &Path) -> Vec<String> {
    let suite = json(&output.join("summary.json"));
    if !suite.is_some_and(|suite| is_ours(&suite) && suite.get("runs").is_some_and(Value::is_array))
    {
        return Vec::new();
    }
    let mut names = vec!["summary.json".to_owned()];
    let junit = text_of(&output.join("junit.xml"));
    if junit.is_some_and(|text| text.contains("<testsuites name=\"fogbench\"")) {
        names.push("junit.xml".to_owned());
    }
    for entry in fs::read_dir(output).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_table = ["published-", "sensitivity-"]
            .iter()
            .any(|start| name.starts_with(start));
        let Some(stem) = name.strip_suffix(".csv").filter(|_| is_table) else {
            continue;
        };
        if text_of(&entry.path()).is_some_and(|text| text.starts_with(TABLE_HEADING)) {
            names.push(format!("{stem}.svg"));
            names.push(name);
        }
    }
    names
}

fn json(path: &Path) -> Option<Value> {
    serde_json::from_str(&text_of(path)?).ok()
}

fn text_of(path: &Path) -> Option<String> {
    read_text(path).ok().flatten()
}

fn is_ours(document: &Value) -> bool {
    document["tool"]["name"] == "fogbench"
}
