//! One writer at a time.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::Path;
use std::time::Duration;

use super::error::StoreError;

/// File of the lock, which is never removed: a lock on a removed file excludes nobody.
pub(super) const FILE: &str = "lock";

/// The right to write into an output folder, until dropped.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
    /// What to say where the file system cannot lock.
    pub(super) caution: Option<String>,
}

impl Lock {
    /// Takes the lock of the workshop of `output`.
    ///
    /// The file is opened for writing, since file systems of networks grant an exclusive lock for
    /// nothing less. The system releases the lock of a process that is killed.
    pub(super) fn take(output: &Path, workshop: &Path) -> Result<Self, StoreError> {
        let path = workshop.join(FILE);
        let at = StoreError::at(&path);
        let opened = fs::OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path);
        let mut file = opened.map_err(&at)?;
        let caution = match try_for_a_moment(&mut file) {
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
        let words = format!("process {} on {}\n", std::process::id(), host_name());
        let written = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| file.write_all(words.as_bytes()));
        written.map_err(at)?;
        Ok(Self { file, caution })
    }
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
        self.sign_off();
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
fn try_for_a_moment(file: &mut File) -> Result<(), Refusal> {
    const TRIES: u32 = 20;
    const PAUSE: Duration = Duration::from_millis(10);
    for _ in 0..TRIES {
        match file.try_lock() {
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

/// Makes a folder for the lock where there is none.
pub(super) fn make_workshop(workshop: &Path) -> io::Result<()> {
    match fs::symlink_metadata(workshop) {
        Ok(kind) if kind.is_dir() => Ok(()),
        Ok(_) => Err(io::Error::new(
            io::ErrorKind::NotADirectory,
            "it is no folder, and the lock belongs there",
        )),
        Err(_) => fs::create_dir_all(workshop),
    }
}
