//! Journals: what is about to be renamed, so that a kill in between can be mended.
//!
//! A journal is in its place, flushed, before the first rename that it tells of, and is removed after the
//! last one. Whoever takes the lock of the output folder next carries out what the journals say.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Component, Path, PathBuf};

use super::error::StoreError;
use super::files::read_text;
use super::flush::flush_folder;

/// Beginnings of the names of what may be left in a workshop.
const BEING_BUILT: &str = "new-";
const DISPLACED: &str = "old-";
const SWAP: &str = "swap-";
const UPDATE: &str = "update-";
const UNFINISHED: &str = "part-";
const KEPT: &str = "kept-";
/// End of the name of a journal.
const SUFFIX: &str = ".toml";

/// What stands in a workshop, as its name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Item<'a> {
    /// A folder being built, which has never stood elsewhere, by number.
    BeingBuilt(&'a str),
    /// What was displaced, or is about to take a place, by number.
    Displaced(&'a str),
    /// A journal, by number.
    Journal(&'a str),
    /// A journal being written.
    Unfinished,
    /// What could not take its place, for the user to look at.
    Kept,
    /// None of the tool's.
    Foreign,
}

impl<'a> Item<'a> {
    /// What has this name.
    pub(super) fn of(name: &'a str) -> Self {
        let journal = || {
            let number = [SWAP, UPDATE].iter().find_map(|it| name.strip_prefix(it));
            number?.strip_suffix(SUFFIX)
        };
        if let Some(number) = name.strip_prefix(BEING_BUILT) {
            Self::BeingBuilt(number)
        } else if let Some(number) = name.strip_prefix(DISPLACED) {
            Self::Displaced(number)
        } else if let Some(number) = journal() {
            Self::Journal(number)
        } else if name.starts_with(UNFINISHED) {
            Self::Unfinished
        } else if name.starts_with(KEPT) {
            Self::Kept
        } else {
            Self::Foreign
        }
    }
}

/// Name in a workshop of what has the number `number`, for the folder being built.
pub(super) fn being_built(number: &str) -> String {
    format!("{BEING_BUILT}{number}")
}

/// Name of what a folder of a workshop displaces, or displaced itself goes by.
pub(super) fn displaced(new: &str) -> String {
    format!("{DISPLACED}{}", number_of(new))
}

/// Name of a folder of a workshop that could not take its place.
pub(super) fn kept(new: &str) -> String {
    format!("{KEPT}{}", number_of(new))
}

fn number_of(new: &str) -> &str {
    new.trim_start_matches(BEING_BUILT)
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
    /// Digests of the files that may be removed or replaced, by name; all others are the user's.
    pub(super) own: BTreeMap<String, String>,
}

/// A journal of either kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Journal {
    Swap(SwapJournal),
    Update(UpdateJournal),
}

impl SwapJournal {
    pub(super) fn new(place: &Path, new: &str) -> Self {
        Self {
            place: place.to_owned(),
            new: new.to_owned(),
            old: displaced(new),
        }
    }
}

impl Journal {
    fn file(&self) -> String {
        let (kind, new) = match self {
            Self::Swap(swap) => (SWAP, &swap.new),
            Self::Update(update) => (UPDATE, &update.new),
        };
        format!("{kind}{}{SUFFIX}", number_of(new))
    }

    /// Number of the folders that the journal is about.
    pub(super) fn number(&self) -> &str {
        match self {
            Self::Swap(swap) => number_of(&swap.new),
            Self::Update(update) => number_of(&update.new),
        }
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
                let own = update.own.iter();
                let own = own.map(|(name, digest)| (name.clone(), digest.as_str().into()));
                table.insert("own".to_owned(), toml::Value::Table(own.collect()));
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
                own: match table.get("own") {
                    // One of a version that did not write it: then the records alone tell.
                    None => BTreeMap::new(),
                    Some(own) => {
                        let own = own.as_table()?.iter();
                        own.map(|(name, digest)| Some((name.clone(), digest.as_str()?.to_owned())))
                            .collect::<Option<_>>()?
                    }
                },
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
        let is_new = |name: &str| name.starts_with(BEING_BUILT) && !name.contains(['/', '\\']);
        match self {
            Self::Swap(swap) => {
                inside(&swap.place) && is_new(&swap.new) && swap.old == displaced(&swap.new)
            }
            Self::Update(update) => {
                let mut names = update.removed.iter().chain(&update.installed);
                is_new(&update.new) && names.all(|name| inside(Path::new(name)))
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

    /// Every journal in a workshop, by name, and the files that should hold one and do not, which only
    /// damage makes: a journal gets its name whole.
    pub(super) fn all(workshop: &Path) -> Result<(Vec<Self>, Vec<Damaged>), StoreError> {
        let at = StoreError::at(workshop);
        let mut names = Vec::new();
        for entry in fs::read_dir(workshop).map_err(&at)? {
            let name = entry.map_err(&at)?.file_name();
            let name = name.to_string_lossy().into_owned();
            if matches!(Item::of(&name), Item::Journal(_)) {
                names.push(name);
            }
        }
        names.sort();
        let (mut journals, mut damaged) = (Vec::new(), Vec::new());
        for name in names {
            let path = workshop.join(&name);
            let text = read_text(&path).map_err(StoreError::at(&path))?;
            let journal = text.and_then(|text| Self::parse(&name, &text));
            // The name tells which folders it is about.
            match journal.filter(|journal| journal.file() == name) {
                Some(journal) => journals.push(journal),
                None => damaged.push(Damaged { path, name }),
            }
        }
        Ok((journals, damaged))
    }
}

/// A file that should hold a journal and does not.
#[derive(Clone, Debug)]
pub(super) struct Damaged {
    pub(super) path: PathBuf,
    name: String,
}

impl Damaged {
    /// Number of the folders that the journal was about.
    pub(super) fn number(&self) -> &str {
        match Item::of(&self.name) {
            Item::Journal(number) => number,
            _ => &self.name,
        }
    }
}
