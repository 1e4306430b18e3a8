//! A file and the bases it extends, or a manifest, read and merged within bounds.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::scenario::check::presence::check_contradictions;
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, merge, parse_within};
use crate::scenario::document::weight;
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::discover::identity;
use crate::scenario::read::draft::Draft;
use crate::scenario::read::files::manifest;
use crate::scenario::read::files::problem::is_problem;
use crate::scenario::read::input::{self, Input, InputError};
use crate::scenario::read::purpose::Purpose;
use crate::scenario::read::resolved::InputFile;

/// Most bases below one another.
const BASES_MAX: usize = 64;
/// Name of a text that was read from no file.
const TEXT: &str = "<text>";

/// Reads a file and its bases, or a manifest, with the complaints that do not hinder more checks,
/// whether it has a name or not; inputs are labelled as seen from another file.
pub(in crate::scenario) fn read_whole(
    file: &Path,
    label: &Label,
) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    let draft = load_labelled(file, label, false)?;
    Ok(draft.expect("only bases are passed over, where that is asked for"))
}

/// Reads the scenario of a campaign that another file names, and its bases.
///
/// # Errors
/// Every complaint about the file.
pub(in crate::scenario) fn load_campaign(
    file: &Path,
    label: &Label,
) -> Result<Draft, Vec<ScenarioError>> {
    match read_whole(file, label)? {
        (draft, errors) if errors.is_empty() => Ok(draft),
        (_, errors) => Err(errors),
    }
}

/// Reads a file and its bases, inputs labelled as seen from another file; none if it is a base and
/// those are passed over.
pub(in crate::scenario) fn load_labelled(
    file: &Path,
    label: &Label,
    passes_bases: bool,
) -> Result<Option<(Draft, Vec<ScenarioError>)>, Vec<ScenarioError>> {
    let mut chain = Chain::new();
    let (root, source) = chain.read(file, label, None)?;
    if passes_bases && !root.contains_key("name") {
        return Ok(None);
    }
    chain.draft(file, label, root, source).map(Some)
}

/// Reads a text and the bases it extends, or the text of a manifest, with the complaints that do not
/// hinder more checks. What it names is relative to the working directory.
///
/// # Errors
/// Every complaint about the text.
pub(in crate::scenario) fn read_text(
    text: &str,
) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
    let file = Path::new(TEXT);
    let label = Label::of_scenario(file);
    let mut chain = Chain::new();
    let (root, source) = match input::of_text(text) {
        Ok(input) => chain.parse(TEXT.to_owned(), input, file, &label)?,
        Err(error) => {
            let location = Location::of_file(TEXT);
            return Err(vec![ScenarioError::at(location, error.to_string())]);
        }
    };
    chain.draft(file, &label, root, source)
}

/// A file and its bases, as far as they have been read.
struct Chain {
    sources: Sources,
    /// The scenario's own file first.
    inputs: Vec<InputFile>,
    /// Files read so far, to find cycles.
    open: Vec<PathBuf>,
    /// Bytes that may still be read.
    bytes_left: u64,
    /// Memory that may still be taken, bytes.
    memory_left: u64,
    errors: Vec<ScenarioError>,
    /// Whether a base could not be read.
    is_partial: bool,
}

impl Chain {
    fn new() -> Self {
        Self {
            sources: Sources::default(),
            inputs: Vec::new(),
            open: Vec::new(),
            bytes_left: input::BYTES_MAX,
            memory_left: weight::MEMORY_BYTES_MAX,
            errors: Vec::new(),
            is_partial: false,
        }
    }

    /// Reads a file and takes it off what may still be read.
    fn input(&mut self, file: &Path) -> Result<Input, InputError> {
        let input = input::read(file)?;
        let left = self.bytes_left.checked_sub(input.text.len() as u64);
        self.bytes_left = left.ok_or(InputError::TooLongTogether)?;
        Ok(input)
    }

    /// Reads and parses one file; `extends` is the mark of the key that names it.
    fn read(
        &mut self,
        file: &Path,
        label: &Label,
        extends: Option<Mark>,
    ) -> Result<(Table, usize), Vec<ScenarioError>> {
        let shown = shown_path(file);
        let input = self.input(file).map_err(|error| {
            let location = Location::of_file(shown.clone());
            vec![match extends {
                // The text itself is at fault, not the key that names it.
                Some(mark) if !matches!(error, InputError::NotText { .. }) => self
                    .sources
                    .error(mark, format!("extends {shown}: {error}")),
                _ => ScenarioError::at(location, error.to_string()),
            }]
        })?;
        self.parse(shown, input, file, label)
    }

