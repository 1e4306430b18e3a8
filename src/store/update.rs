//! Files of a folder change as one.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::WORKSHOP;
use super::error::{Foreign, Spared, StoreError};
use super::files::{remove, rename_to_free, stands};
use super::flush::flush_folder;
use super::journal::{Journal, UpdateJournal, displaced, kept};
use super::record::{RECORD_FILE, Record, Sealed, digest_of};

/// What a change left as it was.
#[derive(Debug, Default)]
pub(super) struct Left {
    /// Files of the user's in the places of others.
    pub(super) spared: Vec<Spared>,
    /// Folder that holds what could not take its place.
    pub(super) kept: Option<PathBuf>,
}

/// Removes and installs what the journal says; see [`refuse_obstacles`].
///
/// Every file is moved aside before it goes, and goes only if its digest is then a recorded one; else
/// it comes back. Killed at any moment, the files are the old ones, or a journal tells how to go on.
pub(super) fn update(
    output: &Path,
    change: &UpdateJournal,
    is_forced: bool,
) -> Result<Left, StoreError> {
    let workshop = output.join(WORKSHOP);
    let journal = Journal::Update(change.clone());
    journal
        .enter(&workshop)
        .map_err(StoreError::at(&workshop))?;
    carry_out(output, change, is_forced)
}

/// Carries a change out from wherever it was cut short.
pub(super) fn carry_out(
    output: &Path,
    change: &UpdateJournal,
    is_forced: bool,
) -> Result<Left, StoreError> {
    let workshop = output.join(WORKSHOP);
    let new = workshop.join(&change.new);
    let mut at_work = Change::new(output, change, is_forced)?;
    for name in &change.removed {
        at_work.make_free(name)?;
    }
    let mut has_waiting = false;
    for name in &change.installed {
        has_waiting |= !at_work.install(&new, name)?;
    }
    at_work.flush()?;
    at_work.clear_aside()?;
    let mut left = Left {
        spared: at_work.spared,
        kept: None,
    };
    if has_waiting {
        let folder = workshop.join(kept(&change.new));
        rename_to_free(&new, &folder).map_err(StoreError::at(&new))?;
        left.kept = Some(folder);
    } else {
        remove(&new).map_err(StoreError::at(&new))?;
    }
    let journal = Journal::Update(change.clone());
    journal
        .close(&workshop)
        .map_err(StoreError::at(&workshop))?;
    Ok(left)
}

/// A change at work.
struct Change<'a> {
    output: &'a Path,
    change: &'a UpdateJournal,
    is_forced: bool,
    /// Folder that files are moved to before they go.
    aside: PathBuf,
    /// Records that tell of files as well: of the new ones, and what stands in the folder.
    records: Vec<Record>,
    spared: Vec<Spared>,
}

impl<'a> Change<'a> {
    fn new(
        output: &'a Path,
        change: &'a UpdateJournal,
        is_forced: bool,
    ) -> Result<Self, StoreError> {
        let workshop = output.join(WORKSHOP);
        let folders = [workshop.join(&change.new), output.to_owned()];
        let mut records = Vec::new();
        for folder in folders {
            let path = folder.join(RECORD_FILE);
            if let Sealed::Whole(record) = Record::read(&path).map_err(StoreError::at(&path))? {
                records.push(record);
            }
        }
        Ok(Self {
            output,
            change,
            is_forced,
            aside: workshop.join(displaced(&change.new)),
            records,
            spared: Vec::new(),
        })
    }

    /// What makes the file `name` at `path` the user's.
    fn foreign(&self, name: &str, path: &Path) -> io::Result<Option<Foreign>> {
        let kind = fs::symlink_metadata(path)?;
        if kind.is_dir() {
            return Ok(Some(Foreign::NoFile));
        }
        if self.is_forced {
            return Ok(None);
        }
        if kind.is_symlink() {
            return Ok(Some(Foreign::Link));
        }
        if !kind.is_file() {
            return Ok(Some(Foreign::NoFile));
        }
        if name == RECORD_FILE && matches!(Record::read(path)?, Sealed::Whole(_)) {
            return Ok(None);
        }
        let recorded = self.records.iter().filter_map(|it| it.files.get(name));
        let mut known = recorded.chain(self.change.own.get(name)).peekable();
        if known.peek().is_none() {
            return Ok(Some(Foreign::Unknown));
        }
        let digest = digest_of(path)?;
        let is_own = known.any(|known| *known == digest);
        Ok((!is_own).then_some(Foreign::Changed))
    }

    /// The first part of the way to a file that is no plain folder.
    fn blocked_way(&self, name: &str) -> Option<Spared> {
        let path = self.output.join(name);
        let parents = path.ancestors().skip(1);
        let parents = parents.take_while(|parent| *parent != self.output);
        let blocked = parents.filter_map(|parent| {
            let kind = fs::symlink_metadata(parent).ok()?;
            let reason = if kind.is_symlink() {
                Foreign::Link
            } else {
                Foreign::NoFolder
            };
            let path = parent.to_owned();
            let is_way = kind.is_dir() || self.is_forced && parent.is_dir();
            (!is_way).then_some(Spared { path, reason })
        });
        blocked.last()
    }

