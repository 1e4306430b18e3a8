//! A folder being built in the workshop.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use super::error::StoreError;
use super::files::{remove, write_npy};
use super::flush::flush_tree;
use super::journal::{UpdateJournal, displaced};
use super::output_folder::OutputFolder;
use super::ownership::clear;
use super::record::{MANIFEST_FILE, RECORD_FILE, Record};
use super::{WORKSHOP, files, swap, sweep_files};

/// A folder being built; dropped before it is put in place, it goes.
#[derive(Debug)]
pub struct Staged<'a> {
    output: &'a OutputFolder,
    /// Name in the workshop.
    name: String,
    path: PathBuf,
    is_in_place: bool,
}

impl<'a> Staged<'a> {
    pub(super) fn create(output: &'a OutputFolder, name: String) -> Result<Self, StoreError> {
        let path = output.path().join(WORKSHOP).join(&name);
        fs::create_dir(&path).map_err(StoreError::at(&path))?;
        Ok(Self {
            output,
            name,
            path,
            is_in_place: false,
        })
    }

    /// The folder being built.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes one file; `name` may lead through folders, which are made.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        let path = self.place(name)?;
        fs::write(&path, bytes).map_err(|source| self.failed(name, source))
    }

    /// Writes one file bit by bit; `name` may lead through folders, which are made.
    ///
    /// # Errors
    /// What `write` or the file system says.
    pub fn write_by(
        &self,
        name: &str,
        write: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
    ) -> Result<(), StoreError> {
        let path = self.place(name)?;
        let written = || {
            let mut file = BufWriter::new(File::create(&path)?);
            write(&mut file)?;
            file.into_inner().map_err(io::IntoInnerError::into_error)?;
            Ok(())
        };
        written().map_err(|source| self.failed(name, source))
    }

    /// Writes one NPY file of binary64; see [`write_npy`].
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write_npy(&self, name: &str, values: &[f64]) -> Result<(), StoreError> {
        let path = self.place(name)?;
        write_npy(&path, values).map_err(|source| self.failed(name, source))
    }

    /// Writes the record of what has been written so far, below `head`, into the file `name`.
    ///
    /// * `name`: [`super::MANIFEST_FILE`] or [`super::RECORD_FILE`].
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn seal(&self, name: &str, head: &str) -> Result<(), StoreError> {
        let record = Record::of(&self.path).map_err(|source| self.failed("", source))?;
        self.write(name, record.sealed(head).as_bytes())
    }

    /// Writes the record of a folder without a manifest, which says what the folder holds.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn seal_plainly(&self) -> Result<(), StoreError> {
        self.seal(RECORD_FILE, &head_of_record(self.output.holds()))
    }

    /// Makes the files of a finished folder of the output stand here as well, under `name`.
    pub(super) fn adopt(&self, finished: &Path, name: &str) -> Result<(), StoreError> {
        let from = self.output.path().join(finished);
        files::link_tree(&from, &self.path.join(name)).map_err(StoreError::at(&from))
    }

    /// Flushes the folder and swaps it into its place below the output folder.
    ///
    /// # Errors
    /// [`StoreError::Kept`] if what stands there has become the user's meanwhile; whatever the file
    /// system says, and what stood there then stands untouched.
    pub fn put_in_place(mut self, place: &str) -> Result<(), StoreError> {
        let target = self.output.path().join(place);
        self.output.check_theirs(&target)?;
        flush_tree(&self.path).map_err(StoreError::at(&target))?;
        let how = (self.output.options().swap, self.output.displaced());
        swap::put(self.output.path(), &self.name, Path::new(place), how)?;
        self.is_in_place = true;
        Ok(())
    }

    /// Flushes the files and makes them those of the output folder itself, in place of the recorded ones.
    ///
    /// # Errors
    /// [`StoreError::NotOurs`] and [`StoreError::Obstacle`], and nothing was done; [`StoreError::Kept`]
    /// if some of the files have become the user's, and all others are in place; whatever the file
    /// system says.
    pub fn put_files_in_place(mut self) -> Result<(), StoreError> {
        let output = self.output.path().to_owned();
        let at = StoreError::at(&output);
        let own = self.output.known_files()?;
        let built = Record::of(&self.path).map_err(&at)?;
        let mut installed: Vec<String> = built.names().map(str::to_owned).collect();
        // The record last, once what it tells of is there.
        let has_record = self.path.join(RECORD_FILE).is_file();
        installed.extend(has_record.then(|| RECORD_FILE.to_owned()));
        let removed = own.keys().filter(|name| !installed.contains(name));
        let change = UpdateJournal {
            new: self.name.clone(),
            removed: removed.cloned().collect(),
            installed,
            own,
        };
        flush_tree(&self.path).map_err(&at)?;
        self.output.check_change(&change)?;
        // From here on a journal may tell of the folder, and then the next run needs it.
        self.is_in_place = true;
        self.output.change_files(&change)
    }

    /// Flushes the files and makes them those of a sweep's folder, beside the folders of its points, in place
    /// of those that an earlier sweep had there, with a record of their own; without files these only go.
    ///
    /// The files stand below `place` in this folder as they will in the output folder.
    ///
    /// # Errors
    /// As [`Staged::put_files_in_place`].
    pub fn put_beside_points(mut self, place: &str) -> Result<(), StoreError> {
        let output = self.output.path().to_owned();
        let at = StoreError::at(&output);
        let below = |name: &str| format!("{place}/{name}");
        if output.join(below(MANIFEST_FILE)).is_file() {
            // A result that is no sweep could not be replaced: its record knows no files of others.
            return Ok(());
        }
        let own = sweep_files::known(&output.join(place)).map_err(&at)?;
        let staged = self.path.join(place);
        let mut installed = Vec::new();
        if staged.is_dir() {
            let record = Record::of(&staged).map_err(&at)?;
            installed.extend(record.names().map(below));
            let text = record.sealed(&head_of_record(sweep_files::HOLDS));
            // The record last, once what it tells of is there.
            installed.push(below(RECORD_FILE));
            self.write(&below(RECORD_FILE), text.as_bytes())?;
        }
        let own: BTreeMap<String, String> = own
            .into_iter()
            .map(|(name, digest)| (below(&name), digest))
            .collect();
        let mut removed: Vec<String> = own.keys().cloned().collect();
        removed.retain(|name| !installed.contains(name) && output.join(name).is_file());
        // The record goes last, as the others are known by it.
        removed.sort_by_key(|name| name.ends_with(RECORD_FILE));
        if removed.is_empty() && installed.is_empty() {
            return Ok(());
        }
        let change = UpdateJournal {
            new: self.name.clone(),
            removed,
            installed,
            own,
        };
        flush_tree(&self.path).map_err(&at)?;
        // From here on a journal may tell of the folder, and then the next run needs it.
        self.is_in_place = true;
        self.output.change_files(&change)
    }

    fn place(&self, name: &str) -> Result<PathBuf, StoreError> {
        let path = self.path.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|source| self.failed(name, source))?;
        }
        Ok(path)
    }

    fn failed(&self, name: &str, source: io::Error) -> StoreError {
        StoreError::Write {
            path: self.path.join(name),
            source,
        }
    }
}

/// Text above the record of a folder without a manifest.
fn head_of_record(holds: &str) -> String {
    format!(
        "# Written by fogbench: the files of this folder. A command replaces them only while they are\n\
         # unchanged.\nschema = 1\nholds = \"{holds}\"\n\n[tool]\nname = \"fogbench\"\nversion = \"{}\"\n",
        env!("CARGO_PKG_VERSION")
    )
}

impl Drop for Staged<'_> {
    fn drop(&mut self) {
        if !self.is_in_place {
            // Best effort: the next run clears the workshop.
            let _ = remove(&self.path);
            // A folder that has stood in its place goes only as its record tells.
            let workshop = self.output.path().join(WORKSHOP);
            let _ = clear(&workshop.join(displaced(&self.name)));
        }
    }
}
