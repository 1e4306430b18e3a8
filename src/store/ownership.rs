//! Whose a folder is.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs::{self, DirEntry};
use std::io;
use std::path::{Path, PathBuf};

use super::error::{Foreign, Spared};
use super::journal::Item;
use super::legacy;
use super::record::{MANIFEST_FILE, RECORD_FILE, Record, Sealed, digest_of};
use super::{WORKSHOP, lock, program_log};

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
/// are ours, and nothing else. An output folder of its own, which has a workshop, is none of a run.
///
/// # Errors
/// What the file system says of reading it.
pub fn inspect(folder: &Path) -> io::Result<Ownership> {
    as_ownership(examine(folder, Place::Scenario))
}

/// Whose the folder of one result of the kind `holds` is: as [`inspect`], but points of a sweep are none
/// of it, and the folder may be named by a link.
pub(super) fn inspect_result(folder: &Path, holds: &str) -> io::Result<Ownership> {
    let contents = || {
        refuse_foreign_workshop(folder)?;
        if let Some((record, own_file)) = record_of(folder)?
            && record.holds.as_deref() != Some(holds)
        {
            return Err(Finding::Theirs(folder.join(own_file), Foreign::OtherResult));
        }
        examine_contents(folder, Place::Output)
    };
    as_ownership(contents())
}

/// Where a folder of results stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// It is an output folder, which holds a workshop.
    Output,
    /// It is that of a scenario, which may hold points of a sweep.
    Scenario,
    /// It is that of a point.
    Point,
}

fn as_ownership(found: Result<Ownership, Finding>) -> io::Result<Ownership> {
    match found {
        Ok(found) => Ok(found),
        Err(Finding::Theirs(path, reason)) => Ok(Ownership::Theirs { path, reason }),
        Err(Finding::Failed(error)) => Err(error),
    }
}

/// What a folder holds, in order of the names.
fn entries(folder: &Path) -> io::Result<Vec<DirEntry>> {
    let mut entries = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    entries.sort_by_key(DirEntry::file_name);
    Ok(entries)
}

/// Whether an entry is the workshop of an output folder.
fn is_workshop(entry: &DirEntry) -> io::Result<bool> {
    Ok(entry.file_name() == OsStr::new(WORKSHOP) && entry.file_type()?.is_dir())
}

/// A workshop belongs to the tool where it holds nothing but the tool's own.
fn refuse_foreign_workshop(folder: &Path) -> Result<(), Finding> {
    let workshop = folder.join(WORKSHOP);
    if !fs::symlink_metadata(&workshop).is_ok_and(|kind| kind.is_dir()) {
        return Ok(());
    }
    for inner in entries(&workshop)? {
        let name = inner.file_name();
        let name = name.to_string_lossy();
        let is_ours = name == lock::FILE || name == program_log::FILE;
        if !is_ours && Item::of(&name) == Item::Foreign {
            return Err(Finding::Theirs(inner.path(), Foreign::Unknown));
        }
    }
    Ok(())
}

fn examine(folder: &Path, place: Place) -> Result<Ownership, Finding> {
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
    examine_contents(folder, place)
}

fn examine_contents(folder: &Path, place: Place) -> Result<Ownership, Finding> {
    let mut is_empty = true;
    let mut holds_points = false;
    let mut own = Vec::new();
    for entry in entries(folder)? {
        if is_workshop(&entry)? {
            if place == Place::Output {
                continue;
            }
            return Err(Finding::Theirs(folder.to_owned(), Foreign::OutputFolder));
        }
        is_empty = false;
        let is_folder = entry.file_type()?.is_dir();
        let is_point = is_folder && is_point_name(&entry.file_name().to_string_lossy());
        if place == Place::Scenario && is_point {
            examine(&entry.path(), Place::Point)?;
            holds_points = true;
        } else {
            own.push(entry);
        }
    }
    if is_empty {
        return Ok(Ownership::Empty);
    }
    if own.is_empty() {
        return Ok(Ownership::Ours { is_whole: false });
    }
    let is_whole = match record_of(folder)? {
        Some((record, own_file)) => compare(&own, &record, own_file)?,
        None => {
            examine_old_version(folder, &own)?;
            false
        }
    };
    Ok(Ownership::Ours {
        is_whole: is_whole && !holds_points,
    })
}

