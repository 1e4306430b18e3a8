//! The files of shards in some folders: complete or not, of one plan or of several.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::file::{Damaged, ShardFile, ShardHead, numbers_of};
use super::list::RunList;
use crate::store::{HeldFolder, StoreError, WORK_SUFFIX, WORKSHOP, holder_of_place};

/// Why the shards of some folders are not merged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GatherError {
    /// Somebody writes into a folder.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A file is not as it was written.
    #[error(transparent)]
    Damaged(#[from] Damaged),
    /// There is none.
    #[error("no complete shard in {folders}: `fogbench run --shard 1/n -o DIR` makes the first")]
    Empty {
        /// The folders.
        folders: String,
    },
    /// Two files that are not of one plan.
    #[error("{} and {} are not of one plan: {what}", one.display(), other.display())]
    Mixed {
        /// A file.
        one: PathBuf,
        /// Another.
        other: PathBuf,
        /// In what they differ.
        what: String,
    },
    /// The same shard twice.
    #[error("shard {index} is there twice: {} and {}", one.display(), other.display())]
    Double {
        /// Its number.
        index: u32,
        /// A file.
        one: PathBuf,
        /// Another.
        other: PathBuf,
    },
    /// What the scenarios say is not what the shards ran.
    #[error(
        "{} was made of other scenarios than those that stand here now, or by another version: merge in the \
         folder, with the scenario files and the version of the shards", path.display()
    )]
    OtherPlan {
        /// A file.
        path: PathBuf,
    },
    /// A file does not hold what its shard must.
    #[error("{} does not hold what shard {index} of {count} runs: run it anew", path.display())]
    NotWhole {
        /// The file.
        path: PathBuf,
        /// Its number.
        index: u32,
        /// Of how many.
        count: u32,
    },
}

/// The complete shards of some folders, all of one plan.
#[derive(Debug)]
pub struct Gathered {
    pub(super) files: Vec<ShardFile>,
    held: Vec<(PathBuf, HeldFolder)>,
}

impl Gathered {
    /// Reads the shards of some folders and checks every digest; nobody writes there meanwhile.
    ///
    /// # Errors
    /// [`GatherError`].
    pub fn of(folders: &[PathBuf]) -> Result<Self, GatherError> {
        let mut files: BTreeMap<u32, ShardFile> = BTreeMap::new();
        let mut held = Vec::new();
        let mut known = Vec::new();
        for folder in folders {
            let real = fs::canonicalize(folder).map_err(|source| StoreError::Read {
                path: folder.clone(),
                source,
            })?;
            if known.contains(&real) {
                continue;
            }
            held.extend(HeldFolder::take(folder)?.map(|lock| (real.clone(), lock)));
            known.push(real);
            for (place, _) in places(folder)? {
                let Some(file) = ShardFile::read(&place)? else {
                    continue;
                };
                file.check_record()?;
                if let Some(first) = files.values().next() {
                    refuse_mixed(first, &file)?;
                }
                let index = file.head.index;
                if let Some(other) = files.insert(index, file) {
                    return Err(GatherError::Double {
                        index,
                        one: other.place,
                        other: place,
                    });
                }
            }
        }
        if files.is_empty() {
            let folders = folders.iter().map(|folder| folder.display().to_string());
            return Err(GatherError::Empty {
                folders: folders.collect::<Vec<_>>().join(", "),
            });
        }
        Ok(Self {
            files: files.into_values().collect(),
            held,
        })
    }

    /// What the shards are part of.
    #[must_use]
    pub fn head(&self) -> &ShardHead {
        &self.files[0].head
    }

    /// Numbers of the shards that are not there.
    #[must_use]
    pub fn missing(&self) -> Vec<u32> {
        let held = |index: &u32| self.files.iter().any(|file| file.head.index == *index);
        let all = 1..=self.head().count;
        all.filter(|index| !held(index)).collect()
    }

    /// Checks that the shards are those of a list.
    ///
    /// # Errors
    /// [`GatherError`].
    pub fn check(&self, list: &RunList) -> Result<(), GatherError> {
        let own = ShardHead::new(list, (1, 1), self.head().selected.clone());
        for file in &self.files {
            if (&file.head.plan, &file.head.version) != (&own.plan, &own.version) {
                return Err(GatherError::OtherPlan {
                    path: file.place.clone(),
                });
            }
            if !file.is_whole(list) {
                return Err(GatherError::NotWhole {
                    path: file.place.clone(),
                    index: file.head.index,
                    count: file.head.count,
                });
            }
        }
        Ok(())
    }

    /// Lets go of the folders in or at which the result is to stand: its own lock keeps others out.
    pub(super) fn release(&mut self, output: &Path) {
        let whole = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
        let standing = whole
            .ancestors()
            .find_map(|path| fs::canonicalize(path).ok());
        let standing = standing.unwrap_or(whole);
        self.held
            .retain(|(folder, _)| !standing.starts_with(folder));
    }
}

