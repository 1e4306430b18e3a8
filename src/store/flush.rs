//! To the disk before a name says that it is there.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Flushes every file and folder of a tree, and the tree itself.
///
/// A rename that outlives a power cut must not name a folder whose files did not.
pub(super) fn flush_tree(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            flush_tree(&entry.path())?;
        } else {
            flush_file(&entry.path())?;
        }
    }
    flush_folder(folder)
}

fn flush_file(path: &Path) -> io::Result<()> {
    if cfg!(unix) {
        // Whatever its permissions say of writing.
        return File::open(path)?.sync_all();
    }
    // Other systems flush only what is open for writing.
    fs::OpenOptions::new().append(true).open(path)?.sync_all()
}

/// Flushes the names that a folder holds.
pub(super) fn flush_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        return match File::open(folder)?.sync_all() {
            // Some file systems of networks have no such thing.
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
            result => result,
        };
    }
    Ok(())
}
