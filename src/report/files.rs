//! Files that are never half written, and folders that are swapped whole.

use npyz::WriterBuilder as _;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes `bytes` to `path`: a temporary file in the same folder, flushed to the disk, then
/// renamed over the old one.
///
/// # Errors
/// Whatever the file system says; the old file then stands untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_atomic_with(path, |file| file.write_all(bytes))
}

/// Writes a one-dimensional NPY file of little-endian binary64, whole or not at all.
///
/// # Errors
/// Whatever the file system says; the old file then stands untouched.
///
/// # Panics
/// Never: the name of the number format is a constant.
pub fn write_npy(path: &Path, values: &[f64]) -> io::Result<()> {
    write_atomic_with(path, |file| {
        let word = "<f8"
            .parse()
            .expect("`<f8` is NumPy's name of little-endian binary64");
        let mut writer = npyz::WriteOptions::new()
            .dtype(npyz::DType::Plain(word))
            .shape(&[values.len() as u64])
            .writer(file)
            .begin_nd()?;
        writer.extend(values.iter().copied())?;
        writer.finish()
    })
}

fn write_atomic_with(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let partial = beside(path, "partial")?;
    let written = File::create(&partial).and_then(|file| {
        let mut file = BufWriter::new(file);
        write(&mut file)?;
        file.into_inner()
            .map_err(io::IntoInnerError::into_error)?
            .sync_all()
    });
    written
        .and_then(|()| fs::rename(&partial, path))
        .inspect_err(|_| {
            // Best effort: the error that matters is the first one.
            let _ = fs::remove_file(&partial);
        })
}

/// `.name.suffix` in the folder of `path`.
fn beside(path: &Path, suffix: &str) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("`{}` does not end in a name", path.display()),
        )
    })?;
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(".");
    hidden.push(suffix);
    Ok(path.with_file_name(hidden))
}

/// Builds a folder beside its place (`.name.partial`) and swaps it in whole.
///
/// Dropped before [`FolderWriter::commit`], it removes what it built; the old folder then stands
/// untouched. The swap renames the old folder to `.name.old`, the new one into place and removes
/// the old one; killed between the two renames, the next [`FolderWriter::create`] puts the old
/// folder back.
#[derive(Debug)]
pub struct FolderWriter {
    target: PathBuf,
    partial: PathBuf,
    old: PathBuf,
}

impl FolderWriter {
    /// Starts an empty folder that is to become `target`; its parents are created.
    ///
    /// # Errors
    /// Whatever the file system says, or a `target` that does not end in a name.
    pub fn create(target: &Path) -> io::Result<Self> {
        let writer = Self {
            target: target.to_path_buf(),
            partial: beside(target, "partial")?,
            old: beside(target, "old")?,
        };
        if writer.old.exists() {
            if target.exists() {
                fs::remove_dir_all(&writer.old)?;
            } else {
                fs::rename(&writer.old, target)?;
            }
        }
        if writer.partial.exists() {
            fs::remove_dir_all(&writer.partial)?;
        }
        fs::create_dir_all(&writer.partial)?;
        Ok(writer)
    }

    /// The folder being built.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Writes one file; `relative` may name sub-folders, which are created.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write(&self, relative: &str, bytes: &[u8]) -> io::Result<()> {
        write_atomic(&self.place(relative)?, bytes)
    }

    /// Writes one NPY file of binary64; see [`write_npy`].
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write_npy(&self, relative: &str, values: &[f64]) -> io::Result<()> {
        write_npy(&self.place(relative)?, values)
    }

    fn place(&self, relative: &str) -> io::Result<PathBuf> {
        let path = self.partial.join(relative);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        Ok(path)
    }

    /// Swaps the built folder into its place.
    ///
    /// # Errors
    /// Whatever the file system says; the old folder then stands in its place, unless the disk
    /// refuses even that, when it stays as `.name.old` and the next run restores it.
    pub fn commit(self) -> io::Result<()> {
        let replaces = self.target.exists();
        if replaces {
            fs::rename(&self.target, &self.old)?;
        }
        if let Err(error) = fs::rename(&self.partial, &self.target) {
            if replaces {
                fs::rename(&self.old, &self.target)?;
            }
            return Err(error);
        }
        if replaces {
            fs::remove_dir_all(&self.old)?;
        }
        Ok(())
    }
}

impl Drop for FolderWriter {
    fn drop(&mut self) {
        if self.partial.exists() {
            // Best effort: a left-over folder is removed by the next run.
            let _ = fs::remove_dir_all(&self.partial);
        }
    }
}
