//! A folder takes the place of another.

use std::fs;
use std::io;
use std::path::Path;

use super::WORKSHOP;
use super::files::{remove, stands};
use super::flush::flush_folder;
use super::journal::{Journal, SwapJournal};

/// How a folder takes the place of another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Swap {
    /// In one step where the system can exchange two names, else by two renames.
    #[default]
    Exchange,
    /// By two renames and a journal, as on systems that cannot exchange names.
    TwoRenames,
}

/// Puts the folder `new` of the workshop into `place`, below `output`; what stood there is removed.
///
/// Killed at any moment, either folder stands in the place whole, or a journal tells how to mend it.
pub(super) fn put(output: &Path, new: &str, place: &Path, how: Swap) -> io::Result<()> {
    let workshop = output.join(WORKSHOP);
    let (built, target) = (workshop.join(new), output.join(place));
    let parent = target.parent().unwrap_or(output);
    fs::create_dir_all(parent)?;
    if !stands(&target)? {
        fs::rename(&built, &target)?;
        return flush_folder(parent);
    }
    if how == Swap::Exchange && exchange(&built, &target)? {
        flush_folder(parent)?;
        // Best effort: it is out of the way, and the next run clears the workshop.
        let _ = remove(&built);
        return Ok(());
    }
    let swap = SwapJournal::new(place, new);
    let journal = Journal::Swap(swap.clone());
    journal.enter(&workshop)?;
    put_aside(output, &swap)?;
    if let Err(error) = put_in_place(output, &swap) {
        fs::rename(workshop.join(&swap.old), &target)?;
        journal.close(&workshop)?;
        return Err(error);
    }
    conclude(output, &swap)
}

fn put_aside(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let aside = output.join(WORKSHOP).join(&swap.old);
    fs::rename(output.join(&swap.place), aside)
}

fn put_in_place(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let built = output.join(WORKSHOP).join(&swap.new);
    fs::rename(built, output.join(&swap.place))
}

fn conclude(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let workshop = output.join(WORKSHOP);
    let target = output.join(&swap.place);
    flush_folder(target.parent().unwrap_or(output))?;
    remove(&workshop.join(&swap.old))?;
    Journal::Swap(swap.clone()).close(&workshop)
}

/// Completes a swap that was cut short, or takes it back where the new folder is gone.
pub(super) fn mend(output: &Path, swap: &SwapJournal) -> io::Result<()> {
    let workshop = output.join(WORKSHOP);
    let (built, aside) = (workshop.join(&swap.new), workshop.join(&swap.old));
    let target = output.join(&swap.place);
    if !stands(&target)? {
        if stands(&built)? {
            put_in_place(output, swap)?;
        } else if stands(&aside)? {
            fs::rename(&aside, &target)?;
        }
    }
    conclude(output, swap)
}

/// Exchanges two names in one step; false where the system or the file system cannot.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<bool> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;

    match renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE) {
        Ok(()) => Ok(true),
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP | Errno::PERM) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_one: &Path, _other: &Path) -> io::Result<bool> {
    Ok(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEW: &str = "new-1";

    /// An output folder with an old and a new folder `s/0000`.
    fn output() -> tempfile::TempDir {
        let output = tempfile::tempdir().unwrap();
        for (folder, text) in [("s/0000", "old"), (".fogbench/new-1", "new")] {
            let folder = output.path().join(folder);
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("file"), text).unwrap();
        }
        output
    }

    fn in_place(output: &Path) -> String {
        fs::read_to_string(output.join("s/0000/file")).unwrap()
    }

    fn workshop_is_empty(output: &Path) -> bool {
        fs::read_dir(output.join(WORKSHOP)).unwrap().count() == 0
    }

    #[test]
    fn both_ways_put_the_new_folder_in_place_and_leave_nothing() {
        for how in [Swap::Exchange, Swap::TwoRenames] {
            let output = output();
            put(output.path(), NEW, Path::new("s/0000"), how).unwrap();
            assert_eq!(in_place(output.path()), "new", "{how:?}");
            assert!(workshop_is_empty(output.path()), "{how:?}");
        }
    }

    #[test]
    fn a_place_that_is_free_is_taken_with_its_parents() {
        let output = output();
        put(output.path(), NEW, Path::new("t/0001"), Swap::TwoRenames).unwrap();
        assert!(output.path().join("t/0001/file").is_file());
        assert_eq!(in_place(output.path()), "old");
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
            for journal in Journal::all(&output.path().join(WORKSHOP)).unwrap() {
                assert_eq!(journal, Journal::Swap(swap.clone()));
                mend(output.path(), &swap).unwrap();
            }
            let found = in_place(output.path());
            assert_eq!(found, if killed_after == 1 { "old" } else { "new" });
            assert!(
                Journal::all(&output.path().join(WORKSHOP))
                    .unwrap()
                    .is_empty()
            );
        }
    }

    #[test]
    fn the_old_folder_comes_back_where_the_new_one_is_gone() {
        let output = output();
        let swap = SwapJournal::new(Path::new("s/0000"), NEW);
        Journal::Swap(swap.clone())
            .enter(&output.path().join(WORKSHOP))
            .unwrap();
        put_aside(output.path(), &swap).unwrap();
        fs::remove_dir_all(output.path().join(WORKSHOP).join(NEW)).unwrap();
        mend(output.path(), &swap).unwrap();
        assert_eq!(in_place(output.path()), "old");
    }

    #[test]
    fn a_journal_that_leads_outside_is_refused() {
        let output = output();
        let workshop = output.path().join(WORKSHOP);
        for place in ["../elsewhere", "/etc", ""] {
            let text = format!("place = \"{place}\"\nnew = \"new-1\"\nold = \"old-1\"\n");
            fs::write(workshop.join("swap-1.toml"), text).unwrap();
            assert!(Journal::all(&workshop).is_err(), "{place}");
        }
    }
}