    fn spare(&mut self, path: &Path, reason: Foreign) {
        let path = path.to_owned();
        self.spared.push(Spared { path, reason });
    }

    /// Moves the file `name` aside; false if what stands there is the user's, which stays.
    fn make_free(&mut self, name: &str) -> Result<bool, StoreError> {
        let (path, aside) = (self.output.join(name), self.aside.join(name));
        let at = StoreError::at(&path);
        if let Some(blocked) = self.blocked_way(name) {
            if stands(&path).map_err(&at)? || self.change.installed.iter().any(|it| it == name) {
                self.spared.push(blocked);
                return Ok(false);
            }
            return Ok(true);
        }
        if !self.settle_aside(name)? || !stands(&path).map_err(&at)? {
            return Ok(!stands(&path).map_err(&at)?);
        }
        if let Some(reason) = self.foreign(name, &path).map_err(&at)? {
            self.spare(&path, reason);
            return Ok(false);
        }
        if let Some(parent) = aside.parent() {
            fs::create_dir_all(parent).map_err(StoreError::at(parent))?;
        }
        fs::rename(&path, &aside).map_err(&at)?;
        // Where it was it could still be written to by whoever knows its name: this decides.
        self.settle_aside(name)
    }

    /// Gives a file that was moved aside and is the user's its place back; false if it was one.
    fn settle_aside(&mut self, name: &str) -> Result<bool, StoreError> {
        let (path, aside) = (self.output.join(name), self.aside.join(name));
        let at = StoreError::at(&aside);
        if !stands(&aside).map_err(&at)? {
            return Ok(true);
        }
        let Some(reason) = self.foreign(name, &aside).map_err(&at)? else {
            return Ok(true);
        };
        match rename_to_free(&aside, &path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                self.spare(&aside, reason);
            }
            renamed => {
                renamed.map_err(&at)?;
                self.spare(&path, reason);
            }
        }
        Ok(false)
    }

    /// Moves the new file `name` into its place; false if something of the user's stands there.
    fn install(&mut self, new: &Path, name: &str) -> Result<bool, StoreError> {
        let (from, to) = (new.join(name), self.output.join(name));
        let at = StoreError::at(&to);
        if !stands(&from).map_err(&at)? {
            return Ok(true);
        }
        if !self.make_free(name)? {
            return Ok(false);
        }
        if let Some(parent) = to.parent() {
            fs::create_dir_all(parent).map_err(StoreError::at(parent))?;
        }
        match rename_to_free(&from, &to) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                self.spare(&to, Foreign::Unknown);
                Ok(false)
            }
            renamed => renamed.map(|()| true).map_err(at),
        }
    }

    fn flush(&self) -> Result<(), StoreError> {
        for name in &self.change.installed {
            let path = self.output.join(name);
            let parent = path.parent().filter(|parent| *parent != self.output);
            if let Some(parent) = parent.filter(|parent| parent.is_dir()) {
                flush_folder(parent).map_err(StoreError::at(parent))?;
            }
        }
        flush_folder(self.output).map_err(StoreError::at(self.output))
    }

    /// Removes the files that were moved aside, and the folders that they leave empty in the output.
    fn clear_aside(&mut self) -> Result<(), StoreError> {
        let names = self.change.removed.iter().chain(&self.change.installed);
        for name in names.clone() {
            let path = self.aside.join(name);
            let at = StoreError::at(&path);
            if stands(&path).map_err(&at)? && self.foreign(name, &path).map_err(&at)?.is_none() {
                fs::remove_file(&path).map_err(&at)?;
            }
        }
        for name in names {
            // A folder of the tool's goes with its last file; one that holds more stays.
            for folder in [self.aside.as_path(), self.output] {
                let path = folder.join(name);
                let parents = path.ancestors().skip(1);
                for parent in parents.take_while(|parent| *parent != folder) {
                    let _ = fs::remove_dir(parent);
                }
            }
        }
        let _ = fs::remove_dir(&self.aside);
        Ok(())
    }
}

