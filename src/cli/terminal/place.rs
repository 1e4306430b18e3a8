//! Where a command writes its one result.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::report::Pictures;
use crate::store::{OutputFolder, SingleFile, StoreError, StoreOptions, holds_result};

/// A path with its links resolved as far as it exists.
pub(in crate::cli) fn real(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut ancestors = whole.ancestors();
    let found = ancestors.find_map(|it| Some((it, fs::canonicalize(it).ok()?)));
    match found {
        Some((stands, real)) => real.join(whole.strip_prefix(stands).unwrap_or(Path::new(""))),
        None => whole,
    }
}

/// Checks that a file that would be written is none of those that are read, be it with `--force`.
///
/// A refusal is printed before its exit code is returned.
pub(in crate::cli) fn check_unread(path: &Path, inputs: &[&Path]) -> Result<(), Exit> {
    let own = real(path);
    if inputs.iter().all(|input| real(input) != own) {
        return Ok(());
    }
    output::talk(&format!(
        "error: {} is read: nothing was done; choose another name",
        path.display()
    ));
    Err(Exit::Usage)
}

/// Checks the place of a file that stands alone before anything is computed.
///
/// A refusal is printed before its exit code is returned.
pub(in crate::cli) fn check_file(file: SingleFile, inputs: &[&Path]) -> Result<(), Exit> {
    check_unread(file.path, inputs)?;
    file.check().map_err(|error| refused(&error))
}

/// The folder of a result, if one is asked for.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct Place<'a> {
    folder: Option<&'a Path>,
    /// Kind of the result, as the record of the folder says.
    holds: &'static str,
    options: StoreOptions,
}

impl<'a> Place<'a> {
    /// The place of a result of the kind `holds`.
    pub(in crate::cli) fn new(folder: Option<&'a Path>, holds: &'static str, force: bool) -> Self {
        let options = StoreOptions {
            force,
            ..StoreOptions::default()
        };
        Self {
            folder,
            holds,
            options,
        }
    }

    /// Checks the folder before anything is computed; none of the `inputs` may be a file of the results
    /// that would be replaced.
    ///
    /// A refusal is printed before its exit code is returned.
    pub(in crate::cli) fn check(self, inputs: &[&Path]) -> Result<(), Exit> {
        let Some(folder) = self.folder else {
            return Ok(());
        };
        if let Some(input) = inputs.iter().find(|input| holds_result(folder, input)) {
            output::talk(&format!(
                "error: {} is read, and is among the results in {} that would be replaced: nothing was \
                 done; choose another folder",
                input.display(),
                folder.display()
            ));
            return Err(Exit::Usage);
        }
        let cautions = OutputFolder::check_result(folder, self.holds, self.options)
            .map_err(|error| refused(&error))?;
        for caution in cautions {
            output::talk(&format!("warning: {caution}"));
        }
        Ok(())
    }

    /// Takes the folder, if there is one, and gives it to `write`.
    pub(in crate::cli) fn fill(
        self,
        write: impl FnOnce(&OutputFolder) -> Result<(), StoreError>,
    ) -> Result<(), Exit> {
        let Some(path) = self.folder else {
            return Ok(());
        };
        // What is worth saying was said when the folder was checked, but for what has come since.
        let folder = OutputFolder::of_result(path, self.holds, self.options);
        folder
            .and_then(|folder| write(&folder))
            .map_err(|error| refused(&error))
    }

    /// Takes the folder, if there is one, and fills it with files, name and text of each, and pictures; says
    /// what is left out of these.
    pub(in crate::cli) fn fill_with(
        self,
        own: &[(&str, &str)],
        pictures: &Pictures,
        more: &[(String, String)],
    ) -> Result<(), Exit> {
        let made = pictures.drawn.iter().chain(more);
        let made = made.map(|(name, text)| (name.as_str(), text.as_str()));
        self.fill(|folder| {
            let staged = folder.stage()?;
            for (path, text) in own.iter().copied().chain(made) {
                staged.write(path, text.as_bytes())?;
            }
            staged.seal_plainly()?;
            staged.put_files_in_place()
        })?;
        for note in &pictures.notes {
            output::talk(&format!("note: {note}"));
        }
        Ok(())
    }
}

/// Says why results are not written.
pub(in crate::cli) fn refused(error: &StoreError) -> Exit {
    output::talk(&format!("error: {error}"));
    exit_of(error)
}

/// The exit code of results that are not written.
pub(in crate::cli) fn exit_of(error: &StoreError) -> Exit {
    if error.is_refusal() {
        Exit::Usage
    } else {
        Exit::Io
    }
}
