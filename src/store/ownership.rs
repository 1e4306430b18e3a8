//! Whose a folder is.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, DirEntry};
use std::io;
use std::path::{Path, PathBuf};

use super::error::Foreign;
use super::legacy;
use super::record::{MANIFEST_FILE, RECORD_FILE, Record, Sealed, digest_of};
use super::{WORKSHOP, journal, lock};

/// Whose a folder is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ownership {
    /// Nothing stands there.
    Absent,
    /// A folder that holds nothing.
    Empty,
    /// Everything in it was written by fogbench and is as it was written.
    Ours {
        /// Whether it holds one result, and nothing that its record lists is lacking.
        is_whole: bool,
    },
    /// The user's.
    Theirs {
        /// What shows it.
        path: PathBuf,
        /// What is the matter with it.
        reason: Foreign,
    },
}

/// The first thing that is the user's, or an error of the file system.
pub(super) enum Finding {
    Theirs(PathBuf, Foreign),
    Failed(io::Error),
}

impl From<io::Error> for Finding {
    fn from(error: io::Error) -> Self {
        Self::Failed(error)
    }
}

/// Whose the folder is: ours if it holds what its record tells of, unchanged, or points of a sweep that
/// are ours, and nothing else.
///
/// # Errors
/// What the file system says of reading it.
pub fn inspect(folder: &Path) -> io::Result<Ownership> {
    as_ownership(examine(folder, true))
}

/// Whose the folder of one result is: as [`inspect`], but points of a sweep are none of it, and the
/// folder may be named by a link.
pub(super) fn inspect_result(folder: &Path) -> io::Result<Ownership> {
    as_ownership(examine_contents(folder, false))
}

fn as_ownership(found: Result<Ownership, Finding>) -> io::Result<Ownership> {
    match found {
        Ok(found) => Ok(found),
        Err(Finding::Theirs(path, reason)) => Ok(Ownership::Theirs { path, reason }),
        Err(Finding::Failed(error)) => Err(error),
    }
}

/// Names in a folder in order, its workshop left out where that holds nothing but the tool's own.
fn entries(folder: &Path) -> Result<Vec<DirEntry>, Finding> {
    let mut entries = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    entries.sort_by_key(DirEntry::file_name);
    let mut kept = Vec::with_capacity(entries.len());
    for entry in entries {
        let is_workshop = entry.file_name() == OsStr::new(WORKSHOP);
        if !(is_workshop && entry.file_type()?.is_dir()) {
            kept.push(entry);
            continue;
        }
        for inner in fs::read_dir(entry.path())? {
            let inner = inner?;
            let name = inner.file_name();
            let name = name.to_string_lossy();
            if name != lock::FILE && !journal::is_own_name(&name) {
                return Err(Finding::Theirs(inner.path(), Foreign::Unknown));
            }
        }
    }
    Ok(kept)
}

fn examine(folder: &Path, may_hold_points: bool) -> Result<Ownership, Finding> {
    let kind = match fs::symlink_metadata(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Ownership::Absent),
        kind => kind?,
    };
    if kind.is_symlink() {
        return Err(Finding::Theirs(folder.to_owned(), Foreign::Link));
    }
    if !kind.is_dir() {
        return Err(Finding::Theirs(folder.to_owned(), Foreign::NoFolder));
    }
    examine_contents(folder, may_hold_points)
}

fn examine_contents(folder: &Path, may_hold_points: bool) -> Result<Ownership, Finding> {
    let entries = entries(folder)?;
    if entries.is_empty() {
        return Ok(Ownership::Empty);
    }
    let mut holds_points = false;
    let mut own = Vec::with_capacity(entries.len());
    for entry in entries {
        let is_folder = entry.file_type()?.is_dir();
        if may_hold_points && is_folder && is_point_name(&entry.file_name().to_string_lossy()) {
            examine(&entry.path(), false)?;
            holds_points = true;
        } else {
            own.push(entry);
        }
    }
    if own.is_empty() {
        return Ok(Ownership::Ours { is_whole: false });
    }
    let is_whole = match record_of(folder)? {
        Some((record, own_file)) => compare(&own, &record, own_file)?,
        None => {
            let is_known = legacy::names_the_tool(folder);
            let known = |name: &str| is_known && legacy::is_file_name(name);
            walk(&own, "", &mut |path, name| {
                if known(name) {
                    Ok(())
                } else {
                    Err(Finding::Theirs(path.to_owned(), Foreign::Unknown))
                }
            })?;
            false
        }
    };
    Ok(Ownership::Ours {
        is_whole: is_whole && !holds_points,
    })
}

