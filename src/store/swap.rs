//! A folder takes the place of another.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::WORKSHOP;
use super::error::{Spared, StoreError};
use super::files::{exchange, remove, rename_to_free, stands};
use super::flush::flush_folder;
use super::journal::{Journal, SwapJournal};
use super::ownership::{Ownership, clear, inspect};

/// How a folder takes the place of another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Swap {
    /// In one step where the system can exchange two names, else by two renames.
    #[default]
    Exchange,
    /// By two renames and a journal, as on systems that cannot exchange names.
    TwoRenames,
}

/// What becomes of what stands in the place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Displaced {
    /// It is removed as its record tells; what is the user's comes back.
    Ours,
    /// It is removed, whosever it is.
    Anybodys,
}

/// Puts the folder `new` of the workshop into `place`, below `output`; what stood there is removed.
///
/// Whose that is, is decided on what has been moved out of the place, where no name leads to it any
/// more; if something in it is the user's, it is put back. Killed at any moment, either folder stands
/// in the place whole, or a journal tells how to mend it.
///
/// # Errors
/// [`StoreError::Kept`], and what stood in the place stands there again; whatever the file system says.
pub(super) fn put(
    output: &Path,
    new: &str,
    place: &Path,
    (how, displaced): (Swap, Displaced),
) -> Result<(), StoreError> {
    let target = output.join(place);
    let at = StoreError::at(&target);
    let parent = target.parent().unwrap_or(output);
    fs::create_dir_all(parent).map_err(&at)?;
    if !stands(&target).map_err(&at)? {
        match rename_to_free(&output.join(WORKSHOP).join(new), &target) {
            // Something has come there meanwhile.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            renamed => {
                renamed.map_err(&at)?;
                return flush_folder(parent).map_err(&at);
            }
        }
    }
    let swap = SwapJournal::new(place, new);
    if how == Swap::Exchange && put_in_one_step(output, &swap, displaced)? {
        return Ok(());
    }
    put_in_two(output, &swap, displaced)
}

/// Exchanges the two folders; false, and nothing is done, where the system cannot.
fn put_in_one_step(
    output: &Path,
    swap: &SwapJournal,
    displaced: Displaced,
) -> Result<bool, StoreError> {
    let workshop = output.join(WORKSHOP);
    let (built, aside) = (workshop.join(&swap.new), workshop.join(&swap.old));
    let target = output.join(&swap.place);
    let at = StoreError::at(&target);
    // Under the name of a displaced folder, so that after a kill it is removed only as a record tells.
    fs::rename(&built, &aside).map_err(&at)?;
    match exchange(&aside, &target) {
        Ok(true) => {}
        refused => {
            fs::rename(&aside, &built).map_err(&at)?;
            return refused.map_err(&at);
        }
    }
    flush_folder(target.parent().unwrap_or(output)).map_err(&at)?;
    if displaced == Displaced::Anybodys {
        // Best effort: it is out of the way, and the next run clears the workshop.
        let _ = remove(&aside);
        return Ok(true);
    }
    match theirs_in(&aside, &target) {
        Ok(None) => {
            // Best effort as well: what cannot be removed, or has become the user's, stays in the
            // workshop, and the next run says so.
            let _ = clear(&aside);
            Ok(true)
        }
        found => {
            put_back(&aside, &target).map_err(&at)?;
            Err(kept(&target, found.map_err(&at)?))
        }
    }
}

/// What shows that a displaced folder is the user's, by its name in the place.
fn theirs_in(aside: &Path, target: &Path) -> io::Result<Option<Spared>> {
    Ok(match inspect(aside)? {
        Ownership::Theirs { path, reason } => {
            let path = match path.strip_prefix(aside) {
                Ok(name) if name.as_os_str().is_empty() => target.to_owned(),
                Ok(name) => target.join(name),
                Err(_) => path,
            };
            Some(Spared { path, reason })
        }
        _ => None,
    })
}

