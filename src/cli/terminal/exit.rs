//! Exit codes: the contract with shells and CI jobs.

use std::borrow::Cow;
use std::io;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};

use crate::cli::terminal::output;
use crate::scenario::bounded;
use crate::wording::is_misspelling;

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Exit {
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
    /// A shard was ended by SIGTERM and goes on where it left off when it is started again.
    Continues,
    /// A signal has ended it; with the code that shells give it.
    Interrupted(u8),
}

impl Exit {
    /// The process's exit code.
    pub(in crate::cli) fn code(self) -> ExitCode {
        ExitCode::from(self.number())
    }

    /// The exit code as a number.
    pub(in crate::cli) fn number(self) -> u8 {
        match self {
            Self::Success => 0,
            Self::GateFailed => 1,
            Self::Usage => 2,
            Self::RunFailed => 3,
            Self::NothingSelected => 4,
            Self::Internal => 70,
            Self::Io => 74,
            Self::Continues => 75,
            Self::Interrupted(code) => code,
        }
    }

    /// The one that counts where both apply.
    pub(in crate::cli) fn worst(self, other: Self) -> Self {
        if other.rank() > self.rank() {
            other
        } else {
            self
        }
    }

    /// Place in the precedence of exit codes, the strongest last.
    fn rank(self) -> u8 {
        match self {
            Self::Success => 0,
            Self::GateFailed => 1,
            Self::RunFailed => 2,
            // These two end the program before anything runs.
            Self::NothingSelected => 3,
            Self::Usage => 4,
            Self::Io => 5,
            Self::Internal => 6,
            Self::Continues | Self::Interrupted(_) => 7,
        }
    }
}

/// Prints what clap has to say (help and version are no errors) and gives its exit code.
pub(in crate::cli) fn usage(mut error: clap::Error) -> ExitCode {
    drop_unlike(&mut error);
    let text = error.render().to_string();
    match bounded(&text) {
        // An argument of many kilobytes is not echoed whole.
        Cow::Owned(short) if error.use_stderr() => output::talk(&short),
        _ => {
            if let Err(failure) = error.print()
                && failure.kind() != io::ErrorKind::BrokenPipe
                && !error.use_stderr()
            {
                return io_failure(failure).code();
            }
            // Whoever closed the stream does not want to read it; the code stays what it is.
        }
    }
    if error.use_stderr() {
        Exit::Usage.code()
    } else {
        Exit::Success.code()
    }
}

/// Takes out a suggestion that is no slip of the pen: clap finds `--initial-inverse-correlation` like
/// `--initiation-interval`.
fn drop_unlike(error: &mut clap::Error) {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let (written, known) = (
        text(ContextKind::InvalidArg),
        text(ContextKind::SuggestedArg),
    );
    let is_slip = written
        .zip(known)
        .is_none_or(|(written, known)| is_misspelling(written, known));
    if !is_slip {
        error.remove(ContextKind::SuggestedArg);
        // The usage is that of the suggestion.
        error.remove(ContextKind::Usage);
    }
}

/// What could not be printed or written, said and as an exit code.
pub(in crate::cli) fn io_failure(error: io::Error) -> Exit {
    output::talk(&format!("error: {error}"));
    Exit::Io
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_exit_code_counts() {
        let order = [
            Exit::Interrupted(130),
            Exit::Internal,
            Exit::Io,
            Exit::RunFailed,
            Exit::GateFailed,
            Exit::Success,
        ];
        for (index, strong) in order.iter().enumerate() {
            for weak in &order[index..] {
                assert_eq!(strong.worst(*weak), *strong);
                assert_eq!(weak.worst(*strong), *strong);
            }
        }
    }
}
