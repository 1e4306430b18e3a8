//! A file that stands alone, where the user asked for it.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::{Foreign, StoreError};
use super::files::{plain_file, read_text, rename_to_free, stands};
use super::flush::flush_folder;

/// A file that is made, or replaced where it is one of the same kind.
#[derive(Clone, Copy, Debug)]
pub struct SingleFile<'a> {
    /// Its path.
    pub path: &'a Path,
    /// Whether a text is one that the tool wrote here, and may replace; none where it replaces nothing
    /// unasked but an empty file.
    pub is_ours: Option<fn(&str) -> bool>,
    /// Whether another file is replaced too; links and folders never are.
    pub force: bool,
}

impl SingleFile<'_> {
    /// Checks what [`SingleFile::write`] would refuse, and makes nothing.
    ///
    /// # Errors
    /// [`StoreError::FileNotOurs`] where something else stands at the path, or what the file system says.
    pub fn check(&self) -> Result<(), StoreError> {
        let at = StoreError::at(self.path);
        let refused = |reason| {
            Err(StoreError::FileNotOurs {
                path: self.path.to_owned(),
                reason,
            })
        };
        if !stands(self.path).map_err(&at)? {
            return Ok(());
        }
        let kind = fs::symlink_metadata(self.path).map_err(&at)?;
        if kind.is_symlink() {
            return refused(Foreign::Link);
        }
        if !kind.is_file() {
            return refused(Foreign::NoFile);
        }
        let text = read_text(self.path).map_err(&at)?;
        let is_ours = self.is_ours.unwrap_or(str::is_empty);
        if self.force || text.is_some_and(|text| is_ours(&text)) {
            return Ok(());
        }
        refused(self.is_ours.map_or(Foreign::Present, |_| Foreign::Unknown))
    }

    /// What a file of its kind that stands there holds; nothing where none does.
    ///
    /// # Errors
    /// What the file system says.
    pub fn text(&self) -> Result<String, StoreError> {
        let at = StoreError::at(self.path);
        if !stands(self.path).map_err(&at)? {
            return Ok(String::new());
        }
        let text = read_text(self.path).map_err(&at)?.unwrap_or_default();
        let is_ours = self.is_ours.unwrap_or(str::is_empty);
        Ok(if is_ours(&text) { text } else { String::new() })
    }

    /// Writes the file whole or not at all.
    ///
    /// # Errors
    /// As [`SingleFile::check`].
    pub fn write(&self, text: &str) -> Result<(), StoreError> {
        self.write_by(&|out| out.write_all(text.as_bytes()))
    }

    /// Writes the file whole or not at all, piece by piece.
    ///
    /// # Errors
    /// As [`SingleFile::check`].
    pub fn write_by(
        &self,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), StoreError> {
        self.check()?;
        let beside = self.beside();
        let written = self.put(&beside, write);
        if written.is_err() {
            // The failure is what counts.
            let _ = fs::remove_file(&beside);
        }
        written.map_err(StoreError::at(self.path))
    }

    fn put(
        &self,
        beside: &Path,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let file = plain_file().write(true).create_new(true).open(beside)?;
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        drop(file);
        if stands(self.path)? {
            fs::rename(beside, self.path)?;
        } else {
            rename_to_free(beside, self.path)?;
        }
        let folder = self.path.parent().filter(|it| *it != Path::new(""));
        flush_folder(folder.unwrap_or(Path::new(".")))
    }

    /// Name under which it is written before it has its own.
    fn beside(&self) -> PathBuf {
        let mut name = self.path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        self.path.with_file_name(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &Path) -> SingleFile<'_> {
        SingleFile {
            path,
            is_ours: Some(|text| text.starts_with("ours")),
            force: false,
        }
    }

    #[test]
    fn only_a_file_of_the_same_kind_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        file(&path).write("ours 1").unwrap();
        file(&path).write("ours 2").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "ours 2");
        fs::write(&path, "theirs").unwrap();
        assert!(matches!(
            file(&path).write("ours 3"),
            Err(StoreError::FileNotOurs {
                reason: Foreign::Unknown,
                ..
            })
        ));
        assert_eq!(fs::read_to_string(&path).unwrap(), "theirs");
        let forced = SingleFile {
            force: true,
            ..file(&path)
        };
        forced.write("ours 4").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "ours 4");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn neither_a_folder_nor_a_link_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let forced = |path| SingleFile {
            force: true,
            ..file(path)
        };
        assert!(forced(folder.path()).write("ours").is_err());
        #[cfg(unix)]
        {
            let (target, link) = (folder.path().join("target"), folder.path().join("link"));
            fs::write(&target, "theirs").unwrap();
            std::os::unix::fs::symlink(&target, &link).unwrap();
            assert!(forced(&link).write("ours").is_err());
            assert_eq!(fs::read_to_string(&target).unwrap(), "theirs");
        }
    }
}
