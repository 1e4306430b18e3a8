//! Files of a sweep beside the folders of its points.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

use super::record::{RECORD_FILE, Record, Sealed, digest_of};

/// What the record of these files says that it holds.
pub(super) const HOLDS: &str = "sweep";

/// The files that an earlier sweep wrote into its folder, with their digests, the record among them.
pub(super) fn known(folder: &Path) -> io::Result<BTreeMap<String, String>> {
    let path = folder.join(RECORD_FILE);
    match Record::read(&path)? {
        Sealed::Whole(record) if record.holds.as_deref() == Some(HOLDS) => {
            let mut files = record.files;
            files.insert(RECORD_FILE.to_owned(), digest_of(&path)?);
            Ok(files)
        }
        _ => Ok(BTreeMap::new()),
    }
}

/// Names of what a sweep has in its folder beside its points.
///
/// # Errors
/// What the file system says of reading the record.
pub fn sweep_files(folder: &Path) -> io::Result<BTreeSet<String>> {
    Ok(known(folder)?.into_keys().collect())
}
