//! The bytes of a large file, read while those before them are worked on.
//!
//! To copy a file out of the cache of the system takes half as long as to read its numbers.

use std::fs::File;
use std::io::{self, BufRead, Read};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use super::input::read_buffered;

/// Buffers on their way.
const BUFFERS: usize = 3;

/// Bytes read at once.
type Block = io::Result<(Vec<u8>, usize)>;

/// A file that a thread of its own reads. The thread ends with the file, and with this.
#[derive(Debug)]
pub(super) struct Ahead {
    empty: Sender<Vec<u8>>,
    full: Receiver<Block>,
    block: Vec<u8>,
    taken: usize,
    end: usize,
    is_over: bool,
}

impl Ahead {
    /// Begins to read.
    ///
    /// # Errors
    /// There is no thread to be had.
    pub(super) fn of(file: File, buffer_bytes: usize) -> io::Result<Self> {
        let (empty, emptied) = channel::<Vec<u8>>();
        let (filled, full) = channel();
        for _ in 1..BUFFERS {
            // Who would take it is not gone yet.
            let _ = empty.send(vec![0; buffer_bytes]);
        }
        let work = move || {
            for buffer in emptied {
                let block = read_block(&file, buffer);
                let is_last = block.as_ref().map_or(true, |(_, count)| *count == 0);
                if filled.send(block).is_err() || is_last {
                    break;
                }
            }
        };
        thread::Builder::new()
            .name("read ahead".to_owned())
            .spawn(work)?;
        Ok(Self {
            empty,
            full,
            block: vec![0; buffer_bytes],
            taken: 0,
            end: 0,
            is_over: false,
        })
    }

    /// Exchanges a block that is done with for the next one.
    fn next(&mut self) -> io::Result<()> {
        // Behind the last block nobody takes a buffer.
        let _ = self.empty.send(std::mem::take(&mut self.block));
        (self.taken, self.end) = (0, 0);
        let gone = |_| io::Error::other("the thread that reads the file is gone");
        let block = self.full.recv().map_err(gone).flatten();
        let (block, count) = block.inspect_err(|_| self.is_over = true)?;
        self.is_over = count == 0;
        (self.block, self.end) = (block, count);
        Ok(())
    }
}

fn read_block(mut file: &File, mut buffer: Vec<u8>) -> Block {
    loop {
        match file.read(&mut buffer) {
            Ok(count) => return Ok((buffer, count)),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

impl Read for Ahead {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        read_buffered(self, buffer)
    }
}

impl BufRead for Ahead {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.end && !self.is_over {
            self.next()?;
        }
        Ok(&self.block[self.taken..self.end])
    }

    fn consume(&mut self, count: usize) {
        self.taken = (self.taken + count).min(self.end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bytes_come_once_and_in_order_whatever_is_taken_of_a_block() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bytes");
        let bytes: Vec<u8> = (0..100_003_u64).map(|at| (at * at % 251) as u8).collect();
        std::fs::write(&path, &bytes).unwrap();
        for (buffer_bytes, most) in [(1000, 7), (4096, 5000), (1 << 20, 1 << 20)] {
            let mut ahead = Ahead::of(File::open(&path).unwrap(), buffer_bytes).unwrap();
            let mut found = Vec::new();
            loop {
                let available = ahead.fill_buf().unwrap();
                let count = available.len().min(most);
                if count == 0 {
                    break;
                }
                found.extend_from_slice(&available[..count]);
                ahead.consume(count);
            }
            assert!(found == bytes, "{buffer_bytes} {most}");
            assert!(
                ahead.fill_buf().unwrap().is_empty(),
                "the end stays the end"
            );
        }
    }

    #[test]
    fn one_that_is_dropped_early_leaves_no_thread_waiting() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bytes");
        std::fs::write(&path, vec![7; 100_000]).unwrap();
        let mut ahead = Ahead::of(File::open(&path).unwrap(), 100).unwrap();
        let mut first = [0; 150];
        ahead.read_exact(&mut first).unwrap();
        assert_eq!(first, [7; 150]);
        // The thread waits for a buffer, and ends as nobody gives it one.
        let Ahead { empty, full, .. } = ahead;
        drop(empty);
        while full.recv().is_ok() {}
    }

    #[test]
    fn an_error_of_the_file_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let mut ahead = Ahead::of(File::open(folder.path()).unwrap(), 100).unwrap();
        assert!(ahead.fill_buf().is_err(), "a folder has no bytes");
        assert!(ahead.fill_buf().unwrap().is_empty());
    }
}
