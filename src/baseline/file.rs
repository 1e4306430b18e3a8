//! The file that keeps a side: TOML that people read, edit and commit.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde::Deserialize;

use super::error::BaselineError;
use super::record::{Entry, Id, Interval, Side, point_of};
use crate::metrics::{Better, find};

/// Version of the form.
const SCHEMA: i64 = 1;

/// First line; by it a file is known as a baseline.
const MARK: &str = "# Baseline of fogbench.";

const HEAD: &str = "\
# `fogbench compare` and `fogbench run --baseline` judge results by it; `fogbench baseline update` writes it
# anew. Yours to edit, and kept by an update: direction (lower, higher, none: which value is better),
# absolute_tolerance (in the unit) and relative_tolerance (of value), differences that count for none.
";

/// Whether a text is a baseline that fogbench wrote.
#[must_use]
pub fn is_baseline_toml(text: &str) -> bool {
    text.starts_with(MARK)
}

/// The text of a baseline.
#[must_use]
pub fn to_toml(side: &Side) -> String {
    let mut text = format!(
        "{MARK}\n{HEAD}schema = {SCHEMA}\n\n[tool]\nname = \"fogbench\"\nversion = {}\n",
        quoted(&side.tool_version)
    );
    for entry in &side.entries {
        write_entry(&mut text, entry);
    }
    text
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn write_entry(text: &mut String, entry: &Entry) {
    let mut line = |key: &str, value: &str| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{key} = {value}");
    };
    let number = |value: f64| format!("{value:?}");
    line("\n[[metric]]\nscenario", &quoted(&entry.id.scenario));
    if !entry.id.point.is_empty() {
        let point = entry.id.point.iter();
        let point = point.map(|(key, value)| format!("{} = {value}", quoted(key)));
        let point: Vec<String> = point.collect();
        line("point", &format!("{{ {} }}", point.join(", ")));
    }
    line("channel", &quoted(&entry.id.channel));
    line("metric", &quoted(&entry.id.metric));
    line("value", &number(entry.value));
    match entry.interval {
        Interval::Confidence { low, high } => {
            line("low", &number(low));
            line("high", &number(high));
        }
        Interval::Exact => line("interval", "\"exact\""),
        Interval::Absent => line("interval", "\"absent\""),
    }
    if let Some(freedom) = entry.degrees_of_freedom {
        line("degrees_of_freedom", &number(freedom));
    }
    line("unit", &quoted(&entry.unit));
    let declared = || find(&entry.id.metric).map_or(Better::Neither, |key| key.better);
    line(
        "direction",
        &quoted(entry.better.unwrap_or_else(declared).as_str()),
    );
    if let Some(tolerance) = entry.absolute_tolerance {
        line("absolute_tolerance", &number(tolerance));
    }
    if let Some(tolerance) = entry.relative_tolerance {
        line("relative_tolerance", &number(tolerance));
    }
    line("seed", &entry.seed.to_string());
    line("digest", &quoted(&entry.conditions));
    if !entry.repeats.is_empty() {
        let values: Vec<String> = entry.repeats.iter().copied().map(number).collect();
        line("values", &format!("[{}]", values.join(", ")));
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: i64,
    tool: Tool,
    #[serde(default)]
    metric: Vec<Written>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Tool {
    #[serde(rename = "name")]
    _name: String,
    version: String,
}

/// An entry as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    scenario: String,
    #[serde(default)]
    point: BTreeMap<String, toml::Value>,
    channel: String,
    metric: String,
    value: f64,
    low: Option<f64>,
    high: Option<f64>,
    interval: Option<String>,
    degrees_of_freedom: Option<f64>,
    unit: String,
    direction: Option<String>,
    absolute_tolerance: Option<f64>,
    relative_tolerance: Option<f64>,
    seed: u64,
    digest: String,
    #[serde(default)]
    values: Vec<f64>,
}

/// Reads a baseline.
///
/// # Errors
/// [`BaselineError`]: what is no baseline, or contradicts itself.
pub fn read_baseline(text: &str) -> Result<Side, BaselineError> {
    let document: Document =
        toml::from_str(text).map_err(|error| BaselineError::Syntax(error.to_string()))?;
    if document.schema != SCHEMA {
        return Err(BaselineError::Schema(document.schema));
    }
    let entries = document.metric.into_iter().map(entry);
    let entries: Vec<Entry> = entries.collect::<Result<_, _>>()?;
    let mut seen = BTreeSet::new();
    if let Some(twice) = entries.iter().find(|entry| !seen.insert(&entry.id)) {
        return Err(BaselineError::Twice(twice.id.to_string()));
    }
    Ok(Side {
        tool_version: document.tool.version,
        entries,
        ..Side::default()
    })
}

/// Checks names and numbers but the interval.
fn check(id: &Id, written: &Written) -> Result<(), BaselineError> {
    let range = |key, value: f64, is_good: bool, expected| {
        let id = id.to_string();
        let error = BaselineError::Range {
            id,
            key,
            value,
            expected,
        };
        if is_good { Ok(()) } else { Err(error) }
    };
    range(
        "value",
        written.value,
        written.value.is_finite(),
        "a finite number",
    )?;
    for (key, tolerance) in [
        ("absolute_tolerance", written.absolute_tolerance),
        ("relative_tolerance", written.relative_tolerance),
    ] {
        let tolerance = tolerance.unwrap_or(0.0);
        let is_good = tolerance >= 0.0 && tolerance.is_finite();
        range(key, tolerance, is_good, "0 or more")?;
    }
    if let Some(freedom) = written.degrees_of_freedom {
        let is_good = freedom > 0.0 && freedom.is_finite();
        range(
            "degrees_of_freedom",
            freedom,
            is_good,
            "above 0, or left out",
        )?;
    }
    let is_hex = |digit| matches!(digit, '0'..='9' | 'a'..='f');
    if written.digest.is_empty() || !written.digest.chars().all(is_hex) {
        return Err(BaselineError::Digest {
            id: id.to_string(),
            digest: written.digest.clone(),
        });
    }
    if id.to_string().chars().any(char::is_control) {
        return Err(BaselineError::Name(
            id.to_string().escape_debug().to_string(),
        ));
    }
    Ok(())
}

fn entry(written: Written) -> Result<Entry, BaselineError> {
    let point: Vec<(&str, String)> = written
        .point
        .iter()
        .map(|(key, value)| (key.as_str(), value.to_string()))
        .collect();
    let id = Id {
        point: point_of(point.iter().map(|(key, value)| (*key, value.as_str()))),
        scenario: written.scenario.clone(),
        channel: written.channel.clone(),
        metric: written.metric.clone(),
    };
    check(&id, &written)?;
    let interval = interval(&id, &written)?;
    let better = match written.direction {
        None => None,
        Some(word) => match Better::of_word(&word) {
            None => {
                let id = id.to_string();
                return Err(BaselineError::Direction { id, word });
            }
            better => better,
        },
    };
    Ok(Entry {
        id,
        value: written.value,
        interval,
        degrees_of_freedom: written.degrees_of_freedom,
        unit: written.unit,
        seed: written.seed,
        conditions: written.digest,
        repeats: written.values,
        blocks: Vec::new(),
        better,
        absolute_tolerance: written.absolute_tolerance,
        relative_tolerance: written.relative_tolerance,
    })
}

/// The interval of an entry.
fn interval(id: &Id, written: &Written) -> Result<Interval, BaselineError> {
    match (written.low, written.high, written.interval.as_deref()) {
        (Some(low), Some(high), None) if low <= high => Ok(Interval::Confidence { low, high }),
        (Some(low), Some(_), None) => Err(BaselineError::Range {
            id: id.to_string(),
            key: "low",
            value: low,
            expected: "at most high",
        }),
        (None, None, Some("exact")) => Ok(Interval::Exact),
        (None, None, Some("absent")) => Ok(Interval::Absent),
        _ => {
            let text =
                format!("{id}: expected low and high, or interval = \"exact\" or \"absent\"");
            Err(BaselineError::Syntax(text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRITTEN: &str = "schema = 1\n[tool]\nname = \"fogbench\"\nversion = \"0.1.0\"\n[[metric]]\n\
        scenario = \"power\"\npoint = { \"gyro.source.power_uw\" = 0.50 }\nchannel = \"raw\"\n\
        metric = \"mean_deg_per_h\"\nvalue = 8\nlow = 7.5\nhigh = 8.5\nunit = \"deg/h\"\n\
        direction = \"higher\"\nabsolute_tolerance = 1\nseed = 3\ndigest = \"c\"\nvalues = [1.0, 2]\n";

    #[test]
    fn a_baseline_reads_back_as_it_was_written() {
        let read = read_baseline(WRITTEN).unwrap();
        let entry = &read.entries[0];
        assert_eq!(entry.better, Some(Better::Higher));
        assert_eq!(entry.absolute_tolerance, Some(1.0));
        assert_eq!(entry.repeats, [1.0, 2.0]);
        let text = to_toml(&read);
        assert!(is_baseline_toml(&text) && !is_baseline_toml(WRITTEN));
        assert_eq!(read_baseline(&text).unwrap(), read, "{text}");
        assert_eq!(to_toml(&read_baseline(&text).unwrap()), text);
    }

    #[test]
    fn what_is_no_baseline_is_refused() {
        let refused =
            |from: &str, to: &str| read_baseline(&WRITTEN.replacen(from, to, 1)).unwrap_err();
        assert_eq!(
            refused("schema = 1", "schema = 2"),
            BaselineError::Schema(2)
        );
        assert!(matches!(
            refused("higher", "up"),
            BaselineError::Direction { .. }
        ));
        assert!(matches!(
            refused("absolute_tolerance = 1", "absolute_tolerance = -1.0"),
            BaselineError::Range {
                key: "absolute_tolerance",
                ..
            }
        ));
        assert!(matches!(
            refused("low = 7.5\n", ""),
            BaselineError::Syntax(_)
        ));
        assert!(matches!(
            refused("low = 7.5", "low = 9.5"),
            BaselineError::Range { key: "low", .. }
        ));
        assert!(matches!(
            refused("absolute", "absolut"),
            BaselineError::Syntax(_)
        ));
        assert!(matches!(
            refused("seed = 3\n", ""),
            BaselineError::Syntax(_)
        ));
        let metric = &WRITTEN[WRITTEN.find("[[metric]]").unwrap()..];
        let twice = read_baseline(&format!("{WRITTEN}{metric}")).unwrap_err();
        assert!(matches!(twice, BaselineError::Twice(_)));
    }
}