/// Refuses what 0.1.0 did not write.
fn examine_old_version(folder: &Path, own: &[DirEntry]) -> Result<(), Finding> {
    let is_known = legacy::names_the_tool(folder);
    if !is_known {
        for name in [MANIFEST_FILE, RECORD_FILE] {
            let path = folder.join(name);
            if fs::symlink_metadata(&path).is_ok_and(|kind| kind.is_file()) {
                return Err(Finding::Theirs(path, Foreign::NoRecord));
            }
        }
    }
    walk(own, "", &mut |path, name| {
        if is_known && legacy::is_file_name(name) {
            Ok(())
        } else {
            Err(Finding::Theirs(path.to_owned(), Foreign::Unknown))
        }
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
    listed: &[DirEntry],
    prefix: &str,
    visit: &mut dyn FnMut(&Path, &str) -> Result<(), Finding>,
) -> Result<(), Finding> {
    for entry in listed {
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
        if is_workshop(entry)? {
            let folder = path.parent().unwrap_or(&path).to_owned();
            return Err(Finding::Theirs(folder, Foreign::OutputFolder));
        }
        let below = entries(&path)?;
        if below.is_empty() {
            return theirs(Foreign::Unknown);
        }
        walk(&below, &format!("{name}/"), visit)?;
    }
    Ok(())
}

/// Files of the folder of one result that an earlier command wrote, with their digests, the one that
/// holds the record among them.
pub(super) fn files_of_result(folder: &Path) -> io::Result<BTreeMap<String, String>> {
    match record_of(folder) {
        Ok(Some((record, own_file))) => {
            let mut files = record.files;
            files.insert(own_file.to_owned(), digest_of(&folder.join(own_file))?);
            Ok(files)
        }
        Ok(None) if legacy::names_the_tool(folder) => {
            let mut files = BTreeMap::new();
            let walked = walk(&entries(folder)?, "", &mut |path, name| {
                if legacy::is_file_name(name) {
                    files.insert(name.to_owned(), digest_of(path)?);
                }
                Ok(())
            });
            match walked {
                Err(Finding::Failed(error)) => Err(error),
                _ => Ok(files),
            }
        }
        Ok(None) | Err(Finding::Theirs(..)) => Ok(BTreeMap::new()),
        Err(Finding::Failed(error)) => Err(error),
    }
}

/// Whether a file is one of the results that a folder holds, whatever it is called.
#[must_use]
pub fn holds_result(folder: &Path, file: &Path) -> bool {
    let (Ok(folder), Ok(file)) = (fs::canonicalize(folder), fs::canonicalize(file)) else {
        return false;
    };
    let names = files_of_result(&folder).unwrap_or_default();
    let Ok(name) = file.strip_prefix(&folder) else {
        return false;
    };
    names.keys().any(|known| Path::new(known) == name)
}

/// Removes a folder of results that is ours, file by file, each only as its record tells of it at that
/// moment; what shows that something in it is the user's, which then stays.
///
/// The record goes last, so that what a kill leaves is still known.
pub(super) fn clear(folder: &Path) -> io::Result<Option<Spared>> {
    let cleared = match examine(folder, Place::Scenario) {
        Ok(Ownership::Absent) => return Ok(None),
        Ok(_) => clear_contents(folder, Place::Scenario),
        Err(finding) => Err(finding),
    };
    match cleared {
        Ok(()) => Ok(None),
        Err(Finding::Theirs(path, reason)) => Ok(Some(Spared { path, reason })),
        Err(Finding::Failed(error)) => Err(error),
    }
}

fn clear_contents(folder: &Path, place: Place) -> Result<(), Finding> {
    let mut own = Vec::new();
    for entry in entries(folder)? {
        let is_folder = entry.file_type()?.is_dir();
        let is_point = is_folder && is_point_name(&entry.file_name().to_string_lossy());
        if place == Place::Scenario && is_point {
            clear_contents(&entry.path(), Place::Point)?;
        } else {
            own.push(entry);
        }
    }
    if own.is_empty() {
        return remove_emptied(folder);
    }
    let record = record_of(folder)?;
    let is_known = record.is_none() && legacy::names_the_tool(folder);
    let own_file = record.as_ref().map_or(MANIFEST_FILE, |(_, name)| *name);
    walk(&own, "", &mut |path, name| {
        if name == own_file {
            return Ok(());
        }
        match &record {
            Some((record, _)) => check_file(path, record.files.get(name))?,
            None if is_known && legacy::is_file_name(name) => {}
            None => return Err(Finding::Theirs(path.to_owned(), Foreign::Unknown)),
        }
        Ok(fs::remove_file(path)?)
    })?;
    for entry in own {
        if entry.file_type()?.is_dir() {
            remove_emptied_tree(&entry.path())?;
        }
    }
    let path = folder.join(own_file);
    if record.is_some() != record_of(folder)?.is_some() {
        return Err(Finding::Theirs(path, Foreign::Changed));
    }
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error.into()),
        _ => {}
    }
    remove_emptied(folder)
}

