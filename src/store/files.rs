//! Single files.

use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::Path;

use npyz::WriterBuilder as _;

/// Writes a one-dimensional NPY file of little-endian binary64.
///
/// # Errors
/// Whatever the file system says.
///
/// # Panics
/// Never: the name of the number format is a constant.
pub fn write_npy(path: &Path, values: &[f64]) -> io::Result<()> {
    let word = "<f8"
        .parse()
        .expect("`<f8` is NumPy's name of little-endian binary64");
    let mut file = BufWriter::new(File::create(path)?);
    let mut writer = npyz::WriteOptions::new()
        .dtype(npyz::DType::Plain(word))
        .shape(&[values.len() as u64])
        .writer(&mut file)
        .begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(())
}

/// Removes whatever stands at `path`; nothing there is no failure.
pub(super) fn remove(path: &Path) -> io::Result<()> {
    let removed = match fs::symlink_metadata(path) {
        Ok(found) if found.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(error) => Err(error),
    };
    match removed {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Whether anything stands at `path`, a dangling link included.
pub(super) fn stands(path: &Path) -> io::Result<bool> {
    match fs::symlink_metadata(path) {
        Ok(_) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        // A file where a folder of the path belongs: nothing stands below it.
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => Ok(false),
        Err(error) => Err(error),
    }
}

/// A tree of hard links to the files of another: the same files under a second name, copied where the
/// file system has no hard links.
pub(super) fn link_tree(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type()?.is_dir() {
            link_tree(&source, &target)?;
        } else if fs::hard_link(&source, &target).is_err() {
            fs::copy(&source, &target)?;
        }
    }
    Ok(())
}
