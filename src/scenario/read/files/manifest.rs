//! The record of a run from which it can be repeated.

use std::sync::Arc;

use crate::scenario::document::source::{Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::message::error::{ScenarioError, portable_place};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::discover::identity;
use crate::scenario::read::draft::{Draft, Recorded};
use crate::scenario::read::input;
use crate::scenario::read::resolved::{InputFile, Resolved, SweepPoint};
use crate::seal::{self, Sealed};

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
        "manifest = {MANIFEST_VERSION}\nbuild = {}\n\n[tool]\nname = \"fogbench\"\nversion = {}\n\n[origin]\nfile = {}\ndigest = {}\nconditions = {}\n",
        text(build),
        text(tool_version),
        text(&resolved.file),
        text(&resolved.digest),
        text(&resolved.conditions())
    );
    let gates = 0..resolved.scenario.gates.len();
    let places: Vec<String> = gates
        .map(|index| text(portable_place(&resolved.gate_place(index))))
        .collect();
    if !places.is_empty() {
        manifest.push_str(&format!("gates = [{}]\n", places.join(", ")));
    }
    let assumed: Vec<String> = resolved.assumed().iter().map(|it| text(&it.key)).collect();
    manifest.push_str(&format!("assumed = [{}]\n", assumed.join(", ")));
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
/// * `is_file`: whether it was read from a file, which ends with the record of its folder.
///
/// # Errors
/// What the manifest lacks, or the version this build does not read.
pub(crate) fn read(
    mut root: Table,
    source: usize,
    sources: Sources,
    inputs: Vec<InputFile>,
    is_file: bool,
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
    if let Some((mark, message)) = absurd_sweep(&root) {
        return fail(mark, message);
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
    let root = (Arc::unwrap_or_clone(scenario), mark.unwrap_or(start));
    let mut draft = Draft {
        recorded: Some(recorded),
        warnings,
        ..Draft::of_record(root, sources, file, inputs)
    };
    let is_sealed = is_as_sealed(draft.sources.text_of(start), is_file);
    draft.remarks = changes(&draft, start, version == TOOL_VERSION, is_sealed);
    Ok(draft)
}

/// Whether the text of a manifest is as it was written, as far as its seal tells: 0.1.0 gave it none, and
/// no line `build` either.
fn is_as_sealed(text: &str, is_file: bool) -> bool {
    match seal::open(text) {
        Sealed::Whole(_) => true,
        Sealed::Broken => false,
        Sealed::Absent => {
            let [before, after] = seal::without_build(text);
            !is_file || before.len() + after.len() == text.len()
        }
    }
}

/// What a manifest says about itself and its inputs that is not, or no longer, true.
fn changes(draft: &Draft, start: Mark, is_own_version: bool, is_sealed: bool) -> Vec<String> {
    let (Some(recorded), Ok(resolved)) = (&draft.recorded, draft.clone().resolve()) else {
        // What is wrong with it is said when it is resolved.
        return Vec::new();
    };
    let shown = draft.sources.locate(start).file;
    let mut found = Vec::new();
    // Another version may resolve the same text to other values.
    if resolved.digest != recorded.digest && is_own_version {
        found.push(format!(
            "[scenario] has the digest {}, but origin.digest is {}",
            excerpt(&resolved.digest),
            excerpt(&recorded.digest)
        ));
    }
    if let Some((key, value)) = recorded.broken_point(resolved.tree()) {
        let here = resolved.value_of(key);
        let here = here.map_or_else(
            || "has no such key".to_owned(),
            |here| format!("has {here}"),
        );
        found.push(format!(
            "origin.sweep says {} = {}, but [scenario] {}",
            excerpt(key),
            excerpt(value),
            excerpt(&here)
        ));
    }
    let is_own = |input: &InputFile| input.file == recorded.file;
    if !recorded.inputs.is_empty() && !recorded.inputs.iter().any(is_own) {
        let file = excerpt(&recorded.file);
        found.push(format!(
            "origin.file = \"{file}\" is none of its [[input]] files"
        ));
    }
    let mut remarks = Vec::new();
    if found.is_empty() && !is_sealed {
        found.push("its text is not the one that its [record] is of".to_owned());
    }
    if !found.is_empty() {
        remarks.push(format!(
            "{shown}: this manifest was changed: {}; the run is that of the file as it is now",
            found.join("; ")
        ));
    }
    let own = identity(&draft.sources.beside(start, &draft.file).0);
    for input in &recorded.inputs {
        let (path, _) = draft.sources.beside(start, &input.file);
        let digest = input::digest(&path);
        if identity(&path) != own && digest.is_ok_and(|digest| digest != input.digest) {
            remarks.push(format!(
                "{shown}: {} is not the file that this manifest was made from: the run takes the \
                 values in the manifest",
                shown_path(&path)
            ));
        }
    }
    remarks
}

/// The complaint about a point that no sweep can have, and where it stands.
fn absurd_sweep(root: &Table) -> Option<(Option<Mark>, String)> {
    let sweep = root.get("origin")?.as_table()?.get("sweep")?.as_table()?;
    let whole = |key: &str| match sweep.get(key) {
        Some(Node {
            value: Value::Integer(number),
            mark,
        }) => Some((*number, *mark)),
        _ => None,
    };
    let ((index, index_mark), (count, count_mark)) = (whole("index")?, whole("count")?);
    if !usize::try_from(count).is_ok_and(|count| (1..=SweepPoint::COUNT_MAX).contains(&count)) {
        let max = SweepPoint::COUNT_MAX;
        let message = format!("origin.sweep.count = {count} is out of range: allowed 1..={max}");
        return Some((count_mark, message));
    }
    if !(0..count).contains(&index) {
        let message = format!(
            "origin.sweep.index = {index} is out of range: allowed 0..={}, the points of the sweep",
            count - 1
        );
        return Some((index_mark, message));
    }
    None
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
    let assumed_keys = match origin.get("assumed") {
        None => None,
        Some(node) => {
            let keys = node.as_array()?.iter();
            let keys = keys.map(|node| node.as_text().map(str::to_owned));
            Some(keys.collect::<Option<Vec<_>>>()?)
        }
    };
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
        assumed_keys,
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