/// Removes folders in which no file is left.
fn remove_emptied_tree(folder: &Path) -> Result<(), Finding> {
    for entry in entries(folder)? {
        if entry.file_type()?.is_dir() {
            remove_emptied_tree(&entry.path())?;
        }
    }
    remove_emptied(folder)
}

/// Removes an empty folder; one that is not holds something of the user's.
fn remove_emptied(folder: &Path) -> Result<(), Finding> {
    match fs::remove_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => {
            let found = entries(folder)?.first().map(DirEntry::path);
            let path = found.unwrap_or_else(|| folder.to_owned());
            Err(Finding::Theirs(path, Foreign::Unknown))
        }
        removed => Ok(removed?),
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
        fs::write(
            folder.join(RECORD_FILE),
            record.sealed("schema = 1\nholds = \"log\"\n"),
        )
        .unwrap();
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
        let log = |holds| inspect_result(root.path(), holds).unwrap();
        assert_eq!(log("log"), Ownership::Ours { is_whole: true });
        let path = root.path().join(RECORD_FILE);
        let reason = Foreign::OtherResult;
        assert_eq!(log("budget"), Ownership::Theirs { path, reason });
        // A run never has one: that is an output folder inside another.
        assert_eq!(
            theirs(root.path()),
            Some((PathBuf::new(), Foreign::OutputFolder))
        );
        fs::write(workshop.join("thesis.txt"), "x").unwrap();
        let path = workshop.join("thesis.txt");
        let reason = Foreign::Unknown;
        assert_eq!(log("log"), Ownership::Theirs { path, reason });
    }

    #[test]
    fn a_damaged_record_is_named_before_the_files_it_told_of() {
        for text in ["", "manifest = 1\n[tool]\nna", "\u{0}\u{1}"] {
            let root = tempfile::tempdir().unwrap();
            recorded(root.path(), &["a.csv"]);
            fs::write(root.path().join(RECORD_FILE), text).unwrap();
            let found = theirs(root.path());
            assert_eq!(found, Some((RECORD_FILE.into(), Foreign::NoRecord)));
        }
    }

    #[test]
    fn a_folder_is_cleared_of_what_is_ours_and_nothing_else() {
        let sweep = || {
            let root = tempfile::tempdir().unwrap();
            recorded(&root.path().join("s/0000"), &["a.csv", "samples/raw.npy"]);
            recorded(&root.path().join("s/0001"), &["a.csv"]);
            root
        };
        let root = sweep();
        assert_eq!(clear(&root.path().join("s")).unwrap(), None);
        assert!(!root.path().join("s").exists());
        for (name, reason) in [
            ("s/0001/samples/thesis", Foreign::Unknown),
            ("s/0001/a.csv", Foreign::Changed),
            ("s/thesis", Foreign::Unknown),
        ] {
            let root = sweep();
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, "years of work").unwrap();
            let spared = clear(&root.path().join("s")).unwrap();
            assert_eq!(
                spared,
                Some(Spared {
                    path: path.clone(),
                    reason
                })
            );
            assert_eq!(fs::read_to_string(path).unwrap(), "years of work");
            assert!(root.path().join("s/0000/a.csv").is_file(), "checked first");
        }
    }
}
