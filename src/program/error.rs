//! What can go wrong with a program.

use std::io;

/// Of which kind a fault is: whether the same program on the same words shows it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaultKind {
    /// The program, or its answer, is wrong.
    Program,
    /// It took too long.
    TimeOut,
    /// It took too much memory.
    Memory,
    /// It could not be started, or the system failed.
    System,
}

/// Why a program gave no words.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ProgramError {
    #[error("the program could not be started: {0}")]
    Start(String),
    #[error("the system failed the program: {0}")]
    System(#[from] io::Error),
    #[error("no {awaited} within {timeout_s} s ({key})")]
    TimeOut {
        awaited: &'static str,
        timeout_s: f64,
        key: &'static str,
    },
    #[error("it took {found_mb} MB of memory: allowed up to {limit_mb} MB (memory_mb)")]
    Memory { found_mb: u64, limit_mb: u64 },
    #[error("it ended {how} before {awaited}")]
    Ended { how: String, awaited: &'static str },
    #[error("it answered every word and then ended {0}")]
    EndedBadly(String),
    #[error("its first line is no answer to the greeting: {reason}; it began with `{line}`")]
    Greeting { reason: &'static str, line: String },
    #[error(
        "it answered {found} words to {wanted}: expected the same count, as u32 little-endian before \
         the words"
    )]
    Count { wanted: u32, found: u32 },
    #[error(
        "it wrote text where words were expected, beginning with `{0}`: print to stderr, stdout is for \
         words"
    )]
    Text(String),
    #[error("its word is {value}, which is not a finite number")]
    NotFinite { index: usize, value: f64 },
    #[error("{0} more bytes came behind the last word: expected none")]
    Surplus(usize),
}

impl ProgramError {
    /// Its kind.
    pub(crate) fn kind(&self) -> FaultKind {
        match self {
            Self::TimeOut { .. } => FaultKind::TimeOut,
            Self::Memory { .. } => FaultKind::Memory,
            Self::Start(_) | Self::System(_) => FaultKind::System,
            _ => FaultKind::Program,
        }
    }

    /// Index of the word in its block that is to blame; 0 where all of it is.
    pub(crate) fn word(&self) -> usize {
        match self {
            Self::NotFinite { index, .. } => *index,
            _ => 0,
        }
    }
}
