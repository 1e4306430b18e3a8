//! Single files and folders.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read as _};
use std::path::Path;

use npyz::WriterBuilder as _;

/// Most bytes of a text that the store reads: records, journals and what an earlier version wrote.
const TEXT_BYTES_MAX: u64 = 64_000_000;

/// Writes a one-dimensional NPY file of little-endian binary64.
///
/// # Errors
/// Whatever the file system says.
///
/// # Panics
/// Never: the name of the number format is a constant.
pub fn write_npy(path: &Path, values: &[f64]) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    put_npy(&mut file, values)?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(())
}

/// Writes what [`write_npy`] writes anywhere else.
///
/// # Errors
/// What `out` says.
///
/// # Panics
/// Never: the name of the number format is a constant.
pub fn put_npy(out: &mut impl io::Write, values: &[f64]) -> io::Result<()> {
    let word = "<f8"
        .parse()
        .expect("`<f8` is NumPy's name of little-endian binary64");
    let mut writer = npyz::WriteOptions::new()
        .dtype(npyz::DType::Plain(word))
        .shape(&[values.len() as u64])
        .writer(out)
        .begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()
}

/// Options that open what is no link and no pipe, and wait for nothing.
pub(super) fn plain_file() -> fs::OpenOptions {
    #[cfg_attr(not(unix), expect(unused_mut, reason = "only Unix has such flags"))]
    let mut options = fs::OpenOptions::new();
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt as _;

        let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
        options.custom_flags(flags.bits().cast_signed());
    }
    options
}

/// The text of a regular file; none if it is something else, no text or longer than any the store
/// writes.
pub(super) fn read_text(path: &Path) -> io::Result<Option<String>> {
    if !fs::symlink_metadata(path)?.is_file() {
        return Ok(None);
    }
    let file = plain_file().read(true).open(path)?;
    if file.metadata()?.len() > TEXT_BYTES_MAX {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.take(TEXT_BYTES_MAX).read_to_end(&mut bytes)?;
    Ok(String::from_utf8(bytes).ok())
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

/// Exchanges two names in one step; false where the system or the file system cannot.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
pub(super) fn exchange(one: &Path, other: &Path) -> io::Result<bool> {
    use rustix::fs::RenameFlags;

    rename_with(one, other, RenameFlags::EXCHANGE)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
pub(super) fn exchange(_one: &Path, _other: &Path) -> io::Result<bool> {
    Ok(false)
}

/// Renames to a name that nothing has: [`io::ErrorKind::AlreadyExists`] if something does, an empty
/// folder included.
pub(super) fn rename_to_free(from: &Path, to: &Path) -> io::Result<()> {
    #[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
    if rename_with(from, to, rustix::fs::RenameFlags::NOREPLACE)? {
        return Ok(());
    }
    if stands(to)? {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    fs::rename(from, to)
}

/// A rename with flags; false where the system or the file system does not know them.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn rename_with(from: &Path, to: &Path, flags: rustix::fs::RenameFlags) -> io::Result<bool> {
    use rustix::fs::{CWD, renameat_with};
    use rustix::io::Errno;

    match renameat_with(CWD, from, CWD, to, flags) {
        Ok(()) => Ok(true),
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP | Errno::PERM) => Ok(false),
        Err(error) => Err(error.into()),
    }
}
