//! One writer at a time.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::error::{Foreign, StoreError};
use super::files::plain_file;

/// File of the lock, which is never removed: a lock on a removed file excludes nobody.
pub(super) const FILE: &str = "lock";

/// How the words of a holder begin.
const PROCESS: &str = "process ";

/// The right to write into an output folder, until dropped.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
    is_shared: bool,
    /// What to say where the file system cannot lock.
    pub(super) caution: Option<String>,
}

impl Lock {
    /// Takes the lock of the workshop of `output`.
    ///
    /// The file is opened for writing, since file systems of networks grant an exclusive lock for
    /// nothing less. The system releases the lock of a process that is killed. What is no lock of the
    /// tool's, such as a link or a file with other words in it, stays as it is.
    pub(super) fn take(output: &Path, workshop: &Path) -> Result<Self, StoreError> {
        Self::of_file(output, &workshop.join(FILE), File::try_lock)?.signed()
    }

    /// Takes a lock of the workshop of `output` that is the own one of a part of its results.
    pub(super) fn take_own(place: &Path, path: &Path) -> Result<Self, StoreError> {
        Self::of_file(place, path, File::try_lock)?.signed()
    }

    /// Takes a share in the lock of the workshop of `output`: others may share it, and nobody has it alone
    /// meanwhile. It names nobody, since one name would overwrite another.
    pub(super) fn share(output: &Path, workshop: &Path) -> Result<Self, StoreError> {
        let mut lock = Self::of_file(output, &workshop.join(FILE), File::try_lock_shared)?;
        lock.is_shared = true;
        Ok(lock)
    }

    fn of_file(
        output: &Path,
        path: &Path,
        try_lock: fn(&File) -> Result<(), TryLockError>,
    ) -> Result<Self, StoreError> {
        let at = StoreError::at(path);
        let foreign = |reason| StoreError::Obstacle {
            folder: output.to_owned(),
            path: path.to_owned(),
            reason,
        };
        if let Some(reason) = foreign_file(path).map_err(&at)? {
            return Err(foreign(reason));
        }
        let opened = plain_file()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path);
        let mut file = opened.map_err(&at)?;
        // Once more: the name may have come to mean something else.
        if let Some(reason) = foreign_file(path).map_err(&at)? {
            return Err(foreign(reason));
        }
        let caution = match try_for_a_moment(&mut file, try_lock) {
            Ok(()) => None,
            Err(Refusal::Held { holder }) => {
                return Err(StoreError::InUse {
                    folder: output.to_owned(),
                    holder,
                });
            }
            Err(Refusal::Unsupported(error)) => Some(format!(
                "{}: locking is not supported here ({error}): let nothing else write into {}",
                path.display(),
                output.display()
            )),
        };
        if !holds_own_words(&mut file).map_err(&at)? {
            return Err(foreign(Foreign::Unknown));
        }
        Ok(Self {
            path: path.to_owned(),
            file,
            caution,
            is_shared: false,
        })
    }

    /// The lock with the name of this process in its file.
    fn signed(mut self) -> Result<Self, StoreError> {
        let words = format!("{PROCESS}{} on {}\n", std::process::id(), host_name());
        let file = &mut self.file;
        let written = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| file.write_all(words.as_bytes()));
        written.map_err(StoreError::at(&self.path))?;
        Ok(self)
    }
}

/// What makes a file that stands in the place of a lock the user's.
fn foreign_file(path: &Path) -> io::Result<Option<Foreign>> {
    let kind = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        kind => kind?,
    };
    Ok(if kind.is_symlink() {
        Some(Foreign::Link)
    } else if !kind.is_file() {
        Some(Foreign::NoFile)
    } else if names_of(&kind) > 1 {
        Some(Foreign::SecondName)
    } else {
        None
    })
}

/// How many names a file has, as far as the system tells.
#[cfg(unix)]
fn names_of(kind: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(kind)
}

#[cfg(not(unix))]
fn names_of(_kind: &fs::Metadata) -> u64 {
    1
}