fn kept(target: &Path, spared: Option<Spared>) -> StoreError {
    StoreError::Kept {
        place: target.to_owned(),
        spared: spared.into_iter().collect(),
        kept: None,
    }
}

/// Gives a displaced folder its place back.
fn put_back(aside: &Path, target: &Path) -> io::Result<()> {
    match exchange(aside, target) {
        Ok(true) => Ok(()),
        // The new folder has been moved or removed: the place is free.
        _ => rename_to_free(aside, target),
    }
}

fn put_in_two(output: &Path, swap: &SwapJournal, displaced: Displaced) -> Result<(), StoreError> {
    let workshop = output.join(WORKSHOP);
    let target = output.join(&swap.place);
    let at = StoreError::at(&target);
    let journal = Journal::Swap(swap.clone());
    journal.enter(&workshop).map_err(&at)?;
    if let Err(error) = put_aside(output, swap) {
        journal.close(&workshop).map_err(&at)?;
        return Err(at(error));
    }
    let aside = workshop.join(&swap.old);
    let come_back = |reason: StoreError| {
        rename_to_free(&aside, &target).map_err(&at)?;
        journal.close(&workshop).map_err(&at)?;
        Err(reason)
    };
    if displaced == Displaced::Ours {
        match theirs_in(&aside, &target) {
            Ok(None) => {}
            Ok(found) => return come_back(kept(&target, found)),
            Err(error) => return come_back(at(error)),
        }
    }
    if let Err(error) = put_in_place(output, swap) {
        return come_back(at(error));
    }
    flush_folder(target.parent().unwrap_or(output)).map_err(&at)?;
    if displaced == Displaced::Anybodys {
        remove(&aside).map_err(&at)?;
    }
    // As above: the next run says what stays in the workshop.
    let _ = clear(&aside);
    journal.close(&workshop).map_err(&at)
}

fn put_aside(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let aside = output.join(WORKSHOP).join(&swap.old);
    rename_to_free(&output.join(&swap.place), &aside)
}

fn put_in_place(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let built = output.join(WORKSHOP).join(&swap.new);
    rename_to_free(&built, &output.join(&swap.place))
}

/// Completes a swap that was cut short, or takes it back where the new folder is gone. Where something
/// of the user's has come to stand in the place, that stays, as do both folders and the journal: what
/// it is and where they are.
pub(super) fn mend(output: &Path, swap: &SwapJournal) -> Result<Option<String>, StoreError> {
    let workshop = output.join(WORKSHOP);
    let (built, aside) = (workshop.join(&swap.new), workshop.join(&swap.old));
    let target = output.join(&swap.place);
    let at = StoreError::at(&target);
    let is_displaced = stands(&aside).map_err(&at)?;
    if is_displaced {
        match inspect(&target).map_err(&at)? {
            Ownership::Absent => {}
            Ownership::Empty => fs::remove_dir(&target).map_err(&at)?,
            Ownership::Ours { .. } => return finish(&workshop, swap, &target, &[&aside]),
            Ownership::Theirs { path, reason } => {
                let mut folders = vec![aside];
                folders.extend(stands(&built).map_err(&at)?.then_some(built));
                return Ok(Some(in_the_way(&target, &path, reason, &folders)));
            }
        }
    }
    if !stands(&target).map_err(&at)? {
        let is_theirs =
            is_displaced && matches!(inspect(&aside).map_err(&at)?, Ownership::Theirs { .. });
        if stands(&built).map_err(&at)? && !is_theirs {
            if let Some(parent) = target.parent() {
                fs::create_dir_all(parent).map_err(&at)?;
            }
            put_in_place(output, swap).map_err(&at)?;
        } else if is_displaced {
            rename_to_free(&aside, &target).map_err(&at)?;
        }
    }
    finish(&workshop, swap, &target, &[&aside])
}

