//! An output folder in the hands of one writer.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::{Foreign, Spared, StoreError};
use super::files::{remove, stands};
use super::journal::{self, Item, Journal, UpdateJournal};
use super::lock::{Lock, refuse_inside_held};
use super::ownership::{self, Ownership, clear};
use super::staged::Staged;
use super::suite_files::{self, SuiteFileNames};
use super::swap::Displaced;
use super::update::Left;
use super::{Swap, WORKSHOP, shard_slot, swap, update};

/// How results are put in place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreOptions {
    /// Whether to replace what is the user's as well.
    pub force: bool,
    /// How a folder takes the place of another.
    pub swap: Swap,
}

/// What the files of an output folder itself are.
#[derive(Debug)]
enum Contents {
    /// One result of a kind: the folder is the tool's as a whole.
    Result(&'static str),
    /// Those of a suite, among the folders of its runs and whatever the user keeps there.
    Suite(SuiteFileNames),
}

/// An output folder in the hands of this process until dropped.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    lock: Lock,
    options: StoreOptions,
    contents: Contents,
    built: AtomicU64,
    cautions: Vec<String>,
}

impl OutputFolder {
    /// Takes a folder for one result, made if absent; it must be empty or hold one of the same kind.
    ///
    /// * `holds`: the kind, as the record will say.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn of_result(
        path: &Path,
        holds: &'static str,
        options: StoreOptions,
    ) -> Result<Self, StoreError> {
        Self::open(path, options, Contents::Result(holds), &|_| Ok(()))
    }

    /// Checks what [`OutputFolder::of_result`] would refuse, and makes nothing; what is worth saying.
    ///
    /// # Errors
    /// As [`OutputFolder::of_result`].
    pub fn check_result(
        path: &Path,
        holds: &'static str,
        options: StoreOptions,
    ) -> Result<Vec<String>, StoreError> {
        if path.join(WORKSHOP).is_dir() {
            // A command that was killed may have left files that only its journal makes sense of.
            return Self::of_result(path, holds, options).map(|folder| folder.cautions().to_vec());
        }
        refuse_unusable(path)?;
        refuse_inside_held(path)?;
        if !options.force && path.is_dir() {
            refuse(path, ownership::inspect_result(path, holds))?;
        }
        Ok(Vec::new())
    }

    /// Takes a folder for a suite, made if absent; the suite's own files must be absent or the tool's,
    /// and so must every folder that `check` looks into with [`refuse_theirs`].
    ///
    /// Everything is checked before anything is made, so that a refusal leaves no trace.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn of_suite(
        path: &Path,
        options: StoreOptions,
        names: SuiteFileNames,
        check: &dyn Fn(&Path) -> Result<(), StoreError>,
    ) -> Result<Self, StoreError> {
        Self::open(path, options, Contents::Suite(names), check)
    }

    fn open(
        path: &Path,
        options: StoreOptions,
        contents: Contents,
        check: &dyn Fn(&Path) -> Result<(), StoreError>,
    ) -> Result<Self, StoreError> {
        let checked = || -> Result<(), StoreError> {
            if options.force || !path.is_dir() {
                return Ok(());
            }
            match &contents {
                Contents::Result(holds) => refuse(path, ownership::inspect_result(path, holds)),
                Contents::Suite(names) => {
                    refuse(path, suite_files::inspect(path, names)).and_then(|()| check(path))
                }
            }
        };
        refuse_unusable(path)?;
        refuse_inside_held(path)?;
        let workshop = path.join(WORKSHOP);
        // Without the lock another process may be changing what is looked into, which its workshop shows:
        // the check under the lock then decides.
        if !workshop.is_dir()
            && let Err(refusal) = checked()
            && !workshop.is_dir()
        {
            return Err(refusal);
        }
        fs::create_dir_all(&workshop).map_err(StoreError::at(&workshop))?;
        let lock = Lock::take(path, &workshop);
        let lock = lock.map_err(|error| shard_slot::named(error, &workshop))?;
        let mut cautions: Vec<String> = lock.caution.iter().cloned().collect();
        cautions.extend(mend(path)?);
        checked()?;
        Ok(Self {
            path: path.to_owned(),
            lock,
            options,
            contents,
            built: AtomicU64::new(0),
            cautions,
        })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What is worth saying: that nothing keeps other writers out, and what commands that were killed
    /// left behind that is not for the tool to clear.
    #[must_use]
    pub fn cautions(&self) -> &[String] {
        &self.cautions
    }

    /// Takes the name of this process off the lock, which ends with the process: for one that ends
    /// without dropping this.
    pub fn sign_off(&self) {
        self.lock.sign_off();
    }

    pub(super) fn options(&self) -> StoreOptions {
        self.options
    }

    /// What the record of the folder's own files says that it holds.
    pub(super) fn holds(&self) -> &'static str {
        match &self.contents {
            Contents::Result(holds) => holds,
            Contents::Suite(_) => SuiteFileNames::HOLDS,
        }
    }

    pub(super) fn displaced(&self) -> Displaced {
        if self.options.force {
            Displaced::Anybodys
        } else {
            Displaced::Ours
        }
    }

    /// Starts an empty folder in the workshop.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn stage(&self) -> Result<Staged<'_>, StoreError> {
        Staged::create(self, self.next_name()?)
    }

    /// A name in the workshop that nothing there has or will have.
    fn next_name(&self) -> Result<String, StoreError> {
        let workshop = self.path.join(WORKSHOP);
        loop {
            let number = self.built.fetch_add(1, Ordering::Relaxed);
            // The process as well, for file systems that cannot keep a second one out.
            let name = journal::being_built(&format!("{}-{number}", std::process::id()));
            // An earlier process of the same number may have left what is not for the tool to clear.
            let names = [
                journal::displaced(&name),
                journal::kept(&name),
                name.clone(),
            ];
            let mut is_free = true;
            for name in names {
                let path = workshop.join(name);
                is_free &= !stands(&path).map_err(StoreError::at(&path))?;
            }
            if is_free {
                return Ok(name);
            }
        }
    }

    /// Refuses to replace what is the user's.
    pub(super) fn check_theirs(&self, target: &Path) -> Result<(), StoreError> {
        if self.options.force {
            return Ok(());
        }
        refuse_theirs(target).map_err(become_theirs)
    }

    /// Refuses a change of the files of one result where anything in the folder is the user's, or in the
    /// way. A suite's files are looked at one by one.
    pub(super) fn check_change(&self, change: &UpdateJournal) -> Result<(), StoreError> {
        let Contents::Result(holds) = &self.contents else {
            return Ok(());
        };
        if !self.options.force {
            refuse(&self.path, ownership::inspect_result(&self.path, holds))?;
        }
        update::refuse_obstacles(&self.path, change)
    }

    /// Removes the suite's own files of an earlier run, so that no verdict outlives its results.
    ///
    /// # Errors
    /// [`StoreError::Kept`] if one has become the user's; whatever the file system says.
    pub fn forget_suite_files(&self) -> Result<(), StoreError> {
        let own = self.known_files()?;
        let is_standing = |name: &&String| self.path.join(name).is_file();
        // The record goes last, as the others are known by it.
        let mut removed: Vec<String> = own.keys().filter(is_standing).cloned().collect();
        removed.sort_by_key(|name| name == super::RECORD_FILE);
        if removed.is_empty() {
            return Ok(());
        }
        self.change_files(&UpdateJournal {
            new: self.next_name()?,
            removed,
            installed: Vec::new(),
            own,
        })
    }

    /// Changes files of the folder itself.
    pub(super) fn change_files(&self, change: &UpdateJournal) -> Result<(), StoreError> {
        let Left { spared, kept } = update::update(&self.path, change, self.options.force)?;
        if spared.is_empty() {
            return Ok(());
        }
        Err(StoreError::Kept {
            place: self.path.clone(),
            spared,
            kept,
        })
    }

    /// Files of the folder itself that an earlier command wrote, with their digests, the record of them
    /// among them.
    pub(super) fn known_files(&self) -> Result<BTreeMap<String, String>, StoreError> {
        let known = match &self.contents {
            Contents::Result(_) => ownership::files_of_result(&self.path),
            Contents::Suite(_) => suite_files::known(&self.path),
        };
        known.map_err(StoreError::at(&self.path))
    }

    /// Replaces a folder of results by one with the same files of those of its sub-folders that `kept`
    /// names, in one step; what else it holds goes.
    ///
    /// # Errors
    /// [`StoreError::Kept`], or whatever the file system says; the folder then stands untouched.
    pub fn keep_only(&self, place: &str, kept: &[String]) -> Result<(), StoreError> {
        let staged = self.stage()?;
        for name in kept {
            staged.adopt(&Path::new(place).join(name), name)?;
        }
        staged.put_in_place(place)
    }
}

