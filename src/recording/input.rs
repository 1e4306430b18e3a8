//! The bytes of a file, with bounds: nothing that ends is too long, nothing endless is read to its end.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::error::LogError;

/// Most bytes that are taken from a pipe or a device, which need not end.
const STREAM_BYTES_MAX: u64 = 1 << 30;
/// Most bytes of a text that is read as a whole: groups, the table of a script, a calibration.
pub const TEXT_BYTES_MAX: u64 = 16 << 20;

/// Why a file was not read as a whole.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file system refused.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// A folder, a pipe or a device where a file is expected.
    #[error("it is no regular file")]
    NotRegular,
    /// More bytes than such a file may have.
    #[error("it has more than {0} bytes, the most that such a file may have")]
    TooLong(u64),
}

/// The bytes of a regular file of at most `bytes_max` bytes.
///
/// # Errors
/// [`FileError`]: whatever the file system says; anything else than a regular file, which is not
/// opened; a longer file, of which no more is read.
pub fn read_regular(path: &Path, bytes_max: u64) -> Result<Vec<u8>, FileError> {
    if !fs::metadata(path)?.is_file() {
        return Err(FileError::NotRegular);
    }
    read_at_most(path, bytes_max)
}

/// The bytes of a file of any kind, at most `bytes_max`.
pub(super) fn read_at_most(path: &Path, bytes_max: u64) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let file = File::open(path)?;
    file.take(bytes_max.saturating_add(1))
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > bytes_max {
        return Err(FileError::TooLong(bytes_max));
    }
    Ok(bytes)
}

/// What a stream ends with that does not end by itself.
#[derive(Debug, thiserror::Error)]
#[error(
    "more than {STREAM_BYTES_MAX} bytes come from this pipe or device: write them into a file first"
)]
struct Endless;

/// A file while it is read.
pub(super) struct Input {
    reader: io::Chain<io::Cursor<Vec<u8>>, BufReader<File>>,
    /// Bytes of a regular file; none of a pipe or a device.
    length: Option<u64>,
    /// Bytes that may still be read.
    left: u64,
    first: Vec<u8>,
}

impl Input {
    /// Opens a file and reads its first bytes.
    pub(super) fn open(path: &Path) -> Result<Self, LogError> {
        const FIRST: u64 = 8;
        let failed = |error| LogError::read(path, error);
        let file = File::open(path).map_err(failed)?;
        let metadata = file.metadata().map_err(failed)?;
        // Files that the system makes up while they are read have no length.
        let length = (metadata.is_file() && metadata.len() > 0).then(|| metadata.len());
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let mut first = Vec::new();
        let read = reader.by_ref().take(FIRST).read_to_end(&mut first);
        read.map_err(failed)?;
        Ok(Self {
            reader: io::Cursor::new(first.clone()).chain(reader),
            length,
            left: length.map_or(STREAM_BYTES_MAX, |_| u64::MAX),
            first,
        })
    }

    /// Bytes of the file; none where only the reading tells.
    pub(super) fn length(&self) -> Option<u64> {
        self.length
    }

    /// Whether the file begins with these bytes, at most eight.
    pub(super) fn starts_with(&self, bytes: &[u8]) -> bool {
        self.first.starts_with(bytes)
    }
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut available = self.fill_buf()?;
        let count = available.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Input {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let available = self.reader.fill_buf()?;
        if self.left == 0 && !available.is_empty() {
            return Err(io::Error::other(Endless));
        }
        let allowed = usize::try_from(self.left).unwrap_or(usize::MAX);
        Ok(&available[..available.len().min(allowed)])
    }

    fn consume(&mut self, count: usize) {
        self.left -= count as u64;
        self.reader.consume(count);
    }
}

/// An error of reading: the bound of a stream is about what it holds, all else is the system's.
pub(super) fn failure(path: &Path, error: io::Error) -> LogError {
    if error.get_ref().is_some_and(|inner| inner.is::<Endless>()) {
        return LogError::of_file(path, error.to_string());
    }
    LogError::read(path, error)
}

/// Appends a value, or says that memory is used up.
pub(super) fn push<T>(values: &mut Vec<T>, value: T) -> io::Result<()> {
    let reserved = values.try_reserve(1);
    reserved.map_err(|error| io::Error::new(io::ErrorKind::OutOfMemory, error))?;
    values.push(value);
    Ok(())
}
