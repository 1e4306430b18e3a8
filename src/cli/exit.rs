//! Exit codes: the contract with shells and CI jobs.

use std::borrow::Cow;
use std::io;
use std::process::ExitCode;

use super::output;
use crate::scenario::bounded;

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Exit {
    /// All well.
    Success,
    /// A gate failed.
    GateFailed,
    /// Wrong usage or a bad scenario.
    Usage,
    /// A channel failed while running.
    RunFailed,
    /// Nothing was selected to run.
    NothingSelected,
    /// A broken invariant.
    Internal,
    /// A file could not be read or written.
    Io,
}

impl Exit {
    /// The process's exit code.
    pub(super) fn code(self) -> ExitCode {
        ExitCode::from(match self {
            Self::Success => 0,
            Self::GateFailed => 1,
            Self::Usage => 2,
            Self::RunFailed => 3,
            Self::NothingSelected => 4,
            Self::Internal => 70,
            Self::Io => 74,
        })
    }
}

/// Prints what clap has to say (help and version are no errors) and gives its exit code.
pub(super) fn usage(error: &clap::Error) -> ExitCode {
    let text = error.render().to_string();
    match bounded(&text) {
        // An argument of many kilobytes is not echoed whole.
        Cow::Owned(short) if error.use_stderr() => output::talk(&short),
        // Whoever closed the stream does not want to read it; the code stays what it is.
        _ => drop(error.print()),
    }
    if error.use_stderr() {
        Exit::Usage.code()
    } else {
        Exit::Success.code()
    }
}

/// A reader that closed its end has seen enough: that is no failure. Anything else is.
pub(super) fn io_failure(error: io::Error) -> Exit {
    if error.kind() == io::ErrorKind::BrokenPipe {
        return Exit::Success;
    }
    output::talk(&format!("error: {error}"));
    Exit::Io
}