/// Whether a folder has the name of a point of a sweep.
pub(super) fn is_point_name(name: &str) -> bool {
    name.len() >= 4 && name.bytes().all(|byte| byte.is_ascii_digit())
}

/// The record of a folder and the file that holds it.
pub(super) fn record_of(folder: &Path) -> Result<Option<(Record, &'static str)>, Finding> {
    for name in [MANIFEST_FILE, RECORD_FILE] {
        let path = folder.join(name);
        if !fs::symlink_metadata(&path).is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        match Record::read(&path)? {
            Sealed::Whole(record) => return Ok(Some((record, name))),
            Sealed::Changed => return Err(Finding::Theirs(path, Foreign::Changed)),
            Sealed::Absent => {}
        }
    }
    Ok(None)
}

/// Compares what a folder holds with its record; whether nothing is lacking.
fn compare(own: &[DirEntry], record: &Record, own_file: &str) -> Result<bool, Finding> {
    let mut seen = BTreeSet::new();
    walk(own, "", &mut |path, name| {
        if name == own_file {
            return Ok(());
        }
        check_file(path, record.files.get(name))?;
        seen.insert(name.to_owned());
        Ok(())
    })?;
    Ok(record.names().all(|name| seen.contains(name)))
}

/// Compares one file with its recorded digest.
pub(super) fn check_file(path: &Path, recorded: Option<&String>) -> Result<(), Finding> {
    let recorded = recorded.ok_or_else(|| Finding::Theirs(path.to_owned(), Foreign::Unknown))?;
    if digest_of(path)? == *recorded {
        Ok(())
    } else {
        Err(Finding::Theirs(path.to_owned(), Foreign::Changed))
    }
}

/// Visits every file below the entries with its name from the folder on; a link, an empty folder or
/// anything that is no file is the user's.
fn walk(
    entries: &[DirEntry],
    prefix: &str,
    visit: &mut dyn FnMut(&Path, &str) -> Result<(), Finding>,
) -> Result<(), Finding> {
    for entry in entries {
        let (path, kind) = (entry.path(), entry.file_type()?);
        let theirs = |reason| Err(Finding::Theirs(path.clone(), reason));
        let file_name = entry.file_name();
        let Some(name) = file_name.to_str() else {
            return theirs(Foreign::Unknown);
        };
        let name = format!("{prefix}{name}");
        if kind.is_symlink() {
            return theirs(Foreign::Link);
        }
        if kind.is_file() {
            visit(&path, &name)?;
            continue;
        }
        if !kind.is_dir() {
            return theirs(Foreign::NoFile);
        }
        let mut below = fs::read_dir(&path)?.collect::<Result<Vec<_>, _>>()?;
        below.sort_by_key(DirEntry::file_name);
        if below.is_empty() {
            return theirs(Foreign::Unknown);
        }
        walk(&below, &format!("{name}/"), visit)?;
    }
    Ok(())
}

