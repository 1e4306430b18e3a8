//! The file of one shard: what it is part of, and a record for each thing that it ran.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use super::codec::{Coded as _, coded, decoded};
use super::list::RunList;
use super::result::{Entry, EntryHead};
use crate::experiment::build::{BUILD, VERSION};
use crate::seal::{self, Sealed};
use crate::store::{digest_of, open_place, read_records, record_path};

/// How each such file begins.
pub(super) const MAGIC: &[u8] = b"fogbench shard 1\n";
/// End of the name of such a file.
const SUFFIX: &str = ".fogshard";

/// Which scenarios a shard was told to run, as the command line says it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selected {
    /// Files and folders.
    pub paths: Vec<String>,
    /// `--set`.
    pub sets: Vec<String>,
    /// `--filter`.
    pub names: Vec<String>,
}

/// What a shard is part of: the first record of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardHead {
    /// Version of the program.
    pub version: String,
    /// Its build.
    pub build: String,
    /// Digest of the list of runs.
    pub plan: String,
    /// Which shard, from 1.
    pub index: u32,
    /// Of how many.
    pub count: u32,
    /// What was selected.
    pub selected: Selected,
}

coded! {
    Selected { paths, sets, names }
    ShardHead { version, build, plan, index, count, selected }
}

impl ShardHead {
    /// The head of a shard of this program.
    #[must_use]
    pub fn new(list: &RunList, (index, count): (u32, u32), selected: Selected) -> Self {
        Self {
            version: VERSION.to_owned(),
            build: BUILD.to_owned(),
            plan: list.digest(),
            index,
            count,
            selected,
        }
    }

    /// Name of the file.
    #[must_use]
    pub fn file_name(&self) -> String {
        format!("shard-{:04}-of-{:04}{SUFFIX}", self.index, self.count)
    }

    /// Whether another file may be continued or taken as this one.
    pub(super) fn is_of(&self, other: &Self) -> bool {
        let of = |head: &Self| {
            (
                head.version.clone(),
                head.plan.clone(),
                head.index,
                head.count,
            )
        };
        of(self) == of(other)
    }

    /// The record of completion, given the digest of the file.
    pub(super) fn record(&self, units: usize, has_failed: bool, digest: &str) -> String {
        let text = format!(
            "# What the shard file beside this one holds, written when it was complete.\n\
             schema = 1\nbuild = {:?}\nversion = {:?}\nplan = {:?}\nindex = {}\ncount = {}\n\
             units = {units}\nfailed = {has_failed}\nfile = {:?}\nfile_blake3 = {digest:?}\n",
            self.build,
            self.version,
            self.plan,
            self.index,
            self.count,
            self.file_name(),
        );
        seal::seal(&text)
    }
}

/// Why a file is not taken as a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct Damaged {
    /// The file.
    pub path: PathBuf,
    /// What is the matter with it.
    pub reason: String,
}

/// A complete file of a shard.
#[derive(Debug)]
pub(super) struct ShardFile {
    pub(super) place: PathBuf,
    pub(super) head: ShardHead,
    /// Heads of the results, and where each result stands: first byte and length.
    pub(super) entries: Vec<(EntryHead, (u64, usize))>,
}

impl ShardFile {
    /// Reads the file at `place` and checks every digest; none where none stands.
    ///
    /// # Errors
    /// [`Damaged`] if it is not as it was written.
    pub(super) fn read(place: &Path) -> Result<Option<Self>, Damaged> {
        let damaged = |reason: &str| Damaged {
            path: place.to_owned(),
            reason: reason.to_owned(),
        };
        let failed = |error: io::Error| damaged(&error.to_string());
        let Some(mut file) = open_place(place).map_err(failed)? else {
            return Ok(None);
        };
        let size = file.metadata().map_err(failed)?.len();
        let mut head: Option<ShardHead> = None;
        let mut entries = Vec::new();
        let end = read_records(&mut file, MAGIC, &mut |record, at| {
            if head.is_none() {
                head = decoded(record);
                return head.is_some();
            }
            let mut from = record;
            let entry = EntryHead::take(&mut from);
            entries.extend(entry.map(|entry| (entry, at)));
            entry.is_some()
        });
        let end = end.map_err(failed)?;
        let end = end.ok_or_else(|| damaged("is no file of a shard of this format"))?;
        let head = head.ok_or_else(|| damaged("does not say what it is part of"))?;
        if end != size {
            return Err(damaged(
                "was changed or cut short after it was written: a digest in it does not fit",
            ));
        }
        Ok(Some(Self {
            place: place.to_owned(),
            head,
            entries,
        }))
    }

    /// Checks the record of completion that stands beside the file.
    ///
    /// # Errors
    /// [`Damaged`] if it is missing, or not of this file.
    pub(super) fn check_record(&self) -> Result<(), Damaged> {
        let path = record_path(&self.place);
        let damaged = |reason: &str| Damaged {
            path: path.clone(),
            reason: reason.to_owned(),
        };
        let text = std::fs::read_to_string(&path).map_err(|error| {
            damaged(&format!("the record of completion cannot be read: {error}"))
        })?;
        if !matches!(seal::open(&text), Sealed::Whole(_)) {
            return Err(damaged("was changed: its digest does not fit"));
        }
        let digest = digest_of(&self.place).map_err(|error| damaged(&error.to_string()))?;
        if text
            == self
                .head
                .record(self.entries.len(), self.has_failed(), &digest)
        {
            Ok(())
        } else {
            Err(damaged(&format!(
                "is not the record of {}",
                self.place.display()
            )))
        }
    }

    /// Whether it has a result that failed.
    pub(super) fn has_failed(&self) -> bool {
        self.entries.iter().any(|(head, _)| head.has_failed)
    }

    /// Whether it holds what a shard of a list must, each once.
    pub(super) fn is_whole(&self, list: &RunList) -> bool {
        let mut held: Vec<usize> = self.entries.iter().map(|(head, _)| head.unit).collect();
        held.sort_unstable();
        held.into_iter()
            .eq(list.dealt(self.head.index, self.head.count))
    }

    /// A result.
    pub(super) fn entry(&self, (first, length): (u64, usize)) -> Result<Entry, Damaged> {
        let damaged = |reason: String| Damaged {
            path: self.place.clone(),
            reason,
        };
        let read = || -> io::Result<Vec<u8>> {
            let mut file = File::open(&self.place)?;
            file.seek(SeekFrom::Start(first))?;
            let mut bytes = vec![0; length];
            file.read_exact(&mut bytes)?;
            Ok(bytes)
        };
        let bytes = read().map_err(|error| damaged(error.to_string()))?;
        decoded(&bytes).ok_or_else(|| damaged("a result in it cannot be read".to_owned()))
    }
}

/// Which shard a file of this name is, and of how many; none of other files.
pub(super) fn numbers_of(name: &str) -> Option<(u32, u32)> {
    let (index, count) = name
        .strip_prefix("shard-")?
        .strip_suffix(SUFFIX)?
        .split_once("-of-")?;
    Some((index.parse().ok()?, count.parse().ok()?))
}