/// Clears what is no longer wanted and closes the journal.
fn finish(
    workshop: &Path,
    swap: &SwapJournal,
    target: &Path,
    unwanted: &[&PathBuf],
) -> Result<Option<String>, StoreError> {
    let at = StoreError::at(target);
    if let Some(parent) = target.parent().filter(|parent| parent.is_dir()) {
        flush_folder(parent).map_err(&at)?;
    }
    for folder in unwanted {
        // What stays of it is said when the workshop is cleared.
        clear(folder).map_err(StoreError::at(folder))?;
    }
    let journal = Journal::Swap(swap.clone());
    journal.close(workshop).map_err(at)?;
    Ok(None)
}

fn in_the_way(target: &Path, path: &Path, reason: super::Foreign, folders: &[PathBuf]) -> String {
    let folders: Vec<String> = folders
        .iter()
        .map(|folder| folder.display().to_string())
        .collect();
    format!(
        "{} {reason} and stands where results of a run that was killed belong, which are in {}: move \
         {} away, and the next command puts them in place",
        path.display(),
        folders.join(" and "),
        target.display()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Foreign;
    use crate::store::record::{RECORD_FILE, Record};

    const NEW: &str = "new-1";
    const BOTH: [Swap; 2] = [Swap::Exchange, Swap::TwoRenames];

    /// An output folder with an old and a new folder `s/0000`.
    fn output() -> tempfile::TempDir {
        let output = tempfile::tempdir().unwrap();
        for (folder, text) in [("s/0000", "old"), (".fogbench/new-1", "new")] {
            let folder = output.path().join(folder);
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("file"), text).unwrap();
            let record = Record::of(&folder).unwrap().sealed("schema = 1\n");
            fs::write(folder.join(RECORD_FILE), record).unwrap();
        }
        output
    }

    fn text_of(output: &Path, file: &str) -> String {
        fs::read_to_string(output.join(file)).unwrap_or_default()
    }

    fn in_place(output: &Path) -> String {
        text_of(output, "s/0000/file")
    }

    fn workshop_is_empty(output: &Path) -> bool {
        fs::read_dir(output.join(WORKSHOP)).unwrap().count() == 0
    }

    fn journals(output: &Path) -> Vec<Journal> {
        Journal::all(&output.join(WORKSHOP)).unwrap().0
    }

    #[test]
    fn both_ways_put_the_new_folder_in_place_and_leave_nothing() {
        for how in BOTH {
            for whose in [Displaced::Ours, Displaced::Anybodys] {
                let output = output();
                if whose == Displaced::Anybodys {
                    fs::write(output.path().join("s/0000/thesis"), "forced").unwrap();
                }
                let place = Path::new("s/0000");
                put(output.path(), NEW, place, (how, whose)).unwrap();
                assert_eq!(in_place(output.path()), "new", "{how:?}");
                assert!(!output.path().join("s/0000/thesis").exists());
                assert!(workshop_is_empty(output.path()), "{how:?}");
            }
        }
    }

    #[test]
    fn a_place_that_is_free_is_taken_with_its_parents() {
        let output = output();
        let how = (Swap::TwoRenames, Displaced::Ours);
        put(output.path(), NEW, Path::new("t/0001"), how).unwrap();
        assert!(output.path().join("t/0001/file").is_file());
        assert_eq!(in_place(output.path()), "old");
    }

    /// What comes into the place after its last look at it: `put` itself looks at what it moved out.
    #[test]
    fn what_has_become_the_users_is_put_back() {
        for how in BOTH {
            for (file, reason) in [
                ("thesis", Foreign::Unknown),
                ("deep/er/thesis", Foreign::Unknown),
                ("file", Foreign::Changed),
            ] {
                let output = output();
                let path = output.path().join("s/0000").join(file);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(&path, "years of work").unwrap();
                let how = (how, Displaced::Ours);
                let error = put(output.path(), NEW, Path::new("s/0000"), how).unwrap_err();
                let StoreError::Kept { spared, .. } = &error else {
                    panic!("{error}");
                };
                let expected = Spared { path, reason };
                assert_eq!(spared[..], [expected], "{how:?}");
                let name = format!("s/0000/{file}");
                assert_eq!(text_of(output.path(), &name), "years of work", "{how:?}");
                assert!(journals(output.path()).is_empty());
            }
        }
    }

    #[test]
    fn a_kill_after_any_step_of_two_renames_is_mended() {
        let swap = SwapJournal::new(Path::new("s/0000"), NEW);
        let steps: [fn(&Path, &SwapJournal) -> io::Result<()>; 3] = [
            |output, swap| Journal::Swap(swap.clone()).enter(&output.join(WORKSHOP)),
            put_aside,
            put_in_place,
        ];
        for killed_after in 1..=steps.len() {
            let output = output();
            for step in &steps[..killed_after] {
                step(output.path(), &swap).unwrap();
            }
            assert_eq!(journals(output.path()), [Journal::Swap(swap.clone())]);
            assert_eq!(mend(output.path(), &swap).unwrap(), None);
            let found = in_place(output.path());
            assert_eq!(found, if killed_after == 1 { "old" } else { "new" });
            assert!(journals(output.path()).is_empty());
        }
    }

    #[test]
    fn what_came_to_stand_in_the_place_after_a_kill_stays_and_so_do_both_folders() {
        let swap = SwapJournal::new(Path::new("s/0000"), NEW);
        let output = output();
        let workshop = output.path().join(WORKSHOP);
        Journal::Swap(swap.clone()).enter(&workshop).unwrap();
        put_aside(output.path(), &swap).unwrap();
        fs::create_dir(output.path().join("s/0000")).unwrap();
        fs::write(output.path().join("s/0000/thesis"), "years of work").unwrap();
        let caution = mend(output.path(), &swap).unwrap().expect("it says so");
        for word in ["thesis", "old-1", "new-1", "move"] {
            assert!(caution.contains(word), "{caution}");
        }
        assert_eq!(journals(output.path()).len(), 1, "for the next command");
        assert_eq!(text_of(output.path(), ".fogbench/old-1/file"), "old");
        assert_eq!(text_of(output.path(), "s/0000/thesis"), "years of work");
        // Once it is out of the way, the swap is completed.
        fs::remove_dir_all(output.path().join("s/0000")).unwrap();
        assert_eq!(mend(output.path(), &swap).unwrap(), None);
        assert_eq!(in_place(output.path()), "new");
        assert!(workshop_is_empty(output.path()));
    }

    #[test]
    fn the_old_folder_comes_back_where_the_new_one_is_gone_or_the_old_one_is_the_users() {
        for is_gone in [true, false] {
            let output = output();
            let workshop = output.path().join(WORKSHOP);
            let swap = SwapJournal::new(Path::new("s/0000"), NEW);
            Journal::Swap(swap.clone()).enter(&workshop).unwrap();
            put_aside(output.path(), &swap).unwrap();
            if is_gone {
                fs::remove_dir_all(workshop.join(NEW)).unwrap();
            } else {
                fs::write(workshop.join("old-1/thesis"), "years of work").unwrap();
            }
            mend(output.path(), &swap).unwrap();
            assert_eq!(in_place(output.path()), "old");
        }
    }

    #[test]
    fn a_journal_that_leads_outside_is_none() {
        let output = output();
        let workshop = output.path().join(WORKSHOP);
        for place in ["../elsewhere", "/etc", ""] {
            let text = format!("place = \"{place}\"\nnew = \"new-1\"\nold = \"old-1\"\n");
            fs::write(workshop.join("swap-1.toml"), text).unwrap();
            let (journals, damaged) = Journal::all(&workshop).unwrap();
            assert!(journals.is_empty(), "{place}");
            assert_eq!(damaged.len(), 1, "{place}");
        }
    }
}
