//! Files that keys name and that are read when a scenario runs, not when it is read.
//!
//! They stand among its inputs with their digests. What the key says becomes the path as seen from the
//! scenario's own folder, so that neither results nor digests depend on where the scenario lies; the
//! path by which the file is found stays beside the scenario.

use std::path::{Path, PathBuf};

use crate::filters::is_file_argument;
use crate::scenario::document::source::{Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{self, Child, Kind, join};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::draft::Recorded;
use crate::scenario::read::input;
use crate::scenario::read::resolved::InputFile;

/// The table of a log.
pub(crate) const LOG: &str = "log";

/// A file that a key names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFile {
    /// Path of the key, as in `filter[0].replay.samples`.
    pub key: String,
    /// Where the file is found, absolute.
    pub path: PathBuf,
    /// BLAKE3 of its bytes when the scenario was read, hexadecimal.
    pub digest: String,
}

/// Finds every file that a key names, and enters it among the inputs.
///
/// * `recorded`: what a manifest says of the files that its run was made from.
///
/// # Errors
/// Every file that is not there, and every one that is not the one of the record.
pub(crate) fn read_all(
    root: &mut Table,
    sources: &Sources,
    inputs: &mut Vec<InputFile>,
    recorded: Option<&Recorded>,
) -> Result<Vec<NamedFile>, Vec<ScenarioError>> {
    let mut search = Search {
        sources,
        inputs,
        recorded: recorded.map_or(&[], |recorded| &recorded.inputs),
        found: Vec::new(),
        errors: Vec::new(),
    };
    // Only filters and logs name such files: the rest of the tree stays shared.
    if let Some(log) = root.get_mut(LOG).and_then(Node::as_table_mut) {
        search.table(LOG, LOG, log);
    }
    if let Some(filters) = root.get_mut("filter").filter(|node| names_files(node)) {
        search.elements("filter", filters);
    }
    if search.errors.is_empty() {
        Ok(search.found)
    } else {
        Err(search.errors)
    }
}

/// Whether an element of an array of tables holds a key that names a file.
fn names_files(array: &Node) -> bool {
    let elements = array.as_array().unwrap_or_default().iter();
    let mut tables = elements.filter_map(Node::as_table);
    tables.any(|table| holds_file("filter[]", table))
}

fn holds_file(schema_path: &str, table: &Table) -> bool {
    table
        .iter()
        .any(|(name, node)| match schema::child(schema_path, name) {
            Some(Child::Leaf(key)) => key.kind.names_files(),
            Some(Child::Table) => node
                .as_table()
                .is_some_and(|inner| holds_file(&join(schema_path, name), inner)),
            _ => false,
        })
}

/// A walk through a tree.
struct Search<'a> {
    sources: &'a Sources,
    inputs: &'a mut Vec<InputFile>,
    recorded: &'a [InputFile],
    found: Vec<NamedFile>,
    errors: Vec<ScenarioError>,
}

impl Search<'_> {
    fn elements(&mut self, name: &str, array: &mut Node) {
        let elements = array.as_array_mut().into_iter().flatten();
        for (index, element) in elements.enumerate() {
            if let Some(table) = element.as_table_mut() {
                self.table(&format!("{name}[]"), &format!("{name}[{index}]"), table);
            }
        }
    }

    fn table(&mut self, schema_path: &str, shown: &str, table: &mut Table) {
        for (name, node) in table {
            let (path, shown) = (join(schema_path, name), join(shown, name));
            match schema::child(schema_path, name) {
                Some(Child::Leaf(key)) => self.leaf(key.kind, &shown, node),
                Some(Child::Table) => {
                    if let Some(inner) = node.as_table_mut() {
                        self.table(&path, &shown, inner);
                    }
                }
                _ => {}
            }
        }
    }

    /// Finds the files of a key, if it names any.
    fn leaf(&mut self, kind: Kind, shown: &str, node: &mut Node) {
        if let Kind::File = kind {
            return self.file(shown, node, "");
        }
        if !matches!(kind, Kind::Files | Kind::Command) {
            return;
        }
        let elements = node.as_array_mut().into_iter().flatten();
        for (index, element) in elements.enumerate() {
            let shown = format!("{shown}[{index}]");
            match (kind, element.as_text()) {
                (Kind::Files, _) => self.file(&shown, element, ""),
                (_, Some(argument)) if is_file_argument(argument) => {
                    self.file(&shown, element, "./");
                }
                (_, Some(argument)) if Path::new(argument).is_absolute() => {
                    self.absolute(&shown, element);
                }
                _ => self.argument(&shown, element),
            }
        }
    }

    /// Takes the digest of an argument that is an absolute path, if there is such a file. What the user
    /// writes so stays so.
    fn absolute(&mut self, key: &str, node: &Node) {
        let (Some(written), Some(mark)) = (node.as_text(), node.mark) else {
            return;
        };
        let path = Path::new(written);
        if !path.is_file() {
            return;
        }
        let (_, label) = self.sources.beside(mark, written);
        match self.digest(key, mark, path, &label.text()) {
            Ok(digest) => self.found.push(NamedFile {
                key: key.to_owned(),
                path: path.to_owned(),
                digest,
            }),
            Err(error) => self.errors.push(error),
        }
    }

    /// Refuses an argument that is meant as a file beside the scenario and would not be found.
    fn argument(&mut self, key: &str, node: &Node) {
        let (Some(written), Some(mark)) = (node.as_text(), node.mark) else {
            return;
        };
        let (path, _) = self.sources.beside(mark, written);
        if !written.is_empty() && path.is_file() {
            let message = format!(
                "{key} = \"{written}\" is a file beside the scenario: write \"./{written}\", as a \
                 program works in a folder of its own",
                written = excerpt(written)
            );
            self.errors.push(self.sources.error(mark, message));
        }
    }

    /// Finds one file; what its path begins with beside the scenario is put before it. A value that is no text is refused with the other types.
    fn file(&mut self, key: &str, node: &mut Node, before: &str) {
        let (Some(written), Some(mark)) = (node.as_text(), node.mark) else {
            return;
        };
        let (path, label) = self.sources.beside(mark, written);
        match self.digest(key, mark, &path, &label.text()) {
            Ok(digest) => {
                let path = std::path::absolute(&path).unwrap_or(path);
                let key = key.to_owned();
                self.found.push(NamedFile { key, path, digest });
                let label = label.text();
                let before = if label.starts_with("../") { "" } else { before };
                node.value = Value::Text(format!("{before}{label}"));
            }
            Err(error) => self.errors.push(error),
        }
    }

    /// The digest of a file, which is entered among the inputs.
    fn digest(
        &mut self,
        key: &str,
        mark: Mark,
        path: &Path,
        label: &str,
    ) -> Result<String, ScenarioError> {
        let complain = |message: &str| {
            let shown = shown_path(path);
            self.sources
                .error(mark, format!("{key} = {}: {message}", excerpt(&shown)))
        };
        let digest = input::digest_of_any(path).map_err(|error| complain(&error.to_string()))?;
        let mut recorded = self.recorded.iter();
        if let Some(recorded) = recorded.find(|input| input.file == label)
            && recorded.digest != digest
        {
            return Err(complain(&format!(
                "this is not the file that the manifest was made from: its digest is {digest}, in \
                 the manifest it is {}",
                excerpt(&recorded.digest)
            )));
        }
        let input = InputFile {
            file: label.to_owned(),
            digest: digest.clone(),
        };
        if !self.inputs.contains(&input) {
            self.inputs.push(input);
        }
        Ok(digest)
    }
}
