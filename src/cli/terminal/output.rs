//! Printing: data on stdout, talk on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::scenario::bounded;

/// Whether whoever read stdout has closed their end.
static READER_IS_GONE: AtomicBool = AtomicBool::new(false);

/// Writes data to stdout. A reader that closes its end (`| head`) has seen enough: that ends the
/// printing, not the command, whose verdict stays what it is.
///
/// # Errors
/// What the stream says, but for a closed pipe.
pub(in crate::cli) fn data(text: &str) -> io::Result<()> {
    if READER_IS_GONE.load(Ordering::Relaxed) {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    let written = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush());
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
            READER_IS_GONE.store(true, Ordering::Relaxed);
            Ok(())
        }
        Err(error) => {
            let message = format!("cannot write to standard output: {error}");
            Err(io::Error::new(error.kind(), message))
        }
        Ok(()) => Ok(()),
    }
}

/// Writes a line of talk to stderr. Nobody is left to tell when stderr itself is gone.
pub(in crate::cli) fn talk(line: &str) {
    let mut stderr = io::stderr().lock();
    drop(writeln!(stderr, "{line}"));
}

/// Most complaints, and most warnings, that are printed.
const LINES_MAX: usize = 50;

/// Writes the first of many lines to stderr, each behind a prefix, and how many more there are.
pub(in crate::cli) fn talk_first<L: Display>(prefix: &str, lines: impl Iterator<Item = L>) {
    talk_first_as(lines, |line| {
        format!("{prefix}{}", bounded(&line.to_string()))
    });
}

/// Writes the first of many things to stderr in words, and how many more there are.
pub(in crate::cli) fn talk_first_as<T>(
    things: impl Iterator<Item = T>,
    shown: impl Fn(&T) -> String,
) {
    let mut more = 0_usize;
    for (index, thing) in things.enumerate() {
        if index < LINES_MAX {
            talk(&shown(&thing));
        } else {
            more += 1;
        }
    }
    if more > 0 {
        talk(&format!("and {more} more"));
    }
}

/// Whether stdout may carry colours: a terminal, and `NO_COLOR` is not set.
pub(in crate::cli) fn colour() -> bool {
    !refuses_colour() && io::stdout().is_terminal()
}

/// Whether `NO_COLOR` is set.
pub(in crate::cli) fn refuses_colour() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Width of tables in columns: `COLUMNS` where it is set, else 100.
pub(in crate::cli) fn width() -> usize {
    const DEFAULT_COLUMNS: usize = 100;
    std::env::var("COLUMNS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(DEFAULT_COLUMNS)
}