/// Whether a file holds nothing but what a lock may: the words of a holder, of which a kill may have
/// left the beginning.
fn holds_own_words(file: &mut File) -> io::Result<bool> {
    const LENGTH_MAX: u64 = 1000;
    let mut bytes = Vec::new();
    file.rewind()?;
    file.take(LENGTH_MAX).read_to_end(&mut bytes)?;
    let Ok(words) = std::str::from_utf8(&bytes) else {
        return Ok(false);
    };
    let is_short = (bytes.len() as u64) < LENGTH_MAX;
    let is_one_line = words.find('\n').is_none_or(|end| end + 1 == words.len());
    let begins = words.starts_with(PROCESS) || PROCESS.starts_with(words);
    Ok(is_short && is_one_line && begins)
}

/// Refuses a folder inside another that is being written.
pub(super) fn refuse_inside_held(output: &Path) -> Result<(), StoreError> {
    let Ok(absolute) = std::path::absolute(output) else {
        return Ok(());
    };
    let existing = absolute.ancestors().find(|path| path.is_dir());
    let Some(Ok(found)) = existing.map(fs::canonicalize) else {
        return Ok(());
    };
    // Its own lock is taken, not asked.
    let is_itself = existing == Some(absolute.as_path());
    for folder in found.ancestors().skip(usize::from(is_itself)) {
        let path = folder.join(super::WORKSHOP).join(FILE);
        if let Some(holder) = holder_of(&path) {
            return Err(StoreError::InUse {
                folder: folder.to_owned(),
                holder,
            });
        }
    }
    Ok(())
}

impl Lock {
    /// Empties the file, so that it names nobody once the process has ended.
    pub(super) fn sign_off(&self) {
        // Best effort: a name that stays behind is overwritten by the next holder.
        let _ = self.file.set_len(0);
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if !self.is_shared {
            self.sign_off();
        }
        let _ = self.file.unlock();
    }
}

/// Why a lock was not taken.
enum Refusal {
    /// Another process has it.
    Held { holder: String },
    /// The file system cannot lock.
    Unsupported(io::Error),
}

/// Takes the lock of a file. A holder that has not written its name yet is given a moment to do so, or
/// to end.
fn try_for_a_moment(
    file: &mut File,
    try_lock: fn(&File) -> Result<(), TryLockError>,
) -> Result<(), Refusal> {
    const TRIES: u32 = 20;
    const PAUSE: Duration = Duration::from_millis(10);
    for _ in 0..TRIES {
        match try_lock(file) {
            Ok(()) => return Ok(()),
            Err(TryLockError::Error(error)) => return Err(Refusal::Unsupported(error)),
            Err(TryLockError::WouldBlock) => {
                if let Some(holder) = holder(file) {
                    return Err(Refusal::Held { holder });
                }
            }
        }
        std::thread::sleep(PAUSE);
    }
    // The system does not let the name be read.
    let holder = "another process".to_owned();
    Err(Refusal::Held { holder })
}

/// Who holds the lock of a file, in words; none if nobody does, or there is no such lock.
pub(super) fn holder_of(path: &Path) -> Option<String> {
    if !matches!(foreign_file(path), Ok(None)) {
        return None;
    }
    let mut file = plain_file().read(true).open(path).ok()?;
    let is_held = matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock));
    is_held.then(|| holder(&mut file).unwrap_or_else(|| "another process".to_owned()))
}

/// Who holds a lock, as its file says; none if it does not say so.
fn holder(file: &mut File) -> Option<String> {
    let mut words = String::new();
    file.rewind().ok()?;
    file.take(1000).read_to_string(&mut words).ok()?;
    // A name without its end is being written.
    let (line, _) = words.split_once('\n')?;
    Some(line.to_owned())
}

#[cfg(unix)]
fn host_name() -> String {
    let system = rustix::system::uname();
    system.nodename().to_string_lossy().into_owned()
}

#[cfg(not(unix))]
fn host_name() -> String {
    std::env::var("COMPUTERNAME").unwrap_or_else(|_| "this host".to_owned())
}
