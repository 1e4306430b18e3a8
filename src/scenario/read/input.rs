//! Reading of the files that a scenario is made of, within bounds.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of one file, and of a scenario with all its bases.
pub(crate) const BYTES_MAX: u64 = 16_000_000;

/// Why a file is not read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum InputError {
    /// Nothing is there.
    #[error("no such file")]
    Missing,
    /// A folder.
    #[error("it is a folder, not a file")]
    Folder,
    /// A device, a pipe or a socket: reading it need not end.
    #[error("it is {kind}, not a regular file: save its content in a file")]
    Special {
        /// What it is, with an article.
        kind: &'static str,
    },
    /// More bytes than the bound.
    #[error("the file holds {found} bytes: allowed up to {bound} (16 MB)")]
    TooLong {
        /// The bound.
        bound: u64,
        /// Its size, or that it is above the bound.
        found: String,
    },
    /// Its text would make the whole too long.
    #[error(
        "the files of one scenario hold more than {BYTES_MAX} bytes together: allowed up to \
         {BYTES_MAX} (16 MB)"
    )]
    TooLongTogether,
    /// Bytes that are no text.
    #[error("the file is not UTF-8 text: line {line} holds other bytes")]
    NotText {
        /// The first line that is none, from 1.
        line: usize,
    },
    /// What the system said.
    #[error("cannot read the file: {0}")]
    System(io::Error),
}

/// A file as it was read.
#[derive(Debug)]
pub(crate) struct Input {
    /// Its text.
    pub(crate) text: String,
    /// BLAKE3 of its bytes, hexadecimal.
    pub(crate) digest: String,
}

/// A text that stands in no file, as if it had been read.
pub(crate) fn of_text(text: &str) -> Result<Input, InputError> {
    if text.len() as u64 > BYTES_MAX {
        return Err(too_long(text.len().to_string()));
    }
    Ok(Input {
        text: text.to_owned(),
        digest: blake3::hash(text.as_bytes()).to_hex().to_string(),
    })
}

/// Reads a regular file of up to [`BYTES_MAX`] bytes; a symbolic link to one will do.
pub(crate) fn read(path: &Path) -> Result<Input, InputError> {
    let bytes = read_bytes(path)?;
    let digest = blake3::hash(&bytes).to_hex().to_string();
    let text = String::from_utf8(bytes).map_err(|error| {
        let sound = error.utf8_error().valid_up_to();
        let ends = error.as_bytes()[..sound].iter();
        let line = 1 + ends.filter(|byte| **byte == b'\n').count();
        InputError::NotText { line }
    })?;
    Ok(Input { text, digest })
}

/// BLAKE3 of a file within the bounds, hexadecimal.
pub(crate) fn digest(path: &Path) -> Result<String, InputError> {
    Ok(blake3::hash(&read_bytes(path)?).to_hex().to_string())
}

/// BLAKE3 of a regular file of any size, hexadecimal; it is not held in memory.
pub(crate) fn digest_of_any(path: &Path) -> Result<String, InputError> {
    let file = open_regular(path, None)?;
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file).map_err(InputError::System)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// The bytes of a regular file.
fn read_bytes(path: &Path) -> Result<Vec<u8>, InputError> {
    let file = open_regular(path, Some(BYTES_MAX))?;
    let metadata = file.metadata().map_err(InputError::System)?;
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    // The size that the system tells need not be true: what is read decides.
    file.take(BYTES_MAX + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| match error.kind() {
            io::ErrorKind::WouldBlock => InputError::Special {
                kind: "a stream of the system",
            },
            _ => InputError::System(error),
        })?;
    if bytes.len() as u64 > BYTES_MAX {
        return Err(too_long(format!("more than {BYTES_MAX}")));
    }
    Ok(bytes)
}

/// Opens a regular file of up to so many bytes.
fn open_regular(path: &Path, bytes_max: Option<u64>) -> Result<File, InputError> {
    // Asked before it is opened, which alone would wait for a writer at the other end of a pipe.
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => InputError::Missing,
        _ => InputError::System(error),
    })?;
    check(&metadata, bytes_max)?;
    let file = open(path).map_err(InputError::System)?;
    let metadata = file.metadata().map_err(InputError::System)?;
    check(&metadata, bytes_max)?;
    Ok(file)
}

/// Opens a file so that reading never waits. What the system shows as a regular file may yet be a
/// stream, as `/proc/kmsg`, the messages of the kernel, which end only when there are no more.
#[cfg(unix)]
fn open(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let flags = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();
    File::options().read(true).custom_flags(flags).open(path)
}

/// Opens a file.
#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

fn too_long(found: String) -> InputError {
    let bound = BYTES_MAX;
    InputError::TooLong { bound, found }
}

/// Refuses what is no regular file within the bound.
fn check(metadata: &Metadata, bytes_max: Option<u64>) -> Result<(), InputError> {
    if metadata.is_dir() {
        return Err(InputError::Folder);
    }
    if !metadata.is_file() {
        let kind = special_kind(metadata);
        return Err(InputError::Special { kind });
    }
    if bytes_max.is_some_and(|most| metadata.len() > most) {
        return Err(too_long(metadata.len().to_string()));
    }
    Ok(())
}

/// What something that is neither file nor folder is.
#[cfg(unix)]
fn special_kind(metadata: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

/// What something that is neither file nor folder is.
#[cfg(not(unix))]
fn special_kind(_: &Metadata) -> &'static str {
    "something else"
}