    /// Parses what was read of one file.
    fn parse(
        &mut self,
        shown: String,
        Input { text, digest }: Input,
        file: &Path,
        label: &Label,
    ) -> Result<(Table, usize), Vec<ScenarioError>> {
        self.inputs.push(InputFile {
            file: label.text(),
            digest,
        });
        self.open.push(identity(file));
        let source = self.sources.add_file(shown, text.clone(), label.clone());
        let root = parse_within(source, &text, &mut self.memory_left).map_err(|error| {
            let mark = Mark {
                source,
                start: error.start,
            };
            vec![self.sources.error(mark, error.message)]
        })?;
        Ok((root, source))
    }

    /// The draft of a document that was parsed first, merged onto its bases.
    fn draft(
        mut self,
        file: &Path,
        label: &Label,
        root: Table,
        source: usize,
    ) -> Result<(Draft, Vec<ScenarioError>), Vec<ScenarioError>> {
        if manifest::is_manifest(&root) {
            let is_file = file != Path::new(TEXT);
            let draft = manifest::read(root, source, self.sources, self.inputs, is_file)?;
            return Ok((draft, Vec::new()));
        }
        if is_problem(&root) {
            let message =
                "this is a problem of inference, which `fogbench infer` takes, not a scenario";
            let start = Mark { source, start: 0 };
            return Err(vec![self.sources.error(start, message)]);
        }
        let root = self.merge_bases(file, label, root, source);
        self.inputs.reverse();
        let draft = Draft {
            root,
            root_mark: Mark { source, start: 0 },
            sources: Arc::new(self.sources),
            file: label.text(),
            inputs: self.inputs,
            named_files: Vec::new(),
            log: None,
            recorded: None,
            warnings: Vec::new(),
            remarks: Vec::new(),
            is_record: false,
            purpose: Purpose::Run,
            is_partial: self.is_partial,
        };
        Ok((draft, self.errors))
    }

    /// Merges a file onto the bases it extends, as far as they can be read.
    fn merge_bases(&mut self, file: &Path, label: &Label, mut root: Table, source: usize) -> Table {
        let start = Mark { source, start: 0 };
        let contradictions = check_contradictions(&root, start, &self.sources);
        self.errors.extend(contradictions);
        let Some(extends) = root.remove("extends") else {
            return root;
        };
        let mark = extends.mark.unwrap_or(start);
        match self.base(file, label, &extends, mark) {
            Ok(mut merged) => {
                // The name is the scenario's own: two files may build on one that can be run itself.
                merged.remove("name");
                merge("", &mut merged, root);
                merged
            }
            Err(errors) => {
                self.is_partial = true;
                self.errors.extend(errors);
                root
            }
        }
    }

    /// The base that a file extends, merged onto its own bases.
    fn base(
        &mut self,
        file: &Path,
        label: &Label,
        extends: &Node,
        mark: Mark,
    ) -> Result<Table, Vec<ScenarioError>> {
        let fail = |chain: &Self, message| Err(vec![chain.sources.error(mark, message)]);
        let Some(base) = extends.as_text() else {
            let message = format!(
                "extends has the wrong type: expected the path of a file, got {}",
                extends.value.type_name()
            );
            return fail(self, message);
        };
        let path = file.parent().unwrap_or(Path::new("")).join(base);
        if self.open.contains(&identity(&path)) {
            let base = excerpt(base);
            let message = format!(
                "extends = \"{base}\" closes a cycle: {} is being extended already",
                shown_path(&path)
            );
            return fail(self, message);
        }
        if self.open.len() > BASES_MAX {
            let base = excerpt(base);
            let message = format!(
                "extends = \"{base}\" is base {} below one another: allowed up to {BASES_MAX}",
                self.open.len()
            );
            return fail(self, message);
        }
        let label = label.of_base(base);
        let (root, source) = self.read(&path, &label, Some(mark))?;
        Ok(self.merge_bases(&path, &label, root, source))
    }
}
