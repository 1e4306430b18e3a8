//! How a channel fails whose words come from outside.

use crate::metrics::ChannelFailure;
use crate::program::FaultKind;

/// What went wrong outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FailureKind {
    /// The words were computed from other samples.
    OtherInput,
    /// The file of the words is none, or of another length.
    Unreadable,
    /// Nobody has allowed programs.
    NotAllowed,
    /// A program ended or answered otherwise than it should.
    Program,
    /// A program took too long.
    TimeOut,
    /// A program took too much memory.
    Memory,
    /// A program could not be started.
    NotStarted,
}

impl FailureKind {
    const ALL: [Self; 7] = [
        Self::OtherInput,
        Self::Unreadable,
        Self::NotAllowed,
        Self::Program,
        Self::TimeOut,
        Self::Memory,
        Self::NotStarted,
    ];

    /// Its name in results.
    const fn word(self) -> &'static str {
        match self {
            Self::OtherInput => "other input",
            Self::Unreadable => "unreadable",
            Self::NotAllowed => "not allowed",
            Self::Program => "program",
            Self::TimeOut => "time-out",
            Self::Memory => "memory",
            Self::NotStarted => "not started",
        }
    }

    /// Whether the same program on the same words may do otherwise another time.
    const fn is_of_the_moment(self) -> bool {
        matches!(
            self,
            Self::NotAllowed | Self::TimeOut | Self::Memory | Self::NotStarted
        )
    }

    /// The failure of a channel.
    pub(super) fn failure(self, sample: u64, message: String) -> ChannelFailure {
        ChannelFailure {
            kind: self.word().to_owned(),
            sample,
            message,
        }
    }
}

/// The kind of a failure, if it happened outside.
fn kind_of(failure: &ChannelFailure) -> Option<FailureKind> {
    let mut kinds = FailureKind::ALL.into_iter();
    kinds.find(|kind| kind.word() == failure.kind)
}

/// Whether a channel failed outside: no equation of a filter diverged.
pub(in crate::experiment) fn is_from_outside(failure: &ChannelFailure) -> bool {
    kind_of(failure).is_some()
}

/// Whether a channel failed by what need not happen again: such a result is not taken over.
pub(in crate::experiment) fn is_of_the_moment(failure: &ChannelFailure) -> bool {
    kind_of(failure).is_some_and(FailureKind::is_of_the_moment)
}

impl From<FaultKind> for FailureKind {
    fn from(kind: FaultKind) -> Self {
        match kind {
            FaultKind::Program => Self::Program,
            FaultKind::TimeOut => Self::TimeOut,
            FaultKind::Memory => Self::Memory,
            FaultKind::System => Self::NotStarted,
        }
    }
}
