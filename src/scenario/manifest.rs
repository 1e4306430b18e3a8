//! The record of a run from which it can be repeated.

use std::sync::Arc;

use super::error::{ScenarioError, portable_place};
use super::resolved::{Draft, InputFile, Recorded, Resolved, SweepPoint};
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};

/// The version of the manifest this build reads and writes.
const MANIFEST_VERSION: i64 = 1;

/// The version of this build.
const TOOL_VERSION: &str = env!("CARGO_PKG_VERSION");

/// Whether a document is a manifest rather than a scenario.
pub(crate) fn is_manifest(root: &Table) -> bool {
    root.contains_key("manifest")
}

/// The manifest of a run: tool, origin, digests of its input files and every resolved value.
///
/// Given to `run` as a scenario, it resolves to an equal [`Resolved`]. The origin is a record of
/// one resolved scenario, named by its digest: once a value has been changed, in the file or by
/// `--set`, the manifest itself is the origin of what it gives. The line `build` is for `--resume`, which
/// takes over what the same build wrote; it has no part in the result.
#[must_use]
pub fn manifest_toml(resolved: &Resolved, tool_version: &str, build: &str) -> String {
    let text = |text: &str| Value::Text(text.to_owned()).to_toml();
    let mut manifest = format!(
        "manifest = {MANIFEST_VERSION}\nbuild = {}\n\n[tool]\nname = \"fogbench\"\nversion = {}\n\n[origin]\nfile = {}\ndigest = {}\n",
        text(build),
        text(tool_version),
        text(&resolved.file),
        text(&resolved.digest)
    );
    let gates = 0..resolved.scenario.gates.len();
    let places: Vec<String> = gates
        .map(|index| text(portable_place(&resolved.gate_place(index))))
        .collect();
    if !places.is_empty() {
        manifest.push_str(&format!("gates = [{}]\n", places.join(", ")));
    }
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
    inputs: Vec<InputFile>,
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
    let Some((version, recorded)) = record(&root) else {
        let message = "the manifest is damaged: expected [tool] version, [origin] file and digest, \
                       [[input]] file and digest, as this tool writes them";
        return fail(None, message.to_owned());
    };
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
    let file = inputs.first().map(|input| input.file.clone());
    let file = file.unwrap_or_default();
    let warnings = other_version(&file, &version).into_iter().collect();
    Ok(Draft {
        root: scenario,
        root_mark: mark.unwrap_or(start),
        sources: Arc::new(sources),
        file,
        inputs,
        recorded: Some(recorded),
        warnings,
    })
}

/// A warning if another version of the tool wrote the manifest.
fn other_version(file: &str, version: &str) -> Option<String> {
    (version != TOOL_VERSION).then(|| {
        format!(
            "{file} was written by fogbench {version}, this is {TOOL_VERSION}: the run need not \
             repeat to the byte"
        )
    })
}

/// Version of the tool and origin; `None` if any part is not as this tool writes it.
fn record(root: &Table) -> Option<(String, Recorded)> {
    let version = text(root.get("tool")?.as_table()?, "version")?;
    let origin = root.get("origin")?.as_table()?;
    let gate_places = origin
        .get("gates")
        .map_or(Some(&[][..]), Node::as_array)?
        .iter()
        .map(|node| node.as_text().map(str::to_owned))
        .collect::<Option<Vec<_>>>()?;
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
    let recorded = Recorded {
        digest: text(origin, "digest")?,
        file: text(origin, "file")?,
        inputs,
        sweep,
        gate_places,
    };
    Some((version, recorded))
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
