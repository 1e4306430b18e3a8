//! The file of a plan: what was selected, the numbered list of what there is to run, and in how many shards.

use super::file::Selected;
use super::list::RunList;
use crate::experiment::build::{BUILD, VERSION};

/// How such a file begins.
const BEGIN: &str = "# fogbench plan";
/// What stands above the list.
const HEADING: &str = "\n# number\tdigest of the run\tfolder\trepeats\n";

/// A plan as a file holds it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanFile {
    /// Number of shards.
    pub shards: u32,
    /// What was selected.
    pub selected: Selected,
    version: String,
    list: String,
}

/// Why a file is no plan, or not one of what stands here.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanFileError {
    /// It cannot be read as one.
    #[error("it is no plan that `fogbench plan` wrote: {0}")]
    NoPlan(String),
    /// Another version made it.
    #[error("it was made by fogbench {0}, and this is {VERSION}: make it anew")]
    OtherVersion(String),
    /// The scenarios are others.
    #[error(
        "the scenarios are no longer those that were planned: {0}: make the plan anew, or bring them back"
    )]
    OtherRuns(String),
}

impl PlanFile {
    /// The plan of a list.
    #[must_use]
    pub fn new(list: &RunList, shards: u32, selected: Selected) -> Self {
        Self {
            shards,
            selected,
            version: VERSION.to_owned(),
            list: list.lines().collect(),
        }
    }

    /// The text of the file.
    ///
    /// * `estimated_s`: CPU seconds that all of it will take.
    #[must_use]
    pub fn text(&self, list: &RunList, estimated_s: f64) -> String {
        let texts = |texts: &[String]| {
            let texts = texts
                .iter()
                .map(|text| toml::Value::from(text.as_str()).to_string());
            texts.collect::<Vec<_>>().join(", ")
        };
        format!(
            "{BEGIN}: `fogbench run --plan FILE --shard i` runs part i of {shards}\n\
             schema = 1\nversion = {version:?}\nbuild = {BUILD:?}\nplan = {digest:?}\nshards = {shards}\n\
             runs = {runs}\nunits = {units}\nestimated_s = {estimated_s:.1}\n\
             paths = [{paths}]\nset = [{sets}]\nfilter = [{names}]\n{HEADING}{lines}",
            shards = self.shards,
            version = self.version,
            digest = list.digest(),
            runs = list.runs(),
            units = list.len(),
            paths = texts(&self.selected.paths),
            sets = texts(&self.selected.sets),
            names = texts(&self.selected.names),
            lines = self.list,
        )
    }

    /// Whether a text is that of a plan.
    #[must_use]
    pub fn is_one(text: &str) -> bool {
        text.starts_with(BEGIN)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`PlanFileError`].
    pub fn read(text: &str) -> Result<Self, PlanFileError> {
        let no_plan = |what: &str| PlanFileError::NoPlan(what.to_owned());
        if !Self::is_one(text) {
            return Err(no_plan(&format!("it does not begin with `{BEGIN}`")));
        }
        let (head, list) = text
            .split_once(HEADING)
            .ok_or_else(|| no_plan("it holds no list"))?;
        let head: toml::Table = head
            .parse()
            .map_err(|error: toml::de::Error| no_plan(error.message()))?;
        let word = |key: &str| {
            let found = head.get(key).and_then(toml::Value::as_str);
            let found = found.ok_or_else(|| no_plan(&format!("`{key}` is no text in it")));
            found.map(str::to_owned)
        };
        let words = |key: &str| {
            let found = head.get(key).and_then(toml::Value::as_array);
            let texts = found.map(|all| all.iter().map(|it| it.as_str().map(str::to_owned)));
            let texts: Option<Vec<String>> = texts.and_then(Iterator::collect);
            texts.ok_or_else(|| no_plan(&format!("`{key}` is no list of texts in it")))
        };
        let shards = head.get("shards").and_then(toml::Value::as_integer);
        let shards = shards.and_then(|count| u32::try_from(count).ok());
        Ok(Self {
            shards: shards
                .filter(|count| *count > 0)
                .ok_or_else(|| no_plan("`shards` is no number from 1 in it"))?,
            selected: Selected {
                paths: words("paths")?,
                sets: words("set")?,
                names: words("filter")?,
            },
            version: word("version")?,
            list: list.to_owned(),
        })
    }

    /// Checks that a list is the one that was planned.
    ///
    /// # Errors
    /// [`PlanFileError`], with the first difference.
    pub fn check(&self, list: &RunList) -> Result<(), PlanFileError> {
        if self.version != VERSION {
            return Err(PlanFileError::OtherVersion(self.version.clone()));
        }
        let mut planned = self.list.split_inclusive('\n');
        let folder = |line: &str| line.split('\t').nth(2).unwrap_or_default().to_owned();
        for line in list.lines() {
            let what = match planned.next() {
                Some(planned) if planned == line => continue,
                Some(planned) if folder(planned) == folder(&line) => {
                    format!("{} has changed", folder(&line))
                }
                Some(planned) => format!("{} stands where {} was", folder(&line), folder(planned)),
                None => format!("{} is new", folder(&line)),
            };
            return Err(PlanFileError::OtherRuns(what));
        }
        planned.next().map_or(Ok(()), |gone| {
            Err(PlanFileError::OtherRuns(format!(
                "{} is gone",
                folder(gone)
            )))
        })
    }
}