fn refuse_mixed(one: &ShardFile, other: &ShardFile) -> Result<(), GatherError> {
    let differ = |what: &str, of: &dyn Fn(&ShardHead) -> String| {
        let (first, second) = (of(&one.head), of(&other.head));
        (first != second).then(|| format!("{what} {first} and {second}"))
    };
    let what = differ("versions", &|head| head.version.clone())
        .or_else(|| differ("counts of shards", &|head| head.count.to_string()))
        .or_else(|| differ("digests of the plans", &|head| head.plan.clone()));
    what.map_or(Ok(()), |what| {
        Err(GatherError::Mixed {
            one: one.place.clone(),
            other: other.place.clone(),
            what,
        })
    })
}

/// A file that goes by the name of a shard: which, and of how many.
type Named = (PathBuf, (u32, u32));

/// The files of a folder that go by the name of a shard.
fn places(folder: &Path) -> Result<Vec<Named>, StoreError> {
    let failed = |source| StoreError::Read {
        path: folder.to_owned(),
        source,
    };
    let entries = fs::read_dir(folder).map_err(failed)?;
    let entries = entries.collect::<Result<Vec<_>, _>>().map_err(failed)?;
    let mut places: Vec<_> = entries
        .into_iter()
        .filter_map(|entry| {
            let numbers = numbers_of(&entry.file_name().to_string_lossy())?;
            Some((entry.path(), numbers))
        })
        .collect();
    places.sort();
    Ok(places)
}

/// How far the shards of a folder are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShardStatus {
    /// Number of shards.
    pub count: u32,
    /// Digest of their plan; of the first where there is none of a complete one.
    pub plan: Option<String>,
    /// Complete ones.
    pub done: Vec<u32>,
    /// Those of them with a run that failed.
    pub failed: Vec<u32>,
    /// Those at work now.
    pub running: Vec<u32>,
    /// Those that were begun and have ended before their end.
    pub begun: Vec<u32>,
    /// All that are not complete, nor at work.
    pub missing: Vec<u32>,
    /// What is the matter with files that are taken for none.
    pub damaged: Vec<Damaged>,
}

/// Says how far the shards of a folder are; starts nothing, and changes nothing.
///
/// # Errors
/// [`GatherError`]: shards of several plans, or none at all.
pub fn shard_status(folder: &Path) -> Result<ShardStatus, GatherError> {
    let mut status = ShardStatus::default();
    let mut first: Option<ShardFile> = None;
    let mut counts: BTreeMap<u32, PathBuf> = BTreeMap::new();
    for (place, (index, count)) in places(folder)? {
        counts.entry(count).or_insert_with(|| place.clone());
        let read = ShardFile::read(&place).and_then(|file| {
            file.map(|file| file.check_record().map(|()| file))
                .transpose()
        });
        match read {
            Ok(None) => {}
            Ok(Some(file)) => {
                if let Some(first) = &first {
                    refuse_mixed(first, &file)?;
                }
                status.done.push(index);
                status.failed.extend(file.has_failed().then_some(index));
                first.get_or_insert(file);
            }
            Err(damaged) => status.damaged.push(damaged),
        }
    }
    let workshop = folder.join(WORKSHOP);
    let begun = if workshop.is_dir() {
        entries(&workshop)
    } else {
        Vec::new()
    };
    for name in begun {
        let Some(own) = name.strip_suffix(WORK_SUFFIX) else {
            continue;
        };
        let Some((index, count)) = numbers_of(own) else {
            continue;
        };
        counts.entry(count).or_insert_with(|| workshop.join(&name));
        if holder_of_place(folder, own).is_some() {
            status.running.push(index);
        } else if !status.done.contains(&index) {
            status.begun.push(index);
        }
    }
    let mut counts = counts.into_iter();
    let Some((count, one)) = counts.next() else {
        return Err(GatherError::Empty {
            folders: folder.display().to_string(),
        });
    };
    if let Some((more, other)) = counts.next() {
        return Err(GatherError::Mixed {
            one,
            other,
            what: format!("counts of shards {count} and {more}"),
        });
    }
    status.count = count;
    status.plan = first.map(|file| file.head.plan);
    let is_there = |index: &u32| status.done.contains(index) || status.running.contains(index);
    status.missing = (1..=count).filter(|index| !is_there(index)).collect();
    Ok(status)
}

fn entries(folder: &Path) -> Vec<String> {
    let found = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = found
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Numbers as a list of ranges, as in `3,7-9`.
#[must_use]
pub fn ranges_text(numbers: &[u32]) -> String {
    let mut text = String::new();
    let mut rest = numbers;
    while let Some(&first) = rest.first() {
        let run = (first..)
            .zip(rest)
            .take_while(|(expected, found)| expected == *found);
        let length = run.count();
        let last = rest[length - 1];
        let gap = if text.is_empty() { "" } else { "," };
        text.push_str(&if length == 1 {
            format!("{gap}{first}")
        } else {
            format!("{gap}{first}-{last}")
        });
        rest = &rest[length..];
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_ranges() {
        assert_eq!(ranges_text(&[]), "");
        assert_eq!(ranges_text(&[3, 7, 8, 9]), "3,7-9");
        assert_eq!(ranges_text(&[1, 2, 4, 6, 7]), "1-2,4,6-7");
    }
}
