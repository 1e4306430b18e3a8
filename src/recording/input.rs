//! The bytes of a file, with bounds: nothing that ends is too long, nothing endless is read to its end.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::ahead::Ahead;
use super::error::LogError;

/// Most bytes that are taken from a pipe or a device, which need not end.
const STREAM_BYTES_MAX: u64 = 1 << 28;
/// Name of what comes on standard input.
const STANDARD_INPUT: &str = "-";
/// Bytes that are read at once: of a text, enough for several threads.
const BUFFER_BYTES: usize = 1 << 19;
/// Bytes of a file from which on it is read ahead.
const AHEAD_MIN: u64 = 1 << 24;
/// First bytes that are looked at.
const FIRST: usize = 8;
/// Most bytes of a text that is read as a whole.
const TEXT_BYTES_MAX: u64 = 16_000_000;

/// The bytes of a text of a few lines, from a file of any kind.
///
/// # Errors
/// [`LogError`]: whatever the file system says; more bytes than such a text may have, of which no
/// more is read.
pub(super) fn read_whole(path: &Path) -> Result<Vec<u8>, LogError> {
    let failed = |error| LogError::read(path, error);
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    let read = file.take(TEXT_BYTES_MAX + 1).read_to_end(&mut bytes);
    read.map_err(failed)?;
    if bytes.len() as u64 > TEXT_BYTES_MAX {
        let message = format!("more than {TEXT_BYTES_MAX} bytes, the most that it may have");
        return Err(LogError::of_file(path, message));
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
    reader: Box<dyn BufRead + Send>,
    /// Bytes of a regular file; none of a pipe or a device.
    length: Option<u64>,
    /// Bytes that may still be read.
    left: u64,
    first: Vec<u8>,
}

impl Input {
    /// Opens a file and reads its first bytes.
    pub(super) fn open(path: &Path) -> Result<Self, LogError> {
        let failed = |error| LogError::read(path, error);
        let file = match path == Path::new(STANDARD_INPUT) {
            true => File::open("/dev/stdin"),
            false => File::open(path),
        };
        let file = file.map_err(failed)?;
        let metadata = file.metadata().map_err(failed)?;
        // Files that the system makes up while they are read have no length.
        let length = (metadata.is_file() && metadata.len() > 0).then_some(metadata.len());
        let mut reader: Box<dyn BufRead + Send> = match length {
            Some(AHEAD_MIN..) => Box::new(Ahead::of(file, BUFFER_BYTES).map_err(failed)?),
            _ => Box::new(BufReader::with_capacity(BUFFER_BYTES, file)),
        };
        let mut first = Vec::new();
        let read = reader.by_ref().take(FIRST as u64).read_to_end(&mut first);
        read.map_err(failed)?;
        Ok(Self {
            reader: Box::new(io::Cursor::new(first.clone()).chain(reader)),
            length,
            left: length.map_or(STREAM_BYTES_MAX, |_| u64::MAX),
            first,
        })
    }

    /// Bytes at hand, as if they were a file.
    pub(super) fn of_bytes(bytes: Vec<u8>) -> Self {
        Self {
            length: Some(bytes.len() as u64),
            left: u64::MAX,
            first: bytes.iter().take(FIRST).copied().collect(),
            reader: Box::new(io::Cursor::new(bytes)),
        }
    }

    /// Takes a pipe for one that is not kept: it may go on as long as it will.
    pub(super) fn let_go_on(&mut self) {
        self.left = u64::MAX;
    }

    /// Bytes of the file; none where only the reading tells.
    pub(super) fn length(&self) -> Option<u64> {
        self.length
    }

    /// The first bytes, eight at most.
    pub(super) fn first(&self) -> &[u8] {
        &self.first
    }

    /// Whether the file begins with these bytes, at most eight.
    pub(super) fn starts_with(&self, bytes: &[u8]) -> bool {
        self.first.starts_with(bytes)
    }
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        read_buffered(self, buffer)
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

/// What `read` is for a reader that has a buffer of its own.
pub(super) fn read_buffered(reader: &mut impl BufRead, buffer: &mut [u8]) -> io::Result<usize> {
    let mut available = reader.fill_buf()?;
    let count = available.read(buffer)?;
    reader.consume(count);
    Ok(count)
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
    reserve(values, 1)?;
    values.push(value);
    Ok(())
}

/// Makes room for more values, or says that memory is used up.
pub(super) fn reserve<T>(values: &mut Vec<T>, more: usize) -> io::Result<()> {
    let reserved = values.try_reserve(more);
    reserved.map_err(|error| io::Error::new(io::ErrorKind::OutOfMemory, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of a file as if it were a pipe of which `bytes_max` bytes are taken.
    fn streamed(bytes_max: u64) -> Result<String, LogError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        std::fs::write(&path, "1\n2\n3\n4\n5\n6\n").unwrap();
        let mut input = Input::open(&path)?;
        input.left = bytes_max;
        let mut text = String::new();
        let read = input.read_to_string(&mut text);
        read.map_err(|error| failure(&path, error))?;
        Ok(text)
    }

    #[test]
    fn a_stream_that_does_not_end_is_refused_with_its_bound() {
        assert_eq!(streamed(12).unwrap(), "1\n2\n3\n4\n5\n6\n");
        let error = streamed(11).unwrap_err();
        assert!(matches!(error, LogError::Content { .. }), "{error:?}");
        let message = error.to_string();
        assert!(message.contains("more than 268435456 bytes"), "{message}");
    }
}