/// Refuses to replace a folder of the user's.
///
/// # Errors
/// [`StoreError::NotOurs`], or whatever the file system says of reading it.
pub fn refuse_theirs(folder: &Path) -> Result<(), StoreError> {
    refuse(folder, ownership::inspect(folder))
}

fn refuse(folder: &Path, found: io::Result<Ownership>) -> Result<(), StoreError> {
    match found {
        Ok(Ownership::Theirs { path, reason }) => Err(StoreError::NotOurs {
            folder: folder.to_owned(),
            path,
            reason,
        }),
        Ok(_) => Ok(()),
        Err(source) => Err(StoreError::Write {
            path: folder.to_owned(),
            source,
        }),
    }
}

/// What is refused before anything is made, as it will be while the command is at work.
fn become_theirs(refusal: StoreError) -> StoreError {
    match refusal {
        StoreError::NotOurs {
            folder,
            path,
            reason,
        } => StoreError::Kept {
            place: folder,
            spared: vec![Spared { path, reason }],
            kept: None,
        },
        other => other,
    }
}

/// Refuses a path that can be no folder of results.
pub(super) fn refuse_unusable(path: &Path) -> Result<(), StoreError> {
    let refused = |found: &Path, reason| {
        Err(StoreError::Obstacle {
            folder: path.to_owned(),
            path: found.to_owned(),
            reason,
        })
    };
    let is_workshop = |part: Component| part.as_os_str() == OsStr::new(WORKSHOP);
    if path.components().any(is_workshop) {
        return refused(path, Foreign::Workshop);
    }
    for found in path.ancestors().filter(|part| *part != Path::new("")) {
        match fs::symlink_metadata(found) {
            Ok(_) if found.is_dir() => break,
            // A link to nothing, or to no folder.
            Ok(_) => return refused(found, Foreign::NoFolder),
            Err(_) => {}
        }
    }
    let workshop = path.join(WORKSHOP);
    match fs::symlink_metadata(&workshop) {
        Ok(kind) if kind.is_symlink() => refused(&workshop, Foreign::Link),
        Ok(kind) if !kind.is_dir() => refused(&workshop, Foreign::NoFolder),
        _ => Ok(()),
    }
}

