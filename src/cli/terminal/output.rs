//! Printing: data on stdout, talk on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::ValueEnum;

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

/// Writes bytes to stdout, where they are seen at once.
///
/// # Errors
/// What the stream says; a closed pipe as well, as nothing is left to be done for whoever streams.
pub(in crate::cli) fn bytes(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(bytes)?;
    stdout.flush()
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

/// When output carries colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Colour {
    /// On a terminal, unless `NO_COLOR` is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// What the command line says of colours.
static COLOUR: OnceLock<Colour> = OnceLock::new();

/// Takes over what the command line says of colours.
pub(in crate::cli) fn set_colour(colour: Colour) {
    COLOUR.get_or_init(|| colour);
}

/// Whether stdout may carry colours.
pub(in crate::cli) fn colour() -> bool {
    is_coloured(&io::stdout())
}

/// Whether stderr may carry colours.
pub(in crate::cli) fn talk_colour() -> bool {
    is_coloured(&io::stderr())
}

fn is_coloured(stream: &impl IsTerminal) -> bool {
    match COLOUR.get().copied().unwrap_or(Colour::Auto) {
        Colour::Always => true,
        Colour::Never => false,
        Colour::Auto => {
            let is_refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
            !is_refused && stream.is_terminal()
        }
    }
}

/// Width of tables in columns: `COLUMNS` where it is set, else 100.
pub(in crate::cli) fn width() -> usize {
    const DEFAULT_COLUMNS: usize = 100;
    std::env::var("COLUMNS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(DEFAULT_COLUMNS)
}
