//! From paths to the files of a suite.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::{Location, ScenarioError};
use super::source::shown_path;
use super::tree::parse_document;

/// The files to load, each once.
pub(super) fn discover(paths: &[PathBuf], errors: &mut Vec<ScenarioError>) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = Vec::new();
    for path in paths {
        if path.is_dir() {
            let mut found = Vec::new();
            walk(path, &mut found, errors);
            found.sort();
            files.extend(found.into_iter().filter(|file| is_scenario(file)));
        } else if path.exists() {
            files.push(path.clone());
        } else {
            errors.push(ScenarioError::at(
                Location::of_file(shown_path(path)),
                "no such file or folder",
            ));
        }
    }
    let mut seen: Vec<PathBuf> = Vec::new();
    files.retain(|file| {
        let identity = identity(file);
        let is_new = !seen.contains(&identity);
        seen.push(identity);
        is_new
    });
    files
}

/// Gathers the `*.toml` below a folder; hidden entries and linked folders are passed over.
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
            walk(&path, found, errors);
        } else if path
            .extension()
            .is_some_and(|extension| extension == "toml")
            && path.is_file()
        {
            found.push(path);
        }
    }
}

/// Whether a file of a folder is to be run; one that cannot be parsed is kept for its error.
fn is_scenario(file: &Path) -> bool {
    let Ok(text) = fs::read_to_string(file) else {
        return true;
    };
    parse_document(0, &text).map_or(true, |root| root.contains_key("name"))
}

/// What makes two paths the same file.
pub(super) fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