/// Carries out the journals of a process that was killed, and clears the workshop; what is worth saying
/// of what stays there.
fn mend(output: &Path) -> Result<Vec<String>, StoreError> {
    let workshop = output.join(WORKSHOP);
    let (journals, damaged) = Journal::all(&workshop)?;
    let mut cautions = Vec::new();
    // What a journal still tells of, or told of, stays.
    let mut wanted: BTreeSet<String> = BTreeSet::new();
    for journal in &damaged {
        wanted.insert(journal.number().to_owned());
        cautions.push(format!(
            "{} is a damaged journal of a command that was killed: what it tells of stays in {}; take out \
             what you need, then remove it",
            journal.path.display(),
            workshop.display()
        ));
    }
    for journal in &journals {
        match journal {
            Journal::Swap(cut_short) => {
                if let Some(caution) = swap::mend(output, cut_short)? {
                    wanted.insert(journal.number().to_owned());
                    cautions.push(caution);
                }
            }
            Journal::Update(cut_short) => {
                let left = update::carry_out(output, cut_short, false)?;
                cautions.extend(left.spared.into_iter().map(|spared| {
                    format!(
                        "{} {} and stays as it is, though a command that was killed was to replace it",
                        spared.path.display(),
                        spared.reason
                    )
                }));
            }
        }
    }
    clear_workshop(&workshop, &wanted, &mut cautions)?;
    Ok(cautions)
}

/// Removes what commands that were killed left in a workshop, and says what stays.
fn clear_workshop(
    workshop: &Path,
    wanted: &BTreeSet<String>,
    cautions: &mut Vec<String>,
) -> Result<(), StoreError> {
    let at = StoreError::at(workshop);
    let entries = fs::read_dir(workshop).map_err(&at)?;
    let mut entries = entries.collect::<Result<Vec<_>, _>>().map_err(&at)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let (path, name) = (entry.path(), entry.file_name());
        let at = StoreError::at(&path);
        match Item::of(&name.to_string_lossy()) {
            Item::BeingBuilt(number) if !wanted.contains(number) => remove(&path).map_err(at)?,
            Item::Unfinished => remove(&path).map_err(at)?,
            Item::Displaced(number) if !wanted.contains(number) => {
                if let Some(spared) = clear(&path).map_err(at)? {
                    cautions.push(format!(
                        "{} {}: it was in a folder that fogbench replaced, and stays until you move it away",
                        spared.path.display(),
                        spared.reason
                    ));
                }
            }
            Item::Kept => cautions.push(format!(
                "{} holds results that could not take their place: move it away, or remove it",
                path.display()
            )),
            _ => {}
        }
    }
    Ok(())
}