/// A folder in the place of a file, or a file in that of a folder, would stop the change half way.
pub(super) fn refuse_obstacles(output: &Path, change: &UpdateJournal) -> Result<(), StoreError> {
    let refused = |path: &Path, reason| StoreError::Obstacle {
        folder: output.to_owned(),
        path: path.to_owned(),
        reason,
    };
    for name in &change.installed {
        let to = output.join(name);
        if fs::symlink_metadata(&to).is_ok_and(|found| found.is_dir()) {
            return Err(refused(&to, Foreign::NoFile));
        }
        let parents = to.ancestors().skip(1);
        for parent in parents.take_while(|parent| *parent != output) {
            if stands(parent).map_err(StoreError::at(parent))? && !parent.is_dir() {
                return Err(refused(parent, Foreign::NoFolder));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files `a` and `gone/b` of an earlier result, `mine` of the user's, and `a` and `samples/c` anew.
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
        let old = digest_of(&output.path().join("a")).unwrap();
        let change = UpdateJournal {
            new: "new-1".to_owned(),
            removed: vec!["gone/b".to_owned()],
            installed: vec!["a".to_owned(), "samples/c".to_owned()],
            own: ["a", "gone/b"]
                .map(|name| (name.to_owned(), old.clone()))
                .into(),
        };
        (output, change)
    }

    fn text_of(output: &Path, file: &str) -> String {
        fs::read_to_string(output.join(file)).unwrap_or_default()
    }

    fn is_done(output: &Path) {
        for (file, text) in [("a", "new"), ("samples/c", "new"), ("mine", "mine")] {
            assert_eq!(text_of(output, file), text, "{file}");
        }
        assert!(!output.join("gone").exists());
        assert_eq!(fs::read_dir(output.join(WORKSHOP)).unwrap().count(), 0);
    }

    #[test]
    fn files_come_and_go_as_one() {
        let (output, change) = output();
        let left = update(output.path(), &change, false).unwrap();
        assert!(left.spared.is_empty() && left.kept.is_none());
        is_done(output.path());
    }

    #[test]
    fn a_change_cut_short_after_any_step_goes_on() {
        for steps in 0..=6 {
            let (output, change) = output();
            let root = output.path();
            let workshop = root.join(WORKSHOP);
            Journal::Update(change.clone()).enter(&workshop).unwrap();
            fs::create_dir_all(workshop.join("old-1/gone")).unwrap();
            fs::create_dir_all(root.join("samples")).unwrap();
            let renames = [
                ("gone/b", ".fogbench/old-1/gone/b"),
                ("a", ".fogbench/old-1/a"),
                (".fogbench/new-1/a", "a"),
                (".fogbench/new-1/samples/c", "samples/c"),
            ];
            for (from, to) in renames.iter().take(steps) {
                fs::rename(root.join(from), root.join(to)).unwrap();
            }
            for file in ["old-1/a", "old-1/gone/b"]
                .iter()
                .take(steps.saturating_sub(4))
            {
                fs::remove_file(workshop.join(file)).unwrap();
            }
            let (journals, damaged) = Journal::all(&workshop).unwrap();
            assert_eq!(journals, [Journal::Update(change.clone())]);
            assert!(damaged.is_empty());
            let left = carry_out(root, &change, false).unwrap();
            assert!(left.spared.is_empty(), "{steps}: {left:?}");
            is_done(root);
        }
    }

    #[test]
    fn files_that_have_become_the_users_stay_and_the_new_ones_are_kept() {
        for steps in 0..=1 {
            let (output, change) = output();
            let root = output.path();
            let workshop = root.join(WORKSHOP);
            Journal::Update(change.clone()).enter(&workshop).unwrap();
            if steps == 1 {
                fs::create_dir_all(workshop.join("old-1")).unwrap();
                fs::rename(root.join("a"), workshop.join("old-1/a")).unwrap();
            }
            fs::write(root.join("a"), "thesis").unwrap();
            fs::write(root.join("gone/b"), "thesis").unwrap();
            let left = carry_out(root, &change, false).unwrap();
            let spared = |name: &str| Spared {
                path: root.join(name),
                reason: Foreign::Changed,
            };
            assert_eq!(left.spared, [spared("gone/b"), spared("a")]);
            for (file, text) in [
                ("a", "thesis"),
                ("gone/b", "thesis"),
                ("samples/c", "new"),
                (".fogbench/kept-1/a", "new"),
            ] {
                assert_eq!(text_of(root, file), text, "{file}");
            }
            assert_eq!(left.kept, Some(workshop.join("kept-1")));
            assert!(!workshop.join("old-1").exists());
        }
    }

    #[test]
    fn a_journal_takes_nothing_that_no_record_tells_of() {
        let (output, change) = output();
        let change = UpdateJournal {
            removed: vec!["mine".to_owned()],
            own: std::collections::BTreeMap::new(),
            ..change
        };
        let left = update(output.path(), &change, false).unwrap();
        assert_eq!(text_of(output.path(), "mine"), "mine");
        assert_eq!(left.spared.len(), 2, "{left:?}");
    }

    #[test]
    fn a_file_that_was_moved_aside_and_is_the_users_comes_back() {
        let (output, change) = output();
        let root = output.path();
        let workshop = root.join(WORKSHOP);
        fs::create_dir_all(workshop.join("old-1")).unwrap();
        fs::rename(root.join("a"), workshop.join("old-1/a")).unwrap();
        fs::write(workshop.join("old-1/a"), "written meanwhile").unwrap();
        Journal::Update(change.clone()).enter(&workshop).unwrap();
        carry_out(root, &change, false).unwrap();
        assert_eq!(text_of(root, "a"), "written meanwhile");
        assert_eq!(text_of(root, ".fogbench/kept-1/a"), "new");
    }

    #[test]
    fn an_obstacle_stops_the_change_before_its_first_file() {
        let (output, change) = output();
        fs::write(output.path().join("samples"), "a file").unwrap();
        assert!(refuse_obstacles(output.path(), &change).is_err());
        assert_eq!(text_of(output.path(), "a"), "old");
        assert!(output.path().join("gone/b").is_file());
    }
}
