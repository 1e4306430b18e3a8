//! From paths to the files of a suite.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::scenario::document::source::shown_path;
use crate::scenario::message::error::{Location, ScenarioError};

/// A file to load.
pub(in crate::scenario) struct Found {
    pub(in crate::scenario) path: PathBuf,
    /// Whether it was named itself, not the folder it lies in.
    pub(in crate::scenario) is_named: bool,
}

/// The files to load, each once.
pub(in crate::scenario) fn discover(
    paths: &[PathBuf],
    errors: &mut Vec<ScenarioError>,
) -> Vec<Found> {
    let mut files: Vec<Found> = Vec::new();
    for path in paths {
        if path.is_dir() {
            let mut found = Vec::new();
            walk(path, &mut found, errors);
            found.sort();
            files.extend(found.into_iter().map(|path| Found {
                path,
                is_named: false,
            }));
        } else if path.exists() {
            files.push(Found {
                path: path.clone(),
                is_named: true,
            });
        } else {
            errors.push(ScenarioError::at(
                Location::of_file(shown_path(path)),
                "no such file or folder",
            ));
        }
    }
    // A file that was named is loaded whether it has a name or not, whatever folder it lies in.
    let named = files.iter().filter(|file| file.is_named);
    let named: BTreeSet<PathBuf> = named.map(|file| identity(&file.path)).collect();
    let mut seen: BTreeSet<PathBuf> = BTreeSet::new();
    files.retain_mut(|file| {
        let identity = identity(&file.path);
        file.is_named |= named.contains(&identity);
        seen.insert(identity)
    });
    files
}

/// File by which a folder says that it is only taken where it is named itself.
const ON_DEMAND: &str = ".on-demand";

fn is_on_demand(folder: &Path) -> bool {
    folder.join(ON_DEMAND).is_file()
}

/// Folders directly below those of some paths that are only taken where they are named themselves, and are not.
#[must_use]
pub fn left_out(paths: &[PathBuf]) -> Vec<PathBuf> {
    let entries = paths.iter().filter_map(|path| fs::read_dir(path).ok());
    let folders = entries.flatten().flatten().map(|entry| entry.path());
    let named: BTreeSet<PathBuf> = paths.iter().map(|path| identity(path)).collect();
    let mut left: Vec<PathBuf> = folders
        .filter(|folder| is_on_demand(folder) && !named.contains(&identity(folder)))
        .collect();
    left.sort();
    left
}

/// Gathers the `*.toml` below a folder; hidden entries, linked folders and those on demand are passed over.
fn walk(folder: &Path, found: &mut Vec<PathBuf>, errors: &mut Vec<ScenarioError>) {
    let complain = |error: std::io::Error| {
        ScenarioError::at(
            Location::of_file(shown_path(folder)),
            format!("cannot read the folder: {error}"),
        )
    };
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => return errors.push(complain(error)),
    };
    for entry in entries {
        let entry = match entry {
            Ok(entry) => entry,
            Err(error) => {
                errors.push(complain(error));
                continue;
            }
        };
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        let path = entry.path();
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            if !is_on_demand(&path) {
                walk(&path, found, errors);
            }
        } else if path
            .extension()
            .is_some_and(|extension| extension == "toml")
            && path.is_file()
        {
            found.push(path);
        }
    }
}

/// What makes two paths the same file.
pub(in crate::scenario) fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
