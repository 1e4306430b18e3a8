//! An output folder in the hands of one writer.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::StoreError;
use super::files::{remove, stands};
use super::journal::{self, Journal};
use super::lock::{Lock, make_workshop};
use super::ownership::{self, Ownership};
use super::staged::Staged;
use super::suite_files::{self, SuiteFileNames};
use super::{Swap, WORKSHOP, swap, update};

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
    /// One result: the folder is the tool's as a whole.
    Result,
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
}

impl OutputFolder {
    /// Takes a folder for one result, made if absent; it must be empty or the tool's.
    ///
    /// # Errors
    /// [`StoreError::NotOurs`], [`StoreError::InUse`], or whatever the file system says.
    pub fn of_result(path: &Path, options: StoreOptions) -> Result<Self, StoreError> {
        Self::open(path, options, Contents::Result, &|_| Ok(()))
    }

    /// Checks what [`OutputFolder::of_result`] would refuse, and makes nothing.
    ///
    /// # Errors
    /// As [`OutputFolder::of_result`].
    pub fn check_result(path: &Path, options: StoreOptions) -> Result<(), StoreError> {
        if path.join(WORKSHOP).is_dir() {
            // A command that was killed may have left files that only its journal makes sense of.
            return Self::of_result(path, options).map(drop);
        }
        if options.force || !path.is_dir() {
            return Ok(());
        }
        refuse(path, ownership::inspect_result(path))
    }

    /// Takes a folder for a suite, made if absent; the suite's own files must be absent or the tool's,
    /// and so must every folder that `check` looks into with [`refuse_theirs`].
    ///
    /// Everything is checked before anything is made, so that a refusal leaves no trace.
    ///
    /// # Errors
    /// [`StoreError::NotOurs`], [`StoreError::InUse`], or whatever the file system says.
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
                Contents::Result => refuse(path, ownership::inspect_result(path)),
                Contents::Suite(names) => {
                    refuse(path, suite_files::inspect(path, names)).and_then(|()| check(path))
                }
            }
        };
        let workshop = path.join(WORKSHOP);
        // Without the lock another process may be changing what is looked into, which its workshop shows:
        // the check under the lock then decides.
        if !workshop.is_dir()
            && let Err(refusal) = checked()
            && !workshop.is_dir()
        {
            return Err(refusal);
        }
        fs::create_dir_all(path).map_err(StoreError::at(path))?;
        make_workshop(&workshop).map_err(StoreError::at(&workshop))?;
        let lock = Lock::take(path, &workshop)?;
        mend(path).map_err(StoreError::at(path))?;
        checked()?;
        Ok(Self {
            path: path.to_owned(),
            lock,
            options,
            contents,
            built: AtomicU64::new(0),
        })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What to say where the file system cannot keep other writers out.
    #[must_use]
    pub fn caution(&self) -> Option<&str> {
        self.lock.caution.as_deref()
    }

    /// Takes the name of this process off the lock, which ends with the process: for one that ends
    /// without dropping this.
    pub fn sign_off(&self) {
        self.lock.sign_off();
    }

    pub(super) fn options(&self) -> StoreOptions {
        self.options
    }

    /// Starts an empty folder in the workshop.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn stage(&self) -> Result<Staged<'_>, StoreError> {
        let number = self.built.fetch_add(1, Ordering::Relaxed);
        // The process as well, for file systems that cannot keep a second one out.
        let name = format!("{}-{number}", std::process::id());
        Staged::create(self, journal::being_built(&name))
    }

    /// Refuses to replace what is the user's.
    pub(super) fn refuse_theirs(&self, target: &Path) -> Result<(), StoreError> {
        if self.options.force {
            return Ok(());
        }
        refuse_theirs(target)
    }

    /// Removes the suite's own files of an earlier run, so that no verdict outlives its results.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn forget_suite_files(&self) -> Result<(), StoreError> {
        for name in self.known_files()? {
            let path = self.path.join(name);
            remove(&path).map_err(StoreError::at(&path))?;
        }
        Ok(())
    }

    /// Files of the folder itself that an earlier command wrote, the record of them last.
    pub(super) fn known_files(&self) -> Result<Vec<String>, StoreError> {
        let known = match &self.contents {
            Contents::Result => ownership::files_of_result(&self.path),
            Contents::Suite(_) => suite_files::known(&self.path),
        };
        known.map_err(StoreError::at(&self.path))
    }

    /// Replaces a folder of results by one with the same files of those of its sub-folders that `kept`
    /// names, in one step; what else it holds goes.
    ///
    /// # Errors
    /// [`StoreError::NotOurs`], or whatever the file system says; the folder then stands untouched.
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

/// Carries out the journals of a process that was killed, and clears the workshop.
fn mend(output: &Path) -> io::Result<()> {
    let workshop = output.join(WORKSHOP);
    for journal in Journal::all(&workshop)? {
        match &journal {
            Journal::Swap(cut_short) => swap::mend(output, cut_short)?,
            Journal::Update(cut_short) => update::carry_out(output, cut_short)?,
        }
    }
    for entry in fs::read_dir(&workshop)? {
        let entry = entry?;
        if journal::is_scrap(&entry.file_name().to_string_lossy()) && stands(&entry.path())? {
            remove(&entry.path())?;
        }
    }
    Ok(())
}
