//! The folder that a program works in: a fresh one each time, gone when the program is.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where the program works, below the folder.
const WORK: &str = "work";
/// File by which the supervisor is asked to end everything.
const STOP: &str = "stop";
/// File in which it says how the program ended.
const END: &str = "end";

/// Names that are tried until one is free.
const ATTEMPTS: u32 = 1000;

/// A folder that is removed when it is dropped.
#[derive(Debug)]
pub(super) struct Folder(PathBuf);

impl Folder {
    /// A new folder, which only its owner can look into.
    pub(super) fn new() -> io::Result<Self> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let mut attempts = 0;
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let name = format!("fogbench-program-{}-{number}", std::process::id());
            let path = std::env::temp_dir().join(name);
            attempts += 1;
            match create(&path) {
                // Left by a process of the same number.
                Err(error)
                    if error.kind() == io::ErrorKind::AlreadyExists && attempts < ATTEMPTS => {}
                made => {
                    made?;
                    let folder = Self(path);
                    fs::create_dir(folder.work())?;
                    return Ok(folder);
                }
            }
        }
    }

    /// The folder itself.
    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    /// Where the program works.
    pub(super) fn work(&self) -> PathBuf {
        self.0.join(WORK)
    }

    /// Asks the supervisor to end everything.
    pub(super) fn ask_to_stop(&self) -> io::Result<()> {
        fs::write(self.0.join(STOP), "")
    }

    /// How the program ended, once the supervisor has said so.
    pub(super) fn end(&self) -> Option<End> {
        End::parse(&fs::read_to_string(self.0.join(END)).ok()?)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that cannot be removed is the system's to clear.
        drop(fs::remove_dir_all(&self.0));
    }
}

/// Whether the supervisor of a folder is asked to end everything.
pub(super) fn is_to_stop(folder: &Path) -> bool {
    // One that is gone was given up by fogbench.
    folder.join(STOP).exists() || !folder.exists()
}

/// Says how the program of a folder ended, in one step.
pub(super) fn say_end(folder: &Path, end: &End) -> io::Result<()> {
    let unfinished = folder.join("end.new");
    fs::write(&unfinished, end.to_text())?;
    fs::rename(unfinished, folder.join(END))
}

#[cfg(unix)]
fn create(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::DirBuilderExt as _;
    fs::DirBuilder::new().mode(0o700).create(path)
}

#[cfg(not(unix))]
fn create(path: &Path) -> io::Result<()> {
    fs::create_dir(path)
}

/// How a program ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// By itself, with this code.
    Code(i32),
    /// By a signal.
    Signal(i32),
    /// It was killed for the memory it took, MB.
    Memory(u64),
    /// It was never started; why.
    NotStarted(String),
}

impl End {
    fn to_text(&self) -> String {
        match self {
            Self::Code(code) => format!("code {code}"),
            Self::Signal(signal) => format!("signal {signal}"),
            Self::Memory(mb) => format!("memory {mb}"),
            Self::NotStarted(why) => format!("start {why}"),
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let (kind, rest) = text.split_once(' ')?;
        match kind {
            "code" => rest.parse().ok().map(Self::Code),
            "signal" => rest.parse().ok().map(Self::Signal),
            "memory" => rest.parse().ok().map(Self::Memory),
            "start" => Some(Self::NotStarted(rest.to_owned())),
            _ => None,
        }
    }

    /// The end in words, behind "it ended".
    pub(super) fn words(&self) -> String {
        match self {
            Self::Code(0) => "without an error".to_owned(),
            Self::Code(code) => format!("with exit code {code}"),
            Self::Signal(signal) => format!("by signal {signal}"),
            Self::Memory(_) => "for its memory".to_owned(),
            Self::NotStarted(_) => "before it began".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_is_read_as_it_was_said() {
        let folder = Folder::new().unwrap();
        assert_eq!(folder.end(), None);
        for end in [
            End::Code(3),
            End::Signal(11),
            End::Memory(700),
            End::NotStarted("no such file".to_owned()),
        ] {
            say_end(folder.path(), &end).unwrap();
            assert_eq!(folder.end(), Some(end));
        }
    }

    #[test]
    fn a_folder_is_fresh_and_gone_when_it_is_dropped() {
        let (one, other) = (Folder::new().unwrap(), Folder::new().unwrap());
        assert_ne!(one.path(), other.path());
        let path = one.path().to_owned();
        assert!(one.work().is_dir() && !is_to_stop(&path));
        one.ask_to_stop().unwrap();
        assert!(is_to_stop(&path));
        drop(one);
        assert!(!path.exists() && other.path().exists());
    }
}
