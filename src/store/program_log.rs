//! What programs of the user's say while a suite runs: a file of the workshop, which no comparison of
//! results sees.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::WORKSHOP;
use super::files::plain_file;

/// Name of the file.
pub(super) const FILE: &str = "programs.log";

/// The file, made anew with its first line.
#[derive(Debug)]
pub struct ProgramLog {
    path: PathBuf,
    file: Mutex<Option<File>>,
}

impl ProgramLog {
    /// The file of an output folder, which need not be there yet.
    #[must_use]
    pub fn of(output: &Path) -> Self {
        Self {
            path: output.join(WORKSHOP).join(FILE),
            file: Mutex::new(None),
        }
    }

    /// Appends what a program said. The terminal has the line all the same where the file fails.
    pub fn said(&self, line: &str) {
        drop(self.append(line));
    }

    /// Appends the time of a channel's program. What the file lacks where it fails, no result has either.
    pub fn took(&self, run: &str, channel: &str, us_per_word: f64) {
        drop(self.append(&format!("{run} {channel}: {us_per_word:.3} us a word")));
    }

    fn append(&self, line: &str) -> io::Result<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let file = match &mut *file {
            Some(file) => file,
            none => {
                let mut options = plain_file();
                options.write(true).create(true).truncate(true);
                none.insert(options.open(&self.path)?)
            }
        };
        writeln!(file, "{line}")
    }
}
