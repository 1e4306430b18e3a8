//! Journals: what is about to be renamed, so that a kill in between can be mended.
//!
//! A journal is in its place, flushed, before the first rename that it tells of, and is removed after the
//! last one. Whoever takes the lock of the output folder next carries out what the journals say.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Component, Path, PathBuf};

use super::flush::flush_folder;

/// Beginnings of the names of what may be left in a workshop.
const BEING_BUILT: &str = "new-";
const DISPLACED: &str = "old-";
const SWAP: &str = "swap-";
const UPDATE: &str = "update-";
const UNFINISHED: &str = "part-";

/// Whether a file or folder of a workshop is the tool's.
pub(super) fn is_own_name(name: &str) -> bool {
    is_scrap(name) || name.starts_with(SWAP) || name.starts_with(UPDATE)
}

/// Whether it may be removed once the journals are carried out.
pub(super) fn is_scrap(name: &str) -> bool {
    [BEING_BUILT, DISPLACED, UNFINISHED]
        .iter()
        .any(|start| name.starts_with(start))
}

/// Name in a workshop of what has the number `number`, for the folder being built.
pub(super) fn being_built(number: &str) -> String {
    format!("{BEING_BUILT}{number}")
}

/// A folder takes the place of another by two renames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SwapJournal {
    /// The place, from the output folder on.
    pub(super) place: PathBuf,
    /// Name in the workshop of the folder that takes it.
    pub(super) new: String,
    /// Name in the workshop that the folder in the place goes by afterwards.
    pub(super) old: String,
}

/// Files of a folder change as one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UpdateJournal {
    /// Name in the workshop of the folder that holds the new files.
    pub(super) new: String,
    /// Files to remove, from the output folder on.
    pub(super) removed: Vec<String>,
    /// Files to move out of `new`.
    pub(super) installed: Vec<String>,
}

/// A journal of either kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Journal {
    Swap(SwapJournal),
    Update(UpdateJournal),
}

impl SwapJournal {
    pub(super) fn new(place: &Path, new: &str) -> Self {
        let number = new.trim_start_matches(BEING_BUILT);
        Self {
            place: place.to_owned(),
            new: new.to_owned(),
            old: format!("{DISPLACED}{number}"),
        }
    }
}

impl Journal {
    fn file(&self) -> String {
        let (kind, new) = match self {
            Self::Swap(swap) => (SWAP, &swap.new),
            Self::Update(update) => (UPDATE, &update.new),
        };
        format!("{kind}{}.toml", new.trim_start_matches(BEING_BUILT))
    }

    fn text(&self) -> io::Result<String> {
        let list = |names: &[String]| {
            let names = names.iter().cloned().map(toml::Value::String);
            toml::Value::Array(names.collect())
        };
        let mut table = toml::Table::new();
        match self {
            Self::Swap(swap) => {
                let place = swap.place.to_str().ok_or_else(|| {
                    let message = format!("{} is no name in Unicode", swap.place.display());
                    io::Error::new(io::ErrorKind::InvalidData, message)
                })?;
                table.insert("place".to_owned(), place.into());
                table.insert("new".to_owned(), swap.new.as_str().into());
                table.insert("old".to_owned(), swap.old.as_str().into());
            }
            Self::Update(update) => {
                table.insert("new".to_owned(), update.new.as_str().into());
                table.insert("removed".to_owned(), list(&update.removed));
                table.insert("installed".to_owned(), list(&update.installed));
            }
        }
        Ok(table.to_string())
    }

    fn parse(file: &str, text: &str) -> Option<Self> {
        let table: toml::Table = text.parse().ok()?;
        let word = |key: &str| Some(table.get(key)?.as_str()?.to_owned());
        let list = |key: &str| {
            let names = table.get(key)?.as_array()?.iter();
            let names = names.map(|name| name.as_str().map(str::to_owned));
            names.collect::<Option<Vec<_>>>()
        };
        let journal = if file.starts_with(SWAP) {
            Self::Swap(SwapJournal {
                place: word("place")?.into(),
                new: word("new")?,
                old: word("old")?,
            })
        } else {
            Self::Update(UpdateJournal {
                new: word("new")?,
                removed: list("removed")?,
                installed: list("installed")?,
            })
        };
        journal.stays_inside().then_some(journal)
    }

    /// Whether no name leads out of the output folder.
    fn stays_inside(&self) -> bool {
        let inside = |path: &Path| {
            let mut parts = path.components();
            path.components().count() > 0 && parts.all(|part| matches!(part, Component::Normal(_)))
        };
        match self {
            Self::Swap(swap) => {
                inside(&swap.place)
                    && is_scrap(&swap.new)
                    && is_scrap(&swap.old)
                    && [&swap.new, &swap.old]
                        .iter()
                        .all(|name| !name.contains(['/', '\\']))
            }
            Self::Update(update) => {
                let mut names = update.removed.iter().chain(&update.installed);
                is_scrap(&update.new)
                    && !update.new.contains(['/', '\\'])
                    && names.all(|name| inside(Path::new(name)))
            }
        }
    }

    /// Puts the journal in its place, flushed.
    pub(super) fn enter(&self, workshop: &Path) -> io::Result<()> {
        let name = self.file();
        let unfinished = workshop.join(format!("{UNFINISHED}{name}"));
        let mut file = File::create(&unfinished)?;
        file.write_all(self.text()?.as_bytes())?;
        file.sync_all()?;
        fs::rename(&unfinished, workshop.join(name))?;
        flush_folder(workshop)
    }

    /// Removes the journal: what it tells of is done.
    pub(super) fn close(&self, workshop: &Path) -> io::Result<()> {
        fs::remove_file(workshop.join(self.file()))
    }

    /// Every journal in a workshop, by name.
    pub(super) fn all(workshop: &Path) -> io::Result<Vec<Self>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(workshop)? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.starts_with(SWAP) || name.starts_with(UPDATE) {
                names.push(name);
            }
        }
        names.sort();
        let read = |name: String| {
            let path = workshop.join(&name);
            Self::parse(&name, &fs::read_to_string(&path)?).ok_or_else(|| {
                let message = format!("{} is no journal of fogbench", path.display());
                io::Error::new(io::ErrorKind::InvalidData, message)
            })
        };
        names.into_iter().map(read).collect()
    }
}