/// Files of the folder of one result that an earlier command wrote, the record of them last.
pub(super) fn files_of_result(folder: &Path) -> io::Result<Vec<String>> {
    match record_of(folder) {
        Ok(Some((record, own_file))) => {
            let mut names: Vec<String> = record.names().map(str::to_owned).collect();
            names.push(own_file.to_owned());
            Ok(names)
        }
        Ok(None) if legacy::names_the_tool(folder) => {
            let mut names = Vec::new();
            let entries = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
            let walked = walk(&entries, "", &mut |_, name| {
                names.push(name.to_owned());
                Ok(())
            });
            names.retain(|name| legacy::is_file_name(name));
            match walked {
                Err(Finding::Failed(error)) => Err(error),
                _ => Ok(names),
            }
        }
        Ok(None) | Err(Finding::Theirs(..)) => Ok(Vec::new()),
        Err(Finding::Failed(error)) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with a record of what it holds.
    fn recorded(folder: &Path, files: &[&str]) {
        for name in files {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, name).unwrap();
        }
        let record = Record::of(folder).unwrap();
        fs::write(folder.join(RECORD_FILE), record.sealed("schema = 1\n")).unwrap();
    }

    fn theirs(folder: &Path) -> Option<(PathBuf, Foreign)> {
        match inspect(folder).unwrap() {
            Ownership::Theirs { path, reason } => {
                Some((path.strip_prefix(folder).unwrap().to_owned(), reason))
            }
            _ => None,
        }
    }

    #[test]
    fn a_folder_is_ours_while_it_holds_what_its_record_tells_of() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("run");
        assert_eq!(inspect(&folder).unwrap(), Ownership::Absent);
        fs::create_dir(&folder).unwrap();
        assert_eq!(inspect(&folder).unwrap(), Ownership::Empty);
        recorded(&folder, &["a.csv", "samples/raw.npy"]);
        assert_eq!(
            inspect(&folder).unwrap(),
            Ownership::Ours { is_whole: true }
        );
        fs::remove_file(folder.join("a.csv")).unwrap();
        assert_eq!(
            inspect(&folder).unwrap(),
            Ownership::Ours { is_whole: false }
        );
        fs::write(folder.join("a.csv"), "other").unwrap();
        assert_eq!(theirs(&folder), Some(("a.csv".into(), Foreign::Changed)));
        fs::remove_file(folder.join("a.csv")).unwrap();
        fs::create_dir_all(folder.join("samples/mine")).unwrap();
        assert_eq!(
            theirs(&folder),
            Some(("samples/mine".into(), Foreign::Unknown))
        );
        fs::write(folder.join("samples/mine/thesis.txt"), "x").unwrap();
        let thesis = PathBuf::from("samples/mine/thesis.txt");
        assert_eq!(theirs(&folder), Some((thesis, Foreign::Unknown)));
    }

    #[test]
    fn a_sweep_is_ours_while_it_holds_points_that_are() {
        let root = tempfile::tempdir().unwrap();
        let sweep = root.path().join("sweep");
        recorded(&sweep.join("0000"), &["a.csv"]);
        recorded(&sweep.join("10000"), &["a.csv"]);
        assert_eq!(
            inspect(&sweep).unwrap(),
            Ownership::Ours { is_whole: false }
        );
        // No sweep in a sweep, and no folder that is not named as a point.
        recorded(&sweep.join("0000/0000"), &["a.csv"]);
        assert!(theirs(&sweep).is_some());
        fs::remove_dir_all(sweep.join("0000/0000")).unwrap();
        recorded(&sweep.join("007"), &["a.csv"]);
        assert_eq!(
            theirs(&sweep),
            Some(("007/.fogbench.toml".into(), Foreign::Unknown))
        );
    }

    #[test]
    fn a_workshop_belongs_to_the_tool_only_with_what_the_tool_leaves_there() {
        let root = tempfile::tempdir().unwrap();
        recorded(root.path(), &["a.csv"]);
        let workshop = root.path().join(WORKSHOP);
        fs::create_dir_all(workshop.join("new-1")).unwrap();
        fs::write(workshop.join(lock::FILE), "").unwrap();
        assert_eq!(
            inspect(root.path()).unwrap(),
            Ownership::Ours { is_whole: true }
        );
        fs::write(workshop.join("thesis.txt"), "x").unwrap();
        let thesis = PathBuf::from(".fogbench/thesis.txt");
        assert_eq!(theirs(root.path()), Some((thesis, Foreign::Unknown)));
    }
}
