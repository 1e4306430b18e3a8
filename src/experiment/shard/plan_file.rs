//! The file of a plan: what was selected, the numbered list of what there is to run, and in how many shards.

use std::collections::BTreeSet;
use std::io::{self, Write};

use super::file::Selected;
use super::list::{RunList, dealt};
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
    /// Writes the file of a list.
    ///
    /// * `estimated_s`: CPU seconds that all of it will take.
    ///
    /// # Errors
    /// What `out` says.
    pub fn write(
        out: &mut dyn Write,
        list: &RunList,
        shards: u32,
        selected: &Selected,
        estimated_s: f64,
    ) -> io::Result<()> {
        let texts = |texts: &[String]| {
            let texts = texts
                .iter()
                .map(|text| toml::Value::from(text.as_str()).to_string());
            texts.collect::<Vec<_>>().join(", ")
        };
        write!(
            out,
            "{BEGIN}: `fogbench run --plan FILE --shard i` runs part i of {shards}\n\
             schema = 1\nversion = {VERSION:?}\nbuild = {BUILD:?}\nplan = {digest:?}\nshards = {shards}\n\
             runs = {runs}\nunits = {units}\nestimated_s = {estimated_s:.1}\n\
             paths = [{paths}]\nset = [{sets}]\nfilter = [{names}]\n{HEADING}",
            digest = list.digest(),
            runs = list.runs(),
            units = list.len(),
            paths = texts(&selected.paths),
            sets = texts(&selected.sets),
            names = texts(&selected.names),
        )?;
        let mut lines = list.lines();
        lines.try_for_each(|line| out.write_all(line.as_bytes()))
    }

    /// Folders of what a shard runs, from 1.
    #[must_use]
    pub fn folders_of(&self, shard: u32) -> BTreeSet<String> {
        let own = dealt(self.list.lines(), shard, self.shards);
        own.map(|line| folder(line).to_owned()).collect()
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
    pub fn read(mut text: String) -> Result<Self, PlanFileError> {
        let no_plan = |what: &str| PlanFileError::NoPlan(what.to_owned());
        if !Self::is_one(&text) {
            return Err(no_plan(&format!("it does not begin with `{BEGIN}`")));
        }
        let end = text.find(HEADING);
        let end = end.ok_or_else(|| no_plan("it holds no list"))?;
        let list = text.split_off(end + HEADING.len());
        let head: toml::Table = text[..end]
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
            list,
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
        for line in list.lines() {
            let what = match planned.next() {
                Some(planned) if planned == line => continue,
                Some(planned) if folder(planned) == folder(&line) => {
                    format!("{} has changed", folder(&line))
                }
                Some(planned) => {
                    format!("{} stands where {} was", folder(&line), folder(planned))
                }
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

/// The folder that a line of a list names.
fn folder(line: &str) -> &str {
    line.split('\t').nth(2).unwrap_or_default()
}
