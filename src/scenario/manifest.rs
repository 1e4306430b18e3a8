//! The record of a run from which it can be repeated.

use std::sync::Arc;

use super::error::ScenarioError;
use super::resolved::{Draft, InputFile, Resolved, SweepPoint};
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};

/// The version of the manifest this build reads and writes.
const MANIFEST_VERSION: i64 = 1;

/// Whether a document is a manifest rather than a scenario.
pub(crate) fn is_manifest(root: &Table) -> bool {
    root.contains_key("manifest")
}

/// The manifest of a run: tool, origin, digests of its input files and every resolved value.
///
/// Given to `run` as a scenario, it resolves to an equal [`Resolved`].
#[must_use]
pub fn manifest_toml(resolved: &Resolved, tool_version: &str) -> String {
    let text = |text: &str| Value::Text(text.to_owned()).to_toml();
    let mut manifest = format!(
        "manifest = {MANIFEST_VERSION}\n\n[tool]\nname = \"fogbench\"\nversion = {}\n\n[origin]\nfile = {}\n",
        text(tool_version),
        text(&resolved.file)
    );
    if let Some(point) = &resolved.sweep {
        manifest.push_str(&format!(
            "\n[origin.sweep]\nindex = {}\ncount = {}\n",
            point.index, point.count
        ));
        for (key, value) in &point.assignments {
            manifest.push_str(&format!(
                "\n[[origin.sweep.assignment]]\nkey = {}\nvalue = {}\n",
                text(key),
                text(value)
            ));
        }
    }
    for input in &resolved.inputs {
        manifest.push_str(&format!(
            "\n[[input]]\nfile = {}\ndigest = {}\n",
            text(&input.file),
            text(&input.digest)
        ));
    }
    manifest.push('\n');
    manifest.push_str(&resolved.to_toml_below("scenario"));
    manifest
}

/// The run that a manifest records.
///
/// # Errors
/// What the manifest lacks, or the version this build does not read.
pub(crate) fn read(
    mut root: Table,
    source: usize,
    sources: Sources,
) -> Result<Draft, Vec<ScenarioError>> {
    let start = Mark { source, start: 0 };
    let fail = |mark: Option<Mark>, message: String| {
        Err(vec![sources.error(mark.unwrap_or(start), message)])
    };
    let version = root.get("manifest").map(|node| (node.mark, &node.value));
    match version {
        Some((_, Value::Integer(MANIFEST_VERSION))) => {}
        Some((mark, other)) => {
            let message = format!(
                "manifest = {} is not supported: this build reads manifest {MANIFEST_VERSION}",
                other.to_toml()
            );
            return fail(mark, message);
        }
        None => return fail(None, "manifest is required".to_owned()),
    }
    let Some(record) = record(&root) else {
        let message = "the manifest is damaged: expected [origin] file, [[input]] file and digest, \
                       as this tool writes them";
        return fail(None, message.to_owned());
    };
    let (file, inputs, sweep) = record;
    let Some(Node {
        value: Value::Table(scenario),
        mark,
    }) = root.remove("scenario")
    else {
        return fail(
            None,
            "the manifest is damaged: there is no table [scenario]".to_owned(),
        );
    };
    Ok(Draft {
        root: scenario,
        root_mark: mark.unwrap_or(start),
        sources: Arc::new(sources),
        file,
        inputs,
        sweep,
    })
}

/// Origin, inputs and sweep point; `None` if any part is not as this tool writes it.
fn record(root: &Table) -> Option<(String, Vec<InputFile>, Option<SweepPoint>)> {
    let origin = root.get("origin")?.as_table()?;
    let file = text(origin, "file")?;
    let inputs = root
        .get("input")
        .map_or(Some(&[][..]), Node::as_array)?
        .iter()
        .map(|node| {
            let table = node.as_table()?;
            Some(InputFile {
                file: text(table, "file")?,
                digest: text(table, "digest")?,
            })
        })
        .collect::<Option<Vec<_>>>()?;
    let sweep = match origin.get("sweep") {
        None => None,
        Some(node) => Some(sweep_point(node.as_table()?)?),
    };
    Some((file, inputs, sweep))
}

/// The sweep point of a manifest.
fn sweep_point(table: &Table) -> Option<SweepPoint> {
    let assignments = table
        .get("assignment")?
        .as_array()?
        .iter()
        .map(|node| {
            let table = node.as_table()?;
            Some((text(table, "key")?, text(table, "value")?))
        })
        .collect::<Option<Vec<_>>>()?;
    Some(SweepPoint {
        index: index(table, "index")?,
        count: index(table, "count")?,
        assignments,
    })
}

/// The text of a key.
fn text(table: &Table, key: &str) -> Option<String> {
    table.get(key)?.as_text().map(str::to_owned)
}

/// The count of a key.
fn index(table: &Table, key: &str) -> Option<usize> {
    match table.get(key)?.value {
        Value::Integer(value) => usize::try_from(value).ok(),
        _ => None,
    }
}
