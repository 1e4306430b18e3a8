//! Files of a folder change as one.

use std::fs;
use std::io;
use std::path::Path;

use super::WORKSHOP;
use super::files::{remove, stands};
use super::flush::flush_folder;
use super::journal::{Journal, UpdateJournal};

/// Removes and installs what the journal says; see [`refuse_obstacles`].
///
/// Killed at any moment, the files are the old ones, or a journal tells how to go on.
pub(super) fn update(output: &Path, change: &UpdateJournal) -> io::Result<()> {
    Journal::Update(change.clone()).enter(&output.join(WORKSHOP))?;
    carry_out(output, change)
}

/// Carries a change out from wherever it was cut short.
pub(super) fn carry_out(output: &Path, change: &UpdateJournal) -> io::Result<()> {
    let workshop = output.join(WORKSHOP);
    let new = workshop.join(&change.new);
    for name in &change.removed {
        let path = output.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        // A folder of the tool's goes with its last file; one that holds more stays.
        if let Some(parent) = path.parent().filter(|parent| *parent != output) {
            let _ = fs::remove_dir(parent);
        }
    }
    for name in &change.installed {
        let (from, to) = (new.join(name), output.join(name));
        if !stands(&from)? {
            continue;
        }
        if let Some(parent) = to.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::rename(from, to)?;
    }
    for name in &change.installed {
        if let Some(parent) = output
            .join(name)
            .parent()
            .filter(|parent| *parent != output)
        {
            flush_folder(parent)?;
        }
    }
    flush_folder(output)?;
    remove(&new)?;
    Journal::Update(change.clone()).close(&workshop)
}

/// A folder in the place of a file, or a file in that of a folder, would stop the change half way.
pub(super) fn refuse_obstacles(output: &Path, change: &UpdateJournal) -> io::Result<()> {
    for name in &change.installed {
        let to = output.join(name);
        if fs::symlink_metadata(&to).is_ok_and(|found| found.is_dir()) {
            let message = format!("{} is a folder", to.display());
            return Err(io::Error::new(io::ErrorKind::IsADirectory, message));
        }
        let parents = to.ancestors().skip(1);
        for parent in parents.take_while(|parent| *parent != output) {
            if stands(parent)? && !parent.is_dir() {
                let message = format!("{} is no folder", parent.display());
                return Err(io::Error::new(io::ErrorKind::NotADirectory, message));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output() -> (tempfile::TempDir, UpdateJournal) {
        let output = tempfile::tempdir().unwrap();
        let new = output.path().join(".fogbench/new-1");
        fs::create_dir_all(new.join("samples")).unwrap();
        fs::create_dir_all(output.path().join("gone")).unwrap();
        for (file, text) in [
            ("a", "old"),
            ("gone/b", "old"),
            ("mine", "mine"),
            (".fogbench/new-1/a", "new"),
            (".fogbench/new-1/samples/c", "new"),
        ] {
            fs::write(output.path().join(file), text).unwrap();
        }
        let change = UpdateJournal {
            new: "new-1".to_owned(),
            removed: vec!["gone/b".to_owned()],
            installed: vec!["a".to_owned(), "samples/c".to_owned()],
        };
        (output, change)
    }

    fn is_done(output: &Path) {
        for (file, text) in [("a", "new"), ("samples/c", "new"), ("mine", "mine")] {
            assert_eq!(
                fs::read_to_string(output.join(file)).unwrap(),
                text,
                "{file}"
            );
        }
        assert!(!output.join("gone").exists());
        assert_eq!(fs::read_dir(output.join(WORKSHOP)).unwrap().count(), 0);
    }

    #[test]
    fn files_come_and_go_as_one() {
        let (output, change) = output();
        update(output.path(), &change).unwrap();
        is_done(output.path());
    }

    #[test]
    fn a_change_cut_short_after_any_file_goes_on() {
        for moved in 0..=2 {
            let (output, change) = output();
            let root = output.path();
            Journal::Update(change.clone())
                .enter(&root.join(WORKSHOP))
                .unwrap();
            fs::remove_file(root.join("gone/b")).unwrap();
            fs::create_dir_all(root.join("samples")).unwrap();
            for name in change.installed.iter().take(moved) {
                fs::rename(root.join(".fogbench/new-1").join(name), root.join(name)).unwrap();
            }
            for journal in Journal::all(&root.join(WORKSHOP)).unwrap() {
                assert_eq!(journal, Journal::Update(change.clone()));
            }
            carry_out(root, &change).unwrap();
            assert!(root.join("a").is_file() && !root.join("gone/b").exists());
            assert!(Journal::all(&root.join(WORKSHOP)).unwrap().is_empty());
        }
    }

    #[test]
    fn an_obstacle_stops_the_change_before_its_first_file() {
        let (output, change) = output();
        fs::write(output.path().join("samples"), "a file").unwrap();
        assert!(refuse_obstacles(output.path(), &change).is_err());
        assert_eq!(fs::read_to_string(output.path().join("a")).unwrap(), "old");
        assert!(output.path().join("gone/b").is_file());
    }
}
