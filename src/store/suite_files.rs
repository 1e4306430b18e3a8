//! The files of a suite among the folders of its runs.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use super::error::Foreign;
use super::legacy;
use super::ownership::{Finding, Ownership, check_file, record_of};
use super::record::{MANIFEST_FILE, RECORD_FILE, Record, Sealed, digest_of};

/// What the record of a suite's own files says that it holds.
const SUITE: &str = "suite";

/// Names of the files that a suite may write into its output folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SuiteFileNames(pub Vec<String>);

impl SuiteFileNames {
    /// What the record of these files says that it holds.
    pub(super) const HOLDS: &'static str = SUITE;
}

/// Whose the suite's files in an output folder are; other files there are nobody's business.
pub(super) fn inspect(output: &Path, names: &SuiteFileNames) -> io::Result<Ownership> {
    match examine(output, names) {
        Ok(()) => Ok(Ownership::Ours { is_whole: false }),
        Err(Finding::Theirs(path, reason)) => Ok(Ownership::Theirs { path, reason }),
        Err(Finding::Failed(error)) => Err(error),
    }
}

fn examine(output: &Path, names: &SuiteFileNames) -> Result<(), Finding> {
    let record_path = output.join(RECORD_FILE);
    let theirs = |path: &Path, reason| Err(Finding::Theirs(path.to_owned(), reason));
    let record = match fs::symlink_metadata(&record_path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error.into()),
        Ok(kind) if kind.is_symlink() => return theirs(&record_path, Foreign::Link),
        Ok(kind) if !kind.is_file() => return theirs(&record_path, Foreign::NoFile),
        Ok(_) => match Record::read(&record_path)? {
            Sealed::Whole(record) if !is_of_suite(&record) => {
                return theirs(&record_path, Foreign::OtherResult);
            }
            Sealed::Whole(record) => Some(record),
            Sealed::Changed => return theirs(&record_path, Foreign::Changed),
            Sealed::Absent => return theirs(&record_path, Foreign::Unknown),
        },
    };
    let of_old_version = match &record {
        Some(_) => Vec::new(),
        None => legacy::suite_files(output),
    };
    let recorded = record.iter().flat_map(Record::names).map(str::to_owned);
    for name in names.0.iter().cloned().chain(recorded) {
        let path = output.join(&name);
        let Ok(kind) = fs::symlink_metadata(&path) else {
            continue;
        };
        if kind.is_symlink() {
            return theirs(&path, Foreign::Link);
        }
        if !kind.is_file() {
            return theirs(&path, Foreign::NoFile);
        }
        if of_old_version.contains(&name) {
            continue;
        }
        let digest = record.as_ref().and_then(|record| record.files.get(&name));
        if digest.is_none() && is_of_run(output, &name)? {
            return theirs(&path, Foreign::OtherResult);
        }
        check_file(&path, digest)?;
    }
    Ok(())
}

/// Whether a file belongs to the folder of a run that is taken for an output folder.
fn is_of_run(output: &Path, name: &str) -> Result<bool, Finding> {
    Ok(match record_of(output) {
        Ok(found) => found.is_some_and(|(record, own_file)| {
            own_file == MANIFEST_FILE && record.names().any(|recorded| recorded == name)
        }),
        Err(Finding::Theirs(..)) => false,
        Err(failed) => return Err(failed),
    })
}

/// Whether a record is of the files of a suite.
fn is_of_suite(record: &Record) -> bool {
    record.holds.as_deref() == Some(SUITE)
}

/// The suite's files that an earlier suite wrote, with their digests, the one that holds the record
/// among them.
pub(super) fn known(output: &Path) -> io::Result<BTreeMap<String, String>> {
    let path = output.join(RECORD_FILE);
    match Record::read(&path)? {
        Sealed::Whole(record) if is_of_suite(&record) => {
            let mut files = record.files;
            files.insert(RECORD_FILE.to_owned(), digest_of(&path)?);
            Ok(files)
        }
        Sealed::Absent => {
            let names = legacy::suite_files(output).into_iter();
            let standing = names.filter(|name| output.join(name).is_file());
            standing
                .map(|name| Ok((name.clone(), digest_of(&output.join(name))?)))
                .collect()
        }
        _ => Ok(BTreeMap::new()),
    }
}
