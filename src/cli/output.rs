//! Printing: data on stdout, talk on stderr.

use std::io::{self, IsTerminal, Write};

/// Writes data to stdout.
///
/// # Errors
/// What the stream says, a closed pipe included.
pub(super) fn data(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}

/// Writes a line of talk to stderr. Nobody is left to tell when stderr itself is gone.
pub(super) fn talk(line: &str) {
    let mut stderr = io::stderr().lock();
    drop(writeln!(stderr, "{line}"));
}

/// Whether stdout may carry colours: a terminal, and `NO_COLOR` is not set.
pub(super) fn colour() -> bool {
    !refuses_colour() && io::stdout().is_terminal()
}

/// Whether `NO_COLOR` is set.
pub(super) fn refuses_colour() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Width of tables in columns: `COLUMNS` where it is set, else 100.
pub(super) fn width() -> usize {
    const DEFAULT_COLUMNS: usize = 100;
    std::env::var("COLUMNS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(DEFAULT_COLUMNS)
}
